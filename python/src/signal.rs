//! Signal conditioning and the relay experiment, with one lane for each signal.

use crate::code;
use crate::failure;
use crate::lanes::{read, written, Lane, Lanes};
use bowden::control::Relay;
use bowden::signal::{
    Biquad, BiquadState, EdgeVelocity, EdgeVelocityState, LowPass, LowPassState, Plausible,
    PlausibleState, Ramp, RampState, Rates, RatesState,
};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// Maximum number of output signals of a block.
const MOST: usize = 3;

/// The output for one sample: signals, and the codes of status and fault.
pub type Out = ([f64; MOST], u8, u8);

/// The functions that this package needs from a block. A new block needs an `impl` and a line in
/// [`block`].
pub trait Block: Copy + Serialize + DeserializeOwned + Send + Sync + 'static {
    type State: Copy + Serialize + DeserializeOwned + Send + Sync;

    fn start(&self, first: f64) -> Self::State;
    fn step(&self, state: &mut Self::State, sample: f64, dt: f64, moves: bool) -> Out;

    /// Acknowledges a failure. Most blocks have no failures.
    fn acknowledge(&self, _: &mut Self::State) {}
}

impl Block for Rates<f64> {
    type State = RatesState<f64>;

    fn start(&self, _: f64) -> RatesState<f64> {
        RatesState::new()
    }

    fn step(&self, state: &mut RatesState<f64>, sample: f64, dt: f64, _: bool) -> Out {
        let out = Self::step(self, state, sample, dt);
        let (status, fault) = code::rates(out.status);
        let own = out.motion;
        (
            [own.position, own.velocity, own.acceleration],
            status,
            fault,
        )
    }
}

impl Block for EdgeVelocity<f64> {
    type State = EdgeVelocityState<f64>;

    fn start(&self, _: f64) -> EdgeVelocityState<f64> {
        EdgeVelocityState::new()
    }

    fn step(&self, state: &mut EdgeVelocityState<f64>, sample: f64, dt: f64, _: bool) -> Out {
        let out = Self::step(self, state, sample, dt);
        let (status, fault) = code::rates(out.status);
        ([out.velocity, 0.0, 0.0], status, fault)
    }
}

impl Block for Ramp<f64> {
    type State = RampState<f64>;

    fn start(&self, first: f64) -> RampState<f64> {
        RampState::at(first)
    }

    fn step(&self, state: &mut RampState<f64>, sample: f64, dt: f64, _: bool) -> Out {
        ([Self::step(self, state, sample, dt), 0.0, 0.0], 0, 0)
    }
}

impl Block for Plausible<f64> {
    type State = PlausibleState<f64>;

    fn start(&self, _: f64) -> PlausibleState<f64> {
        PlausibleState::new()
    }

    fn step(&self, state: &mut PlausibleState<f64>, sample: f64, dt: f64, moves: bool) -> Out {
        let out = Self::step(self, state, sample, dt, moves);
        ([out.value, 0.0, 0.0], 0, code::implausible(out.fault))
    }
}

impl Block for LowPass<f64> {
    type State = LowPassState<f64>;

    fn start(&self, _: f64) -> LowPassState<f64> {
        LowPassState::new()
    }

    fn step(&self, state: &mut LowPassState<f64>, sample: f64, dt: f64, _: bool) -> Out {
        ([Self::step(self, state, sample, dt), 0.0, 0.0], 0, 0)
    }
}

impl Block for Biquad<f64> {
    type State = BiquadState<f64>;

    fn start(&self, _: f64) -> BiquadState<f64> {
        BiquadState::new()
    }

    fn step(&self, state: &mut BiquadState<f64>, sample: f64, dt: f64, _: bool) -> Out {
        ([Self::step(self, state, sample, dt), 0.0, 0.0], 0, 0)
    }
}

/// The settings of the block, and its initial value.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Given<B> {
    block: B,
    start: f64,
}

#[derive(Clone, Copy)]
struct Running<B: Block> {
    given: Given<B>,
    state: B::State,
}

/// Any block with its state.
trait AnyBlock: Send + Sync {
    fn copied(&self) -> Box<dyn AnyBlock>;
    fn settings(&self) -> PyResult<String>;
    fn state(&self) -> PyResult<String>;
    fn restored(&self, state: &str) -> PyResult<Box<dyn AnyBlock>>;
    fn restart(&mut self);
    fn acknowledge(&mut self);
    fn step(&mut self, sample: f64, dt: f64, moves: bool) -> Out;
}

