//! Simulated rigs side by side, alone or in a loop with controllers.

use crate::beside::Cycle;
use crate::control::Controllers;
use crate::failure;
use bowden::control::LoopSample;
use bowden::model::Model;
use bowden_rig::{Reference, Rig, RigConfig, RigSample, RigState};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

/// Most undeclared effects of a rig.
const MOST: usize = 8;

type Reading = fn(&RigSample<f64>) -> f64;

/// What is read off a rig, by name.
const READ: [(&str, Reading); 17] = [
    ("time", |s| s.time),
    ("tau_o", |s| s.tau_o),
    ("measured", |s| s.measured),
    ("tau_i", |s| s.tau_i),
    ("measured_input", |s| s.measured_input),
    ("tau_m", |s| s.tau_m),
    ("phi_p", |s| s.proximal.position),
    ("phi_p_velocity", |s| s.proximal.velocity),
    ("phi_p_acceleration", |s| s.proximal.acceleration),
    ("phi_d", |s| s.distal.position),
    ("phi_d_velocity", |s| s.distal.velocity),
    ("phi_d_acceleration", |s| s.distal.acceleration),
    ("eta", |s| s.eta),
    ("b", |s| s.b),
    ("kappa_eta", |s| s.kappa_eta),
    ("t0", |s| s.t0),
    ("diverged", |s| f64::from(u8::from(s.diverged))),
];

/// Rigs side by side, each with its seed.
#[pyclass(module = "bowden._bowden")]
pub struct Rigs {
    all: Vec<(Rig<f64, MOST>, RigState<f64, MOST>)>,
    seeds: Vec<u64>,
}

/// Signals of samples by lanes, filled row by row.
struct Taken([Array2<f64>; READ.len()]);

impl Taken {
    fn new(shape: (usize, usize)) -> Self {
        Self(std::array::from_fn(|_| Array2::zeros(shape)))
    }

    fn put(&mut self, place: [usize; 2], sample: &RigSample<f64>) {
        for (signal, (_, read)) in self.0.iter_mut().zip(READ) {
            signal[place] = read(sample);
        }
    }

    fn named<'py>(self, py: Python<'py>) -> Named<'py> {
        let signals = READ.iter().zip(self.0);
        signals
            .map(|((name, _), own)| ((*name).to_owned(), own.into_pyarray(py)))
            .collect()
    }
}

type Named<'py> = Vec<(String, Bound<'py, PyArray2<f64>>)>;

type Tracked<'py> = (
    Named<'py>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<u8>>,
);

#[pymethods]
impl Rigs {
    /// `undeclared` is the text of a model whose channels are the proximal and the distal
    /// pulley: its terms are what the controller does not know of.
    #[new]
    fn new(configs: Vec<String>, undeclared: Option<&str>, seeds: Vec<u64>) -> PyResult<Self> {
        let told = |e: toml::de::Error| failure::plain(e.message());
        let model: Option<Model<f64, MOST>> =
            undeclared.map(toml::from_str).transpose().map_err(told)?;
        let terms = model.as_ref().map_or(&[][..], |model| model.terms());
        let mut all = Vec::with_capacity(configs.len());
        for (text, seed) in configs.iter().zip(&seeds) {
            let config: RigConfig<f64> = toml::from_str(text).map_err(told)?;
            let rig = Rig::try_new(config, terms).map_err(failure::plain)?;
            let state = rig.start(*seed);
            all.push((rig, state));
        }
        Ok(Self { all, seeds })
    }

    fn __len__(&self) -> usize {
        self.all.len()
    }

    fn restart(&mut self) {
        for ((rig, state), seed) in self.all.iter_mut().zip(&self.seeds) {
            *state = rig.start(*seed);
        }
    }

