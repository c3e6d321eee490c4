//! The regressor of a planted effect: the range of its channel, and its step.

use super::excitation::Motion;
use super::recipe::{Mode, Recipe};
use super::rig::{Channel, Moment, Rig};
use super::sensor::spread;
use rand::Rng;
use rand_chacha::ChaCha8Rng;

/// How far and how fast a channel moves in the record.
pub(super) struct Extent {
    pub(super) mean: f64,
    /// Largest distance from the mean.
    pub(super) reach: f64,
    /// Rms speed.
    pub(super) speed: f64,
    /// Length of its path.
    pub(super) path: f64,
    /// Length of the record \[s\].
    pub(super) seconds: f64,
    /// Distances from the mean in rising order.
    sorted: Vec<f64>,
}

impl Extent {
    pub(super) fn of(rig: &Rig, channel: Channel, recipe: &Recipe) -> Self {
        let samples = (recipe.seconds * recipe.rate) as usize;
        let motion: Vec<Motion> = (0..samples)
            .map(|k| channel.of(&rig.at(k as f64 / recipe.rate, 0.0)))
            .collect();
        let count = samples as f64;
        let mean = motion.iter().map(|m| m.x).sum::<f64>() / count;
        let mut sorted: Vec<f64> = motion.iter().map(|m| m.x - mean).collect();
        sorted.sort_by(f64::total_cmp);
        Self {
            mean,
            reach: sorted.iter().fold(0.0, |reach, x| x.abs().max(reach)),
            speed: (motion.iter().map(|m| m.v * m.v).sum::<f64>() / count).sqrt(),
            path: motion.iter().map(|m| m.v.abs()).sum::<f64>() / recipe.rate,
            seconds: recipe.seconds,
            sorted,
        }
    }

    /// Distance from the mean below which that share of the samples lies.
    pub(super) fn quantile(&self, share: f64) -> f64 {
        let at = share * (self.sorted.len().max(1) - 1) as f64;
        self.sorted.get(at as usize).copied().unwrap_or_default()
    }

    /// Rms distance from the mean.
    pub(super) fn rms(&self) -> f64 {
        spread(&self.sorted)
    }
}

type Step = dyn FnMut(&Moment, Motion) -> f64;

/// One effect at work: from the moment and its channel, the mean taken off, to
/// a number that a gain is going to multiply.
pub(super) struct Regressor {
    pub(super) step: Box<Step>,
    pub(super) shapes: Vec<(&'static str, f64)>,
    pub(super) sense: Sense,
}

/// What the sign of the gain has to be.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Sense {
    /// Dissipates energy: lowers the transmitted torque, raises the force.
    Loss,
    /// Reduces the hysteresis.
    Relief,
    /// Reduces the output.
    Less,
    /// Both signs are physical.
    Either,
}

impl Regressor {
    pub(super) fn new(sense: Sense, step: impl FnMut(&Moment, Motion) -> f64 + 'static) -> Self {
        Self {
            step: Box::new(step),
            shapes: Vec::new(),
            sense,
        }
    }

    pub(super) fn with(mut self, name: &'static str, value: f64) -> Self {
        self.shapes.push((name, value));
        self
    }

    pub(super) fn sign(&self, mode: Mode, rng: &mut ChaCha8Rng) -> f64 {
        let coin = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
        match (self.sense, mode) {
            (Sense::Either, _) => coin,
            (Sense::Less, _) => -1.0,
            (Sense::Loss, Mode::Torque) | (Sense::Relief, Mode::Displacement) => -1.0,
            (Sense::Loss, Mode::Displacement) | (Sense::Relief, Mode::Torque) => 1.0,
        }
    }
}
