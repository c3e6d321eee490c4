//! Learning over a cycle of a second: with numbers that are loaded, and with numbers in flash.

use crate::{Case, Output, Sample};
use bowden::constant;
use bowden::control::{IterativeLearning, IterativeLearningInput, IterativeLearningState};
use bowden::Error;
use core::hint::black_box;

/// Four samples each.
const CELLS: usize = 250;

/// Two cells ahead, a filter over five.
const LEARNING: IterativeLearning<f32> =
    constant!(IterativeLearning::<f32>::try_new(4.0, 30.0, 2, 2));

/// What was learned, and where in the cycle the last sample was.
#[derive(Debug)]
struct Cycle {
    state: IterativeLearningState<f32, [f32; CELLS]>,
    phase: f32,
}

impl Cycle {
    fn try_new(learning: &IterativeLearning<f32>) -> Result<Self, Error> {
        Ok(Self {
            state: learning.start([0.0; CELLS], [0.0; CELLS])?,
            phase: 0.0,
        })
    }

    /// A time that is none gives a phase that is none, for one sample.
    fn step(&mut self, learning: &IterativeLearning<f32>, at: &Sample) -> Output {
        let mut phase = self.phase + at.dt;
        if phase >= 1.0 {
            phase -= 1.0;
        }
        if phase < 1.0 {
            self.phase = phase;
        }
        let sample = IterativeLearningInput::new(phase, at.reference, at.measured);
        let out = learning.step(&mut self.state, &sample);
        Output::commanded(out.command, out.status)
    }
}

/// The compiler knows none of its numbers.
#[derive(Debug)]
pub struct Loaded {
    learning: IterativeLearning<f32>,
    cycle: Cycle,
}

impl Case for Loaded {
    fn try_new() -> Result<Self, Error> {
        let learning = black_box(LEARNING);
        Ok(Self {
            learning,
            cycle: Cycle::try_new(&learning)?,
        })
    }

    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        self.cycle.step(&self.learning, at)
    }
}

/// A constant, which the compiler has checked.
#[derive(Debug)]
pub struct Constant(Cycle);

impl Case for Constant {
    fn try_new() -> Result<Self, Error> {
        Cycle::try_new(&LEARNING).map(Self)
    }

    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        self.0.step(&LEARNING, at)
    }
}
