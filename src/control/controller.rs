//! What all controllers have in common, so that a loop can be written once.

use super::{Adaptive, AdaptiveInput, AdaptiveState, Limits, Pid, PidInput, PidState, Status};
use crate::Real;

/// What a step of any controller gives.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Output<T> {
    /// What goes to the drive \[command unit\]: finite and within the limits.
    pub command: T,
    /// A good sample, or what was wrong and what is out instead.
    pub status: Status,
}

/// One sample for any controller; each reads of it what it needs.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LoopSample<'a, T> {
    /// Since the last call, also where that was a bad sample \[s\].
    pub dt: T,
    /// Reference y_r \[output unit\], such as \[N·m\].
    pub reference: T,
    /// Reference at the next sample \[output unit\]; the lag form of the adaptive law reads it.
    pub next_reference: T,
    /// Measured output y \[output unit\].
    pub measured: T,
    /// Measured distal velocity \[rad/s\]; PIV reads it.
    pub velocity: T,
    /// Regressors of an adaptive law; one that is not there is a bad sample.
    pub regressors: &'a [T],
    /// Added to the command before the limits \[command unit\].
    pub feed_forward: T,
}

impl<T: Real> LoopSample<'_, T> {
    /// A sample with a constant reference: `dt` \[s\], the torques \[N·m\], nothing else.
    #[must_use]
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
/// /// One tick of a loop that does not care which law it runs.
/// fn tick<C: Controller<f32>>(law: &C, state: &mut C::State, at: &LoopSample<f32>) -> f32 {
///     let out = law.step(state, at);
///     if let Status::Safe(fault) = out.status {
///         // tell the operator about `fault`; after `law.acknowledge(state)` the loop closes
/// #       let _ = fault;
///     }
///     out.command
/// }
/// let pi = Pid::paper_pi();
/// let mut state = Controller::start(&pi);
/// assert!(tick(&pi, &mut state, &LoopSample::new(0.001, 1.0, 0.5)) > 15.0);
/// ```
pub trait Controller<T: Real> {
    /// What is remembered between samples; `Copy`, so that it can be saved. One that was read back
    /// after the power was off goes through [`power_up`](Self::power_up) before its first step.
    type State: Copy;

    /// A state that has seen no sample.
    fn start(&self) -> Self::State;

    /// One sample: the command \[command unit\], finite and within the limits from any state.
    fn step(&self, state: &mut Self::State, at: &LoopSample<'_, T>) -> Output<T>;

    /// Makes a state that was stored fit for a start: the power was off, and the command nearest to
    /// zero is out. What an adaptive law has learned stays, and so does a fault that nobody has seen.
    fn power_up(&self, state: &mut Self::State);

    /// Starts so that the command goes on from `output` \[command unit\] without a jump.
    ///
    /// Does nothing where the safe command is latched. A state of [`start`](Self::start) knows of no
    /// fault: where one law follows another, ask [`is_latched`](Self::is_latched) of the one that ran,
    /// and change over when it is not.
    fn resume_from(&self, state: &mut Self::State, output: T, at: &LoopSample<'_, T>) -> Status;

    /// Takes note that somebody has seen the fault: the next good sample closes the loop
    /// again, from the safe command on.
    fn acknowledge(&self, state: &mut Self::State);

    /// Whether the safe command is out until somebody has seen the fault.
    fn is_latched(&self, state: &Self::State) -> bool;

    /// The command that is out \[command unit\].
    fn command(&self, state: &Self::State) -> T;

    /// Range and slew rate of the command.
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
    /// A regressor that is not there is NaN.
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

    fn acknowledge(&self, state: &mut PidState<T>) {
        state.acknowledge();
    }

    fn power_up(&self, state: &mut PidState<T>) {
        state.power_up(self);
    }

    fn is_latched(&self, state: &PidState<T>) -> bool {
        state.is_latched()
    }

    fn command(&self, state: &PidState<T>) -> T {
        self.settings().limits.confine(state.command())
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

    fn acknowledge(&self, state: &mut AdaptiveState<T, N>) {
        state.acknowledge();
    }

    fn power_up(&self, state: &mut AdaptiveState<T, N>) {
        state.power_up(self);
    }

    fn is_latched(&self, state: &AdaptiveState<T, N>) -> bool {
        state.is_latched()
    }

    fn command(&self, state: &AdaptiveState<T, N>) -> T {
        self.settings().limits.confine(state.command())
    }

    fn limits(&self) -> &Limits<T> {
        &self.settings().limits
    }
}
