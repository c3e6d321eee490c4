//! The control laws with their states.

use crate::code;
use crate::code::Codes;
use crate::failure;
use crate::lanes::{read, written};
use bowden::control::{
    Adaptive, AdaptiveState, AdaptiveTerms, Applied, Controller, LoopSample, Pid, PidState,
    PidTerms,
};
use pyo3::prelude::*;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize};

/// Maximum number of regressors of an adaptive law in this package.
const MOST: usize = 4;

/// The functions that this package needs from a law in addition to [`Controller`].
trait Law:
    Controller<f64, State: Serialize + DeserializeOwned + Send + Sync>
    + Copy
    + Serialize
    + DeserializeOwned
    + Send
    + Sync
    + 'static
{
    const REGRESSORS: usize;
    type Terms: Serialize;

    /// beta_hat, delta_hat and each theta_hat of an adaptive law; the integral of other laws.
    fn estimates(state: &Self::State) -> Vec<f64>;
    /// Makes a step and returns its terms.
    fn terms(&self, state: &mut Self::State, at: &LoopSample<'_, f64>) -> Self::Terms;
    /// Continues a running state with this law. `at` is the last good sample.
    fn bumpless_transfer(&self, state: &mut Self::State, at: &LoopSample<'_, f64>);
    fn reset(&self, state: &mut Self::State);
    /// Whether the stored state fits this law.
    fn admits(&self, state: &Self::State) -> bool;
}

impl Law for Pid<f64> {
    const REGRESSORS: usize = 0;
    type Terms = PidTerms<f64>;

    fn estimates(state: &PidState<f64>) -> Vec<f64> {
        vec![state.integral()]
    }

    fn terms(&self, state: &mut PidState<f64>, at: &LoopSample<'_, f64>) -> PidTerms<f64> {
        self.step_with_terms(state, &at.into()).terms
    }

    fn bumpless_transfer(&self, state: &mut PidState<f64>, _: &LoopSample<'_, f64>) {
        Self::bumpless_transfer(self, state);
    }

    fn reset(&self, state: &mut PidState<f64>) {
        state.reset();
    }

    /// Any state fits, because its numbers were checked when it was read.
    fn admits(&self, _: &PidState<f64>) -> bool {
        true
    }
}

impl<const N: usize> Law for Adaptive<f64, N> {
    const REGRESSORS: usize = N;
    type Terms = AdaptiveTerms<f64, N>;

    fn estimates(state: &AdaptiveState<f64, N>) -> Vec<f64> {
        let ends = [state.beta_hat(), state.delta_hat()];
        ends.into_iter().chain(state.theta_hat()).collect()
    }

    fn terms(
        &self,
        state: &mut AdaptiveState<f64, N>,
        at: &LoopSample<'_, f64>,
    ) -> AdaptiveTerms<f64, N> {
        self.step_with_terms(state, &at.into()).terms
    }

    fn bumpless_transfer(&self, state: &mut AdaptiveState<f64, N>, at: &LoopSample<'_, f64>) {
        Self::bumpless_transfer(self, state, &at.into());
    }

    fn reset(&self, state: &mut AdaptiveState<f64, N>) {
        state.reset(self);
    }

    fn admits(&self, state: &AdaptiveState<f64, N>) -> bool {
        // A drive that was off may have been told of with a command outside the limits: the
        // state keeps it, and the next command starts from there.
        let limits = self.settings().limits;
        let mut within = *state;
        within.applied(Applied::Command(limits.clamp(state.command())));
        self.is_valid(&within)
    }
}

/// A stored sample. A number that is not finite is written as `null`.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Seen {
    #[serde(deserialize_with = "unless_null")]
    dt: f64,
    #[serde(deserialize_with = "unless_null")]
    reference: f64,
    #[serde(deserialize_with = "unless_null")]
    next_reference: f64,
    #[serde(deserialize_with = "unless_null")]
    measured: f64,
    #[serde(deserialize_with = "unless_null")]
    velocity: f64,
    #[serde(deserialize_with = "unless_null")]
    feed_forward: f64,
    #[serde(deserialize_with = "unless_null_each")]
    regressors: [f64; MOST],
}

fn unless_null<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::NAN))
}

