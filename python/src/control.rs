//! Controllers, as many side by side as a caller has lanes; settings come as TOML, so that the
//! core itself reads and checks them.

use crate::beside::{Beside, Cycle};
use crate::failure;
use bowden::control::{
    Adaptive, AdaptiveState, Controller, LoopSample, Output, Pid, PidState, Status,
};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

/// One controller with its state.
pub trait Lane: Send + Sync {
    fn step(&mut self, at: &LoopSample<'_, f64>) -> Output<f64>;
    fn restart(&mut self);
    fn acknowledge(&mut self);
    fn command(&self) -> f64;
    /// beta_hat, delta_hat and each theta_hat of an adaptive law; the integral of another.
    fn estimates(&self) -> Vec<f64>;
    fn regressors(&self) -> usize;
}

struct Running<C: Controller<f64>> {
    law: C,
    state: C::State,
    look: fn(&C::State) -> Vec<f64>,
    regressors: usize,
}

impl<C> Lane for Running<C>
where
    C: Controller<f64> + Send + Sync,
    C::State: Send + Sync,
{
    fn step(&mut self, at: &LoopSample<'_, f64>) -> Output<f64> {
        self.law.step(&mut self.state, at)
    }

    fn restart(&mut self) {
        self.state = self.law.start();
    }

    fn acknowledge(&mut self) {
        self.law.acknowledge(&mut self.state);
    }

    fn command(&self) -> f64 {
        self.law.command(&self.state)
    }

    fn estimates(&self) -> Vec<f64> {
        (self.look)(&self.state)
    }

    fn regressors(&self) -> usize {
        self.regressors
    }
}

fn estimates<const N: usize>(state: &AdaptiveState<f64, N>) -> Vec<f64> {
    let ends = [state.beta_hat(), state.delta_hat()];
    ends.into_iter().chain(state.theta_hat()).collect()
}

fn adaptive<const N: usize>(text: &str) -> Result<Box<dyn Lane>, toml::de::Error> {
    let law: Adaptive<f64, N> = toml::from_str(text)?;
    Ok(Box::new(Running {
        state: law.start(),
        law,
        look: estimates::<N>,
        regressors: N,
    }))
}

/// A law of its settings; `None` for PI, PID and PIV, else the number of regressors.
fn lane(text: &str, regressors: Option<usize>) -> PyResult<Box<dyn Lane>> {
    let built = match regressors {
        None => toml::from_str::<Pid<f64>>(text).map(|law| -> Box<dyn Lane> {
            Box::new(Running {
                state: law.start(),
                law,
                look: |state: &PidState<f64>| vec![state.integral()],
                regressors: 0,
            })
        }),
        Some(0) => adaptive::<0>(text),
        Some(1) => adaptive::<1>(text),
        Some(2) => adaptive::<2>(text),
        Some(3) => adaptive::<3>(text),
        Some(4) => adaptive::<4>(text),
        Some(more) => {
            return Err(failure::plain(format!(
                "theta: {more} estimates; 0 to 4 were expected"
            )))
        }
    };
    built.map_err(|e| failure::plain(e.message()))
}

/// 0 good, 1 degraded, 2 held, 3 safe.
fn code(status: Status) -> u8 {
    match status {
        Status::Good => 0,
        Status::Degraded(_) => 1,
        Status::Held(_) => 2,
        Status::Safe(_) => 3,
    }
}

/// A controller and what goes beside it.
pub struct Helped {
    law: Box<dyn Lane>,
    beside: Beside,
}

impl Helped {
    /// The command and the code of its status: degraded where the law had a good sample, and what goes
    /// beside it could not use it.
    pub fn step(&mut self, at: &LoopSample<'_, f64>, cycle: Cycle) -> (f64, u8) {
        let (added, unused) = self.beside.step(self.law.command(), at, cycle);
        let out = self.law.step(&LoopSample {
            feed_forward: at.feed_forward + added,
            ..*at
        });
        (out.command, code(out.status).max(u8::from(unused)))
    }

    pub fn regressors(&self) -> usize {
        self.law.regressors()
    }
}

/// Controllers side by side.
#[pyclass(module = "bowden._bowden")]
pub struct Controllers {
    pub lanes: Vec<Helped>,
}

type Signal<'py> = PyReadonlyArray2<'py, f64>;
type Answer<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<u8>>);

