//! The relay experiment as a block.

use crate::code;
use crate::lanes::read;
use crate::signal::{Block, Out};
use bowden::control::{Fault, PiRule, Relay, RelayState, Status, Ultimate};
use pyo3::prelude::*;

impl Block for Relay<f64> {
    type State = RelayState<f64>;

    fn start(&self, _: f64) -> RelayState<f64> {
        RelayState::new()
    }

    fn step(&self, state: &mut RelayState<f64>, sample: f64, dt: f64, _: bool) -> Out {
        let out = Self::step(self, state, dt, sample);
        let (phase, fault) = phase(out.status, state);
        ([out.command, 0.0, 0.0], phase, fault)
    }

    fn acknowledge(&self, state: &mut RelayState<f64>) {
        state.acknowledge();
    }
}

/// 0 running, 1 held, 2 done, larger numbers for failures; and the fault of a bad sample.
fn phase(status: Status, state: &RelayState<f64>) -> code::Codes {
    match status {
        Status::Good if state.result().is_some() => (2, 0),
        Status::Good | Status::Degraded(_) => (0, 0),
        Status::Held(fault) => (1, code::fault(fault)),
        Status::Safe(Fault::OutputOutOfRange) => (4, 0),
        Status::Safe(Fault::NoOscillation) => (5, 0),
        Status::Safe(Fault::TimeOut) => (6, 0),
        Status::Safe(fault) => (3, code::fault(fault)),
    }
}

/// k_p and k_i of a PI, from a result and a rule as JSON.
#[pyfunction]
pub fn pi_gains(ultimate: &str, rule: &str) -> PyResult<(f64, f64)> {
    let (ultimate, rule): (Ultimate<f64>, PiRule) = (read(ultimate)?, read(rule)?);
    let gains = ultimate.pi(rule);
    Ok((gains.k_p, gains.k_i))
}
