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