#[pymethods]
impl Controllers {
    #[new]
    #[pyo3(signature = (settings, regressors, observer=None, learning=None))]
    fn new(
        settings: Vec<String>,
        regressors: Option<usize>,
        observer: Option<&str>,
        learning: Option<(String, Vec<f64>)>,
    ) -> PyResult<Self> {
        let lanes = settings.iter().map(|text| {
            Ok(Helped {
                law: lane(text, regressors)?,
                beside: Beside::new(observer, learning.as_ref())?,
            })
        });
        Ok(Self {
            lanes: lanes.collect::<PyResult<_>>()?,
        })
    }

    fn __len__(&self) -> usize {
        self.lanes.len()
    }

    /// Samples by lanes: commands, and the status of each. `regressors` are one array each; `learns` is
    /// zero where a sample is not learned from.
    #[allow(clippy::too_many_arguments)]
    fn run<'py>(
        &mut self,
        py: Python<'py>,
        dt: PyReadonlyArray1<'py, f64>,
        reference: Signal<'py>,
        next_reference: Signal<'py>,
        measured: Signal<'py>,
        velocity: Signal<'py>,
        feed_forward: Signal<'py>,
        phase: Signal<'py>,
        learns: Signal<'py>,
        regressors: Vec<Signal<'py>>,
    ) -> PyResult<Answer<'py>> {
        let signals = [
            &reference,
            &next_reference,
            &measured,
            &velocity,
            &feed_forward,
            &phase,
            &learns,
        ];
        let views = signals.map(PyReadonlyArray2::as_array);
        let more: Vec<_> = regressors.iter().map(PyReadonlyArray2::as_array).collect();
        let dt = dt.as_array();
        let shape = (dt.len(), self.lanes.len());
        if views.iter().chain(&more).any(|view| view.dim() != shape) {
            return Err(failure::plain(format!(
                "arrays of shape {shape:?} were expected"
            )));
        }
        let lanes = &mut self.lanes;
        let (commands, statuses) = py.detach(|| {
            let mut commands = Array2::zeros(shape);
            let mut statuses = Array2::zeros(shape);
            let mut read = Vec::with_capacity(more.len());
            for row in 0..shape.0 {
                for (column, lane) in lanes.iter_mut().enumerate() {
                    let place = [row, column];
                    read.clear();
                    read.extend(more.iter().map(|own| own[place]));
                    let sample = LoopSample {
                        dt: dt[row],
                        reference: views[0][place],
                        next_reference: views[1][place],
                        measured: views[2][place],
                        velocity: views[3][place],
                        feed_forward: views[4][place],
                        regressors: &read,
                    };
                    let cycle = Cycle {
                        phase: views[5][place],
                        learns: views[6][place] != 0.0,
                    };
                    (commands[place], statuses[place]) = lane.step(&sample, cycle);
                }
            }
            (commands, statuses)
        });
        Ok((commands.into_pyarray(py), statuses.into_pyarray(py)))
    }

    fn restart(&mut self) -> PyResult<()> {
        self.lanes.iter_mut().try_for_each(|lane| {
            lane.law.restart();
            lane.beside.restart()
        })
    }

    fn acknowledge(&mut self) {
        self.lanes
            .iter_mut()
            .for_each(|lane| lane.law.acknowledge());
    }

    fn commands(&self) -> Vec<f64> {
        self.lanes.iter().map(|lane| lane.law.command()).collect()
    }

    fn estimates(&self) -> Vec<Vec<f64>> {
        self.lanes.iter().map(|lane| lane.law.estimates()).collect()
    }

    /// d_hat of each observer; `None` without one.
    fn disturbances(&self) -> Option<Vec<f64>> {
        self.lanes
            .iter()
            .map(|lane| lane.beside.disturbance())
            .collect()
    }

    /// What each cell of each controller has learned; `None` without learning.
    fn learned(&self) -> Option<Vec<Vec<f64>>> {
        self.lanes
            .iter()
            .map(|lane| lane.beside.learned())
            .collect()
    }
}