fn unless_null_each<'de, D: Deserializer<'de>>(from: D) -> Result<[f64; MOST], D::Error> {
    let each = <[Option<f64>; MOST]>::deserialize(from)?;
    Ok(each.map(|own| own.unwrap_or(f64::NAN)))
}

impl Seen {
    fn of(at: &LoopSample<'_, f64>) -> Self {
        let mut regressors = [f64::NAN; MOST];
        for (own, given) in regressors.iter_mut().zip(at.regressors) {
            *own = *given;
        }
        Self {
            dt: at.dt,
            reference: at.reference,
            next_reference: at.next_reference,
            measured: at.measured,
            velocity: at.velocity,
            feed_forward: at.feed_forward,
            regressors,
        }
    }

    fn sample(&self) -> LoopSample<'_, f64> {
        LoopSample {
            dt: self.dt,
            reference: self.reference,
            next_reference: self.next_reference,
            measured: self.measured,
            velocity: self.velocity,
            feed_forward: self.feed_forward,
            regressors: &self.regressors,
        }
    }
}

/// The state of a law, and the data of the last step that its terms require.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Memory<S> {
    controller: S,
    /// The state before the last step, and its sample.
    before: Option<(S, Seen)>,
    /// The last good sample.
    good: Option<Seen>,
    codes: Codes,
}

impl<S> Memory<S> {
    fn of(controller: S) -> Self {
        Self {
            controller,
            before: None,
            good: None,
            codes: (0, 0),
        }
    }
}

#[derive(Clone, Copy)]
struct Running<C: Law> {
    law: C,
    memory: Memory<C::State>,
}

/// Any law with its state.
pub trait AnyLaw: Send + Sync {
    fn copied(&self) -> Box<dyn AnyLaw>;
    fn settings(&self) -> PyResult<String>;
    fn state(&self) -> PyResult<String>;
    fn restored(&self, state: &str) -> PyResult<Box<dyn AnyLaw>>;
    fn restart(&mut self);

