//! Controllers side by side, one for each lane.

use crate::beside::{Beside, Cycle};
use crate::code::Codes;
use crate::failure;
use crate::lanes::{read, Lane, Lanes};
use crate::law::{law, AnyLaw};
use bowden::control::{Applied, LoopSample};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

/// A controller and the additions to its command.
#[derive(Clone)]
pub struct Helped {
    law: Box<dyn AnyLaw>,
    beside: Beside,
    codes: Codes,
}

/// The result of a step: the command, and the codes of its status and fault.
pub type Stepped = (f64, u8, u8);

impl Helped {
    /// Makes one step. The status is degraded if the sample was good for the law, but the observer
    /// or iterative learning could not use it.
    pub fn step(&mut self, at: &LoopSample<'_, f64>, cycle: Cycle) -> Stepped {
        let (added, unused) = self.beside.step(self.law.command(), at, cycle);
        let command = self.law.step(&LoopSample {
            feed_forward: at.feed_forward + added,
            ..*at
        });
        self.codes = match (self.law.codes(), unused) {
            ((0, _), (1.., fault)) => (1, fault),
            (own, _) => own,
        };
        (command, self.codes.0, self.codes.1)
    }

    pub fn regressors(&self) -> usize {
        self.law.regressors()
    }

    fn resume_from(&mut self, output: f64, at: &LoopSample<'_, f64>) -> Stepped {
        let command = self.law.resume_from(
            output,
            &LoopSample {
                feed_forward: at.feed_forward + self.beside.added(),
                ..*at
            },
        );
        self.codes = self.law.codes();
        (command, self.codes.0, self.codes.1)
    }
}

impl Lane for Helped {
    fn settings(&self) -> PyResult<String> {
        self.law.settings()
    }

