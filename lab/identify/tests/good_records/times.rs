//! The column of the time, by its name, its unit or an option.

use super::{accepted, csv, rows};
use bowden_lab::record::{parse, Options, Record};

fn timed(text: &str, time: &str) -> Record {
    let options = Options {
        time: Some(time.to_owned()),
        ..Options::default()
    };
    parse(text.as_bytes(), "r.csv", &options).unwrap_or_else(|error| panic!("{error}"))
}

/// The record whose stamps are counted by `per_second`.
fn counted(header: &str, per_second: f64) -> String {
    let row = |(i, row): (usize, &String)| {
        let stamp = i as f64 * 0.01 * per_second;
        format!("{stamp},{}", row.split_once(',').unwrap().1)
    };
    csv(
        header,
        &rows().iter().enumerate().map(row).collect::<Vec<_>>(),
    )
}

fn is_plain(record: &Record, what: &str) {
    let apart = |(i, t): (usize, &f64)| (t - i as f64 * 0.01).abs();
    let apart = record.time.iter().enumerate().map(apart);
    // One rounding of a product below 4.
    assert!(apart.fold(0.0, f64::max) < 1e-12, "{what}");
}

#[test]
fn a_time_column_called_as_its_unit_is_in_that_unit() {
    for (name, per_second, unit) in [
        ("ms", 1e3, "ms"),
        ("millis", 1e3, "ms"),
        ("Milliseconds", 1e3, "ms"),
        ("us", 1e6, "µs"),
        ("micros", 1e6, "µs"),
        ("nanoseconds", 1e9, "ns"),
        ("minutes", 1.0 / 60.0, "min"),
    ] {
        let said = format!("time converted from {unit} to s");
        let text = counted(&format!("{name},x,f"), per_second);
        for record in [accepted(&text), timed(&text, name)] {
            is_plain(&record, name);
            assert_eq!(record.notes, [said.as_str()], "{name}");
        }
        // Behind another word the unit counts too, once the column is chosen.
        let text = counted(&format!("boot {name},x,f"), per_second);
        let record = timed(&text, &format!("boot {name}"));
        is_plain(&record, name);
        assert_eq!(record.notes, [said], "{name}");
    }
    for name in ["timeMs", "time ms", "t_millis", "timestamp.ms"] {
        is_plain(&accepted(counted(&format!("{name},x,f"), 1e3)), name);
    }
    for name in ["seconds", "Sec", "elapsed_sec", "tSec", "s"] {
        let record = timed(&counted(&format!("{name},x,f"), 1.0), name);
        is_plain(&record, name);
        assert_eq!(record.notes, [""; 0], "{name}");
    }
    // What brackets state comes before what a name says, and `t` before any name.
    is_plain(&accepted(counted("millis [s],x,f", 1.0)), "brackets");
    is_plain(
        &accepted(
            counted("t,x,f,ms", 1.0)
                .replace('\n', ",7\n")
                .replacen(",7", "", 1),
        ),
        "t",
    );
}

#[test]
fn an_option_states_the_unit_of_a_column() {
    let record = timed(&counted("tick,x,f", 1e3), "tick [ms]");
    is_plain(&record, "tick");
    let converted = "time converted from ms to s";
    assert_eq!(record.notes, ["unit of `tick` from --time: ms", converted]);
    // Also against the file, which is then named; a row of units is overruled.
    for header in ["t [s],x,f", "t,x,f\ns,mm,N"] {
        let record = timed(&counted(header, 1e3), "t [ms]");
        is_plain(&record, header);
        assert!(
            record
                .notes
                .iter()
                .any(|note| note.starts_with("unit of `t` from --time: ms")),
            "{:?}",
            record.notes
        );
    }
    let options = Options {
        input: Some("x (mm)".to_owned()),
        output: Some("f [N]".to_owned()),
        channels: vec![("angle".to_owned(), "q [deg]-p [rad]".to_owned())],
        ..Options::default()
    };
    let wide: Vec<String> = rows().iter().map(|row| format!("{row},90,1")).collect();
    let text = csv("t,x,f,q,p", &wide);
    let record = parse(text.as_bytes(), "r.csv", &options).unwrap();
    assert_eq!(record.input.unit.as_deref(), Some("mm"));
    assert_eq!(record.output.unit.as_deref(), Some("N"));
    let angle = record.channel("angle").unwrap();
    assert_eq!(angle.unit.as_deref(), Some("rad"));
    // Two roundings of values below two.
    assert!((angle.values[0] - (std::f64::consts::FRAC_PI_2 - 1.0)).abs() < 1e-14);
}

