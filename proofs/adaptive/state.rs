//! Arbitrary laws, states and samples.

use super::super::state::End;
use super::super::{Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState};
use super::super::{Estimator, Form, Leakage, OnMissing, SmoothSign};
use crate::control::status::Held;
use crate::proofs::any::{fallback, finite, limits};
use crate::proofs::pid::latch;
use crate::signal::{Compensated, DerivativeState};

/// Any leakage.
pub(super) fn leakage() -> Leakage<f32> {
    let rate = kani::any();
    match kani::any::<u8>() {
        0 => Leakage::None,
        1 => Leakage::Constant { rate },
        _ => Leakage::Switching {
            rate,
            bound: kani::any(),
        },
    }
}

/// Any estimator.
pub(super) fn estimator(leakage: Leakage<f32>) -> Estimator<f32> {
    Estimator {
        initial: kani::any(),
        low: kani::any(),
        high: kani::any(),
        gain: kani::any(),
        leakage,
        prior: kani::any(),
    }
}

/// Any law of this form: more than the constructor accepts, for only the order of the
/// boxes, the range, a safe command within it and a longest step above zero are taken from its
/// checks.
pub(super) fn law<const N: usize>(form: Form<f32>, smooth_sign: SmoothSign) -> Adaptive<f32, N> {
    let settings = AdaptiveSettings {
        form,
        gain: kani::any(),
        lambda: kani::any(),
        epsilon: kani::any(),
        smooth_sign,
        beta: estimator(leakage()),
        delta: estimator(leakage()),
        theta: core::array::from_fn(|_| estimator(leakage())),
        z_limit: kani::any(),
        frozen: kani::any(),
        missing: core::array::from_fn(|_| {
            if kani::any() {
                OnMissing::Hold
            } else {
                OnMissing::DropRegressor
            }
        }),
        limits: limits(),
        longest_dt: kani::any(),
        fallback: fallback(),
    };
    let safe = settings.fallback.command();
    kani::assume(safe.is_none_or(|safe| settings.limits.contains(safe)));
    Adaptive {
        settings,
        longest: kani::any_where(|longest: &f32| *longest > 0.0 && longest.is_finite()),
    }
}

fn sum() -> Compensated<f32> {
    Compensated {
        value: kani::any(),
        carry: kani::any(),
    }
}

/// Any numbers in the fields of a state.
pub(super) fn any_state<const N: usize>() -> AdaptiveState<f32, N> {
    let seen = DerivativeState::at(kani::any(), kani::any());
    AdaptiveState {
        z: sum(),
        error_rate: if kani::any() {
            seen
        } else {
            DerivativeState::new()
        },
        lag: sum(),
        beta: sum(),
        delta: sum(),
        theta: core::array::from_fn(|_| sum()),
        held: Held {
            command: kani::any(),
            score: kani::any(),
            latch: latch(),
        },
        gap: kani::any(),
        drive: drive(),
    }
}

/// Any state that is valid for the law.
pub(super) fn state<const N: usize>(law: &Adaptive<f32, N>) -> AdaptiveState<f32, N> {
    let state = any_state();
    kani::assume(law.is_valid(&state));
    state
}

/// All bit patterns.
pub(super) fn input<const N: usize>() -> AdaptiveInput<f32, N> {
    AdaptiveInput {
        dt: kani::any(),
        reference: kani::any(),
        next_reference: kani::any(),
        measured: kani::any(),
        regressors: core::array::from_fn(|_| kani::any()),
        feed_forward: kani::any(),
    }
}

fn finite_sum() -> Compensated<f32> {
    Compensated {
        value: finite(),
        carry: finite(),
    }
}

/// Any state of finite numbers, of whichever law it was.
pub(super) fn finite_state<const N: usize>() -> AdaptiveState<f32, N> {
    AdaptiveState {
        z: finite_sum(),
        error_rate: DerivativeState::at(finite(), finite()),
        lag: finite_sum(),
        beta: finite_sum(),
        delta: finite_sum(),
        theta: core::array::from_fn(|_| finite_sum()),
        held: Held {
            command: finite(),
            score: kani::any(),
            latch: latch(),
        },
        gap: finite(),
        drive: drive(),
    }
}

/// Any limit of the drive, or none.
pub(super) fn drive() -> Option<End> {
    match kani::any::<u8>() {
        0 => Some(End::Upper),
        1 => Some(End::Lower),
        _ => None,
    }
}