    /// `{"law": …, "beside": …}` from JSON texts.
    fn state(&self) -> PyResult<String> {
        let (law, beside) = (self.law.state()?, self.beside.state()?);
        Ok(format!(r#"{{"law":{law},"beside":{beside}}}"#))
    }

    fn restored(&self, state: &str) -> PyResult<Self> {
        let parts: Parts = read(state)?;
        let law = self.law.restored(&parts.law.to_string())?;
        Ok(Self {
            codes: law.codes(),
            beside: self.beside.restored(&parts.beside.to_string())?,
            law,
        })
    }

    fn restart(&mut self) -> PyResult<()> {
        self.law.restart();
        self.codes = self.law.codes();
        self.beside.restart()
    }
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Parts {
    law: serde_json::Value,
    beside: serde_json::Value,
}

/// Controllers side by side.
#[pyclass(frozen, module = "bowden._bowden")]
pub struct Controllers {
    pub lanes: Lanes<Helped>,
}

type Signal<'py> = PyReadonlyArray2<'py, f64>;
type Codes2<'py> = Bound<'py, PyArray2<u8>>;
type Answer<'py> = (Bound<'py, PyArray2<f64>>, Codes2<'py>, Codes2<'py>);

/// The numbers of one sample in the order of the Python call: reference, next reference, measured,
/// velocity, feed-forward, phase, and zero if the law does not learn from the sample.
type Numbers = [f64; 7];

fn sample<'a>(dt: f64, numbers: &Numbers, regressors: &'a [f64]) -> (LoopSample<'a, f64>, Cycle) {
    let [reference, next_reference, measured, velocity, feed_forward, phase, learns] = *numbers;
    let sample = LoopSample {
        dt,
        reference,
        next_reference,
        measured,
        velocity,
        feed_forward,
        regressors,
    };
    let learns = learns != 0.0;
    (sample, Cycle { phase, learns })
}

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
            let law = law(text, regressors)?;
            Ok(Helped {
                codes: law.codes(),
                law,
                beside: Beside::new(observer, learning.as_ref())?,
            })
        });
        let lanes = Lanes::new(lanes.collect::<PyResult<_>>()?);
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

    /// Processes one sample of one lane.
    fn step(
        &self,
        py: Python<'_>,
        dt: f64,
        numbers: Numbers,
        regressors: Vec<f64>,
    ) -> Option<Stepped> {
        let (at, cycle) = sample(dt, &numbers, &regressors);
        let mut lanes = self.lanes.now(py);
        lanes.first_mut().map(|lane| lane.step(&at, cycle))
    }

    /// Processes samples by lanes and returns the commands, statuses and faults. `signals` are
    /// those of [`Numbers`]. `regressors` has one array for each regressor.
    fn run<'py>(
        &self,
        py: Python<'py>,
        dt: PyReadonlyArray1<'py, f64>,
        signals: [Signal<'py>; 7],
        regressors: Vec<Signal<'py>>,
    ) -> PyResult<Answer<'py>> {
        let views = signals.each_ref().map(PyReadonlyArray2::as_array);
        let more: Vec<_> = regressors.iter().map(PyReadonlyArray2::as_array).collect();
        let dt = dt.as_array();
        let shape = (dt.len(), self.lanes.count());
        if views.iter().chain(&more).any(|view| view.dim() != shape) {
            return Err(failure::plain(format!(
                "arrays of shape {shape:?} are allowed"
            )));
        }
        let (commands, statuses, faults) = py.detach(|| {
            let mut lanes = self.lanes.detached();
            let mut commands = Array2::zeros(shape);
            let (mut statuses, mut faults) = (Array2::zeros(shape), Array2::zeros(shape));
            let mut read = Vec::with_capacity(more.len());
            for row in 0..shape.0 {
                for (column, lane) in lanes.iter_mut().enumerate() {
                    let place = [row, column];
                    read.clear();
                    read.extend(more.iter().map(|own| own[place]));
                    let (at, cycle) = sample(dt[row], &views.map(|own| own[place]), &read);
                    (commands[place], statuses[place], faults[place]) = lane.step(&at, cycle);
                }
            }
            (commands, statuses, faults)
        });
        Ok((
            commands.into_pyarray(py),
            statuses.into_pyarray(py),
            faults.into_pyarray(py),
        ))
    }

    /// Changes the settings of each lane without a jump of the command.
    fn bumpless_transfer(&self, py: Python<'_>, settings: Vec<String>) -> PyResult<()> {
        self.lanes.replace(py, &settings, |lane, text| {
            Ok(Helped {
                law: lane.law.taken_over(text)?,
                ..lane.clone()
            })
        })
    }

    /// Restarts each lane from its own output and sample.
    fn resume_from(
        &self,
        py: Python<'_>,
        outputs: Vec<f64>,
        samples: Vec<Numbers>,
        regressors: Vec<Vec<f64>>,
    ) -> Vec<Stepped> {
        let mut lanes = self.lanes.now(py);
        let given = outputs.into_iter().zip(samples).zip(regressors);
        let resumed = lanes.iter_mut().zip(given);
        resumed
            .map(|(lane, ((output, numbers), regressors))| {
                // No time passes here: dt is not read.
                let (at, _) = sample(f64::NAN, &numbers, &regressors);
                lane.resume_from(output, &at)
            })
            .collect()
    }

    /// Reports the response (JSON) of each lane's drive to the last command.
    fn applied(&self, py: Python<'_>, applied: Vec<String>) -> PyResult<()> {
        let given: Vec<Applied<f64>> = applied
            .iter()
            .map(|own| read(own))
            .collect::<PyResult<_>>()?;
        let mut lanes = self.lanes.now(py);
        let each = lanes.iter_mut().zip(given);
        each.for_each(|(lane, own)| lane.law.applied(own));
        Ok(())
    }

    fn acknowledge(&self, py: Python<'_>) {
        let mut lanes = self.lanes.now(py);
        lanes.iter_mut().for_each(|lane| lane.law.acknowledge());
    }

    fn restore(&self, py: Python<'_>) {
        let mut lanes = self.lanes.now(py);
        lanes.iter_mut().for_each(|lane| lane.law.restore());
    }

    fn reset(&self, py: Python<'_>) {
        let mut lanes = self.lanes.now(py);
        lanes.iter_mut().for_each(|lane| lane.law.reset());
    }

    fn are_latched(&self, py: Python<'_>) -> Vec<bool> {
        let lanes = self.lanes.now(py);
        lanes.iter().map(|lane| lane.law.is_latched()).collect()
    }

    /// The applied command, the status and the fault of the last sample.
    fn last(&self, py: Python<'_>) -> Vec<Stepped> {
        let lanes = self.lanes.now(py);
        let last = |lane: &Helped| (lane.law.command(), lane.codes.0, lane.codes.1);
        lanes.iter().map(last).collect()
    }

    /// The terms of the last step, as JSON.
    fn terms(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let lanes = self.lanes.now(py);
        lanes.iter().map(|lane| lane.law.terms()).collect()
    }

    fn estimates(&self, py: Python<'_>) -> Vec<Vec<f64>> {
        let lanes = self.lanes.now(py);
        lanes.iter().map(|lane| lane.law.estimates()).collect()
    }

    /// d_hat of each observer; `None` without an observer.
    fn disturbances(&self, py: Python<'_>) -> Option<Vec<f64>> {
        let lanes = self.lanes.now(py);
        let all = lanes.iter().map(|lane| lane.beside.disturbance());
        all.collect()
    }

    /// The learned value of each cell of each controller; `None` without learning.
    fn learned(&self, py: Python<'_>) -> Option<Vec<Vec<f64>>> {
        let lanes = self.lanes.now(py);
        let all = lanes.iter().map(|lane| lane.beside.learned());
        all.collect()
    }
}
