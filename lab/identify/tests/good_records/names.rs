//! Names of columns as data acquisition programs write them, and units as those of test machines do.

use super::*;

#[test]
fn columns_of_one_name_that_are_not_read_may_have_it() {
    let text = wider("t,x,f,Not selected,Not selected", ",0,0");
    let note = "columns not read: `Not selected`, `Not selected`";
    same(text, &Options::default(), &[note]);
}

/// Of each channel its time and its values, with the names behind a label.
#[test]
fn pairs_of_time_and_value_are_read_by_the_rate_or_by_given_names() {
    let head = "Started,2026-03-01,Started,2026-03-01\nChannel,\"Force\",Channel,\"Travel\"\nUnit,\"N\",Unit,\"mm\"";
    let text = changed(head, |_, row| {
        let cells: Vec<&str> = row.split(',').collect();
        format!("{},{},{},{}", cells[0], cells[2], cells[0], cells[1])
    });
    let mut rate = ends("Travel", "Force");
    rate.rate = Some(100.0);
    for options in [rate, named(&["t", "f [N]", "", "x [mm]"])] {
        let record = read(&text, &options);
        assert_eq!(units(&record), [Some("mm"), Some("N")]);
        assert!((record.time[399] - 3.99).abs() < 1e-12);
    }
    let mut twice = ends("Travel", "Force");
    twice.time = Some("Channel".to_owned());
    refused_with(
        &text,
        &twice,
        "2: column `Channel`: named twice, as columns 1 and 3; --names A,B,… gives each column its own name",
    );
}

/// The second row has the names of the channels, and the unit of the time.
#[test]
fn names_of_channels_in_the_row_of_units_are_names() {
    let head = "Axis1\nTime,Analog 1,Analog 2,Analog 3,Analog 4\nms,Droop,Torque,Not selected,Not selected";
    let text = changed(head, |i, row| format!("{},{},0,0", 10 * i, &row[5..]));
    for options in [ends("Droop", "Torque"), ends("Analog 1", "Analog 2")] {
        let record = read(&text, &options);
        assert!((record.time[399] - 3.99).abs() < 1e-9);
    }
    let line = refusal(&text, &Options::default());
    let says = "r.csv:3: the columns `ms`, `Droop`, `Torque`, `Not selected` include neither";
    assert!(line.starts_with(says), "{line}");
}

#[test]
fn units_are_known_in_any_case_and_spelt_out() {
    let is = |header: &str, own: [&str; 2]| {
        let record = accepted(csv(header, &rows()));
        assert_eq!(units(&record), own.map(Some), "{header}");
        record
    };
    for (row, own) in [
        ("Sec,mm,kN", ["mm", "kN"]),
        ("seconds,Inch,lbs", ["in", "lbf"]),
        ("SEC,MM,KN", ["mm", "kN"]),
        ("s,Millimeters,Newtons", ["mm", "N"]),
        ("(sec),[inches],(Kilonewtons)", ["in", "kN"]),
        ("Unit,mm/mm,MPA", ["mm/mm", "MPa"]),
        ("s,counts,N", ["counts", "N"]),
    ] {
        for above in ["", "Axial test\nDate,now\n"] {
            let record = is(&format!("{above}t,x,f\n{row}"), own);
            assert!((record.time[399] - 3.99).abs() < 1e-12, "{row}");
        }
    }
    for (header, own) in [
        ("t,x (Inch),f (lbs)", ["in", "lbf"]),
        ("t [Sec],x [MM],f [Newtons]", ["mm", "N"]),
        ("time_sec,x_inches,f_KN", ["in", "kN"]),
        ("t,x / mm,f / Kilonewton", ["mm", "kN"]),
        ("Time Sec,x inches,f lbs", ["in", "lbf"]),
        ("t,x (mm/mm),f (lbs)", ["mm/mm", "lbf"]),
        ("#t,x,f\n#s,mm,kN", ["mm", "kN"]),
        ("# Rig 4\n# t,x,f\n# s,mm,kN", ["mm", "kN"]),
        ("%t,x,f\n% made by hand\n%s,mm,kN", ["mm", "kN"]),
    ] {
        is(header, own);
    }
    // A unit of time that is spelt out is converted as its sign is.
    for header in ["#t,x,f\n#ms,mm,N", "t,x,f\nMilliseconds,mm,N"] {
        let record = is(header, ["mm", "N"]);
        assert!((record.time[399] - 0.003_99).abs() < 1e-12);
    }
}

#[test]
fn a_word_that_is_no_known_unit_is_kept_with_a_note() {
    let record = accepted(csv("t,x,f\ns,wide,N·x", &rows()));
    assert_eq!(units(&record), [Some("wide"), Some("N·x")]);
    assert_eq!(
        record.notes,
        [
            "units from line 2",
            "unit `wide` of `x` is unknown and was kept",
            "unit `N·x` of `f` is unknown and was kept"
        ]
    );
    // Two units at once are none.
    let record = accepted(csv("t,x,f\ns,mm,NM", &rows()));
    assert_eq!(units(&record), [Some("mm"), Some("NM")]);
}
