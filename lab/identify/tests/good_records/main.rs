//! Good records are read: in every spelling, cut, held, quantised, and measured by others.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[allow(dead_code)]
#[path = "../shared/rows.rs"]
mod fine;
mod json;
mod names;
mod npz;
mod segments;
#[allow(dead_code)]
#[path = "../shared/mod.rs"]
mod shared;
mod stamps;
mod times;
mod workbook;

use bowden_lab::record::{of_columns, Column, Mode, Options, Record};
use fine::*;
use std::path::{Path, PathBuf};

#[test]
fn a_good_record_is_read_in_every_spelling() {
    let none = Options::default();
    let record = same(plain(), &none, &[]);
    let own = (record.mode, record.samples());
    assert_eq!(own, (Mode::Displacement, 400));
    assert!((record.step() - 0.01).abs() < 1e-12);
    let text = csv("t [s],x [mm],\"f [N]\"", &rows());
    for other in [
        text.clone(),
        format!("\u{feff}{text}"),
        text.replace('\n', "\r\n") + "\r\n\r\n",
        text.replace(',', ";"),
        text.replace(',', "\t"),
        text.replace('\n', "\r"),
        wider("t [s], x [mm], f [N], ", ", "),
    ] {
        let record = same_numbers(&other, &none);
        assert_eq!(units(&record), [Some("mm"), Some("N")]);
    }
}

#[test]
fn quoted_cells_hold_separators_quotes_and_line_ends() {
    for (newline, separator) in [("\n", ","), ("\r\n", ";"), ("\r", "\t")] {
        let names = [
            "t",
            "\"x [mm]\"",
            "\"f\n[N]\"",
            "\"what \"\"they\"\" said, or; not\"",
        ];
        let text = changed(&names.join(separator), |i, row| {
            let note = match i {
                7 => "\"the \"\"old\"\" jaw, as is; warm\"",
                9 => "\"slipped,\n\nmounted anew\n\"",
                _ => "\"\"",
            };
            let cells = row.replace(',', &format!("\"{separator}\""));
            format!("\"{cells}\"{separator}{note}")
        });
        let text = text.replace('\n', newline);
        let notes = [
            "columns not read: `what \"they\" said, or; not`",
            "1 row spans several lines within quotes",
        ];
        let record = same(&text, &Options::default(), &notes);
        assert_eq!(record.output.name, "f");
        assert_eq!(units(&record)[1], Some("N"));
        // Lines are counted as an editor does, those inside quotes included.
        let says = "26: column `t`: `0,20` has a decimal comma; write a decimal point";
        refused(text.replace("\"0.20\"", "\"0,20\""), says);
    }
}

#[test]
fn channels_are_read_by_their_own_name_or_by_the_given_one() {
    let header = "t,tau_i,tau_o,phi_p [rad],jaw_rad,spare";
    let text = wider(header, ",1.5,2.5,3.5");
    let record = read(text, &channels(&[("phi_d", "jaw_rad")]));
    let named = record.channels.iter();
    let named: Vec<_> = named.map(|c| (c.name.as_str(), c.values[0])).collect();
    assert_eq!(named, [("phi_d", 2.5), ("phi_p", 1.5)]);
    assert_eq!(record.channels[0].unit.as_deref(), Some("rad"));
    assert_eq!(record.mode, Mode::Torque);
    assert_eq!(record.notes, ["columns not read: `spare`"]);
}

#[test]
fn cuts_count_from_the_first_time_stamp_and_hide_what_they_cut() {
    let cut = with(|o| (o.skip, o.until) = (0.5, Some(3.0)));
    let record = read(with_line(12, "0.1,cut away,"), &cut);
    assert_eq!((record.samples(), record.time[0]), (251, 0.0));
    assert_eq!(record.notes, ["149 of 400 samples cut"]);
}

#[test]
fn holds_quantisation_and_dry_friction_are_not_clipping() {
    // A trapezoid: the input is held at its ends, and the output rests too.
    let triangle = |t: f64| (t - 4.0 * (t / 4.0 + 0.5).floor()).abs() - 1.0;
    let trapezoid = |t: f64| (3.0 * triangle(t)).clamp(-1.5, 1.5);
    accepted(of(trapezoid, |t| 2.0 * trapezoid(t)));
    accepted(of(trapezoid, |t| {
        2.0 * trapezoid(t) + 0.01 * (377.0 * t).sin()
    }));
    // A coarse converter: 16 counts in all.
    let sine = |t: f64| 8.0 * t.sin();
    accepted(of(|t| sine(t).round(), |t| (3.0 * sine(t)).round()));
    // A friction force without noise that is flat while the input slides.
    accepted(of(sine, |t| (1e3 * t.cos()).clamp(-1.0, 1.0)));
}

