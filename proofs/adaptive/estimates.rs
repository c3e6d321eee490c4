//! K4, K5, K9: one estimate, whatever drives it.

use super::super::{Estimator, Leakage};
use super::state::{estimator, leakage};
use crate::proofs::any::{finite, within};
use crate::signal::{two_sum, Compensated};
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

/// K4, K5. An estimate stays within its bounds, so beta_hat stays at or above its lower bound.
///
/// Assumes: nothing about gains, leakage, prior, dt or input; an estimate within its bounds.
#[kani::proof]
fn estimate_in_its_box() {
    let estimator = estimator(leakage());
    let before = held_by(&estimator);
    let after = estimator.update(before, kani::any(), kani::any());
    kani::cover!(after.is_finite() && after.value > before.value && after.carry != 0.0);
    kani::cover!(!after.carry.is_finite());
    assert!(estimator.holds(&after) || !after.carry.is_finite());
}

/// Whether `lost` is no number where the sum is none and, of numbers within ±1e6, within ±1e8:
/// far from what it is, and enough.
fn may_be_lost<T: Real>(a: T, b: T, sum: T, lost: T) -> bool {
    let small = |x: T, most: f64| x.abs() <= T::from_f64(most);
    let is_small = !(small(a, 1e6) && small(b, 1e6)) || small(lost, 1e8);
    (sum.is_finite() || !lost.is_finite()) && is_small
}

/// K1. If a sum is not finite, neither is its rounding error, so a step that checks the rounding
/// error detects both; for numbers within ±1e6 the rounding error is within ±1e8. (A finite sum may
/// have a rounding error that is not finite: for example, MAX plus one and a half of its last
/// units.)
#[kani::proof]
fn a_sum_and_what_it_lost() {
    let (a, b) = (kani::any::<f32>(), kani::any());
    let (sum, lost) = two_sum(a, b);
    kani::cover!(lost > 0.0 && sum < -1.0);
    kani::cover!(sum.is_finite() && !lost.is_finite());
    kani::cover!(sum.is_infinite());
    assert!(may_be_lost(a, b, sum, lost));
}

/// What `a_sum_and_what_it_lost` proves of a sum, and no more.
pub(super) fn any_lost<T: Real>(a: T, b: T) -> (T, T) {
    let (sum, lost) = (a + b, T::from_f64(f64::from(kani::any::<f32>())));
    kani::assume(may_be_lost(a, b, sum, lost));
    (sum, lost)
}

/// Any estimate, and what rounding has dropped of it: less than rounding can see.
fn any_estimate() -> Compensated<f32> {
    let sum = Compensated {
        value: within(-1000.0, 1000.0),
        carry: finite(),
    };
    kani::assume(is_rounded(&sum));
    sum
}

/// Whether the carry is what rounding has dropped of the sum: added, it is dropped again.
fn is_rounded(sum: &Compensated<f32>) -> bool {
    sum.value + sum.carry == sum.value
}

/// Whether one sum, carry included, is at most another. Exact: a carry is at most half an ulp
/// of its value, so that it decides only between equal values.
fn is_at_most(sum: &Compensated<f32>, other: &Compensated<f32>) -> bool {
    sum.value < other.value || (sum.value == other.value && sum.carry <= other.carry)
}

/// Any leakage rate up to 1e4/s, as `a_leakage_rate_is_at_most_its_rate` bounds it.
fn any_rate_at<T: Real>(_: &Leakage<T>, _: T) -> T {
    T::from_f64(within(0.0, 1e4).into())
}

/// K9. The rate of a leakage, constant or switching, lies between zero and its maximum; a switching
/// rate is the same on both sides of the prior.
///
/// Assumes: a rate that is not negative and a bound above zero, both finite; any finite distance.
#[kani::proof]
fn a_leakage_rate_is_at_most_its_rate() {
    let leakage = leakage();
    let (most, distance) = (leakage.rate(), finite());
    kani::assume(most.is_finite() && most >= 0.0);
    if let Leakage::Switching { bound, .. } = leakage {
        kani::assume(bound.is_finite() && bound > 0.0);
    }
    let rate = leakage.rate_at(distance);
    kani::cover!(rate > 0.0 && rate < most);
    assert!(0.0 <= rate && rate <= most);
}

