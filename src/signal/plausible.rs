//! Whether a finite number can be true: its range, its rate, and whether it is stuck.

use super::gap::gap_after;
use crate::error::{above_zero, ordered};
use crate::{Error, Real};

/// What a sensor's sample can be: within a range, not faster than a rate, not frozen.
///
/// A controller refuses NaN by itself; a number that is finite and wrong (an encoder that
/// was reset, a shorted bridge, a bus that repeats its last frame) looks good to it. Put a
/// `Plausible` before each input: a sample that cannot be true becomes NaN, which the
/// controller holds its command on, and counts.
///
/// ```
/// use bowden::signal::{Implausible, Plausible, PlausibleState};
/// // Acceleration of the pulley [rad/s²]: ±500, and at most 2e5 rad/s³.
/// let plausible = Plausible::try_new(-500.0, 500.0)?.with_rate(2e5)?.with_stuck_after(50);
/// let mut state = PlausibleState::new();
/// assert_eq!(plausible.step(&mut state, 3.0, 0.001, true).value, 3.0);
///
/// let spike = plausible.step(&mut state, 6e5_f32, 0.001, true); // the encoder was reset
/// assert_eq!(spike.fault, Some(Implausible::OutOfRange));
/// assert!(spike.value.is_nan());
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
pub struct Plausible<T> {
    low: T,
    high: T,
    rate: Option<T>,
    stuck_after: u32,
    longest_dt: T,
}

/// Why a sample cannot be true.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Implausible {
    /// It is NaN or infinite.
    NotFinite,
    /// It lies outside of the range.
    OutOfRange,
    /// It is further from the last plausible sample than the rate allows.
    TooFast,
    /// It has been the same number for too long, while the machine moved.
    Stuck,
}

/// A sample after the check.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PlausibleOutput<T> {
    /// The sample where it is plausible, else NaN.
    pub value: T,
    /// What is wrong with it, where something is.
    pub fault: Option<Implausible>,
}

/// State of a [`Plausible`]: the last plausible sample, and for how long it is past.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(deserialize = "T: Real + serde::Deserialize<'de>"))
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PlausibleState<T> {
    #[cfg_attr(
        feature = "serde",
        serde(default, deserialize_with = "super::stored::optional")
    )]
    last: Option<T>,
    /// Time since `last`, without the present sample's own \[s\].
    #[cfg_attr(feature = "serde", serde(deserialize_with = "super::stored::number"))]
    gap: T,
    same: u32,
}

/// The range after its checks, for any float and for constants.
macro_rules! range {
    ($low:ident, $high:ident, $highest:expr) => {{
        ordered!($low, $high);
        Ok(Self {
            low: $low,
            high: $high,
            rate: None,
            stuck_after: 0,
            longest_dt: $highest,
        })
    }};
}

/// A range with its rate after the checks, likewise.
macro_rules! rated {
    ($range:ident, $rate:ident, $zero:expr) => {{
        above_zero!($rate, $zero, "rate");
        Ok(Self {
            rate: Some($rate),
            ..$range
        })
    }};
}

macro_rules! constant {
    ($float:ty) => {
        impl Plausible<$float> {
            /// [`try_new`](Self::try_new) at compile time, see [`constant!`](crate::constant).
            ///
            /// # Errors
            /// As [`try_new`](Self::try_new).
            pub const fn const_new(low: $float, high: $float) -> Result<Self, Error> {
                range!(low, high, <$float>::MAX)
            }

            /// [`with_rate`](Self::with_rate) at compile time.
            ///
            /// # Errors
            /// As [`with_rate`](Self::with_rate).
            pub const fn const_with_rate(self, rate: $float) -> Result<Self, Error> {
                rated!(self, rate, 0.0)
            }
        }
    };
}
constant!(f32);
constant!(f64);

impl<T: Real> Plausible<T> {
    /// Samples within `low..=high` \[signal unit\], at any rate.
    ///
    /// # Errors
    /// [`Error::NonFinite`] with `"low"` or `"high"`; [`Error::Inadmissible`] unless
    /// `low < high`.
    pub fn try_new(low: T, high: T) -> Result<Self, Error> {
        range!(low, high, T::HIGHEST)
    }

    /// The same where the signal moves by at most `rate` \[signal unit/s\], above zero.
    ///
    /// Not for an angle that wraps: each wrap is too fast. Check the velocity behind
    /// [`Rates`](crate::signal::Rates), which knows the period, within a range instead.
    ///
    /// Through a gap the reach grows with its time, so that a signal that has really moved
    /// is taken up again. So is an encoder that was reset, and [`Rates`](crate::signal::Rates) behind
    /// it then shows a velocity of up to `rate`:
    /// [`Compensator::with_ranges`](crate::control::Compensator::with_ranges) keeps that from a
    /// feed-forward.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"rate"`.
    pub fn with_rate(self, rate: T) -> Result<Self, Error> {
        rated!(self, rate, T::ZERO)
    }

