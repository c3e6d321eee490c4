//! Holds the last good sample through bad ones.

use crate::error::finite;
use crate::{Error, Real};

/// Bad-sample guard: the last good sample stands in for a bad one.
///
/// A sample is bad if it is not finite or its magnitude exceeds the limit
/// [signal unit]. The state counts consecutive bad samples, so that a controller can
/// stop after too many.
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

impl<T: Real> Guard<T> {
    /// A guard that admits finite samples with magnitude up to `limit` [signal unit].
    ///
    /// # Errors
    /// [`Error::NonFinite`] or, at `limit <= 0`, [`Error::OutOfRange`] with `"limit"`.
    pub fn try_new(limit: T) -> Result<Self, Error> {
        if finite(limit, "limit")? <= T::zero() {
            return Err(Error::OutOfRange("limit"));
        }
        Ok(Self { limit })
    }

    /// Largest magnitude that is admitted [signal unit].
    #[inline]
    #[must_use]
    pub fn limit(&self) -> T {
        self.limit
    }

    /// The sample if it is good, else the last good one.
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

    /// How many samples in a row were bad; stays at `u32::MAX`.
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
