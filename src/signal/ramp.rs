//! A reference that a loop can follow.

use crate::error::finite;
use crate::signal::Compensated;
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
    longest_dt: T,
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
    /// What rounding has kept back of each: at 10 kHz a plain `f32` ramp of 0.005/s would never
    /// leave 25.
    #[cfg_attr(
        feature = "serde",
        serde(default = "T::zero", deserialize_with = "super::stored::number")
    )]
    ramp_carry: T,
    #[cfg_attr(
        feature = "serde",
        serde(default = "T::zero", deserialize_with = "super::stored::number")
    )]
    value_carry: T,
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
            longest_dt: T::HIGHEST,
        })
    }

    /// The same, where a `dt` longer than this one \[s\] leaves the reference where it is; any
    /// finite one moves it before.
    ///
    /// A counter that wrapped would take the reference all the way in one sample, which the
    /// controller behind it refuses, and the next sample would be a step. Take the controller's own
    /// longest dt.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"longest_dt"`.
    pub fn with_longest_dt(self, longest_dt: T) -> Result<Self, Error> {
        if finite(longest_dt, "longest_dt")? <= T::ZERO {
            return Err(Error::OutOfRange("longest_dt"));
        }
        Ok(Self { longest_dt, ..self })
    }

    /// The reference `dt` \[s\] later, on its way to `wanted` \[signal unit\].
    ///
    /// A `wanted` that is not finite, or a `dt` that is not positive or too long, leaves it where it
    /// is. It never passes a `wanted` that stays; one that comes back while the reference is on its
    /// way may be passed by `rate·time_constant`, which the corner takes.
    #[inline]
    pub fn step(&self, state: &mut RampState<T>, wanted: T, dt: T) -> T {
        if wanted.is_finite() && dt > T::ZERO && dt <= self.longest_dt {
            let reach = self.rate * dt;
            let ramp = Compensated {
                value: state.ramp,
                carry: state.ramp_carry,
            };
            let ramp = if (wanted - ramp.value).abs() <= reach {
                Compensated::new(wanted)
            } else if wanted > ramp.value {
                ramp.plus(reach)
            } else {
                ramp.plus(-reach)
            };
            let value = Compensated {
                value: state.value,
                carry: state.value_carry,
            };
            let way = dt * (ramp.value - value.value) / (self.time_constant + dt);
            let value = value.plus(way);
            if (ramp.carry + value.carry).is_finite() {
                *state = RampState {
                    ramp: ramp.value,
                    value: value.value,
                    ramp_carry: ramp.carry,
                    value_carry: value.carry,
                };
            }
        }
        state.value
    }
}

impl<T: Real> RampState<T> {
    /// At rest at a value \[signal unit\].
    #[must_use]
    pub const fn at(value: T) -> Self {
        Self {
            ramp: value,
            value,
            ramp_carry: T::ZERO,
            value_carry: T::ZERO,
        }
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
#[serde(bound(deserialize = "T: Real + serde::Deserialize<'de>"))]
struct Unchecked<T> {
    rate: T,
    time_constant: T,
    #[serde(default = "super::stored::any_dt")]
    longest_dt: T,
}

#[cfg(feature = "serde")]
impl<T: Real> TryFrom<Unchecked<T>> for Ramp<T> {
    type Error = Error;
    fn try_from(raw: Unchecked<T>) -> Result<Self, Error> {
        Self::try_new(raw.rate, raw.time_constant)?.with_longest_dt(raw.longest_dt)
    }
}
