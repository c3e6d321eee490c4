//! Iterative learning in combination with a control law and the inverse of the nominal plant along
//! the reference.

use super::data_sheet::{above_zero, nominal, shown};
use super::setup::IterativeLearningGains;
use bowden::control::{
    IterativeLearning, IterativeLearningInput, IterativeLearningState, NominalPlant,
};
use bowden::effect::Motion;
use bowden::Error;
use bowden_rig::RigConfig;

/// Iterative learning over the cycle of a reference, with its feed-forward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Learned {
    /// Gain, lead, filter and limit of iterative learning.
    pub learning: IterativeLearning<f64>,
    /// Number of cells in a cycle.
    pub cells: usize,
    /// Duration of a cycle \[s\].
    pub period: f64,
    /// The plant whose inverse is fed forward.
    pub plant: NominalPlant<f64>,
    /// Time by which the reference is read ahead for the inverse \[s\].
    pub latency: f64,
}

impl Learned {
    /// Iterative learning over a cycle of `period` \[s\], on a rig at a rate \[Hz\].
    ///
    /// # Errors
    /// The error of the core for an invalid parameter.
    pub fn new(
        gains: &IterativeLearningGains,
        period: f64,
        rig: &RigConfig<f64>,
        rate: f64,
    ) -> Result<Self, Error> {
        above_zero(gains.frequency, "frequency")?;
        if gains.cells > IterativeLearning::<f64>::MOST_CELLS {
            return Err(Error::Capacity("cells"));
        }
        let a_second = gains.cells as f64 / period;
        // Corner of the triangle of one cell, as a share of the cells a second: `sin(x)/x` is
        // `2^(−1/4)`.
        let width = (0.319 * a_second / gains.frequency).round().max(1.0);
        let whole = |cells: f64, name| match (0.0..=f64::from(u16::MAX)).contains(&cells) {
            true => Ok(cells as u16),
            false if cells.is_finite() => Err(Error::OutOfRange(name)),
            false => Err(Error::NonFinite(name)),
        };
        let lead = whole((gains.lead * a_second).round(), "lead")?;
        let half_width = whole(width - 1.0, "frequency")?;
        let learning = IterativeLearning::try_new(gains.gain, gains.limit, lead, half_width)?;
        let learned = Self {
            learning,
            cells: gains.cells,
            period,
            plant: nominal(rig)?,
            latency: shown(rig, rate),
        };
        // What a start would refuse, before one.
        learned.start()?;
        Ok(learned)
    }

    fn start(&self) -> Result<IterativeLearningState<f64, Vec<f64>>, Error> {
        self.learning
            .start(vec![0.0; self.cells], vec![0.0; self.cells])
    }
}

/// Iterative learning with its running state.
pub(crate) struct Running {
    learned: Learned,
    state: IterativeLearningState<f64, Vec<f64>>,
}

impl Running {
    /// # Errors
    /// The error of the core for an invalid number of cells. [`Learned::new`] has already checked
    /// this number.
    pub(crate) fn new(learned: &Learned) -> Result<Self, Error> {
        Ok(Self {
            learned: *learned,
            state: learned.start()?,
        })
    }

    /// The value to add to the next command \[units\] at time `t` \[s\].
    pub(crate) fn step(
        &mut self,
        t: f64,
        (reference, measured): (f64, f64),
        ahead: impl Fn(f64) -> Motion<f64>,
    ) -> f64 {
        let cycles = t / self.learned.period;
        let at = IterativeLearningInput::new(cycles - cycles.floor(), reference, measured);
        let out = self.learned.learning.step(&mut self.state, &at);
        let wanted = ahead(self.learned.latency);
        out.command + self.learned.plant.feed_forward(&wanted)
    }
}
