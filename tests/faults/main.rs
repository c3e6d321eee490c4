//! The faults that every motor meets, one named test each.

// Clippy's allowance covers the test functions, not what they share.
#![allow(clippy::unwrap_used)]

mod adaptive;
#[cfg(feature = "serde")]
mod flash;
mod inputs;
mod latch;
mod pid;
mod score;
mod stored;

use bowden::control::{
    AdaptiveSettings, Estimator, Fallback, Form, Limits, LoopSample, PidSettings,
};

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
    LoopSample {
        measured: f64::NAN,
        ..good()
    }
}

/// A PI with limits of ±60.
fn pi() -> PidSettings<f64> {
    PidSettings::new(3.0, 30.0, limits(60.0), LONGEST, fallback())
}

/// A law over one regressor within `most`, in the literal or in the lag form.
fn law(lag: bool, most: f64) -> AdaptiveSettings<f64, 1> {
    let form = if lag {
        Form::FirstOrder {
            step: DT,
            plant_gain: 1.0,
        }
    } else {
        Form::AsPublished {
            time_constant: 0.005,
        }
    };
    AdaptiveSettings {
        beta: Estimator::fixed(1.0)
            .within(0.9, 1.1)
            .adapting(2.5e-4, 0.01),
        delta: Estimator::fixed(1.0)
            .within(0.0, 7.0)
            .adapting(6.25e-3, 0.01),
        theta: [Estimator::fixed(1.0).within(-5.0, 5.0).adapting(5e-4, 0.01)],
        ..AdaptiveSettings::new(form, 24.0, 8.0, 0.2, limits(most), LONGEST, fallback())
    }
}
