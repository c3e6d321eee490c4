//! Units below the names or in brackets: their spellings, and what is no unit.

use super::{accepted, csv, refusal, refused, rows, with_time};
use bowden_lab::record::{agree, parse, Options, Record};

fn with_row(above: &str, units: &str) -> String {
    let values = rows().join("\n").replace(',', ";");
    format!("{above}t;tau_i;tau_o\n{units}\n{values}\n")
}

/// Units of input and output.
fn units(record: &Record) -> (Option<&str>, Option<&str>) {
    (record.input.unit.as_deref(), record.output.unit.as_deref())
}

/// The same row with and without lines above the names.
const ABOVE: [&str; 2] = ["", "# Rig 4\nWhen;now\n"];

#[test]
fn a_row_of_units_has_torques_in_every_spelling() {
    for (cell, unit) in [
        ("N·m", "N·m"),
        ("N-m", "N·m"),
        ("N.m", "N·m"),
        ("N m", "N·m"),
        ("N·mm", "N·mm"),
        ("N*mm", "N·mm"),
        ("N mm", "N·mm"),
        ("Nmm", "Nmm"),
        ("[N-mm]", "N·mm"),
        ("kgf·cm", "kgf·cm"),
        ("in-lb", "in·lb"),
        ("ft-lbf", "ft·lbf"),
    ] {
        for above in ABOVE {
            // Time stamps may have no unit, or their form.
            for time in ["s", "", "-", "ISO 8601", "hh:mm:ss"] {
                let record = accepted(with_row(above, &format!("{time};{cell};{cell}")));
                assert_eq!(units(&record), (Some(unit), Some(unit)), "{cell} {time}");
                let said = |note: &String| note.starts_with("units from line ");
                assert!(record.notes.iter().any(said), "{:?}", record.notes);
            }
        }
    }
    let angles = rows().join("\n").replace(',', ";");
    let record = accepted(format!("t;tau_i;tau_o;phi_p\ns;Nm;Nm;Grad\n{}\n", {
        let wide: Vec<String> = angles.lines().map(|row| format!("{row};90")).collect();
        wide.join("\n")
    }));
    let angle = record.channel("phi_p").unwrap();
    assert_eq!(angle.unit.as_deref(), Some("rad"));
    assert_eq!(angle.values[0], std::f64::consts::FRAC_PI_2);
}

#[test]
fn a_word_below_the_time_that_is_no_unit_of_time_is_refused() {
    for (above, line) in [(ABOVE[0], 2), (ABOVE[1], 4)] {
        for word in ["when", "mm", "N/A"] {
            refused(
                with_row(above, &format!("{word};Nm;Nm")),
                &format!(
                    "r.csv:{line}: column `t`: `{word}` is not a unit of time; allowed are s, ms, us, ns, min, h and d, in the file or with --time 't [ms]'"
                ),
            );
        }
        let options = Options {
            time: Some("t [s]".to_owned()),
            ..Options::default()
        };
        let text = with_row(above, "when;Nm;Nm");
        let record = parse(text.as_bytes(), "r.csv", &options).unwrap();
        assert_eq!(units(&record), (Some("Nm"), Some("Nm")));
    }
    // Letters that number the channels are words, although two of them are units.
    let record = accepted(with_row(ABOVE[1], "T;A;B"));
    assert_eq!(units(&record), (None, None));
    assert_eq!(record.notes.len(), 2, "{:?}", record.notes);
}

#[test]
fn spellings_of_one_unit_are_one_and_newton_millimetres_convert() {
    let of = |unit: &str| accepted(csv(&format!("t,tau_i [{unit}],tau_o [{unit}]"), &rows()));
    for unit in ["N*mm", "N mm", "N-mm", "Nmm", "mN·m"] {
        // Another output, since the same samples twice are refused.
        let mut other = of(unit);
        other.output.values[7] += 1.0;
        let mut both = [of("N·mm"), other];
        agree(&mut both).unwrap();
        assert_eq!(both[1].notes, [""; 0], "{unit}");
        assert_eq!(both[1].input, both[0].input);
    }
    let mut both = [of("N·m"), of("N mm")];
    agree(&mut both).unwrap();
    let (a, b) = (both[0].output.values[9], both[1].output.values[9]);
    assert!((1e3 * b / a - 1.0).abs() < 1e-15);
    assert_eq!(
        both[1].notes[0],
        "`tau_i` converted from unit N·mm to unit N·m"
    );
    // What is not known stays as it is, and is not taken for anything else.
    let mut both = [of("N·m"), of("wide")];
    let line = agree(&mut both).unwrap_err().to_string();
    assert!(
        line.contains("has unit wide, but it must have unit N·m"),
        "{line}"
    );
}

#[test]
fn the_unit_of_time_is_converted() {
    let record = accepted(with_time("t [ms],x,f", |i| format!("{}", 10 * i)));
    assert!((record.time[399] - 3.99).abs() < 1e-12);
    assert_eq!(record.notes, ["time converted from ms to s"]);
    refused(
        csv("t [V],x,f", &rows()),
        "r.csv:1: column `t`: `V` is not a unit of time; allowed are s, ms, us, ns, min, h and d, in the file or with --time 't [ms]'",
    );
}

#[test]
fn days_without_a_unit_are_not_taken_for_seconds() {
    let day = |i: usize| format!("{:.12}", 45_000.0 + i as f64 * 1e-3 / 86_400.0);
    refused(
        with_time("t,x,f", day),
        "r.csv:1: column `t`: the time has no unit, and in s there would be 8.640e7 rows per second; set --time 't [d]' for days, 't [h]' for hours, or 't [s]'",
    );
    let record = accepted(with_time("t [d],x,f", day));
    // A day's twelfth digit is a tenth of a microsecond.
    assert!((record.time[399] - 0.399).abs() < 1e-6);
}

#[test]
fn whole_seconds_give_the_rate_between_them() {
    let error = refusal(
        with_time("t,x,f", |i| (i / 40).to_string()),
        &Options::default(),
    );
    assert!(error.contains("(about 40.0 Hz)"), "{error}");
}