impl<B: Block> AnyBlock for Running<B> {
    fn copied(&self) -> Box<dyn AnyBlock> {
        Box::new(*self)
    }

    fn settings(&self) -> PyResult<String> {
        written(&self.given)
    }

    fn state(&self) -> PyResult<String> {
        written(&self.state)
    }

    fn restored(&self, state: &str) -> PyResult<Box<dyn AnyBlock>> {
        let state = read(state)?;
        Ok(Box::new(Self { state, ..*self }))
    }

    fn restart(&mut self) {
        self.state = self.given.block.start(self.given.start);
    }

    fn acknowledge(&mut self) {
        self.given.block.acknowledge(&mut self.state);
    }

    fn step(&mut self, sample: f64, dt: f64, moves: bool) -> Out {
        self.given.block.step(&mut self.state, sample, dt, moves)
    }
}

/// One lane.
pub struct One(Box<dyn AnyBlock>);

impl Clone for One {
    fn clone(&self) -> Self {
        Self(self.0.copied())
    }
}

impl Lane for One {
    fn settings(&self) -> PyResult<String> {
        self.0.settings()
    }

    fn state(&self) -> PyResult<String> {
        self.0.state()
    }

    fn restored(&self, state: &str) -> PyResult<Self> {
        self.0.restored(state).map(Self)
    }

    fn restart(&mut self) -> PyResult<()> {
        self.0.restart();
        Ok(())
    }
}

fn block(kind: &str, settings: &str) -> PyResult<One> {
    fn started<B: Block>(settings: &str) -> PyResult<One> {
        let given: Given<B> = read(settings)?;
        let state = given.block.start(given.start);
        Ok(One(Box::new(Running { given, state })))
    }
    match kind {
        "Rates" => started::<Rates<f64>>(settings),
        "EdgeVelocity" => started::<EdgeVelocity<f64>>(settings),
        "Relay" => started::<Relay<f64>>(settings),
        "Ramp" => started::<Ramp<f64>>(settings),
        "LowPass" => started::<LowPass<f64>>(settings),
        "Biquad" => started::<Biquad<f64>>(settings),
        "Plausible" => started::<Plausible<f64>>(settings),
        other => Err(failure::plain(format!("{other}: no such block"))),
    }
}

/// Blocks side by side.
#[pyclass(frozen, module = "bowden._bowden")]
pub struct Blocks {
    lanes: Lanes<One>,
}

type Codes2<'py> = Bound<'py, PyArray2<u8>>;
type Answer<'py> = (Vec<Bound<'py, PyArray2<f64>>>, Codes2<'py>, Codes2<'py>);

#[pymethods]
impl Blocks {
    #[new]
    fn new(kind: &str, settings: Vec<String>) -> PyResult<Self> {
        let lanes = settings.iter().map(|text| block(kind, text));
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

    fn acknowledge(&self, py: Python<'_>) {
        let mut lanes = self.lanes.now(py);
        lanes.iter_mut().for_each(|lane| lane.0.acknowledge());
    }

    /// Processes samples by lanes and returns the signals, statuses and faults. `moves` is zero
    /// while the machine does not move.
    fn run<'py>(
        &self,
        py: Python<'py>,
        dt: PyReadonlyArray1<'py, f64>,
        samples: PyReadonlyArray2<'py, f64>,
        moves: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Answer<'py>> {
        let (dt, samples, moves) = (dt.as_array(), samples.as_array(), moves.as_array());
        let shape = (dt.len(), self.lanes.count());
        if samples.dim() != shape || moves.dim() != shape {
            return Err(failure::plain(format!(
                "arrays of shape {shape:?} are allowed"
            )));
        }
        let (signals, statuses, faults) = py.detach(|| {
            let mut lanes = self.lanes.detached();
            let mut signals: [Array2<f64>; MOST] = std::array::from_fn(|_| Array2::zeros(shape));
            let (mut statuses, mut faults) = (Array2::zeros(shape), Array2::zeros(shape));
            for row in 0..shape.0 {
                for (column, lane) in lanes.iter_mut().enumerate() {
                    let place = [row, column];
                    let moving = moves[place] != 0.0;
                    let (out, status, fault) = lane.0.step(samples[place], dt[row], moving);
                    for (signal, value) in signals.iter_mut().zip(out) {
                        signal[place] = value;
                    }
                    (statuses[place], faults[place]) = (status, fault);
                }
            }
            (signals, statuses, faults)
        });
        let signals = signals.into_iter().map(|own| own.into_pyarray(py));
        Ok((
            signals.collect(),
            statuses.into_pyarray(py),
            faults.into_pyarray(py),
        ))
    }
}
