//! The certificates: their figures, their algebra, and adversaries that try to break them.

// Clippy's allowance covers the test functions, not what they share.
#![allow(clippy::unwrap_used)]

mod adversary;
mod continuous;
mod dyadic;
mod figures;
mod learning;
mod observer;
mod refused;
mod rounded;
mod sampled;
mod simulated;
mod step;

use bowden::control::*;
use bowden::{Error, Real};
use bowden_bound::*;
use proptest::prelude::*;

/// xorshift64*: uniform, the same in every run.
struct Random(u64);

impl Random {
    fn within(&mut self, low: f64, high: f64) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11;
        low + (high - low) * (bits as f64 / (1u64 << 53) as f64)
    }

    /// -1, or 1.
    fn sign(&mut self) -> f64 {
        match self.within(-1.0, 1.0) < 0.0 {
            true => -1.0,
            false => 1.0,
        }
    }

    fn smooth_sign(&mut self) -> SmoothSign {
        match self.sign() > 0.0 {
            true => SmoothSign::Clamp,
            false => SmoothSign::Tanh,
        }
    }
}

/// The same with a change.
fn with<S>(mut of: S, change: impl FnOnce(&mut S)) -> S {
    change(&mut of);
    of
}

/// Fails where two numbers are as far apart as this, or further.
#[track_caller]
fn near(got: f64, expected: f64, within: f64) {
    let error = (got - expected).abs();
    assert!(error < within, "{got} instead of {expected}, by {error:e}");
}

fn first_order<T: Real>(step: f64, plant_gain: f64) -> Form<T> {
    Form::FirstOrder {
        step: T::from_f64(step),
        plant_gain: T::from_f64(plant_gain),
    }
}

/// The form as published, whose derivative is filtered over 5 ms.
fn published<T: Real>() -> Form<T> {
    let time_constant = T::from_f64(0.005);
    Form::AsPublished { time_constant }
}

fn between(low: f64, high: f64) -> Interval<f64> {
    Interval { low, high }
}

/// A regressor and what is known of its coefficient.
fn known(theta: Interval<f64>, magnitude: f64, rate: f64) -> Known<f64> {
    Known {
        theta,
        magnitude,
        rate,
    }
}

fn pi(k_p: f64, k_i: f64) -> Pid<f64> {
    Pid::try_new(PidSettings::unlimited(k_p, k_i)).unwrap()
}
