//! One interface for the laws, so that each question is asked of all of them.

#![allow(dead_code)]

use bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveState, Applied, Limits, Output, Pid, PidInput, PidState,
    Status,
};
use bowden::Real;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopSample<'a, T> {
    pub dt: T,
    pub reference: T,
    pub next_reference: T,
    pub measured: T,
    pub velocity: T,
    pub regressors: &'a [T],
    pub feed_forward: T,
}

impl<T: Real> LoopSample<'_, T> {
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

pub trait Controller<T: Real> {
    type State: Copy;

    fn start(&self) -> Self::State;

    fn step(&self, state: &mut Self::State, at: &LoopSample<'_, T>) -> Output<T>;

    fn restore(&self, state: &mut Self::State);

    fn resume_from(&self, state: &mut Self::State, output: T, at: &LoopSample<'_, T>) -> Status;

    fn applied(&self, state: &mut Self::State, applied: Applied<T>);

    fn acknowledge(&self, state: &mut Self::State);

    fn is_latched(&self, state: &Self::State) -> bool;

    fn command(&self, state: &Self::State) -> T;

    fn limits(&self) -> &Limits<T>;
}

impl<T: Real> From<&LoopSample<'_, T>> for PidInput<T> {
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