    fn step(&mut self, at: &LoopSample<'_, f64>) -> f64;
    fn resume_from(&mut self, output: f64, at: &LoopSample<'_, f64>) -> f64;
    /// Status and fault of the last step.
    fn codes(&self) -> Codes;
    fn command(&self) -> f64;
    fn estimates(&self) -> Vec<f64>;
    fn terms(&self) -> PyResult<String>;
    fn regressors(&self) -> usize;

    fn taken_over(&self, settings: &str) -> PyResult<Box<dyn AnyLaw>>;
    fn applied(&mut self, applied: Applied<f64>);
    fn acknowledge(&mut self);
    fn is_latched(&self) -> bool;
    fn restore(&mut self);
    fn reset(&mut self);
}

impl<C: Law> Running<C> {
    fn start(law: C) -> Box<dyn AnyLaw> {
        let memory = Memory::of(law.start());
        Box::new(Self { law, memory })
    }

    /// Forgets the last step, because its terms belong to other settings or to another state.
    fn forget_terms(&mut self) {
        self.memory.before = None;
    }
}

impl<C: Law> AnyLaw for Running<C> {
    fn copied(&self) -> Box<dyn AnyLaw> {
        Box::new(*self)
    }

    fn settings(&self) -> PyResult<String> {
        written(&self.law)
    }

    fn state(&self) -> PyResult<String> {
        written(&self.memory)
    }

    fn restored(&self, state: &str) -> PyResult<Box<dyn AnyLaw>> {
        let memory: Memory<C::State> = read(state)?;
        let of_before = memory.before.iter().map(|(state, _)| state);
        if !of_before
            .chain([&memory.controller])
            .all(|own| self.law.admits(own))
        {
            return Err(failure::plain(
                "a number is outside of what these settings allow",
            ));
        }
        Ok(Box::new(Self { memory, ..*self }))
    }

    fn restart(&mut self) {
        self.memory = Memory::of(self.law.start());
    }

    fn step(&mut self, at: &LoopSample<'_, f64>) -> f64 {
        let (own, seen) = (&mut self.memory, Seen::of(at));
        own.before = Some((own.controller, seen));
        let out = self.law.step(&mut own.controller, at);
        own.codes = code::status(out.status);
        if own.codes.0 == 0 {
            own.good = Some(seen);
        }
        out.command
    }

    fn resume_from(&mut self, output: f64, at: &LoopSample<'_, f64>) -> f64 {
        self.forget_terms();
        let own = &mut self.memory;
        own.codes = code::status(self.law.resume_from(&mut own.controller, output, at));
        if own.codes.0 == 0 {
            own.good = Some(Seen::of(at));
        }
        self.command()
    }

    fn codes(&self) -> Codes {
        self.memory.codes
    }

    fn command(&self) -> f64 {
        self.law.command(&self.memory.controller)
    }

    fn estimates(&self) -> Vec<f64> {
        C::estimates(&self.memory.controller)
    }

    fn terms(&self) -> PyResult<String> {
        // Where there was no step: a sample that is bad, which tells the terms of the state.
        let none = Seen::of(&LoopSample::new(f64::NAN, 0.0, 0.0));
        let (mut state, seen) = self.memory.before.unwrap_or((self.memory.controller, none));
        written(&self.law.terms(&mut state, &seen.sample()))
    }

    fn regressors(&self) -> usize {
        C::REGRESSORS
    }

    fn taken_over(&self, settings: &str) -> PyResult<Box<dyn AnyLaw>> {
        let mut next = Self {
            law: read(settings)?,
            ..*self
        };
        next.forget_terms();
        let state = &mut next.memory.controller;
        match &next.memory.good {
            Some(good) => next.law.bumpless_transfer(state, &good.sample()),
            // Nothing runs yet: the new initial estimates count.
            None => next.law.reset(state),
        }
        Ok(Box::new(next))
    }

    fn applied(&mut self, applied: Applied<f64>) {
        self.law.applied(&mut self.memory.controller, applied);
    }

    fn acknowledge(&mut self) {
        self.law.acknowledge(&mut self.memory.controller);
    }

    fn is_latched(&self) -> bool {
        self.law.is_latched(&self.memory.controller)
    }

    fn restore(&mut self) {
        self.forget_terms();
        self.law.restore(&mut self.memory.controller);
    }

    fn reset(&mut self) {
        self.forget_terms();
        self.law.reset(&mut self.memory.controller);
    }
}

impl Clone for Box<dyn AnyLaw> {
    fn clone(&self) -> Self {
        self.copied()
    }
}

/// A law from its settings. `regressors` is the number of regressors, or `None` for PI, PID and
/// PIV.
pub fn law(settings: &str, regressors: Option<usize>) -> PyResult<Box<dyn AnyLaw>> {
    fn started<C: Law>(settings: &str) -> PyResult<Box<dyn AnyLaw>> {
        read::<C>(settings).map(Running::start)
    }
    match regressors {
        None => started::<Pid<f64>>(settings),
        Some(0) => started::<Adaptive<f64, 0>>(settings),
        Some(1) => started::<Adaptive<f64, 1>>(settings),
        Some(2) => started::<Adaptive<f64, 2>>(settings),
        Some(3) => started::<Adaptive<f64, 3>>(settings),
        Some(MOST) => started::<Adaptive<f64, MOST>>(settings),
        Some(more) => Err(failure::plain(format!(
            "theta: {more} estimates; 0 to {MOST} are allowed"
        ))),
    }
}
