//! Tables whose names come again: one record if the time continues.

use super::*;

/// What is above the names, the names, and what is below them.
type Head = (&'static str, &'static str, &'static str);

/// Each with a preamble of its own in every segment.
const HEADS: [Head; 4] = [
    ("", "t,x,f\n", ""),
    ("", "# t,x [mm],f\n", ""),
    ("Acquisition,,Time:,7.5,s\n", "t,x,f\n", "Sec,mm,kN\n"),
    (
        "Channels,2\nSamples,100,100\n***End_of_Header***,\n",
        "t,x,f,Comment\n",
        "",
    ),
];

/// The plain record in segments of a hundred rows, behind each of which is a blank line.
fn blocks((preamble, names, units): Head) -> String {
    let of = |rows: &[String]| format!("{preamble}{names}{units}{}\n\n", rows.join("\n"));
    rows().chunks(100).map(of).collect()
}

fn segment(text: &str, number: usize) -> Record {
    read(text, &with(|o| o.segment = Some(number)))
}

#[test]
fn names_that_come_again_while_the_time_goes_on_leave_one_record() {
    let none = Options::default();
    for head in HEADS {
        let text = blocks(head);
        let record = same_numbers(&text, &none);
        let lines = (1..).zip(text.lines());
        let mut names = lines.filter(|(_, line)| *line == head.1.trim());
        let second = names.nth(1).unwrap().0;
        let said = format!(
            "the column names are repeated, first in line {second}; 4 segments were read as one record"
        );
        assert!(record.notes.contains(&said), "{:?}", record.notes);
        // Of two records with four segments each, the first four belong together.
        let line = refusal(text.repeat(2), &with(|o| o.segment = Some(5)));
        let says = "the record is too short: 100 samples";
        assert!(line.contains(says), "{line}");
    }
    // Without blank lines, with blanks between the columns, and with names but no units.
    let text = blocks(HEADS[0]);
    for text in [
        text.replace("\n\n", "\n"),
        text.replace(',', " "),
        text.replace("t,x,f\n", "t,x,f\nt,x,f\n"),
        text.clone() + &"t,x,f\n".repeat(100_000),
        text.replacen("f\n", "f\ns,mm,N\n", 1),
    ] {
        same_numbers(&text, &none);
    }
}

#[test]
fn a_segment_is_read_by_its_number() {
    let whole = |shift: f64| stamped("t,x,f", |i| format!("{:.2}", shift + 0.01 * i as f64));
    let text = [0.0, 7.0, 0.0].map(whole).concat();
    let (first, second) = (segment(&text, 1), segment(&text, 2));
    assert_eq!(first.samples(), 400);
    assert_eq!(first.input.values, second.input.values);
    assert_eq!(second.notes, ["segment 2 of 3, with its names in line 402"]);
    assert_eq!(segment(&whole(0.0), 1).notes, [""; 0]);
    // Lines are those of the file, and the end of the file is that of its last segment.
    let cut = text.trim_end();
    let cut = &cut[..cut.len() - 5];
    assert_eq!(segment(cut, 1).samples(), 400);
    assert_eq!(segment(cut, 3).samples(), 400);
}
