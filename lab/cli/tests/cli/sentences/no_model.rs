//! Files in which there is no model to be found: the verdict must say so.

use crate::sentences::files::{noise, Closed, Rows, PHI_P, T, TAU_I, TAU_O};
use crate::shell::{bowden, Folder};
use std::f64::consts::TAU;

fn sound() -> Rows {
    Rows::generated(&["--mode", "torque", "--seed", "31", "--rate", "500"])
}

#[test]
fn an_output_of_white_noise_is_no_model_and_the_input_explains_nothing() {
    let mut rows = sound();
    rows.set(TAU_O, |i, _| noise(i));
    let closed = rows.close(&[]);
    assert_eq!(closed.verdict(), "no-input-dependence");
    closed.says(&[
        "the input `tau_i` explains 0 % of the held-out output",
        "right input",
    ]);
}

/// Everything is connected, and nobody has switched the drive on.
#[test]
fn an_input_at_rest_is_told_and_nothing_is_planned_from_its_noise() {
    let mut rows = sound();
    rows.set(TAU_I, |i, _| 8.0 + 1e-3 * noise(i));
    rows.set(TAU_O, |i, _| 6.5 + 1e-2 * noise(1_000_000 + i));
    let closed = rows.close(&[]);
    assert_eq!(closed.verdict(), "no-input-dependence");
    closed.says(&["`tau_i` is at rest", "Record a motion"]);
    let folder = Folder::new();
    let record = rows.write(&folder, "rest.csv");
    let plan = folder.root().join("plan.csv");
    let asked = ["plan", &record, "--out", plan.to_str().unwrap()];
    for asked in [asked.as_slice(), &["power", &record]] {
        let output = bowden(asked);
        assert_eq!(output.status.code(), Some(2), "{output:?}");
        let line = String::from_utf8(output.stderr).unwrap();
        assert!(
            line.contains("rest.csv: the input `tau_i` is at rest"),
            "{line}"
        );
    }
    assert!(!plan.exists());
}

/// Half a kilogram swings on the joint, and nothing that was measured tells where it is.
#[test]
fn a_model_that_misses_much_is_called_poor_and_by_how_much() {
    let mut rows = sound();
    let mut swing = 0.0;
    rows.set(TAU_O, |i, row| {
        swing = 0.995 * swing + 0.4 * noise(i);
        row[TAU_O] + swing
    });
    let closed = rows.close(&[]);
    closed.says(&[
        "No effect in the catalogue explains the residual of the baseline model, ",
        " % of the output's standard deviation on the held-out segment.",
        "The model is poor: its error is ",
        " of the output's standard deviation.",
    ]);
    let closed = sound().close(&[]);
    assert!(!closed.sentence().contains("model is poor"));
}

/// The wrong cable is plugged in: a tone is a function of nothing measured.
#[test]
fn an_output_that_is_a_sine_at_another_frequency_is_no_model_whatever_a_tone_takes() {
    let mut rows = sound();
    rows.set(TAU_O, |i, row| {
        10.0 * (TAU * 2.37 * row[T]).sin() + 0.05 * noise(i)
    });
    let closed = rows.close(&[]);
    assert_eq!(closed.verdict(), "no-input-dependence");
    assert!(
        closed.explains("input") < 0.1,
        "{}",
        closed.json["explains"]
    );
    closed.says(&["the input `tau_i` explains", "of the held-out output"]);
    // What the tone takes is told apart, and not as explained.
    if closed.names().contains(&"tone") {
        assert!(closed.explains("time") > 0.5, "{}", closed.json["explains"]);
        closed.says(&["functions of time explain"]);
    }
}

/// A motor from voltage to angle.
#[test]
fn an_output_that_integrates_the_input_is_told_with_what_to_do() {
    let mut rows = sound();
    let mut angle = 0.0;
    rows.set(TAU_O, |i, row| {
        angle += 0.4 * row[TAU_I] * 0.002;
        angle + 0.002 * noise(i)
    });
    let closed = rows.close(&[]);
    assert_eq!(closed.verdict(), "no-input-dependence");
    assert!(closed.finding("output-integrates").is_some());
    assert!(closed.names().is_empty());
}

