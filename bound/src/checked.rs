//! Checks of numbers, with the parameter's name in the error.

use bowden::{Error, Real};

/// A finite number. NaN and infinities are errors.
pub(crate) fn finite<T: Real>(value: T, name: &'static str) -> Result<T, Error> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Error::NonFinite(name))
    }
}

/// A positive finite number.
pub(crate) fn above_zero<T: Real>(value: T, name: &'static str) -> Result<T, Error> {
    if finite(value, name)? > T::ZERO {
        Ok(value)
    } else {
        Err(Error::OutOfRange(name))
    }
}

/// A finite number that is not negative.
pub(crate) fn not_negative<T: Real>(value: T, name: &'static str) -> Result<T, Error> {
    if finite(value, name)? < T::ZERO {
        return Err(Error::OutOfRange(name));
    }
    Ok(value)
}
