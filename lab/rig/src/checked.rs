//! Values that are finite.

use bowden::{Error, Real};

/// Returns a finite value; refuses NaN and infinities with the parameter's name.
pub(crate) fn finite<T: Real>(value: T, name: &'static str) -> Result<T, Error> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Error::NonFinite(name))
    }
}

/// The nearest finite value: infinities become the largest, NaN becomes 0.
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
