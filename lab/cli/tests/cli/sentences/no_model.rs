//! Files in which there is no model to be found: the verdict must say so.

use crate::sentences::files::{noise, Closed, Rows, PHI_P, T, TAU_I, TAU_O};
use crate::shell::{has, refuses, said, Folder};
use std::f64::consts::TAU;

fn sound() -> Rows {
    Rows::generated("--mode torque --seed 31 --rate 500")
}

/// The sound record with another output.
fn with_output(of: impl FnMut(usize, &[f64]) -> f64) -> Rows {
    let mut rows = sound();
    rows.set(TAU_O, of);
    rows
}

#[test]
fn an_output_of_white_noise_is_no_model_and_the_input_explains_nothing() {
    let closed = with_output(|i, _| noise(i)).close("");
    assert_eq!(closed.verdict(), "no-input-dependence");
    let nothing = "the input `tau_i` explains 0 % of the held-out output";
    closed.says(&[nothing, "right input"]);
}

/// Everything is connected, and nobody has switched the drive on.
#[test]
fn an_input_at_rest_is_told_and_nothing_is_planned_from_its_noise() {
    let mut rows = with_output(|i, _| 6.5 + 1e-2 * noise(1_000_000 + i));
    rows.set(TAU_I, |i, _| 8.0 + 1e-3 * noise(i));
    let closed = rows.close("");
    assert_eq!(closed.verdict(), "no-input-dependence");
    closed.says(&["`tau_i` is at rest", "Record a motion"]);
    let folder = Folder::new();
    let (record, plan) = (rows.write(&folder, "rest.csv"), folder.path("plan.csv"));
    for asked in [
        format!("plan {record} --out {plan}"),
        format!("power {record}"),
    ] {
        refuses(&asked, &["rest.csv: the input `tau_i` is at rest"]);
    }
    assert_eq!(folder.names(), ["rest.csv"]);
}

/// Half a kilogram swings on the joint, and nothing that was measured tells where it is.
#[test]
fn a_model_that_misses_much_is_called_poor_and_by_how_much() {
    let mut swing = 0.0;
    let rows = with_output(|i, row| {
        swing = 0.995 * swing + 0.4 * noise(i);
        row[TAU_O] + swing
    });
    rows.close("").says(&[
        "No effect in the catalogue explains the residual of the baseline model, ",
        " % of the output's standard deviation on the held-out segment.",
        "The model is poor: its error is ",
        " of the output's standard deviation.",
    ]);
    sound().close("").does_not_say("model is poor");
}

/// The wrong cable is plugged in: a tone is a function of nothing measured.
#[test]
fn an_output_that_is_a_sine_at_another_frequency_is_no_model_whatever_a_tone_takes() {
    let rows = with_output(|i, row| 10.0 * (TAU * 2.37 * row[T]).sin() + 0.05 * noise(i));
    let closed = rows.close("");
    assert_eq!(closed.verdict(), "no-input-dependence");
    let explains = &closed.json["explains"];
    assert!(closed.number("/explains/input") < 0.1, "{explains}");
    closed.says(&["the input `tau_i` explains", "of the held-out output"]);
    // What the tone takes is told apart, and not as explained.
    if closed.names().contains(&"tone") {
        assert!(closed.number("/explains/time") > 0.5, "{explains}");
        closed.says(&["functions of time explain"]);
    }
}

/// A motor from voltage to angle; with an offset of the input the angle runs away.
#[test]
fn an_output_that_integrates_the_input_is_told_with_what_to_do() {
    for offset in [0.0, 1.0] {
        let mut angle = 0.0;
        let rows = with_output(|i, row| {
            angle += 0.4 * (row[TAU_I] + offset) * 0.002;
            angle + 0.002 * noise(i)
        });
        let closed = rows.close("");
        assert!(closed.finding("output-integrates").is_some());
        if offset == 0.0 {
            assert_eq!(closed.verdict(), "no-input-dependence");
            assert!(closed.names().is_empty());
        }
    }
}

fn moved() -> Rows {
    let mut rows = Rows::generated("--mode displacement --seed 32 --rate 500");
    rows.header = "t,x,f".to_owned();
    rows
}

fn said_to_count_against(closed: &Closed) -> bool {
    let mut notes = closed.notes().into_iter();
    notes.any(|note| note.contains("has the opposite sign to"))
}

#[test]
fn a_damper_and_a_spring_in_series_with_a_dashpot_do_not_integrate_their_motion() {
    // A loop that opens with the speed leads; an integral lags.
    let mut rows = moved();
    let ahead = rows.differences(1, 1);
    rows.set(2, |i, _| ahead[i] / 0.004 + 0.05 * noise(i));
    let closed = rows.close("--baseline bouc-wen");
    assert_eq!(closed.finding("output-integrates"), None);
    // The force follows the velocity where it has time to relax.
    for tau in [0.02, 0.1, 0.5, 3.0] {
        let mut rows = moved();
        let (decay, mut force, mut before) = ((-0.002_f64 / tau).exp(), 0.0, rows.rows[0][1]);
        rows.set(2, |i, row| {
            force = decay * force + 3.0 * (row[1] - before);
            before = row[1];
            force + 0.02 * noise(i)
        });
        let closed = rows.close("--max-terms 0");
        assert_eq!(closed.finding("output-integrates"), None, "{tau}");
        assert!(!said_to_count_against(&closed), "{tau}");
    }
}

