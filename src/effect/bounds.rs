//! Finite results for any input: regressors saturate if the arithmetic overflows.

use crate::Real;

/// The nearest finite value: an infinity becomes the largest value of its sign, NaN becomes 0.
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
