//! Sums over many samples. A plain sum in `f32` stops growing once its increments fall below half
//! an ulp: after a few hours of operation, or on a slow approach to a limit.

use super::bounds::saturate;
use crate::signal::two_sum;
use crate::Real;

/// `[sum, carry]` after one more step; the carry is the rounding error of the sum
/// ([`Compensated`](crate::signal::Compensated)). Finite for finite numbers.
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