    /// The same where `samples` equal numbers in succession are a stuck sensor; 0: never.
    ///
    /// A sensor that was found stuck stays so until its number changes, at rest too. Where the
    /// machine cannot move because of that, a new [`PlausibleState`] takes it for sound again.
    ///
    /// They are counted while the machine moves only. A coarse encoder repeats itself at low
    /// speed: choose more samples than one of its counts takes then.
    #[must_use]
    pub const fn with_stuck_after(self, samples: u32) -> Self {
        Self {
            stuck_after: samples,
            ..self
        }
    }

    /// The same where a `dt` longer than this one \[s\], or one that cannot be used, counts as
    /// this one.
    ///
    /// A counter that wrapped says that an hour has passed, or that time ran back; any signal may
    /// have moved anywhere meanwhile: one spike is believed then, and every true sample after it
    /// is too fast.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"longest_dt"`.
    pub fn with_longest_dt(self, longest_dt: T) -> Result<Self, Error> {
        above_zero!(longest_dt, T::ZERO, "longest_dt");
        Ok(Self { longest_dt, ..self })
    }

    /// Checks a sample that came `dt` \[s\] after the one before.
    ///
    /// `moves`: whether the machine moves, so that the signal has to: the command changes, or
    /// another sensor does.
    ///
    /// A `dt` of zero is no time: at a rate, the last plausible number alone is plausible. One that
    /// is negative, NaN or infinite counts as [`with_longest_dt`](Self::with_longest_dt) says;
    /// without that the time is unknown, and any sample in the range is plausible until one was
    /// taken. A sample that is not finite never is, whatever `dt`.
    #[inline]
    pub fn step(
        &self,
        state: &mut PlausibleState<T>,
        sample: T,
        dt: T,
        moves: bool,
    ) -> PlausibleOutput<T> {
        // Written so that NaN is not within.
        let dt = if dt >= T::ZERO && dt <= self.longest_dt {
            dt
        } else {
            self.longest_dt
        };
        let elapsed = gap_after(state.gap, dt, T::HIGHEST);
        let fault = self.fault(state, sample, elapsed, moves);
        match fault {
            None => {
                state.last = Some(sample);
                state.gap = T::ZERO;
                let value = sample;
                PlausibleOutput { value, fault }
            }
            Some(_) => {
                state.gap = elapsed;
                let value = T::nan();
                PlausibleOutput { value, fault }
            }
        }
    }

    #[inline]
    fn fault(
        &self,
        state: &mut PlausibleState<T>,
        sample: T,
        elapsed: T,
        moves: bool,
    ) -> Option<Implausible> {
        if !sample.is_finite() {
            return Some(Implausible::NotFinite);
        }
        if sample < self.low || sample > self.high {
            return Some(Implausible::OutOfRange);
        }
        let last = state.last?;
        if let Some(rate) = self.rate {
            // Written so that an overflow of the way is too fast.
            if (sample - last).abs() > rate * elapsed {
                return Some(Implausible::TooFast);
            }
        }
        if sample != last {
            state.same = 0;
        } else if moves {
            state.same = state.same.saturating_add(1);
        }
        let stuck = self.stuck_after > 0 && state.same >= self.stuck_after;
        stuck.then_some(Implausible::Stuck)
    }
}

impl<T: Real> PlausibleState<T> {
    /// A state that has seen no sample: the first one may be anywhere in the range.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            last: None,
            gap: T::ZERO,
            same: 0,
        }
    }

    /// The last plausible sample \[signal unit\], where there was one.
    #[must_use]
    pub const fn last(&self) -> Option<T> {
        self.last
    }
}

/// What is read before it is checked.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(
    deny_unknown_fields,
    bound(deserialize = "T: Real + serde::Deserialize<'de>")
)]
struct Unchecked<T> {
    low: T,
    high: T,
    rate: Option<T>,
    #[serde(default)]
    stuck_after: u32,
    #[serde(default = "super::stored::any_dt")]
    longest_dt: T,
}

#[cfg(feature = "serde")]
impl<T: Real> TryFrom<Unchecked<T>> for Plausible<T> {
    type Error = Error;
    fn try_from(raw: Unchecked<T>) -> Result<Self, Error> {
        let range = Self::try_new(raw.low, raw.high)?
            .with_stuck_after(raw.stuck_after)
            .with_longest_dt(raw.longest_dt)?;
        raw.rate.map_or(Ok(range), |rate| range.with_rate(rate))
    }
}