/// The same where the input's offset makes the angle run away.
#[test]
fn an_output_that_integrates_an_input_with_an_offset_is_told_too() {
    let mut rows = sound();
    let mut angle = 0.0;
    rows.set(TAU_O, |i, row| {
        angle += 0.4 * (row[TAU_I] + 1.0) * 0.002;
        angle + 0.002 * noise(i)
    });
    let closed = rows.close(&[]);
    assert!(closed.finding("output-integrates").is_some());
}

/// A loop that opens with the speed leads; an integral lags.
#[test]
fn a_damper_does_not_integrate() {
    let mut rows = Rows::generated(&["--mode", "displacement", "--seed", "32", "--rate", "500"]);
    let before: Vec<f64> = rows.rows.iter().map(|row| row[1]).collect();
    rows.set(2, |i, _| {
        let next = before[(i + 1).min(before.len() - 1)];
        let last = before[i.saturating_sub(1)];
        (next - last) / 0.004 + 0.05 * noise(i)
    });
    let closed = rows.close(&["--baseline", "bouc-wen"]);
    assert_eq!(closed.finding("output-integrates"), None);
}

/// A spring in series with a dashpot, moved: its force follows the velocity where it has time to relax.
#[test]
fn the_force_of_a_spring_in_series_with_a_dashpot_does_not_integrate_its_motion() {
    for tau in [0.02, 0.1, 0.5, 3.0] {
        let mut rows = moved();
        let (decay, mut force, mut before) = ((-0.002_f64 / tau).exp(), 0.0, rows.rows[0][1]);
        rows.set(2, |i, row| {
            force = decay * force + 3.0 * (row[1] - before);
            before = row[1];
            force + 0.02 * noise(i)
        });
        let closed = rows.close(&["--max-terms", "0"]);
        assert_eq!(closed.finding("output-integrates"), None, "{tau}");
        assert!(!said_to_count_against(&closed), "{tau}");
    }
}

/// The same, driven by a force: its motion follows the integral, and no friction is in it.
#[test]
fn the_motion_of_a_spring_in_series_with_a_dashpot_integrates_its_force() {
    let mut rows = moved();
    let mut flown = 0.0;
    rows.set(2, |i, row| {
        flown += 0.002 * 0.5 * row[1];
        0.02 * row[1] + flown + 0.002 * noise(i)
    });
    let closed = rows.close(&[]);
    assert!(closed.finding("output-integrates").is_some());
    assert_eq!(
        closed.finding("output-integrates").unwrap()["may_creep"],
        true
    );
    assert!(!said_to_count_against(&closed));
}

fn moved() -> Rows {
    let mut rows = Rows::generated(&["--mode", "displacement", "--seed", "32", "--rate", "500"]);
    rows.header = "t,x,f".to_owned();
    rows
}

fn said_to_count_against(closed: &Closed) -> bool {
    let notes = closed.json["notes"].as_array().unwrap();
    let mut notes = notes.iter().filter_map(|note| note.as_str());
    notes.any(|note| note.contains("has the opposite sign to"))
}

/// The torque channel has nothing to do with the output; an angle makes all of it.
#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn where_only_the_channels_explain_the_output_the_input_is_asked_about() {
    let mut rows = sound();
    rows.set(TAU_O, |i, row| {
        6.0 * row[PHI_P] - 0.07 * row[TAU_I] + 0.05 * noise(i)
    });
    // Another torque than the one that moves the joint.
    rows.set(TAU_I, |i, row| {
        0.3 * row[TAU_I] + 8.0 * (TAU * 0.83 * row[T]).sin() + 0.05 * noise(7 * i)
    });
    let closed = rows.close(&[]);
    assert_eq!(closed.verdict(), "no-input-dependence");
    assert!(
        closed.explains("channels") > 0.5,
        "{}",
        closed.json["explains"]
    );
    closed.says(&[
        "the input `tau_i` explains",
        "the other channels",
        "right input",
    ]);
}

