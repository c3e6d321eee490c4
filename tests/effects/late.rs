//! The late output of a delay, and what a term adds.

use crate::make;
use crate::memory::stroke;
use bowden::effect::{EffectState, Inputs};

/// A tone behind the delay, once its start is forgotten: the largest difference to the tone
/// that is late by that time.
fn lateness(late: f64, dt: f64, w: f64) -> f64 {
    let delay = make::<f64>("delay");
    let mut state = EffectState::default();
    let mut worst: f64 = 0.0;
    for k in 0..4000 {
        let t = dt * f64::from(k);
        let y = (w * t).sin();
        let at = Inputs {
            dt,
            output: y,
            ..Inputs::default()
        };
        let z = y + delay.contribution(late, &mut state, &at);
        if k > 2000 {
            worst = worst.max((z - (w * (t - late)).sin()).abs());
        }
    }
    worst
}

#[test]
fn a_delay_is_late_by_its_gain_and_takes_nothing_from_the_amplitude() {
    // Whole samples are exact. Rounding of the phase, 4000·1e-16, and of as many steps.
    assert!(lateness(0.01, 0.01, 130.0) < 1e-11);
    for (late, dt) in [
        (0.0115, 0.025),
        (0.004, 0.001),
        (0.0004, 0.001),
        (0.02, 0.001),
    ] {
        for w in [0.02, 0.1, 0.3] {
            let w = w / f64::max(late, dt);
            // The docs: a share of (w·max(T, dt))²/12 of the delay, hence of the phase; the
            // next term is of fourth order.
            let share = (w * f64::max(late, dt)).powi(2) / 12.0;
            let bound = 1.1 * share * w * late;
            let own = lateness(late, dt, w);
            assert!(own < bound, "T {late}, dt {dt}, w {w}: {own} of {bound}");
        }
    }
    // At a fifth of the sampling rate and half a sample: the all-pass errs by 0.067, a straight
    // line between two samples takes 0.19 from the amplitude.
    let (dt, w) = (0.025, 2.0 * std::f64::consts::PI / (5.0 * 0.025));
    assert!(lateness(0.46 * dt, dt, w) < 0.07);
}

#[test]
fn a_contribution_is_gain_times_regressor_but_for_a_late_output() {
    let path = stroke([0.3, -0.4, 1.1, 0.2, 0.9], 0.01);
    for name in crate::names() {
        let effect = make::<f64>(name);
        for gain in [-0.3, 0.0, 0.7] {
            let (mut a, mut b) = (EffectState::default(), EffectState::default());
            for (at, output) in path.iter().zip([1.0, -2.0, 0.5, 3.0, 2.0]) {
                let at = Inputs { output, ..*at };
                let linear = gain * effect.regressor(&mut a, &at);
                let own = effect.contribution(gain, &mut b, &at);
                assert!(own == linear || (name == "delay" && gain > 0.0), "{name}");
            }
        }
    }
}

#[test]
fn a_late_output_is_finite_and_a_bad_sample_moves_nothing() {
    let delay = make::<f64>("delay");
    let mut state = EffectState::default();
    let at = |dt, output| Inputs {
        dt,
        output,
        ..Inputs::default()
    };
    for (dt, output, gain) in [
        (0.01, f64::MAX, 1.0),
        (0.01, f64::MIN, 1.0),
        (f64::MAX, f64::MAX, f64::MAX),
        (f64::MIN_POSITIVE, f64::MIN, f64::MIN_POSITIVE),
        (f64::MIN_POSITIVE, 1.0, f64::MAX),
        (0.01, 1.0, 1e-300),
    ] {
        assert!(delay
            .contribution(gain, &mut state, &at(dt, output))
            .is_finite());
    }
    let before = state;
    for (dt, output) in [
        (-0.1, 1.0),
        (f64::NAN, 1.0),
        (0.1, f64::NAN),
        (0.1, f64::INFINITY),
    ] {
        assert_eq!(delay.contribution(1.0, &mut state, &at(dt, output)), 0.0);
        assert_eq!(state, before);
    }
    // The same sample again: the same lateness, and the memory stays.
    let held = delay.contribution(0.02, &mut state, &at(0.0, 5.0));
    assert_eq!(held, delay.contribution(0.02, &mut state, &at(0.0, 5.0)));
    assert_eq!(state, before);
}
