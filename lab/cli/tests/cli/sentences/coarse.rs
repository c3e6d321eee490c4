//! A coarse encoder: what its steps do is told, and is no firm name.

use crate::sentences::files::{noise, uniform, Closed, Rows};
use std::f64::consts::TAU;

const RATE: f64 = 500.0;

/// A spring with a hysteresis and a viscous damper, moved by noise behind four low-passes; the
/// motion is logged in so large steps \[mm\].
fn seen_in_steps_of(step: f64) -> Closed {
    let share = 1.0 - (-TAU * 1.2 / RATE).exp();
    let (mut stages, mut z, mut before) = ([0.0; 4], 0.0, 0.0);
    let row = |i: usize| {
        let mut signal = uniform(i);
        for stage in &mut stages {
            *stage += share * (signal - *stage);
            signal = *stage;
        }
        let x = 100.0 * signal;
        let dx = (x - before) / 10.0;
        for _ in 0..10 {
            z += 0.9 * (dx - 0.8 * dx.abs() * z - 0.2 * dx * f64::abs(z));
        }
        let force = 1.5 * x + 4.0 * z + 0.2 * RATE * (x - before) + 0.02 * noise(i);
        before = x;
        vec![i as f64 / RATE, (x / step).round() * step, force]
    };
    let rows = Rows {
        header: "t,x [mm],f [N]".to_owned(),
        rows: (0..20_000).map(row).collect(),
    };
    rows.close(&[])
}

fn notes(closed: &Closed) -> Vec<&str> {
    let notes = closed.json["notes"].as_array().unwrap().iter();
    let notes = notes.filter_map(|note| note.as_str());
    notes.filter(|note| note.contains("resolution")).collect()
}

/// About a hundred and twenty steps over the stroke.
#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn names_that_the_steps_of_an_encoder_explain_are_not_firm() {
    let closed = seen_in_steps_of(0.15);
    let rounds = closed.json["terms"].as_array().unwrap();
    for round in rounds {
        // The model is above the noise: every term is a candidate, also the one that is there.
        assert_eq!(round["confidence"], "low", "{round}");
    }
    assert!(rounds.len() > 1, "a name that is not there: {rounds:?}");
    let told = notes(&closed);
    assert!(
        told[0].starts_with("`x` has a resolution of 0.15 mm, 1/1"),
        "{told:?}"
    );
    closed.says(&[
        "`x` has a resolution of 0.15 mm",
        "Terms that depend on its velocity or its reversals (",
        ") are uncertain.",
    ]);
    closed.text();
}

/// Twelve bits.
#[test]
fn an_encoder_of_twelve_bits_is_not_called_coarse() {
    let closed = seen_in_steps_of(18.0 / 4096.0);
    assert_eq!(notes(&closed), Vec::<&str>::new());
    assert!(!closed.sentence().contains("resolved"));
    assert_eq!(closed.names()[0], "viscous");
}
