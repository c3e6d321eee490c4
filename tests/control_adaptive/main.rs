//! The robust adaptive law: its equations, its boxes, its two forms.

// Clippy's allowance covers the test functions, not what they share.
#![allow(clippy::unwrap_used)]

mod boxes;
mod equations;
mod forms;
mod hand_over;
mod law;
mod leakage;
mod limited;
mod line;
mod liveness;
#[path = "../shared/mod.rs"]
mod shared;
mod told;

use bowden::control::*;
use bowden::{Error, Real};
use proptest::prelude::*;
use shared::*;

/// Room for the rounding of a few sums and products of numbers up to 100.
const ROUNDING: f64 = 1e-12;

type Settings = AdaptiveSettings<f64, 1>;
type Input = AdaptiveInput<f64, 1>;
type State = AdaptiveState<f64, 1>;

/// A lag form at 1 kHz that the box theorem covers: g within 0.9 to 1.1.
fn lag() -> Settings {
    let form = Form::FirstOrder {
        step: 0.001,
        plant_gain: 1.0,
    };
    let own = |initial, low, high, gain| {
        Estimator::fixed(initial)
            .within(low, high)
            .adapting(gain, 0.01)
    };
    AdaptiveSettings {
        beta: own(1.0, 0.9, 1.1, 2.5e-4),
        delta: own(1.0, 0.0, 7.0, 6.25e-3),
        theta: [own(0.0, -5.0, 5.0, 5e-4)],
        ..AdaptiveSettings::unlimited(form, 24.0, 8.0, 0.2)
    }
}

/// The same gains in the literal form.
fn literal() -> Settings {
    let time_constant = 0.002;
    with(lag(), |s| s.form = Form::AsPublished { time_constant })
}

/// The literal form, then the lag form.
fn both() -> [Settings; 2] {
    [literal(), lag()]
}

fn law(settings: Settings, change: impl FnOnce(&mut Settings)) -> Adaptive<f64, 1> {
    Adaptive::try_new(with(settings, change)).unwrap()
}

/// A sample of 1 ms.
fn at(reference: f64, measured: f64, x: f64) -> Input {
    AdaptiveInput::new(0.001, reference, measured, [x])
}

/// The same sample where the measurement is none.
fn lost(at: Input) -> Input {
    with(at, |at| at.measured = f64::NAN)
}

fn range(low: f64, high: f64) -> Limits<f64> {
    Limits::try_new(low, high).unwrap()
}

/// What adapts: beta_hat, delta_hat, theta_hat.
fn estimates(state: &State) -> [f64; 3] {
    [state.beta_hat(), state.delta_hat(), state.theta_hat()[0]]
}

/// What the lag form's share of the command must be, from where the lag starts.
fn lagged(start: f64, terms: &AdaptiveTerms<f64, 1>) -> f64 {
    start + 0.001 * 8.0 * (terms.beta_hat * terms.virtual_command - start)
}

/// An estimator in another precision, its start in its box.
fn cast_estimator<T: Real>(from: &Estimator<f64>) -> Estimator<T> {
    let of = T::from_f64;
    let (low, high) = (of(from.low), of(from.high));
    let initial = bowden::signal::clamp(of(from.initial), low, high);
    Estimator {
        gain: of(from.gain),
        prior: of(from.prior),
        leakage: match from.leakage {
            Leakage::None => Leakage::None,
            Leakage::Constant { rate } => Leakage::Constant { rate: of(rate) },
            Leakage::Switching { rate, bound } => {
                let (rate, bound) = (of(rate), of(bound));
                Leakage::Switching { rate, bound }
            }
        },
        ..Estimator::fixed(initial).within(low, high)
    }
}
