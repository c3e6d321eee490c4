//! A model may fit well with velocities without phase, and err with those of a chip.

use crate::sentences::files::{noise, Closed, Rows};
use std::f64::consts::TAU;

/// A mass on a spring, moved by two tones, the slower one of that amplitude; with the errors of the
/// fit and of firmware.
fn moved(mass: f64, slow: f64) -> (Closed, [f64; 2]) {
    let row = |i: usize| {
        let t = 0.005 * i as f64;
        let (mut x, mut acceleration) = (0.0, 0.0);
        for (a, f, p) in [(1.0, 1.0, 0.0), (slow, 0.37, 1.0)] {
            let tone = a * (TAU * f * t + p).sin();
            x += tone;
            acceleration -= (TAU * f).powi(2) * tone;
        }
        vec![t, x, 2.0 * x + mass * acceleration + 0.002 * noise(i)]
    };
    let declared = "--mode displacement --baseline inertia,stiffness-linear,offset --max-terms 0";
    let closed = Rows::new("t,x,f", (0..6000).map(row)).close(declared);
    let errors =
        ["nrmse", "causal_nrmse"].map(|of| closed.number(&format!("/final/{of}/held_out")));
    (closed, errors)
}

#[test]
fn what_firmware_loses_of_the_fit_is_told_with_both_errors() {
    let (closed, errors) = moved(0.05, 0.6);
    let [fit, firmware] = errors.map(|share| 100.0 * share);
    // The acceleration passes two low-passes, whose cut-off is eight times the faster tone: it is
    // late by 2·atan(1/8) = 0.25 rad, an error of a quarter of the inertial force.
    assert!(fit < 1.0 && firmware > 5.0, "{fit} {firmware}");
    let error = "(sample by sample, with causal velocities) the held-out error is";
    closed.says(&[&format!(
        "In firmware {error} {firmware:.2} % instead of {fit:.2} %."
    )]);
    closed.does_not_say("Do not use");
    // Where firmware loses nothing it is not told.
    moved(0.0, 0.6).0.does_not_say("firmware");
}

#[test]
fn a_model_that_a_constant_beats_on_a_chip_is_not_praised_first() {
    // At the faster tone the mass takes what the spring gives, so that the lateness of the
    // acceleration is many times what is left.
    let (closed, [fit, firmware]) = moved(2.0 / TAU.powi(2), 0.05);
    assert!(fit < 0.1 && firmware > 1.0, "{fit} {firmware}");
    let first = "Do not use this model in firmware";
    assert!(closed.sentence().starts_with(first));
}

/// A hysteresis between torques whose input is measured with that noise.
fn cable(of_input: f64) -> Closed {
    let (mut z, mut before) = (0.0_f64, 0.0);
    let row = |i: usize| {
        let t = 0.001 * i as f64;
        let tau = 6.0 + 4.0 * (2.3 * t).sin() + 2.0 * (0.9 * t + 1.0).sin();
        let step = 0.25 * (tau - before);
        before = tau;
        for _ in 0..4 {
            z += 0.6 * (step - 0.8 * f64::abs(step) * z - 0.2 * step * z.abs());
        }
        let measured = tau + of_input * noise(i + 31_337);
        vec![t, measured, 0.85 * tau + 0.9 * z + 0.01 * noise(i + 99_991)]
    };
    Rows::new("t,tau_i [N·m],tau_o [N·m]", (0..20_000).map(row)).close("")
}

#[test]
fn noise_that_turns_the_hysteresis_is_told_with_the_play_that_stops_it() {
    let closed = cable(0.02);
    let firmware = closed.number("/final/causal_nrmse/held_out");
    let calmed = "/final/exported_model/with_deadband";
    let error = closed.number(&format!("{calmed}/causal_nrmse/held_out"));
    assert!(error < 0.5 * firmware, "{firmware} {error}");
    closed.says(&["the noise of `tau_i` drives the hysteresis. With `signal::Play` of half-width"]);
    // Four standard deviations.
    let half_width = closed.number(&format!("{calmed}/half_width"));
    assert!((half_width / 0.08 - 1.0).abs() < 0.1, "{half_width}");
    cable(0.0).does_not_say("hysteresis");
}
