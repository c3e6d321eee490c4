//! State of a [`DisturbanceObserver`](super::DisturbanceObserver) between samples.

use crate::signal::Compensated;
#[cfg(feature = "serde")]
use crate::Error;
use crate::Real;

/// State of a [`DisturbanceObserver`](super::DisturbanceObserver): five lags and the last estimate.
///
/// ```
/// use bowden::control::ObserverState;
/// assert_eq!(ObserverState::<f32>::new().estimate(), 0.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
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
pub struct ObserverState<T> {
    /// None before the first good sample.
    pub(super) lags: Option<Lags<T>>,
    pub(super) estimate: T,
    /// Time of the bad samples since the last good one \[s\]. The highest float means an
    /// unknown time, which counts as one more dt.
    pub(super) gap: T,
}

/// The command behind latency and Q, and the output behind Q; each with its rounding error.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Lags<T> {
    pub(super) sent: [Compensated<T>; 3],
    pub(super) measured: [Compensated<T>; 2],
}

impl<T: Real> Lags<T> {
    pub(super) fn at(sent: T, measured: T) -> Self {
        Self {
            sent: [Compensated::new(sent); 3],
            measured: [Compensated::new(measured); 2],
        }
    }

    /// The sum of all numbers: not finite if one of them is not.
    #[inline]
    pub(super) fn sum(&self) -> T {
        let all = self.sent.iter().chain(&self.measured);
        all.fold(T::ZERO, |sum, lag| sum + lag.value + lag.carry)
    }
}

/// A lag that moves by a share of the way to its target.
#[inline]
pub(super) fn lag<T: Real>(state: Compensated<T>, target: T, share: T) -> Compensated<T> {
    state.plus(share * (target - state.value))
}

impl<T: Real> ObserverState<T> {
    /// A new state, before the first sample; its estimate is zero.
    ///
    /// The first good sample counts as a steady state: the estimate is then the applied command
    /// minus the command that the nominal plant needs at rest. Use a new state after the drive was
    /// off, because a command that did not reach the motor must not count.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            lags: None,
            estimate: T::ZERO,
            gap: T::ZERO,
        }
    }

    /// The last estimate \[command unit\].
    #[must_use]
    pub const fn estimate(&self) -> T {
        self.estimate
    }
}

/// The stored form, or a proof's state, before its checks.
#[cfg(any(feature = "serde", kani))]
#[cfg_attr(feature = "serde", derive(serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub(super) struct Unchecked<T> {
    pub(super) lags: Option<Lags<T>>,
    pub(super) estimate: T,
    pub(super) gap: T,
}

#[cfg(any(feature = "serde", kani))]
impl<T: Real> ObserverState<T> {
    /// A state of these fields, with any values.
    pub(super) fn assumed(raw: Unchecked<T>) -> Self {
        Self {
            lags: raw.lags,
            estimate: raw.estimate,
            gap: raw.gap,
        }
    }
}

#[cfg(feature = "serde")]
impl<T: Real> TryFrom<Unchecked<T>> for ObserverState<T> {
    type Error = Error;
    fn try_from(raw: Unchecked<T>) -> Result<Self, Error> {
        let finite = raw.lags.is_none_or(|lags| lags.sum().is_finite())
            && (raw.estimate + raw.gap).is_finite();
        if finite && raw.gap >= T::ZERO {
            return Ok(Self::assumed(raw));
        }
        Err(Error::Inadmissible(
            "a state must have finite numbers and no negative gap",
        ))
    }
}
