//! Simulated rigs side by side, open loop or in a closed loop with controllers.

use crate::beside::Cycle;
use crate::control::Controllers;
use crate::failure;
use crate::lanes::{read, written, Lane, Lanes};
use bowden::control::LoopSample;
use bowden::model::Model;
use bowden_rig::{Reference, Rig, RigConfig, RigSample, RigState};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

/// Maximum number of undeclared effects of a rig.
const MOST: usize = 8;

type Reading = fn(&RigSample<f64>) -> f64;

/// Names of the signals that are read from a rig.
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

/// One rig with its state and its seed.
#[derive(Clone, Copy)]
struct Own {
    config: RigConfig<f64>,
    rig: Rig<f64, MOST>,
    state: RigState<f64, MOST>,
    seed: u64,
}

impl Lane for Own {
    fn settings(&self) -> PyResult<String> {
        written(&self.config)
    }

    fn state(&self) -> PyResult<String> {
        written(&self.state)
    }

    fn restored(&self, state: &str) -> PyResult<Self> {
        let state = read(state)?;
        Ok(Self { state, ..*self })
    }

    fn restart(&mut self) -> PyResult<()> {
        self.state = self.rig.start(self.seed);
        Ok(())
    }
}

/// Rigs side by side.
#[pyclass(frozen, module = "bowden._bowden")]
pub struct Rigs {
    lanes: Lanes<Own>,
}

/// Signals of samples by lanes, written row by row.
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

type Codes2<'py> = Bound<'py, PyArray2<u8>>;

type Tracked<'py> = (
    Named<'py>,
    Bound<'py, PyArray2<f64>>,
    Codes2<'py>,
    Codes2<'py>,
);

#[pymethods]
impl Rigs {
    /// `undeclared` is a model whose channels are the proximal and the distal pulley. The
    /// controller does not know its terms.
    #[new]
    fn new(configs: Vec<String>, undeclared: Option<&str>, seeds: Vec<u64>) -> PyResult<Self> {
        let model: Option<Model<f64, MOST>> = undeclared.map(read).transpose()?;
        let terms = model.as_ref().map_or(&[][..], |model| model.terms());
        let own = configs.iter().zip(&seeds).map(|(text, seed)| {
            let config: RigConfig<f64> = read(text)?;
            let rig = Rig::try_new(config, terms).map_err(failure::plain)?;
            Ok(Own {
                config,
                state: rig.start(*seed),
                rig,
                seed: *seed,
            })
        });
        let lanes = Lanes::new(own.collect::<PyResult<_>>()?);
        Ok(Self { lanes })
    }

    fn __len__(&self) -> usize {
        self.lanes.count()
    }

    fn settings(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.lanes.settings(py)
    }

    fn states(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.lanes.states(py)
    }

    fn load_state(&self, py: Python<'_>, states: Vec<String>) -> PyResult<()> {
        self.lanes.load_state(py, &states)
    }

    fn copied(&self, py: Python<'_>) -> Self {
        let lanes = self.lanes.copied(py);
        Self { lanes }
    }

    fn restart(&self, py: Python<'_>) -> PyResult<()> {
        self.lanes.restart(py)
    }

    /// The last sample of each rig.
    fn sample<'py>(&self, py: Python<'py>) -> Named<'py> {
        let mut taken = Taken::new((1, self.lanes.count()));
        for (column, own) in self.lanes.now(py).iter().enumerate() {
            taken.put([0, column], &own.state.sample());
        }
        // Not under the lock: a new array may start Python's own clean-up, which may call again.
        taken.named(py)
    }

    /// Applies the commands and loads of samples by lanes, and returns the signals after each
    /// sample.
    fn run<'py>(
        &self,
        py: Python<'py>,
        commands: PyReadonlyArray2<'py, f64>,
        loads: PyReadonlyArray2<'py, f64>,
        dt: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Named<'py>> {
        let (commands, loads, dt) = (commands.as_array(), loads.as_array(), dt.as_array());
        let shape = (dt.len(), self.lanes.count());
        if commands.dim() != shape || loads.dim() != shape {
            return Err(failure::plain(format!(
                "arrays of shape {shape:?} are allowed"
            )));
        }
        let taken = py.detach(|| {
            let mut taken = Taken::new(shape);
            let mut lanes = self.lanes.detached();
            for row in 0..shape.0 {
                for (column, own) in lanes.iter_mut().enumerate() {
                    let place = [row, column];
                    let (command, load) = (commands[place], loads[place]);
                    let now = own
                        .rig
                        .step_with_load(&mut own.state, command, load, dt[row]);
                    taken.put(place, &now);
                }
            }
            taken
        });
        Ok(taken.named(py))
    }

    /// Runs the closed loop of each controller and its rig with a common reference, feed-forward
    /// and phase. Returns the signals before each command, and the commands, statuses and faults.
    fn track<'py>(
        &self,
        py: Python<'py>,
        controllers: &Bound<'py, Controllers>,
        reference: PyReadonlyArray1<'py, f64>,
        feed_forward: PyReadonlyArray1<'py, f64>,
        phase: PyReadonlyArray1<'py, f64>,
        dt: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Tracked<'py>> {
        let controllers = &controllers.get().lanes;
        if controllers.count() != self.lanes.count() {
            return Err(failure::plain(format!(
                "{} controllers on {} rigs; one controller for each rig is allowed",
                controllers.count(),
                self.lanes.count()
            )));
        }
        let [reference, feed_forward, phase, dt] =
            [&reference, &feed_forward, &phase, &dt].map(|own| own.as_array());
        if [feed_forward.len(), phase.len(), dt.len()] != [reference.len(); 3] {
            return Err(failure::plain("signals of one length are allowed"));
        }
        let shape = (reference.len(), self.lanes.count());
        let (taken, commands, statuses, faults) = py.detach(|| {
            // Rigs before controllers, always: two loops cannot wait for each other.
            let (mut rigs, mut lanes) = (self.lanes.detached(), controllers.detached());
            let (mut taken, mut commands) = (Taken::new(shape), Array2::zeros(shape));
            let (mut statuses, mut faults) = (Array2::zeros(shape), Array2::zeros(shape));
            for row in 0..shape.0 {
                let next = reference.get(row + 1).copied().unwrap_or(reference[row]);
                for (column, (own, lane)) in rigs.iter_mut().zip(lanes.iter_mut()).enumerate() {
                    let (place, now) = ([row, column], own.state.sample());
                    let known = [now.proximal.velocity, now.proximal.acceleration];
                    let read = known.get(..lane.regressors()).unwrap_or(&known);
                    let sample = LoopSample {
                        next_reference: next,
                        velocity: now.distal.velocity,
                        feed_forward: feed_forward[row],
                        regressors: read,
                        ..LoopSample::new(dt[row], reference[row], now.measured)
                    };
                    let cycle = Cycle {
                        phase: phase[row],
                        learns: true,
                    };
                    taken.put(place, &now);
                    (commands[place], statuses[place], faults[place]) = lane.step(&sample, cycle);
                    own.rig.step(&mut own.state, commands[place], dt[row]);
                }
            }
            (taken, commands, statuses, faults)
        });
        Ok((
            taken.named(py),
            commands.into_pyarray(py),
            statuses.into_pyarray(py),
            faults.into_pyarray(py),
        ))
    }
}

/// The reference of Nguyen et al. (2018) \[N·m\] at these times \[s\].
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
