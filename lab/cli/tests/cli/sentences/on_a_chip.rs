//! A model may fit well with velocities without phase, and err with those of a chip.

use crate::sentences::files::{noise, Closed, Rows};
use crate::shell::args;
use std::f64::consts::TAU;

/// A mass on a spring, moved by two tones, the slower one of that amplitude.
fn moved(mass: f64, slow: f64) -> Closed {
    let tones = [(1.0, 1.0, 0.0), (slow, 0.37, 1.0)];
    let row = |i: usize| {
        let t = 0.005 * i as f64;
        let angle = |f: f64, phase: f64| (TAU * f * t + phase).sin();
        let x: f64 = tones.iter().map(|(a, f, p)| a * angle(*f, *p)).sum();
        let acceleration: f64 = tones
            .iter()
            .map(|(a, f, p)| -a * (TAU * f).powi(2) * angle(*f, *p))
            .sum();
        vec![t, x, 2.0 * x + mass * acceleration + 0.002 * noise(i)]
    };
    let rows = Rows {
        header: "t,x,f".to_owned(),
        rows: (0..6000).map(row).collect(),
    };
    let declared = "inertia,stiffness-linear,offset";
    rows.close(&args(&format!(
        "--mode displacement --baseline {declared} --max-terms 0"
    )))
}

#[test]
fn what_firmware_loses_of_the_fit_is_told_with_both_errors() {
    let closed = moved(0.05, 0.6);
    let error = |of: &str| 100.0 * closed.json["final"][of]["held_out"].as_f64().unwrap();
    let (fit, firmware) = (error("nrmse"), error("causal_nrmse"));
    // The acceleration passes two low-passes, whose cut-off is eight times the faster tone: it is
    // late by 2·atan(1/8) = 0.25 rad, an error of a quarter of the inertial force.
    assert!(fit < 1.0 && firmware > 5.0, "{fit} {firmware}");
    closed.says(&[&format!(
        "In firmware (sample by sample, with causal velocities) the held-out error is {firmware:.2} % instead of {fit:.2} %."
    )]);
}

#[test]
fn where_firmware_loses_nothing_it_is_not_told() {
    let closed = moved(0.0, 0.6);
    assert!(
        !closed.sentence().contains("firmware"),
        "{}",
        closed.sentence()
    );
}

#[test]
fn a_model_that_a_constant_beats_on_a_chip_is_not_praised_first() {
    // At the faster tone the mass takes what the spring gives, so that the lateness of the
    // acceleration is many times what is left.
    let closed = moved(2.0 / TAU.powi(2), 0.05);
    let error = |of: &str| closed.json["final"][of]["held_out"].as_f64().unwrap();
    let (fit, firmware) = (error("nrmse"), error("causal_nrmse"));
    assert!(fit < 0.1 && firmware > 1.0, "{fit} {firmware}");
    assert!(
        closed
            .sentence()
            .starts_with("Do not use this model in firmware"),
        "{}",
        closed.sentence()
    );
    assert!(!moved(0.05, 0.6).sentence().contains("Do not use"));
}

/// A hysteresis between torques whose input is measured with that noise.
fn cable(of_input: f64) -> Closed {
    let (mut z, mut before) = (0.0_f64, 0.0);
    let row = |i: usize| {
        let t = 0.001 * i as f64;
        let tau = 6.0 + 4.0 * (2.3 * t).sin() + 2.0 * (0.9 * t + 1.0).sin();
        for _ in 0..4 {
            let step = 0.25 * (tau - before);
            z += 0.6 * (step - 0.8 * step.abs() * z - 0.2 * step * z.abs());
        }
        before = tau;
        let measured = tau + of_input * noise(i + 31_337);
        vec![t, measured, 0.85 * tau + 0.9 * z + 0.01 * noise(i + 99_991)]
    };
    Rows {
        header: "t,tau_i [N·m],tau_o [N·m]".to_owned(),
        rows: (0..20_000).map(row).collect(),
    }
    .close(&[])
}

#[test]
fn noise_that_turns_the_hysteresis_is_told_with_the_play_that_stops_it() {
    let closed = cable(0.02);
    let error = |of: &str| closed.json.pointer(of).and_then(|v| v.as_f64()).unwrap();
    let firmware = error("/final/causal_nrmse/held_out");
    let calmed = error("/final/exported_model/with_deadband/causal_nrmse/held_out");
    assert!(calmed < 0.5 * firmware, "{firmware} {calmed}");
    closed.says(&["the noise of `tau_i` drives the hysteresis. With `signal::Play` of half-width"]);
    // Four standard deviations.
    let half_width = error("/final/exported_model/with_deadband/half_width");
    assert!((half_width / 0.08 - 1.0).abs() < 0.1, "{half_width}");
    let quiet = cable(0.0);
    assert!(
        !quiet.sentence().contains("hysteresis"),
        "{}",
        quiet.sentence()
    );
}
