//! The error type of the crate: the cause and the name of the parameter.
//!
//! The constructors check all parameters. After construction, no step returns a `Result`, and no
//! step panics.

use core::fmt;

/// The reason for rejecting a parameter. Every variant contains the name of the parameter or the
/// violated condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// The parameter is NaN or infinite.
    NonFinite(&'static str),
    /// The parameter is finite but outside its documented range.
    OutOfRange(&'static str),
    /// Each parameter is valid on its own, but together they violate this condition.
    Inadmissible(&'static str),
    /// The number of items exceeds the fixed capacity.
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

impl Error {
    /// The name of the parameter, or the violated condition.
    #[must_use]
    pub const fn parameter(&self) -> &'static str {
        match self {
            Self::NonFinite(name)
            | Self::OutOfRange(name)
            | Self::Inadmissible(name)
            | Self::Capacity(name) => name,
        }
    }
}

impl core::error::Error for Error {}

/// Makes a configuration for a `static` or a `const`, checked at compile time.
///
/// The arguments are the same as at run time, for `f32` or `f64`. The macro supports all
/// configurations except effects, models and compensators. An invalid parameter is a compile error
/// whose message contains the name of the parameter. The configuration is stored in flash and needs
/// no initialisation at start-up.
///
/// ```
/// use bowden::constant;
/// use bowden::control::{Fallback, Limits, Pid, PidSettings};
/// static PI: Pid<f32> = constant!(Pid::<f32>::try_new(PidSettings::new(
///     30.0,
///     18.0,
///     constant!(Limits::<f32>::try_new(-20.0, 60.0).with_slew(500.0)), // [N·m], [N·m/s]
///     0.005,                                                           // longest dt [s]
///     constant!(Fallback::<f32>::try_new(20, 0.0)),                    // after 20 bad samples, [N·m]
/// )));
/// assert_eq!(PI.settings().k_p, 30.0);
/// ```
///
/// ```compile_fail
/// # use bowden::{constant, control::Limits};
/// const REVERSED: Limits<f32> = constant!(Limits::<f32>::try_new(60.0, -20.0));
/// ```
#[macro_export]
macro_rules! constant {
    ($config:ident::<$($of:tt),+>::$make:ident($($arg:expr),* $(,)?) $($with:tt)*) => {
        $crate::constant!(
            @ $config<$($of),+>, $crate::Constant::<$config<$($of),+>>::$make($($arg),*), $($with)*
        )
    };
    (@ $config:ty, $made:expr, .$with:ident($($arg:expr),* $(,)?) $($rest:tt)*) => {
        $crate::constant!(
            @ $config,
            $crate::Constant::<$config>::$with($crate::constant!(@ $config, $made,), $($arg),*),
            $($rest)*
        )
    };
    (@ $config:ty, $made:expr,) => {
        const {
            match $made {
                Ok(it) => it,
                Err(error) => ::core::panic!("{}", error.parameter()),
            }
        }
    };
}

/// Returns a finite value, or an error with the name of the parameter.
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

/// Marks the surrounding branch as rare, so that the usual branch needs no jump.
#[cold]
#[inline]
pub(crate) const fn rarely() {}

/// Whether a number is finite. To test several numbers at once, test their sum.
#[inline]
#[allow(clippy::eq_op)]
pub(crate) fn is_usable<T: crate::Real>(sum: T) -> bool {
    // An infinity minus itself is NaN; the test loads no constant.
    sum - sum == T::ZERO
}

/// Returns the error of a number that is not finite from the surrounding function.
///
/// These checks work on a generic `T: Real` and, in a `const fn`, on `f32` and `f64`.
macro_rules! must_be_finite {
    ($value:expr, $name:expr) => {
        if !$value.is_finite() {
            return Err(Error::NonFinite($name));
        }
    };
}

/// The same for a number that is not finite or not positive.
macro_rules! above_zero {
    ($value:expr, $name:expr) => {
        crate::error::must_be_finite!($value, $name);
        if $value <= T::ZERO {
            return Err(Error::OutOfRange($name));
        }
    };
}

/// The same for a number that is not finite or negative.
macro_rules! not_below_zero {
    ($value:expr, $name:expr) => {
        crate::error::must_be_finite!($value, $name);
        if $value < T::ZERO {
            return Err(Error::OutOfRange($name));
        }
    };
}

/// The same for both ends of a range, `"low"` and `"high"`.
macro_rules! ordered {
    ($low:expr, $high:expr) => {
        crate::error::must_be_finite!($low, "low");
        crate::error::must_be_finite!($high, "high");
        if $low >= $high {
            return Err(Error::Inadmissible("low < high"));
        }
    };
}

pub(crate) use {above_zero, must_be_finite, not_below_zero, ordered};
