//! The one error of the crate: what was wrong, with the parameter's name.
//!
//! Everything is checked once, in the constructors. After that no arithmetic
//! returns a `Result` and nothing panics.

use core::fmt;

/// Why a parameter was refused. Every variant carries the parameter's name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// The parameter is NaN or infinite.
    NonFinite(&'static str),
    /// The parameter is finite but outside the range that the docs state.
    OutOfRange(&'static str),
    /// The parameters are fine one by one, but together break the named condition.
    Inadmissible(&'static str),
    /// More items were given than the fixed capacity holds.
    Capacity(&'static str),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NonFinite(name) => write!(f, "{name} is not finite"),
            Self::OutOfRange(name) => write!(f, "{name} is out of range"),
            Self::Inadmissible(condition) => write!(f, "condition not met: {condition}"),
            Self::Capacity(what) => write!(f, "too many {what} for the fixed capacity"),
        }
    }
}

impl core::error::Error for Error {}

/// Passes a finite value on, refuses NaN and infinities with the parameter's name.
///
/// # Errors
/// [`Error::NonFinite`] with `name`.
pub(crate) fn finite<T: crate::Real>(value: T, name: &'static str) -> Result<T, Error> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Error::NonFinite(name))
    }
}
