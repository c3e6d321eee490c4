//! Holds the last good sample during bad ones.

use crate::error::above_zero;
use crate::{Error, Real};

/// Bad-sample guard: the last good sample replaces a bad one.
///
/// A sample is bad if it is not finite or its magnitude exceeds the limit [signal unit]. The
/// state counts consecutive bad samples, so a controller can stop after too many.
///
/// ```
/// use bowden::signal::{Guard, GuardState};
/// # fn main() -> Result<(), bowden::Error> {
/// let guard = Guard::try_new(200.0)?; // [N·m], the range of the sensor
/// let mut state = GuardState::new(0.0);
/// assert_eq!(guard.step(&mut state, 1.5), 1.5);
/// assert_eq!(guard.step(&mut state, f64::NAN), 1.5);
/// assert_eq!(guard.step(&mut state, 1e9), 1.5);
/// assert_eq!(state.consecutive_bad(), 2);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        try_from = "Unchecked<T>",
        bound(
            serialize = "T: Real + serde::Serialize",
            deserialize = "T: Real + serde::Deserialize<'de>"
        )
    )
)]
pub struct Guard<T> {
    limit: T,
}

/// State of a [`Guard`]: the last good sample and the count of bad ones.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(deserialize = "T: Real + serde::Deserialize<'de>"))
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GuardState<T> {
    #[cfg_attr(feature = "serde", serde(deserialize_with = "super::stored::number"))]
    good: T,
    bad: u32,
}

/// The checked configuration, for any float and for constants.
macro_rules! guard {
    ($limit:ident, $zero:expr) => {{
        above_zero!($limit, $zero, "limit");
        Ok(Self { limit: $limit })
    }};
}

macro_rules! constant {
    ($float:ty) => {
        impl Guard<$float> {
            /// [`try_new`](Self::try_new) at compile time, see [`constant!`](crate::constant).
            ///
            /// # Errors
            /// The same as [`try_new`](Self::try_new).
            pub const fn const_new(limit: $float) -> Result<Self, Error> {
                guard!(limit, 0.0)
            }
        }
    };
}
constant!(f32);
constant!(f64);

impl<T: Real> Guard<T> {
    /// A guard that accepts finite samples with a magnitude up to `limit` [signal unit].
    ///
    /// # Errors
    /// [`Error::NonFinite`] or, for `limit <= 0`, [`Error::OutOfRange`] with `"limit"`.
    pub fn try_new(limit: T) -> Result<Self, Error> {
        guard!(limit, T::ZERO)
    }

    /// Largest accepted magnitude [signal unit].
    #[inline]
    #[must_use]
    pub fn limit(&self) -> T {
        self.limit
    }

    /// The sample if it is good, otherwise the last good one.
    #[inline]
    pub fn step(&self, state: &mut GuardState<T>, sample: T) -> T {
        // Written so that NaN fails the comparison.
        if sample.abs() <= self.limit {
            *state = GuardState::new(sample);
        } else {
            state.bad = state.bad.saturating_add(1);
        }
        state.good
    }
}

impl<T: Real> GuardState<T> {
    /// A state that returns `initial` [signal unit] until the first good sample.
    #[inline]
    #[must_use]
    pub fn new(initial: T) -> Self {
        Self {
            good: initial,
            bad: 0,
        }
    }

    /// Number of bad samples in a row; saturates at `u32::MAX`.
    #[inline]
    #[must_use]
    pub fn consecutive_bad(&self) -> u32 {
        self.bad
    }

    /// The last good sample [signal unit].
    #[inline]
    #[must_use]
    pub fn good(&self) -> T {
        self.good
    }
}

#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Unchecked<T> {
    limit: T,
}

#[cfg(feature = "serde")]
impl<T: Real> TryFrom<Unchecked<T>> for Guard<T> {
    type Error = Error;
    fn try_from(raw: Unchecked<T>) -> Result<Self, Error> {
        Self::try_new(raw.limit)
    }
}
