//! Units as the programs of test machines write them.

use super::{accepted, csv, rows};
use bowden_lab::record::Record;

/// Units of input and output.
fn units(record: &Record) -> (Option<&str>, Option<&str>) {
    (record.input.unit.as_deref(), record.output.unit.as_deref())
}

fn below(units: &str) -> Record {
    accepted(csv(&format!("t,x,f\n{units}"), &rows()))
}

#[test]
fn units_are_known_in_any_case_and_spelt_out() {
    for (row, input, output) in [
        ("Sec,mm,kN", "mm", "kN"),
        ("seconds,Inch,lbs", "in", "lbf"),
        ("SEC,MM,KN", "mm", "kN"),
        ("s,Millimeters,Newtons", "mm", "N"),
        ("(sec),[inches],(Kilonewtons)", "in", "kN"),
        ("Unit,mm/mm,MPA", "mm/mm", "MPa"),
        ("s,counts,N", "counts", "N"),
    ] {
        for above in ["", "Axial test\nDate,now\n"] {
            let text = csv(&format!("{above}t,x,f\n{row}"), &rows());
            let record = accepted(text);
            assert_eq!(units(&record), (Some(input), Some(output)), "{row}");
            assert!((record.time[399] - 3.99).abs() < 1e-12, "{row}");
        }
    }
    for (header, input, output) in [
        ("t,x (Inch),f (lbs)", "in", "lbf"),
        ("t [Sec],x [MM],f [Newtons]", "mm", "N"),
        ("time_sec,x_inches,f_KN", "in", "kN"),
        ("t,x / mm,f / Kilonewton", "mm", "kN"),
        ("Time Sec,x inches,f lbs", "in", "lbf"),
        ("t,x (mm/mm),f (lbs)", "mm/mm", "lbf"),
    ] {
        let record = accepted(csv(header, &rows()));
        assert_eq!(units(&record), (Some(input), Some(output)), "{header}");
    }
    for head in [
        "#t,x,f\n#s,mm,kN",
        "# Rig 4\n# t,x,f\n# s,mm,kN",
        "%t,x,f\n% made by hand\n%s,mm,kN",
    ] {
        let record = accepted(csv(head, &rows()));
        assert_eq!(units(&record), (Some("mm"), Some("kN")), "{head}");
    }
    let record = accepted(csv("#t,x,f\n#ms,mm,N", &rows()));
    assert!((record.time[399] - 0.003_99).abs() < 1e-12);
    // A unit of time that is spelt out is converted as its sign is.
    let record = accepted(format!("t,x,f\nMilliseconds,mm,N\n{}\n", rows().join("\n")));
    assert!((record.time[399] - 0.003_99).abs() < 1e-12);
}

#[test]
fn a_word_that_is_no_known_unit_is_kept_with_a_note() {
    let record = below("s,wide,N·x");
    assert_eq!(units(&record), (Some("wide"), Some("N·x")));
    assert_eq!(
        record.notes,
        [
            "units from line 2",
            "unit `wide` of `x` is unknown and was kept",
            "unit `N·x` of `f` is unknown and was kept"
        ]
    );
    // Two units at once are none.
    let record = below("s,mm,NM");
    assert_eq!(units(&record), (Some("mm"), Some("NM")));
}
