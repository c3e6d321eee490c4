//! A reference that a loop can follow.

use crate::error::finite;
use crate::signal::clamp;
use crate::{Error, Real};

/// A reference ramp: at most a rate, then a lag that rounds its corners.
///
/// `r⁺ = r + clamp(wanted − r, ±rate·dt)`, `y⁺ = y + dt/(tau + dt)·(r⁺ − y)`. A step of the
/// reference asks a drive for what it cannot give: the anti-windup then shapes the answer
/// instead of the gains.
///
/// ```
/// use bowden::signal::{Ramp, RampState};
/// let ramp = Ramp::try_new(50.0, 0.02)?; // 50 N·m/s, corners of 20 ms
/// let mut state = RampState::at(0.0_f32);
/// for _ in 0..1000 {
///     ramp.step(&mut state, 25.0, 0.001);
/// }
/// assert!((state.value() - 25.0).abs() < 1e-4); // there after half a second
/// # Ok::<(), bowden::Error>(())
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
pub struct Ramp<T> {
    rate: T,
    time_constant: T,
}

/// State of a [`Ramp`]: where the ramp is, and the rounded value.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(deserialize = "T: Real + serde::Deserialize<'de>"))
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RampState<T> {
    #[cfg_attr(feature = "serde", serde(deserialize_with = "super::stored::number"))]
    ramp: T,
    #[cfg_attr(feature = "serde", serde(deserialize_with = "super::stored::number"))]
    value: T,
}

impl<T: Real> Ramp<T> {
    /// A ramp of `rate > 0` \[signal unit/s\] with a lag of `time_constant >= 0` \[s\].
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"rate"` or `"time_constant"`.
    pub fn try_new(rate: T, time_constant: T) -> Result<Self, Error> {
        if finite(rate, "rate")? <= T::ZERO {
            return Err(Error::OutOfRange("rate"));
        }
        if finite(time_constant, "time_constant")? < T::ZERO {
            return Err(Error::OutOfRange("time_constant"));
        }
        Ok(Self {
            rate,
            time_constant,
        })
    }

    /// The reference `dt` \[s\] later, on its way to `wanted` \[signal unit\].
    ///
    /// A `wanted` that is not finite, or a `dt` that is not positive and finite, leaves it
    /// where it is. It never passes what was wanted.
    #[inline]
    pub fn step(&self, state: &mut RampState<T>, wanted: T, dt: T) -> T {
        let reach = self.rate * dt;
        if wanted.is_finite() && dt > T::ZERO && dt.is_finite() {
            let next = clamp(wanted, state.ramp - reach, state.ramp + reach);
            let way = dt * (next - state.value) / (self.time_constant + dt);
            if next.is_finite() && way.is_finite() {
                state.ramp = next;
                state.value += way;
            }
        }
        state.value
    }
}

impl<T: Real> RampState<T> {
    /// At rest at a value \[signal unit\].
    #[must_use]
    pub const fn at(value: T) -> Self {
        Self { ramp: value, value }
    }

    /// The reference \[signal unit\].
    #[must_use]
    pub const fn value(&self) -> T {
        self.value
    }
}

/// What is read before it is checked.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Unchecked<T> {
    rate: T,
    time_constant: T,
}

#[cfg(feature = "serde")]
impl<T: Real> TryFrom<Unchecked<T>> for Ramp<T> {
    type Error = Error;
    fn try_from(raw: Unchecked<T>) -> Result<Self, Error> {
        Self::try_new(raw.rate, raw.time_constant)
    }
}
