//! The column of the time, by its name, its unit or an option.

use super::*;

/// The record whose stamps are counted by `per_second`.
fn counted(header: &str, per_second: f64) -> String {
    stamped(header, |i| (i as f64 * 0.01 * per_second).to_string())
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
        // Behind another word the unit counts too, once the column is chosen.
        let boot = format!("boot {name}");
        let [text, late] = [name, &boot].map(|own| counted(&format!("{own},x,f"), per_second));
        for record in [
            accepted(&text),
            read(&text, &timed(name)),
            read(&late, &timed(&boot)),
        ] {
            is_plain(&record, name);
            let said = format!("time converted from {unit} to s");
            assert_eq!(record.notes, [said], "{name}");
        }
    }
    for name in ["timeMs", "time ms", "t_millis", "timestamp.ms", "t [ms]"] {
        is_plain(&accepted(counted(&format!("{name},x,f"), 1e3)), name);
    }
    for name in ["seconds", "Sec", "elapsed_sec", "tSec", "s"] {
        let record = read(counted(&format!("{name},x,f"), 1.0), &timed(name));
        is_plain(&record, name);
        assert_eq!(record.notes, [""; 0], "{name}");
    }
    // Most programs write `time`, whose unit may stand behind it.
    for name in ["time", "Time", "time_s", "Time [s]"] {
        is_plain(&accepted(counted(&format!("{name},x,f"), 1.0)), name);
    }
    is_plain(&accepted(counted("Time [ms],x,f", 1e3)), "Time [ms]");
    // What brackets state comes before what a name says, and `t` before any name.
    is_plain(&accepted(counted("millis [s],x,f", 1.0)), "brackets");
    for name in ["ms", "time"] {
        is_plain(&accepted(wider(&format!("t,x,f,{name}"), ",7")), name);
    }
}

#[test]
fn an_option_states_the_unit_of_a_column() {
    let record = read(counted("tick,x,f", 1e3), &timed("tick [ms]"));
    is_plain(&record, "tick");
    let converted = "time converted from ms to s";
    assert_eq!(record.notes, ["unit of `tick` from --time: ms", converted]);
    // Also against the file, which is then named; a row of units is overruled.
    for header in ["t [s],x,f", "t,x,f\ns,mm,N"] {
        let record = read(counted(header, 1e3), &timed("t [ms]"));
        is_plain(&record, header);
        let said = |note: &String| note.starts_with("unit of `t` from --time: ms");
        assert!(record.notes.iter().any(said), "{:?}", record.notes);
    }
    let mut options = channels(&[("angle", "q [deg]-p [rad]")]);
    options.input = Some("x (mm)".to_owned());
    options.output = Some("f [N]".to_owned());
    let record = read(wider("t,x,f,q,p", ",90,1"), &options);
    assert_eq!(units(&record), [Some("mm"), Some("N")]);
    let angle = record.channel("angle").unwrap();
    assert_eq!(angle.unit.as_deref(), Some("rad"));
    // Two roundings of values below two.
    assert!((angle.values[0] - (std::f64::consts::FRAC_PI_2 - 1.0)).abs() < 1e-14);
}

#[test]
fn comments_among_the_rows_are_passed_over() {
    let none = Options::default();
    let with = |comment: &str| plain().replacen("\n0.20,", &format!("\n{comment}\n0.20,"), 1);
    for comment in [
        "# slipped here",
        "% slipped, here, now, ok",
        "//",
        "#",
        "#stop",
        "#0.2,1,2",
        "# warm,,",
    ] {
        let said = "line 22 ignored because it is a comment";
        same(with(comment), &none, &[said]);
        let blanks = with(&comment.replace(',', " ")).replace(',', " ");
        same_numbers(blanks, &none);
    }
    let two = "2 comment lines ignored, the first one in line 22";
    same(with("# one\n# two words more"), &none, &[two]);
    // Comments above the units, and between the first rows below a preamble.
    let above = "line 1 above the names ignored";
    for (head, notes) in [
        ("t,x,f\n# in the lab\ns,mm,N", &["units from line 3"][..]),
        (
            "Rig 4\nt,x,f\n% in the lab\ns,mm,N",
            &[
                above,
                "units from line 4",
                "line 3 between names and values ignored",
            ],
        ),
        ("Rig 4\nt,x,f", &[above]),
    ] {
        let text = csv(head, &rows()).replacen("\n0.01,", "\n# warm\n0.01,", 1);
        let own = same_numbers(&text, &none).notes;
        assert_eq!(own[..notes.len()], *notes, "{head}");
        let last = &own[notes.len()];
        assert!(last.contains("ignored because it is a comment"), "{own:?}");
    }
    // A mark before a name is none of a comment, nor is an error of a spreadsheet.
    let numbered = changed("no,t,x,f", |i, row| format!("#{i},{row}"));
    same_numbers(numbered, &none);
    let line = refusal(with("#N/A,1,2"), &none);
    assert!(line.contains("`#N/A` is a placeholder"), "{line}");
}

#[test]
fn minutes_and_seconds_are_time_stamps() {
    let text = stamped("t,x,f", |i| {
        let tenths = 599 + i;
        format!(
            "{:02}:{:02}.{}",
            tenths / 600,
            tenths / 10 % 60,
            tenths % 10
        )
    });
    let record = accepted(&text);
    assert!((record.time[399] - 39.9).abs() < 1e-9);
    assert_eq!(record.notes, ["time stamps are minutes and seconds"]);
    // Excel hides the hours.
    refused(
        text.replace("01:30", "00:00"),
        "303: column `t`: the time decreases from 89.9 to 0 s; if the record spans a full hour, write the hours too, as in 01:59:50.2",
    );
}

#[test]
fn a_time_with_a_mark_before_its_name_is_read() {
    for name in ["%time", "% time", "#t", "__time"] {
        let text = csv(&format!("{name},x,f"), &rows());
        for options in [Options::default(), timed(name)] {
            same(&text, &options, &[]);
        }
    }
    let text = stamped("%time,x,f", |i| {
        (1_772_373_801_000_000_000 + 10_000_000 * i as u64).to_string()
    });
    for options in [Options::default(), timed("%time")] {
        let record = read(&text, &options);
        // A double counts nanoseconds since 1970 by 256.
        assert!((record.time[399] - 3.99).abs() < 1e-6);
        let said = "time stamps are in ns, as ROS writes them to `%time`";
        assert_eq!(record.notes, [said]);
    }
    // Under another name the unit is asked for.
    let line = refusal(text.replace('%', ""), &Options::default());
    assert!(line.contains("if the unit is ns"), "{line}");
}