#[test]
fn comments_among_the_rows_are_passed_over() {
    let plain = accepted(csv("t,x,f", &rows()));
    let with = |comment: &str| {
        csv("t,x,f", &rows()).replacen("\n0.20,", &format!("\n{comment}\n0.20,"), 1)
    };
    for comment in [
        "# slipped here",
        "% slipped, here, now, ok",
        "//",
        "#",
        "#stop",
        "#0.2,1,2",
        "# warm,,",
    ] {
        let record = accepted(with(comment));
        assert_eq!(record.time, plain.time, "{comment}");
        assert_eq!(record.output.values, plain.output.values, "{comment}");
        assert_eq!(
            record.notes,
            ["line 22 ignored because it is a comment"],
            "{comment}"
        );
        let blanks = with(&comment.replace(',', " ")).replace(',', " ");
        assert_eq!(accepted(blanks).time, plain.time, "{comment}");
    }
    let record = accepted(with("# one\n# two words more"));
    assert_eq!(
        record.notes,
        ["2 comment lines ignored, the first one in line 22"]
    );
    // Comments above the units, and between the first rows below a preamble.
    for (head, notes) in [
        ("t,x,f\n# in the lab\ns,mm,N", &["units from line 3"][..]),
        (
            "Rig 4\nt,x,f\n% in the lab\ns,mm,N",
            &[
                "line 1 above the names ignored",
                "units from line 4",
                "line 3 between names and values ignored",
            ],
        ),
        ("Rig 4\nt,x,f", &["line 1 above the names ignored"]),
    ] {
        let text = csv(head, &rows()).replacen("\n0.01,", "\n# warm\n0.01,", 1);
        let record = accepted(&text);
        assert_eq!(record.time, plain.time, "{head}");
        assert_eq!(record.notes[..notes.len()], *notes, "{head}");
        assert!(
            record.notes[notes.len()].contains("ignored because it is a comment"),
            "{:?}",
            record.notes
        );
    }
    // A mark before a name is none of a comment, nor is an error of a spreadsheet.
    let numbered = |(i, row): (usize, &String)| format!("#{i},{row}");
    let numbered: Vec<String> = rows().iter().enumerate().map(numbered).collect();
    assert_eq!(accepted(csv("no,t,x,f", &numbered)).time, plain.time);
    let line = parse(with("#N/A,1,2").as_bytes(), "r.csv", &Options::default()).unwrap_err();
    assert!(
        line.to_string().contains("`#N/A` is a placeholder"),
        "{line}"
    );
}

#[test]
fn minutes_and_seconds_are_time_stamps() {
    let stamp = |(i, row): (usize, &String)| {
        let tenths = 599 + i;
        let values = row.split_once(',').unwrap().1;
        format!(
            "{:02}:{:02}.{},{values}",
            tenths / 600,
            tenths / 10 % 60,
            tenths % 10
        )
    };
    let text = csv(
        "t,x,f",
        &rows().iter().enumerate().map(stamp).collect::<Vec<_>>(),
    );
    let record = accepted(&text);
    assert!((record.time[399] - 39.9).abs() < 1e-9);
    assert_eq!(record.notes, ["time stamps are minutes and seconds"]);
    // Excel hides the hours.
    let wrapped = text.replace("01:30", "00:00");
    let line = parse(wrapped.as_bytes(), "r.csv", &Options::default()).unwrap_err();
    assert_eq!(
        line.to_string(),
        "r.csv:303: column `t`: the time decreases from 89.9 to 0 s; if the record spans a full hour, write the hours too, as in 01:59:50.2"
    );
}

#[test]
fn a_time_with_a_mark_before_its_name_is_read() {
    for name in ["%time", "% time", "#t", "__time"] {
        let text = csv(&format!("{name},x,f"), &rows());
        for record in [accepted(&text), timed(&text, name)] {
            is_plain(&record, name);
            assert_eq!(record.notes, [""; 0], "{name}");
        }
    }
    let since = |(i, row): (usize, &String)| {
        format!(
            "{},{}",
            1_772_373_801_000_000_000 + 10_000_000 * i as u64,
            row.split_once(',').unwrap().1
        )
    };
    let text = csv(
        "%time,x,f",
        &rows().iter().enumerate().map(since).collect::<Vec<_>>(),
    );
    for record in [accepted(&text), timed(&text, "%time")] {
        // A double counts nanoseconds since 1970 by 256.
        assert!((record.time[399] - 3.99).abs() < 1e-6);
        assert_eq!(
            record.notes,
            ["time stamps are in ns, as ROS writes them to `%time`"]
        );
    }
    // Under another name the unit is asked for.
    let line = parse(
        text.replace('%', "").as_bytes(),
        "r.csv",
        &Options::default(),
    )
    .unwrap_err();
    assert!(line.to_string().contains("if the unit is ns"), "{line}");
}
