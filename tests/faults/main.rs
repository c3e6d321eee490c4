//! The faults that every motor meets, one named test each.

// Clippy's allowance covers the test functions, not what they share.
#![allow(clippy::unwrap_used)]

#[cfg(feature = "serde")]
mod flash;
mod inputs;
mod latch;
mod laws;
mod score;
#[path = "../shared/mod.rs"]
mod shared;
mod stored;

use bowden::control::*;
use proptest::prelude::*;
use shared::*;

/// Nominal step \[s\], and the longest: five of them.
const DT: f64 = 1e-3;
const LONGEST: f64 = 5e-3;

/// Zero after 20 bad samples in a row.
fn fallback() -> Fallback<f64> {
    Fallback::try_new(20, 0.0).unwrap()
}

fn limits(most: f64) -> Limits<f64> {
    Limits::try_new(-most, most).unwrap()
}

/// A good sample in a loop that moves, and one whose sensor is dead.
fn good() -> LoopSample<'static, f64> {
    LoopSample {
        regressors: &[0.2],
        ..LoopSample::new(DT, 25.0, 24.5)
    }
}

fn bad() -> LoopSample<'static, f64> {
    with(good(), |at| at.measured = f64::NAN)
}

/// A PI with limits of ±60.
fn pi() -> PidSettings<f64> {
    PidSettings::new(3.0, 30.0, limits(60.0), LONGEST, fallback())
}

fn pid(change: impl FnOnce(&mut PidSettings<f64>)) -> Pid<f64> {
    Pid::try_new(with(pi(), change)).unwrap()
}

/// A law over one regressor, in the literal or in the lag form.
fn law(lag: bool) -> AdaptiveSettings<f64, 1> {
    let (step, plant_gain, time_constant) = (DT, 1.0, 0.005);
    let form = match lag {
        true => Form::FirstOrder { step, plant_gain },
        false => Form::AsPublished { time_constant },
    };
    let own = |x, low, high, gain| Estimator::fixed(x).within(low, high).adapting(gain, 0.01);
    AdaptiveSettings {
        beta: own(1.0, 0.9, 1.1, 2.5e-4),
        delta: own(1.0, 0.0, 7.0, 6.25e-3),
        theta: [own(1.0, -5.0, 5.0, 5e-4)],
        ..AdaptiveSettings::new(form, 24.0, 8.0, 0.2, limits(60.0), LONGEST, fallback())
    }
}

/// Both forms with a change.
fn forms(change: impl Fn(&mut AdaptiveSettings<f64, 1>)) -> [Adaptive<f64, 1>; 2] {
    [false, true].map(|lag| Adaptive::try_new(with(law(lag), &change)).unwrap())
}