/// Gravity is sin q, whatever unit the encoder's log has.
#[test]
fn angles_are_read_in_radians_and_an_output_stays_as_it_is() {
    let angle = |unit: &str, of_a_radian: f64| {
        let header = format!("t,tau_i,tau_o,phi_p [{unit}],phi_d [rad]");
        let text = changed(&header, |i, row| {
            let q = 0.8 * (0.02 * i as f64).sin();
            format!("{row},{},{}", q * of_a_radian, 0.5 * q)
        });
        read(text, &channels(&[("stretch", "phi_p-phi_d")]))
    };
    let plain = angle("rad", 1.0);
    assert_eq!(plain.notes, [""; 0]);
    let turn = 1.0 / std::f64::consts::TAU;
    for (unit, of_a_radian) in [
        ("deg", 360.0 * turn),
        ("°", 360.0 * turn),
        ("degrees", 360.0 * turn),
        // As a German header has it; 400 to the turn are gon.
        ("Grad", 360.0 * turn),
        ("gon", 400.0 * turn),
        ("rev", turn),
        ("turns", turn),
        ("mrad", 1e3),
    ] {
        let record = angle(unit, of_a_radian);
        let said = |name: &str| {
            format!("`{name}` converted from {unit} to rad, the angle unit of the effects `gravity` and `ripple`")
        };
        assert_eq!(record.notes, [said("stretch"), said("phi_p")]);
        for name in ["phi_p", "stretch"] {
            let (own, true_one) = (record.channel(name).unwrap(), plain.channel(name).unwrap());
            assert_eq!(own.unit.as_deref(), Some("rad"), "{unit}");
            // The sum is of channels, which are in radians, and so says the firmware's file.
            assert_eq!(own.definition, true_one.definition, "{unit}");
            let pairs = own.values.iter().zip(&true_one.values);
            // Three roundings of values below one.
            assert!(pairs.fold(0.0, |most: f64, (a, b)| (a - b).abs().max(most)) < 1e-15);
        }
    }
    // The input of displacement mode is what effects are functions of, its output is not.
    let record = accepted(csv("t,x [deg],f [deg]", &rows()));
    assert_eq!(units(&record), [Some("rad"), Some("deg")]);
    let plain = accepted(fine::plain());
    assert_eq!(record.output.values, plain.output.values);
    // Columns in memory go the same way.
    let column = |name: &str, values: &[f64]| Column {
        name: name.to_owned(),
        unit: None,
        values: values.to_vec(),
        definition: None,
    };
    let columns = vec![
        column("t", &record.time),
        column("x [deg]", &plain.input.values),
        column("f", &record.output.values),
    ];
    let arrays = of_columns(columns, "arrays", &Options::default()).unwrap();
    assert_eq!(arrays.input, record.input);
    assert_eq!(arrays.notes, record.notes);
}

/// A single-turn encoder leaps in the unit of its log.
#[test]
fn an_angle_in_degrees_is_unwrapped_before_it_is_converted() {
    let record = accepted(changed("t,tau_i,tau_o,phi_p [deg]", |i, row| {
        let q = (170.0 + 0.1 * i as f64 + 180.0).rem_euclid(360.0) - 180.0;
        format!("{row},{q:.4}")
    }));
    assert_eq!(
        record.notes,
        [
            "`phi_p` wraps around at 360 once and was unwrapped",
            "`phi_p` converted from deg to rad, the angle unit of the effects `gravity` and `ripple`"
        ]
    );
    let last = record.channel("phi_p").unwrap().values[399];
    assert!((last - 209.9_f64.to_radians()).abs() < 1e-12);
}

/// Columns and cuts of each measured record.
fn mapping(path: &Path) -> Option<Options> {
    let folder = path.parent()?.file_name()?.to_str()?;
    let (input, output) = match folder {
        "emps" => ("q_m", "force_N"),
        "davinci_cable_tool" => ("drive_torque_Nm", "jaw_torque_Nm"),
        "faster_fatigue_rig" => ("displacement_mm", "force_norm"),
        "tribometer_friction" => ("position_mm", "friction_N"),
        "pneumatic_cylinder" => ("position_mm", "force_N"),
        "piezo_stage" => ("control_V", "displacement_um"),
        "mr_damper_utfsm" if path.ends_with("validation_earthquake.csv") => {
            ("displacement_mm", "force_N_1.0A")
        }
        "mr_damper_utfsm" => ("displacement_mm", "force_N"),
        _ => return None,
    };
    let mut options = ends(input, output);
    options.time = Some("time_s".to_owned());
    match folder {
        "davinci_cable_tool" => {
            options.mode = Some(Mode::Torque);
            options.channels = vec![
                ("phi_p".into(), "drive_angle_rad".into()),
                ("phi_d".into(), "jaw_angle_rad".into()),
            ];
        }
        "faster_fatigue_rig" => options.rate = Some(128.0),
        "tribometer_friction" => (options.skip, options.until) = (20.0, Some(209.0)),
        _ => {}
    }
    Some(options)
}

#[test]
fn every_measured_record_is_read() {
    let data = shared::folder();
    let Ok(folders) = std::fs::read_dir(&data) else {
        println!(
            "skipped: the measured records are not at {}",
            data.display()
        );
        return;
    };
    let files: Vec<PathBuf> = folders
        .flat_map(|folder| std::fs::read_dir(folder.unwrap().path()).unwrap())
        .map(|file| file.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "csv"))
        .collect();
    assert!(!files.is_empty());
    for path in files {
        let Some(options) = mapping(&path) else {
            continue;
        };
        let record = bowden_lab::record::read(&path, &options);
        let record = record.unwrap_or_else(|error| panic!("{error}"));
        println!(
            "{}: {} samples, {:?}",
            record.path,
            record.samples(),
            record.notes
        );
    }
}
