//! A derivative that survives noise, jitter and bad samples.

use crate::error::{finite, rarely};
use crate::{Error, Real};

/// First-order filtered derivative with a time constant \[s\].
///
/// `v⁺ = (tau·v + x - x_last)/(tau + dt)`: the difference quotient through the first-order
/// lag in its implicit (backward Euler) form, which is stable for any `dt` and needs no
/// exponential. `dt` may vary. It starts at rate zero with the first sample: no kick.
///
/// ```
/// use bowden::signal::{Derivative, DerivativeState};
/// # fn main() -> Result<(), bowden::Error> {
/// let derivative = Derivative::try_new(0.01)?; // \[s\]
/// let mut state = DerivativeState::new();
/// for k in 0..200 {
///     derivative.step(&mut state, 3.0 * 1e-3 * f64::from(k), 1e-3);
/// }
/// assert!((state.rate() - 3.0).abs() < 1e-6); // after 20 time constants
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
pub struct Derivative<T> {
    time_constant: T,
}

/// State of a [`Derivative`]: the last good sample and the filtered rate.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(deserialize = "T: Real + serde::Deserialize<'de>"))
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DerivativeState<T> {
    #[cfg_attr(
        feature = "serde",
        serde(default, deserialize_with = "super::stored::optional")
    )]
    last: Option<T>,
    #[cfg_attr(feature = "serde", serde(deserialize_with = "super::stored::number"))]
    rate: T,
}

impl<T: Real> Derivative<T> {
    /// A derivative with `time_constant >= 0` \[s\]; at zero it is not filtered.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"time_constant"`.
    pub fn try_new(time_constant: T) -> Result<Self, Error> {
        if finite(time_constant, "time_constant")? < T::zero() {
            return Err(Error::OutOfRange("time_constant"));
        }
        Ok(Self { time_constant })
    }

    /// The same where the time constant was checked before.
    #[inline]
    pub(crate) const fn assumed(time_constant: T) -> Self {
        Self { time_constant }
    }

    /// The time constant \[s\].
    #[inline]
    #[must_use]
    pub fn time_constant(&self) -> T {
        self.time_constant
    }

    /// The filtered rate [signal unit/s] after a sample that came `dt` \[s\] later.
    ///
    /// A sample that is not finite, a `dt` that is not positive and finite, or a
    /// rate that overflows leaves the state and returns the rate that was. The time of a bad
    /// sample is not remembered: add it to the `dt` of the next good one, or the rate of a signal
    /// that has moved meanwhile is too high. [`Rates`](crate::signal::Rates) does that.
    #[inline]
    pub fn step(&self, state: &mut DerivativeState<T>, sample: T, dt: T) -> T {
        if sample.is_finite() {
            self.follow(state, sample, dt);
        }
        state.rate
    }

    /// The same of a sample that is finite.
    #[inline]
    pub(crate) fn follow(&self, state: &mut DerivativeState<T>, sample: T, dt: T) {
        let Some(last) = state.last else {
            state.last = Some(sample);
            return;
        };
        if dt.positive_below_highest() {
            let rate = self.quotient(state.rate, sample - last, dt);
            if rate.is_finite() {
                state.rate = rate;
                state.last = Some(sample);
            }
        } else if dt == T::HIGHEST && state.rate.is_finite() {
            rarely();
            state.last = Some(sample);
        }
    }

    /// The filtered rate after the signal has moved by `change` in `dt > 0`; the rate as it
    /// was where `dt` is the highest float, which stands for a time that nobody knows.
    #[inline]
    pub(crate) fn after(&self, rate: T, change: T, dt: T) -> T {
        if dt < T::HIGHEST {
            self.quotient(rate, change, dt)
        } else {
            rate
        }
    }

    #[inline]
    fn quotient(&self, rate: T, change: T, dt: T) -> T {
        (self.time_constant * rate + change) / (self.time_constant + dt)
    }
}

impl<T: Real> DerivativeState<T> {
    /// A state that starts at rate zero with the first good sample.
    #[inline]
    #[must_use]
    pub const fn new() -> Self {
        Self {
            last: None,
            rate: T::ZERO,
        }
    }

    /// A state that has seen `last` and stands at `rate`.
    #[cfg(kani)]
    #[inline]
    pub(crate) fn at(last: T, rate: T) -> Self {
        Self {
            last: Some(last),
            rate,
        }
    }

    /// Whether steps can lead to this state: a last sample that is not finite would hold the
    /// rate for ever.
    pub(crate) fn is_finite(&self) -> bool {
        self.rate.is_finite() && self.last.is_none_or(T::is_finite)
    }

    /// The filtered rate [signal unit/s].
    #[inline]
    #[must_use]
    pub fn rate(&self) -> T {
        self.rate
    }
}

#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Unchecked<T> {
    time_constant: T,
}

#[cfg(feature = "serde")]
impl<T: Real> TryFrom<Unchecked<T>> for Derivative<T> {
    type Error = Error;
    fn try_from(raw: Unchecked<T>) -> Result<Self, Error> {
        Self::try_new(raw.time_constant)
    }
}
