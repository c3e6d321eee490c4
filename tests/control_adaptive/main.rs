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
mod told;

use bowden::control::{AdaptiveSettings, Estimator, Form, Leakage};
use bowden::Real;

/// A lag form at 1 kHz that the box theorem covers: g within 0.9 to 1.1.
fn lag() -> AdaptiveSettings<f64, 1> {
    let form = Form::FirstOrder {
        step: 0.001,
        plant_gain: 1.0,
    };
    AdaptiveSettings {
        beta: Estimator::fixed(1.0)
            .within(0.9, 1.1)
            .adapting(2.5e-4, 0.01),
        delta: Estimator::fixed(1.0)
            .within(0.0, 7.0)
            .adapting(6.25e-3, 0.01),
        theta: [Estimator::fixed(0.0).within(-5.0, 5.0).adapting(5e-4, 0.01)],
        ..AdaptiveSettings::unlimited(form, 24.0, 8.0, 0.2)
    }
}

/// The same gains in the literal form.
fn literal() -> AdaptiveSettings<f64, 1> {
    AdaptiveSettings {
        form: Form::AsPublished {
            time_constant: 0.002,
        },
        ..lag()
    }
}

/// An estimator in another precision, its start in its box.
fn cast_estimator<T: Real>(from: &Estimator<f64>) -> Estimator<T> {
    let (low, high) = (T::from_f64(from.low), T::from_f64(from.high));
    let initial = bowden::signal::clamp(T::from_f64(from.initial), low, high);
    Estimator {
        gain: T::from_f64(from.gain),
        prior: T::from_f64(from.prior),
        leakage: match from.leakage {
            Leakage::None => Leakage::None,
            Leakage::Constant { rate } => Leakage::Constant {
                rate: T::from_f64(rate),
            },
            Leakage::Switching { rate, bound } => Leakage::Switching {
                rate: T::from_f64(rate),
                bound: T::from_f64(bound),
            },
        },
        ..Estimator::fixed(initial).within(low, high)
    }
}

/// xorshift64*: uniform in -1..1, the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11;
        #[allow(clippy::cast_precision_loss)]
        let unit = bits as f64 / (1u64 << 53) as f64;
        2.0 * unit - 1.0
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * 0.5 * (self.next() + 1.0)
    }
}
