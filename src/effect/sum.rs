//! Sums over many samples. A plain one in `f32` stops growing once its steps fall below
//! half an ulp: after a few hours of work, or on a slow approach to a limit.

use super::bounds::saturate;
use crate::Real;

/// `[sum, carry]` after one more step; `carry` is what rounding has added too much
/// (Kahan's sum). Finite for finite numbers.
#[inline]
pub(super) fn add<T: Real>([sum, carry]: [T; 2], step: T) -> [T; 2] {
    let step = saturate(step - carry);
    let total = sum + step;
    // At the end of the floats `total - sum` may overflow where the total does not.
    let lost = (total - sum) - step;
    if lost.is_finite() {
        [total, lost]
    } else {
        [saturate(total), T::zero()]
    }
}
