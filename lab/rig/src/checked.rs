//! Finite values.

use bowden::{Error, Real};

/// A finite value. NaN and infinities are errors with the name of the parameter.
pub(crate) fn finite<T: Real>(value: T, name: &'static str) -> Result<T, Error> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Error::NonFinite(name))
    }
}

/// The nearest finite value. Infinities become the largest float with the same sign, and NaN
/// becomes 0.
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