#[test]
fn the_files_of_no_model_say_so_and_no_gains_are_derived_from_it() {
    let mut rows = sound();
    rows.set(TAU_O, |i, _| noise(i));
    let folder = Folder::new();
    let record = rows.write(&folder, "record.csv");
    let path = |name: &str| folder.path(name);
    let (toml, rust) = (path("m.toml"), path("m.rs"));
    for out in [&toml, &rust] {
        assert!(bowden(&["identify", &record, "--model-out", out])
            .status
            .success());
    }
    let read = |name: &str| std::fs::read_to_string(name).unwrap();
    assert!(
        read(&toml).contains("verdict = \"no-input-dependence\""),
        "{}",
        read(&toml)
    );
    let warning = "DO NOT USE: its verdict is `no-input-dependence`.";
    assert!(read(&rust).contains(warning), "{}", read(&rust));
    let header = bowden(&["export", "--c", &toml]);
    assert!(
        String::from_utf8_lossy(&header.stdout).contains(warning),
        "{header:?}"
    );
    let design = bowden(&["design", &toml, "--rate", "1000", "--delay", "0.006"]);
    assert_eq!(design.status.code(), Some(2));
    let said = String::from_utf8_lossy(&design.stderr);
    assert!(said.contains("(verdict `no-input-dependence`)"), "{said}");
    assert_eq!(said.trim_end().lines().count(), 1, "{said}");
}

/// A joint under gravity, driven through so many times a friction: the output is the torque of the
/// load.
fn load_on_a_joint(friction: f64) -> Rows {
    let tones = [(0.9, 0.7, 0.0), (0.5, 1.9, 0.3), (0.15, 4.1, 0.0)];
    let row = |i: usize| {
        let t = i as f64 / 500.0;
        let angle: f64 = tones.iter().map(|(a, w, p)| a * (w * t + p).sin()).sum();
        let rate: f64 = tones
            .iter()
            .map(|(a, w, p)| a * w * (w * t + p).cos())
            .sum();
        let load = 3.0 * angle.sin();
        let lost = friction * (2.0 * (rate / 0.05).tanh() + 1.2 * rate);
        vec![t, load + lost, load + 0.02 * noise(i), angle]
    };
    Rows {
        header: "t,tau_i [N·m],tau_o [N·m],phi_p [rad]".to_owned(),
        rows: (0..12_000).map(row).collect(),
    }
}

/// Where the load follows the angle alone, a model of the load is found and none of the cable.
#[test]
fn a_model_of_the_load_that_reads_no_torque_is_called_one_of_the_load() {
    let closed = load_on_a_joint(2.0).close(&["--mode", "torque"]);
    assert_eq!(closed.names(), ["gravity"]);
    closed.says(&[
        "Nearly all of the model's output comes from `phi_p` and none from `tau_i`",
        "so the model describes only this load.",
    ]);
}

/// A cable under a nearly constant load on a joint that moves: friction is all that there is.
#[test]
fn friction_under_a_constant_load_is_a_model() {
    let mut rows = load_on_a_joint(0.0);
    let tones = [(0.63, 0.7, 0.0), (0.95, 1.9, 0.3), (0.615, 4.1, 0.0)];
    rows.set(TAU_I, |i, _| 10.0 + 0.25 * (1.3 * i as f64 / 500.0).sin());
    rows.set(TAU_O, |i, row| {
        let t = i as f64 / 500.0;
        let rate: f64 = tones.iter().map(|(a, w, p)| a * (w * t + p).cos()).sum();
        0.95 * row[TAU_I] - 1.5 * (rate / 0.05).tanh() - 0.4 * rate + 0.02 * noise(i)
    });
    let closed = rows.close(&["--mode", "torque"]);
    assert_ne!(closed.verdict(), "no-input-dependence");
    assert!(closed.explains("input") < 0.5);
    let names = closed.names();
    assert!(
        names.contains(&"coulomb") && names.contains(&"viscous"),
        "{names:?}"
    );
    assert!(!closed.sentence().contains("sensor connected"));
}
