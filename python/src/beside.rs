//! Additions to the command of a controller: disturbance observer and iterative learning.

use crate::code;
use crate::code::Codes;
use crate::failure;
use crate::lanes::{read, written};
use bowden::control::{
    DisturbanceObserver, IterativeLearning, IterativeLearningInput, IterativeLearningState,
    LoopSample, NominalPlant, ObserverInput, ObserverState,
};
use bowden::effect::Motion;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

/// The observer and iterative learning, if they are used, with their states.
#[derive(Clone)]
pub struct Beside {
    observer: Option<DisturbanceObserver<f64>>,
    learning: Option<Learns>,
    memory: Memory,
}

#[derive(Clone)]
struct Learns {
    learning: IterativeLearning<f64>,
    /// The learned values before the first sample.
    first: Vec<f64>,
}

/// The states of the observer and of iterative learning.
#[derive(Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Memory {
    observer: Option<ObserverState<f64>>,
    learning: Option<IterativeLearningState<f64, Vec<f64>>>,
}

/// The position of a sample in its cycle, and whether the law learns from it.
#[derive(Clone, Copy)]
pub struct Cycle {
    pub phase: f64,
    pub learns: bool,
}

impl Beside {
    /// From settings as JSON, and from the initial learned value of each cell.
    pub fn new(observer: Option<&str>, learning: Option<&(String, Vec<f64>)>) -> PyResult<Self> {
        let observer = observer.map(read::<DisturbanceObserver<f64>>).transpose()?;
        let learns = |(text, first): &(String, Vec<f64>)| -> PyResult<Learns> {
            Ok(Learns {
                learning: read(text)?,
                first: first.clone(),
            })
        };
        let learning = learning.map(learns).transpose()?;
        let memory = Memory {
            observer: observer.map(|_| ObserverState::new()),
            learning: learning.as_ref().map(Learns::start).transpose()?,
        };
        Ok(Self {
            observer,
            learning,
            memory,
        })
    }

    /// Returns the value to add to the next command, and the worse of the two statuses. `sent` is
    /// the applied command.
    pub fn step(&mut self, sent: f64, at: &LoopSample<'_, f64>, cycle: Cycle) -> (f64, Codes) {
        let observed = self.observer.zip(self.memory.observer.as_mut());
        let observed = observed.map(|(observer, state)| {
            let (dt, measured) = (at.dt, at.measured);
            let seen = observer.step(state, &ObserverInput { dt, sent, measured });
            (seen.command, code::status(seen.status))
        });
        let learned = self.learning.as_ref().zip(self.memory.learning.as_mut());
        let learned = learned.map(|(own, state)| {
            let Cycle { phase, learns } = cycle;
            let at = IterativeLearningInput {
                learns,
                ..IterativeLearningInput::new(phase, at.reference, at.measured)
            };
            let out = own.learning.step(state, &at);
            (out.command, code::status(out.status))
        });
        let both = [observed, learned];
        let added = both.iter().flatten().map(|(added, _)| added).sum();
        let worst = both.iter().flatten().map(|(_, codes)| *codes).max();
        (added, worst.unwrap_or_default())
    }

    /// The last value that was added to the command.
    pub fn added(&self) -> f64 {
        let observed = self.disturbance().unwrap_or_default();
        let learned = self.memory.learning.as_ref();
        observed + learned.map_or(0.0, IterativeLearningState::feed_forward)
    }

    /// Returns to the state before the first sample.
    pub fn restart(&mut self) -> PyResult<()> {
        let fresh = self.learning.as_ref().map(Learns::start).transpose()?;
        self.memory = Memory {
            observer: self.observer.map(|_| ObserverState::new()),
            learning: fresh,
        };
        Ok(())
    }

    pub fn state(&self) -> PyResult<String> {
        written(&self.memory)
    }

    pub fn restored(&self, state: &str) -> PyResult<Self> {
        let memory: Memory = read(state)?;
        let cells = |own: &Memory| own.learning.as_ref().map(|own| own.learned().len());
        let same = memory.observer.is_some() == self.memory.observer.is_some()
            && cells(&memory) == cells(&self.memory);
        if !same {
            return Err(failure::plain(
                "the state is of another observer or another number of cells",
            ));
        }
        Ok(Self {
            memory,
            ..self.clone()
        })
    }

    pub fn disturbance(&self) -> Option<f64> {
        self.memory.observer.as_ref().map(ObserverState::estimate)
    }

    pub fn learned(&self) -> Option<Vec<f64>> {
        let own = self.memory.learning.as_ref()?;
        Some(own.learned().to_vec())
    }
}

impl Learns {
    fn start(&self) -> PyResult<IterativeLearningState<f64, Vec<f64>>> {
        let unfiltered = vec![0.0; self.first.len()];
        let state = self.learning.resume(self.first.clone(), unfiltered);
        state.map_err(|e| failure::plain(format!("learning: {e}")))
    }
}

/// Rejects invalid settings.
#[pyfunction]
pub fn check_beside(observer: Option<&str>, learning: Option<(String, Vec<f64>)>) -> PyResult<()> {
    Beside::new(observer, learning.as_ref()).map(|_| ())
}

/// The command for which the output of a nominal plant (as JSON) has the given value and first two
/// derivatives.
#[pyfunction]
pub fn nominal_feed_forward<'py>(
    py: Python<'py>,
    plant: &str,
    output: [PyReadonlyArray1<'py, f64>; 3],
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let plant: NominalPlant<f64> = read(plant)?;
    let [positions, velocities, accelerations] = output.each_ref().map(|own| own.as_array());
    let rates = velocities.iter().zip(accelerations);
    let commands: Vec<f64> = positions
        .iter()
        .zip(rates)
        .map(|(position, (velocity, acceleration))| {
            plant.feed_forward(&Motion {
                position: *position,
                velocity: *velocity,
                acceleration: *acceleration,
            })
        })
        .collect();
    Ok(commands.into_pyarray(py))
}
