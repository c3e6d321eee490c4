//! What goes beside a controller and is added to its command: a disturbance observer, and learning
//! over a cycle.

use crate::failure;
use bowden::control::{
    DisturbanceObserver, Learning, LearningInput, LearningState, LoopSample, NominalPlant,
    ObserverInput, ObserverState, Status,
};
use bowden::signal::Motion;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

/// Both, where they are wanted, with their states.
pub struct Beside {
    observer: Option<(DisturbanceObserver<f64>, ObserverState<f64>)>,
    learning: Option<Learns>,
}

struct Learns {
    learning: Learning<f64>,
    /// What was known before the first sample.
    first: Vec<f64>,
    state: LearningState<f64, Vec<f64>>,
}

/// Where in its cycle a sample is, and whether it is learned from.
#[derive(Clone, Copy)]
pub struct Cycle {
    pub phase: f64,
    pub learns: bool,
}

impl Beside {
    /// Of settings as TOML, and of what each cell has learned before.
    pub fn new(observer: Option<&str>, learning: Option<&(String, Vec<f64>)>) -> PyResult<Self> {
        let observer = observer.map(read::<DisturbanceObserver<f64>>).transpose()?;
        Ok(Self {
            observer: observer.map(|observer| (observer, ObserverState::new())),
            learning: learning
                .map(|(text, first)| Learns::new(read(text)?, first.clone()))
                .transpose()?,
        })
    }

    /// What is to be added to the next command, and whether a sample could not be used; `sent` is
    /// the command that is out.
    pub fn step(&mut self, sent: f64, at: &LoopSample<'_, f64>, cycle: Cycle) -> (f64, bool) {
        let observed = self.observer.as_mut().map(|(observer, state)| {
            let (dt, measured) = (at.dt, at.measured);
            let seen = observer.step(state, &ObserverInput { dt, sent, measured });
            (seen.estimate, seen.status)
        });
        let learned = self.learning.as_mut().map(|own| {
            let Cycle { phase, learns } = cycle;
            let at = LearningInput {
                learns,
                ..LearningInput::new(phase, at.reference, at.measured)
            };
            let out = own.learning.step(&mut own.state, &at);
            (out.feed_forward, out.status)
        });
        let both = [observed, learned];
        let added = both.iter().flatten().map(|(added, _)| added).sum();
        let unused = both
            .iter()
            .flatten()
            .any(|(_, status)| *status != Status::Good);
        (added, unused)
    }

    /// Back to what was known before the first sample.
    pub fn restart(&mut self) -> PyResult<()> {
        if let Some((_, state)) = &mut self.observer {
            *state = ObserverState::new();
        }
        if let Some(own) = &mut self.learning {
            *own = Learns::new(own.learning, own.first.clone())?;
        }
        Ok(())
    }

    pub fn disturbance(&self) -> Option<f64> {
        self.observer.as_ref().map(|(_, state)| state.estimate())
    }

    pub fn learned(&self) -> Option<Vec<f64>> {
        let own = self.learning.as_ref()?;
        Some(own.state.learned().to_vec())
    }
}

impl Learns {
    fn new(learning: Learning<f64>, first: Vec<f64>) -> PyResult<Self> {
        let unfiltered = vec![0.0; first.len()];
        let state = learning.resume(first.clone(), unfiltered);
        Ok(Self {
            state: state.map_err(|e| failure::plain(format!("learning: {e}")))?,
            learning,
            first,
        })
    }
}

fn read<T: serde::de::DeserializeOwned>(text: &str) -> PyResult<T> {
    toml::from_str(text).map_err(|e: toml::de::Error| failure::plain(e.message()))
}

/// Refuses settings that make no sense.
#[pyfunction]
pub fn check_beside(observer: Option<&str>, learning: Option<(String, Vec<f64>)>) -> PyResult<()> {
    Beside::new(observer, learning.as_ref()).map(|_| ())
}

/// The command by which a nominal plant (as TOML) follows an output with its first two derivatives.
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
