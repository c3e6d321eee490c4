//! K4, K5, K9: one estimate, whatever drives it.

use super::super::compensated::Compensated;
use super::super::{Estimator, Leakage};
use super::state::{estimator, leakage};
use crate::proofs::any::within;
use crate::Real;

/// Any sum that the box holds.
pub(super) fn held_by(estimator: &Estimator<f32>) -> Compensated<f32> {
    let sum = Compensated {
        value: kani::any(),
        carry: kani::any(),
    };
    kani::assume(estimator.holds(&sum));
    sum
}

/// K4, K5. An estimate stays in its box, so beta_hat above its least value.
///
/// Assumes: nothing of gains, leakage, prior, dt or what drives it; an estimate in its box.
#[kani::proof]
fn estimate_in_its_box() {
    let estimator = estimator(leakage());
    let before = held_by(&estimator);
    let after = estimator.update(before, kani::any(), kani::any());
    kani::cover!(after.is_some_and(|after| after.value > before.value && after.carry != 0.0));
    kani::cover!(after.is_none());
    assert!(after.is_none_or(|after| estimator.holds(&after)));
}

/// K9. Without excitation a leak to zero never grows an estimate or turns its sign.
///
/// Assumes: dt = 1/1024 s, leakage rate ∈ [0, 1e4]/s, |estimate| ≤ 1000, nothing owed by
/// rounding.
#[kani::proof]
fn leak_to_zero() {
    let estimator = Estimator {
        leakage: Leakage::Constant {
            rate: within(0.0, 1e4),
        },
        ..Estimator::<f32>::fixed(0.0)
    };
    let before = within(-1000.0, 1000.0);
    let after = estimator.update(Compensated::new(before), 1.0 / 1024.0, 0.0);
    let value = after.map_or(f32::NAN, |after| after.value);
    kani::cover!(value < before && value > 0.5);
    assert!(value.abs() <= before.abs() && value * before >= 0.0);
}

/// An increment as `leak_moves_towards_the_prior` proves it, and no more.
fn any_leak<T: Real>(_: &Estimator<T>, distance: T, _: T, _: T) -> T {
    let by = T::of(kani::any());
    let zero = T::zero();
    kani::assume((-distance <= by && by <= zero) || (zero <= by && by <= -distance));
    by
}

/// K9. Without excitation the increment of a leak lies between nothing and the way to the
/// prior.
///
/// Assumes: dt = 1/1024 s, leakage rate ∈ [0, 1e4]/s, constant; at most 2000 from the prior.
#[kani::proof]
fn leak_moves_towards_the_prior() {
    let rate = within(0.0, 1e4);
    let estimator = Estimator::<f32>::fixed(0.0).adapting(1.0, rate);
    let distance = within(-2000.0, 2000.0);
    let by = estimator.increment(distance, 1.0 / 1024.0, 0.0);
    kani::cover!(by < -1.0 && by > -distance);
    assert!((-distance <= by && by <= 0.0) || (0.0 <= by && by <= -distance));
}

/// K9. Without excitation a leak moves an estimate towards its prior and stops there, but for
/// an ulp of the larger one.
///
/// Assumes: a prior of 1, |estimate| ≤ 1000, nothing owed by rounding; the increment as proved by
/// leak_moves_towards_the_prior.
#[kani::proof]
#[kani::stub(Estimator::increment, any_leak)]
fn leak_to_the_prior() {
    let prior = 1.0_f32;
    let estimator = Estimator {
        prior,
        ..Estimator::<f32>::fixed(0.0)
    };
    let before = within(-1000.0, 1000.0);
    let after = estimator.update(Compensated::new(before), kani::any(), 0.0);
    let value = after.map_or(f32::NAN, |after| after.value);
    // What rounding their distance may add.
    let tolerance = f32::EPSILON * before.abs().max(prior.abs());
    kani::cover!(value < before && value > prior);
    if before >= prior {
        assert!(value <= before && value >= prior - tolerance);
    } else {
        assert!(value >= before && value <= prior + tolerance);
    }
}