/// The same, driven by a force: its motion follows the integral, and no friction is in it.
#[test]
fn the_motion_of_a_spring_in_series_with_a_dashpot_integrates_its_force() {
    let (mut rows, mut flown) = (moved(), 0.0);
    rows.set(2, |i, row| {
        flown += 0.002 * 0.5 * row[1];
        0.02 * row[1] + flown + 0.002 * noise(i)
    });
    let closed = rows.close("");
    let integrates = closed.finding("output-integrates").unwrap();
    assert_eq!(integrates["may_creep"], true);
    assert!(!said_to_count_against(&closed));
}

/// The torque channel has nothing to do with the output; an angle makes all of it.
#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn where_only_the_channels_explain_the_output_the_input_is_asked_about() {
    let of_angle = |i, row: &[f64]| 6.0 * row[PHI_P] - 0.07 * row[TAU_I] + 0.05 * noise(i);
    let mut rows = with_output(of_angle);
    // Another torque than the one that moves the joint.
    rows.set(TAU_I, |i, row| {
        0.3 * row[TAU_I] + 8.0 * (TAU * 0.83 * row[T]).sin() + 0.05 * noise(7 * i)
    });
    let closed = rows.close("");
    assert_eq!(closed.verdict(), "no-input-dependence");
    let explains = &closed.json["explains"];
    assert!(closed.number("/explains/channels") > 0.5, "{explains}");
    closed.says(&[
        "the input `tau_i` explains",
        "the other channels",
        "right input",
    ]);
}

#[test]
fn the_files_of_no_model_say_so_and_no_gains_are_derived_from_it() {
    let folder = Folder::new();
    let record = with_output(|i, _| noise(i)).write(&folder, "record.csv");
    let toml = folder.path("m.toml");
    for name in ["m.toml", "m.rs"] {
        said(&format!(
            "identify {record} --model-out {}",
            folder.path(name)
        ));
    }
    has(
        &folder.read("m.toml"),
        &["verdict = \"no-input-dependence\""],
    );
    let warning = "DO NOT USE THIS MODEL: its verdict is `no-input-dependence`.";
    has(&folder.read("m.rs"), &[warning]);
    has(&said(&format!("export --c {toml}")), &[warning]);
    let design = format!("design {toml} --rate 1000 --delay 0.006");
    refuses(&design, &["(verdict `no-input-dependence`)"]);
}

/// Position and rate of three tones.
fn tones(all: [(f64, f64, f64); 3], t: f64) -> (f64, f64) {
    let position = all.iter().map(|(a, w, p)| a * (w * t + p).sin());
    let rate = all.iter().map(|(a, w, p)| a * w * (w * t + p).cos());
    (position.sum(), rate.sum())
}

/// A joint that moves by tones, with its torques of angle, rate, time and row.
fn joint(torques: impl Fn((f64, f64), f64, usize) -> [f64; 2]) -> Closed {
    let row = |i: usize| {
        let t = i as f64 / 500.0;
        let at = tones([(0.9, 0.7, 0.0), (0.5, 1.9, 0.3), (0.15, 4.1, 0.0)], t);
        let [tau_i, tau_o] = torques(at, t, i);
        vec![t, tau_i, tau_o, at.0]
    };
    let header = "t,tau_i [N·m],tau_o [N·m],phi_p [rad]";
    Rows::new(header, (0..12_000).map(row)).close("--mode torque")
}

/// Under gravity, driven through a friction, the output is the torque of the load: where the load
/// follows the angle alone, a model of the load is found and none of the cable.
#[test]
fn a_model_of_the_load_that_reads_no_torque_is_called_one_of_the_load() {
    let closed = joint(|(angle, rate), _, i| {
        let load = 3.0 * angle.sin();
        let lost = 2.0 * (2.0 * (rate / 0.05).tanh() + 1.2 * rate);
        [load + lost, load + 0.02 * noise(i)]
    });
    assert_eq!(closed.names(), ["gravity"]);
    closed.says(&[
        "Nearly all of the model's output comes from `phi_p` and none from `tau_i`",
        "so the model describes only this load.",
    ]);
}

/// A cable under a nearly constant load on a joint that moves: friction is all that there is.
#[test]
fn friction_under_a_constant_load_is_a_model() {
    let closed = joint(|(_, rate), t, i| {
        let load = 10.0 + 0.25 * (1.3 * t).sin();
        let friction = 1.5 * (rate / 0.05).tanh() + 0.4 * rate;
        [load, 0.95 * load - friction + 0.02 * noise(i)]
    });
    assert_ne!(closed.verdict(), "no-input-dependence");
    assert!(closed.number("/explains/input") < 0.5);
    for effect in ["coulomb", "viscous"] {
        assert!(closed.names().contains(&effect), "{:?}", closed.names());
    }
    closed.does_not_say("sensor connected");
}
