//! State of a [`Pid`] between samples.

use super::{Pid, PidInput};
#[cfg(any(feature = "serde", kani))]
use crate::checked::Finite;
use crate::control::status::Held;
use crate::control::Status;
use crate::error::is_usable;
use crate::signal::Compensated;
use crate::Real;

crate::checked::stored! {
    /// State of a [`Pid`]: the integral, the filtered derivative and the last good sample.
    ///
    /// Any state is valid for any [`Pid`]. To change the gains of a running controller without a
    /// jump, see [`Pid::bumpless_transfer`].
    ///
    /// ```
    /// use bowden::control::{Pid, PidInput, PidState};
    /// let pid = Pid::paper_pi();
    /// let mut state = PidState::new();
    /// pid.step(&mut state, &PidInput::new(0.001, 1.0, 0.5_f64));
    /// assert!(state.integral() > 0.0);
    /// state.reset();
    /// assert_eq!(state.integral(), 0.0);
    /// ```
    #[derive(Default)]
    pub struct PidState<T> {
        /// The integral term \[command unit\].
        pub(crate) integral: Compensated<T>,
        /// Filtered rate of y − c·y_r, zero if it is not used.
        pub(crate) rate: T,
        pub(crate) last: Option<Last<T>>,
        pub(crate) held: Held<T>,
        /// Time of the bad samples since the last good one \[s\]. The highest float means an
        /// unknown time: the rate then stays unchanged for a sample.
        pub(crate) gap: T,
    }
    => {
        let state = Self { integral, rate, last, held: held.remembering(), gap };
        if !state.is_valid() {
            return Err(crate::Error::Inadmissible(
                "a state must have finite numbers and no negative gap",
            ));
        }
        Ok(state)
    }
}

crate::checked::stored! {
    /// The last good sample and its terms.
    pub(crate) struct Last<T> {
        pub(crate) reference: T,
        pub(crate) measured: T,
        /// Zero for NaN, which affects PIV only.
        pub(crate) velocity: T,
        pub(crate) feed_forward: T,
        pub(crate) unlimited: T,
        /// Change of the integral at this sample.
        pub(crate) change: T,
    }
}

impl<T: Real> Last<T> {
    /// A sample before the law has processed it.
    #[inline]
    pub(super) fn at(at: &PidInput<T>) -> Self {
        Self {
            reference: at.reference,
            measured: at.measured,
            velocity: at.velocity,
            feed_forward: at.feed_forward,
            unlimited: T::ZERO,
            change: T::ZERO,
        }
    }

    /// The same, with zero for a velocity that is NaN.
    pub(super) fn with_known_velocity(self) -> Self {
        if is_usable(self.velocity) {
            return self;
        }
        Self {
            velocity: T::ZERO,
            ..self
        }
    }
}

impl<T: Real> PidState<T> {
    /// Initial state, before the first sample. Its command is zero.
    ///
    /// A slew-rate limit starts from this command. If another command is applied, use
    /// [`PidState::resume_from`].
    pub const fn new() -> Self {
        Self {
            integral: Compensated::new(T::ZERO),
            rate: T::ZERO,
            last: None,
            held: Held::new(T::ZERO),
            gap: T::ZERO,
        }
    }

    /// Restarts so that the command continues from `output` \[command unit\].
    ///
    /// The integral is set so that, at the sample `at`, all terms including the feed-forward add up
    /// to `output`, clamped to the limits. Use this method after manual control or another
    /// controller. The derivative starts at zero. The next step at the same sample adds only one
    /// increment of the integral. `at.dt` is ignored.
    ///
    /// If a number is not finite or an overflow occurs, the sample is bad, and the method returns
    /// the fault. A latched safe command stays latched, and the fault counter is kept.
    ///
    /// With `k_i` = 0, the integral then returns to zero; see
    /// [`PidSettings::k_i`](super::PidSettings::k_i).
    ///
    /// ```
    /// use bowden::control::{Pid, PidInput, PidState, Status};
    /// let pid = Pid::paper_pi();
    /// let mut state = PidState::new();
    /// let at = PidInput { feed_forward: 20.0, ..PidInput::new(0.001, 25.0, 25.0_f64) };
    /// assert_eq!(state.resume_from(&pid, 42.0, &at), Status::Good);
    /// assert_eq!(pid.step(&mut state, &at).command, 42.0);
    /// ```
    pub fn resume_from(&mut self, pid: &Pid<T>, output: T, at: &PidInput<T>) -> Status {
        match self.held.latched(&pid.settings().fallback) {
            Some(safe) => safe,
            None => pid.restart(self, output, at, false),
        }
    }

