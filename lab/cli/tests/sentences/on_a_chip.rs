//! A model may fit well with velocities without phase, and err with those of a chip.

use crate::files::{noise, Closed, Rows};
use std::f64::consts::TAU;

/// A mass on a spring, moved by two tones.
fn moved(mass: f64) -> Closed {
    let tones = [(1.0, 1.0, 0.0), (0.6, 0.37, 1.0)];
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
    rows.close(&[
        "--mode",
        "displacement",
        "--declare",
        declared,
        "--rounds",
        "0",
    ])
}

#[test]
fn what_firmware_loses_of_the_fit_is_told_with_both_errors() {
    let closed = moved(0.05);
    let error = |of: &str| 100.0 * closed.json["final"][of]["held_out"].as_f64().unwrap();
    let (fit, firmware) = (error("nrmse"), error("causal_nrmse"));
    // The acceleration passes two low-passes, whose cut-off is eight times the faster tone: it is
    // late by 2·atan(1/8) = 0.25 rad, an error of a quarter of the inertial force.
    assert!(fit < 1.0 && firmware > 5.0, "{fit} {firmware}");
    closed.says(&[&format!(
        "In firmware, sample by sample with causal velocities, the held-out error is {firmware:.2} % instead of {fit:.2} %."
    )]);
}

#[test]
fn where_firmware_loses_nothing_it_is_not_told() {
    let closed = moved(0.0);
    assert!(
        !closed.sentence().contains("firmware"),
        "{}",
        closed.sentence()
    );
}