    /// The last sample of each.
    fn sample<'py>(&self, py: Python<'py>) -> Named<'py> {
        let mut taken = Taken::new((1, self.all.len()));
        for (column, (_, state)) in self.all.iter().enumerate() {
            taken.put([0, column], &state.sample());
        }
        taken.named(py)
    }

    /// Commands and loads of samples by lanes; what is read off after each.
    fn run<'py>(
        &mut self,
        py: Python<'py>,
        commands: PyReadonlyArray2<'py, f64>,
        loads: PyReadonlyArray2<'py, f64>,
        dt: f64,
    ) -> PyResult<Named<'py>> {
        let (commands, loads) = (commands.as_array(), loads.as_array());
        let shape = (commands.nrows(), self.all.len());
        if commands.dim() != shape || loads.dim() != shape {
            return Err(failure::plain(format!(
                "arrays of shape {shape:?} were expected"
            )));
        }
        let all = &mut self.all;
        let taken = py.detach(|| {
            let mut taken = Taken::new(shape);
            for row in 0..shape.0 {
                for (column, (rig, state)) in all.iter_mut().enumerate() {
                    let place = [row, column];
                    let own = rig.step_with_load(state, commands[place], loads[place], dt);
                    taken.put(place, &own);
                }
            }
            taken
        });
        Ok(taken.named(py))
    }

    /// The loop: each controller on its rig, all on one reference, feed-forward and phase. What is read
    /// off before each command, the commands, and the status of each.
    fn track<'py>(
        &mut self,
        py: Python<'py>,
        mut controllers: PyRefMut<'py, Controllers>,
        reference: PyReadonlyArray1<'py, f64>,
        feed_forward: PyReadonlyArray1<'py, f64>,
        phase: PyReadonlyArray1<'py, f64>,
        dt: f64,
    ) -> PyResult<Tracked<'py>> {
        if controllers.lanes.len() != self.all.len() {
            return Err(failure::plain("as many controllers as rigs were expected"));
        }
        let [reference, feed_forward, phase] =
            [&reference, &feed_forward, &phase].map(|own| own.as_array());
        if [feed_forward.len(), phase.len()] != [reference.len(); 2] {
            return Err(failure::plain("as many samples of each were expected"));
        }
        let shape = (reference.len(), self.all.len());
        let (all, lanes) = (&mut self.all, &mut controllers.lanes);
        let (taken, commands, statuses) = py.detach(|| {
            let mut taken = Taken::new(shape);
            let (mut commands, mut statuses) = (Array2::zeros(shape), Array2::zeros(shape));
            for row in 0..shape.0 {
                let next = reference.get(row + 1).copied().unwrap_or(reference[row]);
                for (column, ((rig, state), lane)) in all.iter_mut().zip(&mut *lanes).enumerate() {
                    let (place, now) = ([row, column], state.sample());
                    let known = [now.proximal.velocity, now.proximal.acceleration];
                    let read = known.get(..lane.regressors()).unwrap_or(&known);
                    let sample = LoopSample {
                        next_reference: next,
                        velocity: now.distal.velocity,
                        feed_forward: feed_forward[row],
                        regressors: read,
                        ..LoopSample::new(dt, reference[row], now.measured)
                    };
                    let cycle = Cycle {
                        phase: phase[row],
                        learns: true,
                    };
                    let (command, status) = lane.step(&sample, cycle);
                    taken.put(place, &now);
                    commands[place] = command;
                    statuses[place] = status;
                    rig.step(state, command, dt);
                }
            }
            (taken, commands, statuses)
        });
        let (commands, statuses) = (commands.into_pyarray(py), statuses.into_pyarray(py));
        Ok((taken.named(py), commands, statuses))
    }
}

/// The paper's reference \[N·m\] at these times \[s\].
#[pyfunction]
pub fn paper_reference<'py>(
    py: Python<'py>,
    t: PyReadonlyArray1<'py, f64>,
    ramp: f64,
) -> Bound<'py, PyArray1<f64>> {
    let reference = Reference::<f64>::paper().with_ramp(ramp);
    let at: Vec<f64> = t.as_array().iter().map(|t| reference.at(*t)).collect();
    at.into_pyarray(py)
}