    /// Starts at rest at a sample, with this command and this integral.
    pub(super) fn start(&mut self, command: T, last: Last<T>, integral: T) {
        *self = Self {
            integral: Compensated::new(integral),
            last: Some(last),
            held: self.held.going_on_from(command),
            ..Self::new()
        };
    }

    /// Acknowledges the fault: the next good sample closes the loop again.
    ///
    /// The next good sample starts from the safe command without a jump.
    pub fn acknowledge(&mut self) {
        self.held.acknowledge();
    }

    /// Clears the integral, the derivative and the samples, but keeps the applied command.
    ///
    /// A latched safe command stays latched, and the fault counter is kept. To discard the applied
    /// command as well, assign [`PidState::new`].
    pub fn reset(&mut self) {
        *self = Self {
            held: self.held,
            ..Self::new()
        };
    }

    /// Prepares a stored state for a restart after a power-off, when no command is applied.
    ///
    /// This is a [`reset`](Self::reset) that sets the command to the value nearest to zero within
    /// the limits. A latched safe command stays latched, and the fault counter is kept. The first
    /// good sample starts from the new command without a jump. Without this call, a step on a
    /// stored state continues from the stored command.
    ///
    /// ```
    /// use bowden::control::{Pid, PidInput, PidState};
    /// let pi = Pid::paper_pi();
    /// let mut state = PidState::new();
    /// pi.step(&mut state, &PidInput::new(0.001, 2.0, 0.0_f64));
    /// let stored = state; // a command of 60 units; then the power fails
    /// let mut state = stored;
    /// state.restore(&pi);
    /// assert_eq!(pi.step(&mut state, &PidInput::new(0.001, 2.0, 0.0)).command, 0.0);
    /// ```
    pub fn restore(&mut self, pid: &Pid<T>) {
        let command = pid.settings().limits.clamp(T::ZERO);
        *self = Self {
            held: self.held.after_power_off(command),
            ..Self::new()
        };
    }

    /// The applied command \[command unit\].
    pub fn command(&self) -> T {
        self.held.command
    }

    /// The integral term \[command unit\].
    pub fn integral(&self) -> T {
        self.integral.value
    }

    /// The filtered derivative of `y − c·y_r` \[output unit/s\]; zero if it is not used.
    pub fn rate(&self) -> T {
        self.rate
    }

    /// The fault counter of the [`Fallback`](crate::control::Fallback).
    pub fn fault_counter(&self) -> u32 {
        self.held.score
    }

    /// Whether the safe command is latched.
    pub fn is_latched(&self) -> bool {
        self.held.is_latched()
    }

    /// Whether steps can lead to this state: every number is finite.
    #[cfg(any(feature = "serde", kani))]
    pub(crate) fn is_valid(&self) -> bool {
        self.all_finite()
            && self.gap >= T::ZERO
            && (self.last).is_none_or(|last| (last.measured - last.reference).is_finite())
    }

    /// Records a good sample; returns its command.
    #[inline(always)]
    pub(super) fn moved_on(
        &mut self,
        command: T,
        last: Last<T>,
        integral: Compensated<T>,
        rate: T,
    ) -> T {
        self.integral = integral;
        self.rate = rate;
        self.gap = T::ZERO;
        self.last = Some(last);
        self.held.command = command;
        command
    }
}
