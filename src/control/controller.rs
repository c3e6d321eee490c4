//! The common interface of the controllers. A loop that uses it can run any controller.

use super::{
    Adaptive, AdaptiveInput, AdaptiveState, Applied, Limits, Pid, PidInput, PidState, Status,
};
use crate::Real;

crate::data! {
    /// Output of a step of a controller, of [`IterativeLearning`](super::IterativeLearning), or of
    /// a [`DisturbanceObserver`](super::DisturbanceObserver).
    pub struct Output<T> {
        /// Command for the drive, or the value to add to the command \[command unit\]; finite and
        /// within the limits.
        pub command: T,
        /// Status of the sample: good, or the fault.
        pub status: Status,
    }
}

/// Output of a step, with all terms of the control law.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Telemetry<T, M> {
    /// Command for the drive \[command unit\]; finite and within the limits.
    pub command: T,
    /// Status of the sample: good, or the fault.
    pub status: Status,
    /// The terms: [`PidTerms`](super::PidTerms) of the last good sample, or
    /// [`AdaptiveTerms`](super::AdaptiveTerms).
    pub terms: M,
}

impl<T> Output<T> {
    pub(super) fn with<M>(self, terms: M) -> Telemetry<T, M> {
        let Self { command, status } = self;
        Telemetry {
            command,
            status,
            terms,
        }
    }
}

/// One sample for any controller. Each controller reads only the fields that it needs.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LoopSample<'a, T> {
    /// Time since the last call \[s\], even if the sample of that call was bad.
    pub dt: T,
    /// Reference y_r \[output unit\], such as \[N·m\].
    pub reference: T,
    /// Reference at the next sample \[output unit\]. Only the first-order form of the adaptive law
    /// uses the value, but both forms reject a value that is not finite.
    pub next_reference: T,
    /// Measured output y \[output unit\].
    pub measured: T,
    /// Measured distal velocity \[rad/s\]; only PIV reads it.
    pub velocity: T,
    /// Regressors of an adaptive law; a missing regressor is treated as NaN.
    pub regressors: &'a [T],
    /// Feed-forward, added to the command before the limits \[command unit\].
    pub feed_forward: T,
}

impl<T: Real> LoopSample<'_, T> {
    /// A sample with a constant reference, from `dt` \[s\] and the torques \[N·m\]; all other
    /// fields are zero or empty.
    pub const fn new(dt: T, reference: T, measured: T) -> Self {
        Self {
            dt,
            reference,
            next_reference: reference,
            measured,
            velocity: T::ZERO,
            regressors: &[],
            feed_forward: T::ZERO,
        }
    }
}

/// A torque controller: PI, PID, PIV or the adaptive law.
///
/// ```
/// use bowden::control::{Controller, LoopSample, Pid, Status};
/// /// One tick of a loop that runs any law.
/// fn tick<C: Controller<f32>>(law: &C, state: &mut C::State, at: &LoopSample<f32>) -> f32 {
///     let out = law.step(state, at);
///     if let Status::Safe(fault) = out.status {
///         // report to the operator: `fault`; after `law.acknowledge(state)` the loop closes
/// #       let _ = fault;
///     }
///     out.command
/// }
/// let pi = Pid::paper_pi();
/// let mut state = Controller::start(&pi);
/// assert!(tick(&pi, &mut state, &LoopSample::new(0.001, 1.0, 0.5)) > 15.0);
/// ```
pub trait Controller<T: Real> {
    /// State between samples. After a power-off, call [`restore`](Self::restore) on a stored state
    /// before its first step.
    type State: Copy;

    /// Initial state, before the first sample.
    fn start(&self) -> Self::State;

