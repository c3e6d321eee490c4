//! Tables whose names come again: one record if the time continues.

use super::{accepted, csv, rows};
use bowden_lab::record::{parse, Options, Record};

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
fn blocks((preamble, names, units): Head, last: usize) -> String {
    let all = rows();
    let of = |rows: &[String]| format!("{preamble}{names}{units}{}\n\n", rows.join("\n"));
    all[..last].chunks(100).map(of).collect()
}

fn segment(text: &str, number: usize) -> Record {
    let options = Options {
        segment: Some(number),
        ..Options::default()
    };
    parse(text.as_bytes(), "r.csv", &options).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn names_that_come_again_while_the_time_goes_on_leave_one_record() {
    let plain = accepted(csv("t,x,f", &rows()));
    for head in HEADS {
        let text = blocks(head, 400);
        let record = accepted(&text);
        assert_eq!(record.time, plain.time, "{head:?}");
        assert_eq!(record.input.values, plain.input.values, "{head:?}");
        assert_eq!(record.output.values, plain.output.values, "{head:?}");
        let names = text
            .lines()
            .enumerate()
            .filter(|(_, line)| *line == head.1.trim());
        let second = names.map(|(index, _)| index + 1).nth(1).unwrap();
        let said = format!(
            "the column names are repeated, first in line {second}; 4 segments were read as one record"
        );
        assert!(record.notes.contains(&said), "{:?}", record.notes);
    }
    // Without blank lines, with blanks between the columns, and with names but no units.
    for text in [
        blocks(HEADS[0], 400).replace("\n\n", "\n"),
        blocks(HEADS[0], 400).replace(',', " "),
        blocks(HEADS[0], 400).replace("t,x,f\n", "t,x,f\nt,x,f\n"),
        blocks(HEADS[0], 400) + &"t,x,f\n".repeat(100_000),
        blocks(HEADS[0], 400).replacen("f\n", "f\ns,mm,N\n", 1),
    ] {
        assert_eq!(accepted(&text).time, plain.time, "{text:.30}");
    }
}

#[test]
fn a_segment_is_read_by_its_number() {
    let restart = |head: Head| {
        let own = blocks(head, 400);
        [own.as_str(), &own].concat()
    };
    for head in HEADS {
        // Of two records with four segments each, the first four belong together.
        let text = restart(head);
        let short = Options {
            segment: Some(5),
            ..Options::default()
        };
        let line = parse(text.as_bytes(), "r.csv", &short)
            .unwrap_err()
            .to_string();
        assert!(
            line.contains("the record is too short: 100 samples"),
            "{line}"
        );
    }
    let whole = |shift: f64| {
        let row = |(i, row): (usize, String)| {
            format!(
                "{:.2},{}",
                shift + 0.01 * i as f64,
                row.split_once(',').unwrap().1
            )
        };
        csv(
            "t,x,f",
            &rows().into_iter().enumerate().map(row).collect::<Vec<_>>(),
        )
    };
    let text = [whole(0.0), whole(7.0), whole(0.0)].concat();
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
