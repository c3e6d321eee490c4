//! The relay experiment, as one of the blocks.

use crate::code;
use crate::lanes::read;
use crate::signal::{Block, Out};
use bowden::control::{PiRule, Relay, RelayFailure, RelayPhase, RelayState, Ultimate};
use pyo3::prelude::*;

impl Block for Relay<f64> {
    type State = RelayState<f64>;

    fn start(&self, _: f64) -> RelayState<f64> {
        RelayState::new()
    }

    fn step(&self, state: &mut RelayState<f64>, sample: f64, dt: f64, _: bool) -> Out {
        let out = Self::step(self, state, dt, sample);
        let (phase, fault) = phase(&out.phase);
        ([out.command, 0.0, 0.0], phase, fault)
    }

    fn acknowledge(&self, state: &mut RelayState<f64>) {
        state.acknowledge();
    }
}

/// 0 running, 1 held, 2 done, the others failures; and the fault of a bad sample.
fn phase(phase: &RelayPhase<f64>) -> code::Codes {
    match phase {
        RelayPhase::Running => (0, 0),
        RelayPhase::Held(fault) => (1, code::fault(*fault)),
        RelayPhase::Done(_) => (2, 0),
        RelayPhase::Failed(RelayFailure::BadSamples(fault)) => (3, code::fault(*fault)),
        RelayPhase::Failed(RelayFailure::OutputOutOfRange) => (4, 0),
        RelayPhase::Failed(RelayFailure::NoOscillation) => (5, 0),
        RelayPhase::Failed(RelayFailure::TimeOut) => (6, 0),
        // The core may learn of more; it is then a failure without a name here.
        RelayPhase::Failed(_) => (7, 0),
    }
}

/// k_p and k_i of a PI, from a result and a rule as JSON.
#[pyfunction]
pub fn pi_gains(ultimate: &str, rule: &str) -> PyResult<(f64, f64)> {
    let (ultimate, rule): (Ultimate<f64>, PiRule) = (read(ultimate)?, read(rule)?);
    let gains = ultimate.pi(rule);
    Ok((gains.k_p, gains.k_i))
}