/// K9. Without excitation the increment of a leakage lies between zero and the distance to the
/// prior.
///
/// Assumes: dt = 1/1024 s; at most 2000 from the prior; the rate within \[0, 1e4\]/s, as proved by
/// a_leakage_rate_is_at_most_its_rate for constant and switching leakage.
#[kani::proof]
#[kani::stub(Leakage::rate_at, any_rate_at)]
fn leak_moves_towards_the_prior() {
    let estimator = Estimator::<f32>::fixed(0.0).adapting(1.0, 1.0);
    let distance = within(-2000.0, 2000.0);
    let by = estimator.increment(distance, 1.0 / 1024.0, 0.0);
    kani::cover!(by < -1.0 && by > -distance);
    assert!((-distance <= by && by <= 0.0) || (0.0 <= by && by <= -distance));
}

/// An increment as `leak_moves_towards_the_prior` proves it, and no more.
fn any_leak<T: Real>(_: &Estimator<T>, distance: T, _: T, _: T) -> T {
    let by = T::from_f64(f64::from(kani::any::<f32>()));
    let zero = T::zero();
    kani::assume((-distance <= by && by <= zero) || (zero <= by && by <= -distance));
    by
}

/// A sum, and what rounding lost of it: what Knuth's Theorem B leaves of it, and no more.
fn any_two_sum<T: Real>(a: T, b: T) -> (T, T) {
    let (sum, lost) = (a + b, T::from_f64(f64::from(kani::any::<f32>())));
    kani::assume(if sum == a {
        lost == b
    } else {
        sum + lost == sum
    });
    (sum, lost)
}

/// The estimate after a step of any leak, which must leave a sum that is rounded again.
fn leaked(prior: f32, before: &Compensated<f32>) -> Compensated<f32> {
    let estimator = Estimator {
        prior,
        ..Estimator::<f32>::free(0.0)
    };
    let after = estimator.update(*before, 1.0 / 1024.0, 0.0);
    assert!(is_rounded(&after));
    after
}

/// K9. Without excitation a leakage to zero moves an estimate, including its carry, towards zero
/// and past zero by at most the previous carry; the new carry is at most half an ulp again.
///
/// Assumes: dt = 1/1024 s, leakage rate ∈ [0, 1e4]/s, constant or switching, |estimate| ≤ 1000, any
/// carry that vanishes when it is added to the sum; the increment as proved by
/// leak_moves_towards_the_prior; the rounding error of a sum below its resolution.
#[kani::proof]
#[kani::stub(Estimator::increment, any_leak)]
#[kani::stub(two_sum, any_two_sum)]
fn leak_to_zero() {
    let before = any_estimate();
    let after = leaked(0.0, &before);
    let owed = before.carry.abs();
    kani::cover!(after.value < before.value && after.value > 0.5 && before.carry > 0.0);
    if before.value >= 0.0 {
        assert!(-owed <= after.value && is_at_most(&after, &before));
    } else {
        assert!(is_at_most(&before, &after) && after.value <= owed);
    }
}

/// K9. Without excitation a leakage to a prior moves an estimate, including its carry, towards the
/// prior and past it by at most two ulps of the larger of the two; the new carry is at most half an
/// ulp again.
///
/// Assumes: a prior of 1, dt = 1/1024 s, leakage rate ∈ [0, 1e4]/s, constant or switching,
/// |estimate| ≤ 1000, any carry that vanishes when it is added to the sum; the increment as proved
/// by leak_moves_towards_the_prior; the rounding error of a sum below its resolution.
#[kani::proof]
#[kani::stub(Estimator::increment, any_leak)]
#[kani::stub(two_sum, any_two_sum)]
fn leak_to_the_prior() {
    let prior = 1.0_f32;
    let before = any_estimate();
    let after = leaked(prior, &before);
    // What rounding their distance, and its sum with what was owed, may add.
    let tolerance = 2.0 * f32::EPSILON * before.value.abs().max(prior);
    kani::cover!(after.value < before.value && after.value > 1.0);
    if before.value >= prior {
        assert!(prior - tolerance <= after.value && is_at_most(&after, &before));
    } else {
        assert!(is_at_most(&before, &after) && after.value <= prior + tolerance);
    }
}
