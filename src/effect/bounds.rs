//! Saturation: a regressor stays finite if the arithmetic overflows.

use crate::signal::two_sum;
use crate::Real;

/// The nearest finite value. An infinity becomes the largest float of the same sign, and NaN
/// becomes 0.
#[cfg_attr(kani, kani::ensures(|result| result.is_finite()))]
#[inline]
pub(crate) fn saturate<T: Real>(value: T) -> T {
    if value.is_finite() {
        value
    } else if value > T::zero() {
        T::max_value()
    } else if value < T::zero() {
        T::min_value()
    } else {
        T::zero()
    }
}

/// `[sum, carry]` after one more step, where `carry` is the rounding error of the sum
/// ([`Compensated`](crate::signal::Compensated)). The result is finite for finite numbers.
///
/// A plain `f32` sum stops changing once an increment is less than half an ulp of the sum. This
/// occurs, for example, after a few hours of operation or on a slow approach to a limit.
#[inline]
pub(super) fn add<T: Real>([sum, carry]: [T; 2], step: T) -> [T; 2] {
    let (total, owed) = two_sum(sum, saturate(step + carry));
    // Near the largest float the distance may overflow, and the total too.
    if owed.is_finite() {
        [total, owed]
    } else {
        [saturate(total), T::zero()]
    }
}
