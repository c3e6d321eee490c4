//! State of a [`DisturbanceObserver`](super::DisturbanceObserver) between samples.

use crate::signal::Compensated;
#[cfg(feature = "serde")]
use crate::Error;
use crate::Real;

crate::checked::stored! {
    /// State of a [`DisturbanceObserver`](super::DisturbanceObserver): the lags and the last
    /// estimate.
    ///
    /// ```
    /// use bowden::control::ObserverState;
    /// assert_eq!(ObserverState::<f32>::new().estimate(), 0.0);
    /// ```
    #[derive(Default)]
    pub struct ObserverState<T> {
        /// None before the first good sample.
        pub(super) lags: Option<Lags<T>>,
        pub(super) estimate: T,
        /// Time of the bad samples since the last good one \[s\]. The highest float means an
        /// unknown time, which counts as one more dt.
        pub(super) gap: T,
    }
    => {
        let state = Self { lags, estimate, gap };
        if gap < T::ZERO {
            return Err(Error::Inadmissible("a state must have no negative gap"));
        }
        finite(state)
    }
}

crate::checked::stored! {
    /// The command behind latency and Q, and the output behind Q; each with its rounding error.
    pub(super) struct Lags<T> {
        pub(super) sent: [Compensated<T>; 3],
        pub(super) measured: [Compensated<T>; 2],
    }
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
    /// Initial state, before the first sample. Its estimate is zero.
    ///
    /// The observer treats the first good sample as a steady state. The estimate is then the
    /// applied command minus the command that the nominal plant needs at rest. After the drive has
    /// been off, start from the initial state, because earlier commands did not reach the motor.
    pub const fn new() -> Self {
        Self {
            lags: None,
            estimate: T::ZERO,
            gap: T::ZERO,
        }
    }

    /// The last estimate \[command unit\].
    pub const fn estimate(&self) -> T {
        self.estimate
    }
}
