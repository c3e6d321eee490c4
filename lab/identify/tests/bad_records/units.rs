//! Units below the names or in brackets: their spellings, and what is no unit; the unit of time.

use super::*;
use bowden_lab::record::{agree, Options};

/// The torque record behind semicolons with a row of units.
fn with_row(above: &str, units: &str) -> String {
    let values = rows().join("\n").replace(',', ";");
    format!("{above}t;tau_i;tau_o\n{units}\n{values}\n")
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
                assert_eq!(units(&record), [Some(unit); 2], "{cell} {time}");
                let said = |note: &String| note.starts_with("units from line ");
                assert!(record.notes.iter().any(said), "{:?}", record.notes);
            }
        }
    }
    let text = wider("t,tau_i,tau_o,phi_p\ns,Nm,Nm,Grad", ",90");
    let record = accepted(text.replace(',', ";"));
    let angle = record.channel("phi_p").unwrap();
    assert_eq!(angle.unit.as_deref(), Some("rad"));
    assert_eq!(angle.values[0], std::f64::consts::FRAC_PI_2);
}

#[test]
fn a_word_below_the_time_that_is_no_unit_of_time_is_refused() {
    let says = "is not a unit of time; allowed are s, ms, us, ns, min, h and d, in the file or with --time 't [ms]'";
    for (above, line) in [(ABOVE[0], 2), (ABOVE[1], 4)] {
        for word in ["when", "mm", "N/A"] {
            let text = with_row(above, &format!("{word};Nm;Nm"));
            refused(text, &format!("{line}: column `t`: `{word}` {says}"));
        }
        let record = read(with_row(above, "when;Nm;Nm"), &timed("t [s]"));
        assert_eq!(units(&record), [Some("Nm"); 2]);
    }
    // Letters that number the channels are words, although two of them are units.
    let record = accepted(with_row(ABOVE[1], "T;A;B"));
    assert_eq!(units(&record), [None; 2]);
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
    let said = "`tau_i` converted from unit N·mm to unit N·m";
    assert_eq!(both[1].notes[0], said);
    // What is not known stays as it is, and is not taken for anything else.
    let line = agree(&mut [of("N·m"), of("wide")]).unwrap_err().to_string();
    let says = "has unit wide, but it must have unit N·m";
    assert!(line.contains(says), "{line}");
}

#[test]
fn days_without_a_unit_are_not_taken_for_seconds() {
    let day = |i: usize| format!("{:.12}", 45_000.0 + i as f64 * 1e-3 / 86_400.0);
    refused(
        stamped("t,x,f", day),
        "1: column `t`: the time has no unit, and in s there would be 8.640e7 rows per second; set --time 't [d]' for days, 't [h]' for hours, or 't [s]'",
    );
    let record = accepted(stamped("t [d],x,f", day));
    // A day's twelfth digit is a tenth of a microsecond.
    assert!((record.time[399] - 0.399).abs() < 1e-6);
}

#[test]
fn stamps_without_a_unit_that_cannot_be_seconds_are_refused() {
    let of =
        |step: u64, first: u64| stamped("t,x,f", move |i| (first + step * i as u64).to_string());
    let since = "; in s, the first time stamp of FIRST would be thousands of years";
    // Since nothing, and since 1970; a double counts nanoseconds since then by 256.
    for (step, first, unit, start) in [
        (2_000, 0, "µs", ""),
        (2_000_000, 0, "ns", ""),
        (2, 1_772_373_801_000, "ms", "1.772e12"),
        (2_000, 1_772_373_801_000_000, "µs", "1.772e15"),
        (
            2_048_000,
            1_772_373_801_000_000_000 / 256 * 256,
            "ns",
            "1.772e18",
        ),
    ] {
        let start = match start {
            "" => String::new(),
            first => since.replace("FIRST", first),
        };
        refused(of(step, first), &format!(
            "1: column `t`: the time has no unit and was read as seconds, with a median step of {step} s; \
             set --time 't [{unit}]' if the unit is {unit}, or 't [s]' for seconds{start}"
        ));
    }
    // What may be seconds is read, and asked about.
    for text in [of(1, 0), of(2, 0), of(100, 0), of(2, 1_772_373_801)] {
        let notes = accepted(text).notes;
        assert!(
            notes[0].contains("set --time 't [ms]' if the unit is ms"),
            "{notes:?}"
        );
    }
    // A year a row is no logger's step in any unit, and with its unit any step is right.
    accepted(of(31_557_600_000, 0));
    let stated = of(2_000, 0).replacen("t,", "t [s],", 1);
    assert_eq!(read(stated, &Options::default()).time[1], 2000.0);
}