    /// Processes one sample and returns the command \[command unit\], which is finite and within
    /// the limits for any state.
    fn step(&self, state: &mut Self::State, at: &LoopSample<'_, T>) -> Output<T>;

    /// Prepares a stored state for a start after a power-off. The command becomes the value nearest
    /// to zero within the limits. The estimates of an adaptive law and an unacknowledged fault are
    /// kept.
    fn restore(&self, state: &mut Self::State);

    /// Restarts a state so that the command continues from `output` \[command unit\] without a
    /// jump.
    ///
    /// A latched safe command stays latched. Before you switch to another control law, check that
    /// the old law is not [latched](Self::is_latched), because a state from [`start`](Self::start)
    /// has no fault.
    fn resume_from(&self, state: &mut Self::State, output: T, at: &LoopSample<'_, T>) -> Status;

    /// Reports the drive's response to the last command if the drive did not apply the command.
    fn applied(&self, state: &mut Self::State, applied: Applied<T>);

    /// Acknowledges the fault: the next good sample closes the loop again, starting from the
    /// safe command.
    fn acknowledge(&self, state: &mut Self::State);

    /// Whether the safe command is latched until the fault is acknowledged.
    fn is_latched(&self, state: &Self::State) -> bool;

    /// The applied command \[command unit\].
    fn command(&self, state: &Self::State) -> T;

    /// Range and slew-rate limit of the command.
    fn limits(&self) -> &Limits<T>;
}

impl<T: Real> From<&LoopSample<'_, T>> for PidInput<T> {
    #[inline]
    fn from(at: &LoopSample<'_, T>) -> Self {
        Self {
            dt: at.dt,
            reference: at.reference,
            measured: at.measured,
            velocity: at.velocity,
            feed_forward: at.feed_forward,
        }
    }
}

impl<T: Real, const N: usize> From<&LoopSample<'_, T>> for AdaptiveInput<T, N> {
    /// A missing regressor is NaN.
    #[inline]
    fn from(at: &LoopSample<'_, T>) -> Self {
        let mut regressors = [T::nan(); N];
        for (own, given) in regressors.iter_mut().zip(at.regressors) {
            *own = *given;
        }
        Self {
            dt: at.dt,
            reference: at.reference,
            next_reference: at.next_reference,
            measured: at.measured,
            regressors,
            feed_forward: at.feed_forward,
        }
    }
}

impl<T: Real> Controller<T> for Pid<T> {
    type State = PidState<T>;

    fn start(&self) -> PidState<T> {
        PidState::new()
    }

    #[inline]
    fn step(&self, state: &mut PidState<T>, at: &LoopSample<'_, T>) -> Output<T> {
        Self::step(self, state, &at.into())
    }

    fn resume_from(&self, state: &mut PidState<T>, output: T, at: &LoopSample<'_, T>) -> Status {
        state.resume_from(self, output, &at.into())
    }

    fn applied(&self, state: &mut PidState<T>, applied: Applied<T>) {
        Self::applied(self, state, applied);
    }

    fn acknowledge(&self, state: &mut PidState<T>) {
        state.acknowledge();
    }

    fn restore(&self, state: &mut PidState<T>) {
        state.restore(self);
    }

    fn is_latched(&self, state: &PidState<T>) -> bool {
        state.is_latched()
    }

    fn command(&self, state: &PidState<T>) -> T {
        self.settings().limits.clamp(state.command())
    }

    fn limits(&self) -> &Limits<T> {
        &self.settings().limits
    }
}

impl<T: Real, const N: usize> Controller<T> for Adaptive<T, N> {
    type State = AdaptiveState<T, N>;

    fn start(&self) -> AdaptiveState<T, N> {
        AdaptiveState::new(self)
    }

    #[inline]
    fn step(&self, state: &mut AdaptiveState<T, N>, at: &LoopSample<'_, T>) -> Output<T> {
        Self::step(self, state, &at.into())
    }

    fn resume_from(
        &self,
        state: &mut AdaptiveState<T, N>,
        output: T,
        at: &LoopSample<'_, T>,
    ) -> Status {
        Self::resume(self, state, output, &at.into())
    }

    fn applied(&self, state: &mut AdaptiveState<T, N>, applied: Applied<T>) {
        state.applied(applied);
    }

    fn acknowledge(&self, state: &mut AdaptiveState<T, N>) {
        state.acknowledge();
    }

    fn restore(&self, state: &mut AdaptiveState<T, N>) {
        state.restore(self);
    }

    fn is_latched(&self, state: &AdaptiveState<T, N>) -> bool {
        state.is_latched()
    }

    fn command(&self, state: &AdaptiveState<T, N>) -> T {
        self.settings().limits.clamp(state.command())
    }

    fn limits(&self) -> &Limits<T> {
        &self.settings().limits
    }
}
