//! State of a [`Relay`](super::Relay) between samples.

use super::Ultimate;
use crate::control::status::Held;
use crate::signal::{clamp, Compensated};
use crate::Real;

crate::checked::stored! {
    /// State of a [`Relay`](super::Relay): the present cycle, the average and the remaining time.
    ///
    /// After a power-off, start with [`RelayState::new`], because the limit cycle has stopped.
    ///
    /// ```
    /// use bowden::control::RelayState;
    /// let state = RelayState::<f32>::new();
    /// assert!(state.is_running() && state.result().is_none() && state.cycles() == 0);
    /// ```
    pub struct RelayState<T> {
        pub(super) held: Held<T>,
        /// Ticks until the end of `longest_time`.
        pub(super) remaining: u32,
        /// Whether the command is `centre + d`; none before the first good sample.
        pub(super) upper: Option<bool>,
        /// None before the first switch to `centre + d`, and after an unusable `dt`.
        pub(super) cycle: Option<Cycle<T>>,
        pub(super) mean: Mean<T>,
        pub(super) cycles: u32,
        pub(super) result: Option<Ultimate<T>>,
    }
    => {
        finite(Self { held: held.remembering(), remaining, upper, cycle, mean, cycles, result })
    }
}

crate::checked::stored! {
    /// A cycle since its switch to `centre + d`.
    pub(super) struct Cycle<T> {
        pub(super) time: Compensated<T>,
        /// Time of the switch to `centre − d`.
        pub(super) upper_time: T,
        /// Lowest and highest deviation from the reference.
        pub(super) lowest: T,
        pub(super) highest: T,
        pub(super) samples: u32,
    }
}

impl<T: Real> Cycle<T> {
    pub(super) fn starting_at(deviation: T) -> Self {
        Self {
            time: Compensated::new(T::ZERO),
            upper_time: T::ZERO,
            lowest: deviation,
            highest: deviation,
            samples: 0,
        }
    }

    /// Records a deviation.
    pub(super) fn sees(&mut self, deviation: T) {
        self.samples = self.samples.saturating_add(1);
        self.lowest = clamp(self.lowest, T::LOWEST, deviation);
        self.highest = clamp(self.highest, deviation, T::HIGHEST);
    }
}

crate::checked::stored! {
    /// Mean over cycles that agree.
    #[derive(Default)]
    pub(super) struct Mean<T> {
        pub(super) count: u32,
        pub(super) period: T,
        pub(super) amplitude: T,
        pub(super) duty: T,
    }
}

impl<T: Real> Mean<T> {
    /// The mean over one cycle.
    pub(super) fn of(cycle: &Cycle<T>) -> Self {
        let period = cycle.time.value;
        let half = T::from_f64(0.5);
        Self {
            count: 1,
            period,
            amplitude: half * cycle.highest - half * cycle.lowest,
            duty: cycle.upper_time / period,
        }
    }

    /// The mean with one more cycle, or only this cycle if it does not agree.
    pub(super) fn joined_by(&self, cycle: &Self, agreement: T) -> Self {
        let near = |mean: T, x: T| (x - mean).abs() <= agreement * mean;
        let agrees = near(self.period, cycle.period) && near(self.amplitude, cycle.amplitude);
        if self.count == 0 || !agrees {
            return *cycle;
        }
        let count = self.count.saturating_add(1);
        let moved = |mean: T, x: T| mean + (x - mean) / T::from_f64(f64::from(count));
        Self {
            count,
            period: moved(self.period, cycle.period),
            amplitude: moved(self.amplitude, cycle.amplitude),
            duty: moved(self.duty, cycle.duty),
        }
    }
}

impl<T: Real> RelayState<T> {
    /// Initial state, before the first sample. Its command is zero.
    pub const fn new() -> Self {
        Self::starting_from(T::ZERO)
    }

    const fn starting_from(command: T) -> Self {
        Self {
            held: Held::new(command),
            remaining: u32::MAX,
            upper: None,
            cycle: None,
            mean: Mean {
                count: 0,
                period: T::ZERO,
                amplitude: T::ZERO,
                duty: T::ZERO,
            },
            cycles: 0,
            result: None,
        }
    }

    /// Acknowledges the failure: the next good sample restarts the experiment with its full
    /// duration.
    ///
    /// The safe command is applied until this call. Without a failure, the call has no effect.
    pub fn acknowledge(&mut self) {
        if self.is_latched() {
            *self = Self::starting_from(self.held.command);
        }
    }

    /// The applied command \[command unit\].
    pub const fn command(&self) -> T {
        self.held.command
    }

    /// The result, if the experiment has succeeded.
    pub const fn result(&self) -> Option<Ultimate<T>> {
        self.result
    }

    /// Whether the experiment is still running: it has neither succeeded nor failed.
    pub fn is_running(&self) -> bool {
        self.result.is_none() && !self.is_latched()
    }

    /// Number of complete cycles, including cycles outside the average.
    pub const fn cycles(&self) -> u32 {
        self.cycles
    }

    /// The remaining time in units of `longest_time`/(2³² − 1). Every sample of a running
    /// experiment reduces this time.
    pub const fn remaining(&self) -> u32 {
        self.remaining
    }

    /// The fault counter of the [`Fallback`](crate::control::Fallback).
    pub const fn fault_counter(&self) -> u32 {
        self.held.score
    }

    /// Whether the safe command is latched.
    pub fn is_latched(&self) -> bool {
        self.held.is_latched()
    }
}

impl<T: Real> Default for RelayState<T> {
    fn default() -> Self {
        Self::new()
    }
}
