//! The regressors along the motion, and the gain of each one.

use super::effect::{build, reads_load, usual_channel};
use super::recipe::{refuse, Mode, Planted, Recipe, RecipeError};
use super::regressor::{Extent, Regressor};
use super::rig::{Channel, Moment, Rig};
use super::{effects, outsiders, PlantedTruth};
use rand_chacha::ChaCha8Rng;

/// One planted effect while the record is being made.
pub(super) struct Running {
    pub(super) truth: PlantedTruth,
    pub(super) channel: Option<Channel>,
    /// `None` for a delay or a lag.
    regressor: Option<Regressor>,
    sign: f64,
    mean: f64,
    /// The regressor, where the grid keeps it.
    pub(super) fine: Vec<f64>,
}

impl Running {
    pub(super) fn start(
        planted: &Planted,
        rig: &Rig,
        recipe: &Recipe,
        rng: &mut ChaCha8Rng,
    ) -> Result<Self, RecipeError> {
        let (name, mode) = (planted.effect.as_str(), recipe.mode);
        if !effects(mode).contains(&name) && !outsiders().contains(&name) {
            return refuse(format!(
                "effect `{name}` must be one of {}",
                effects(mode).join(", ")
            ));
        }
        let usual = usual_channel(name, mode);
        let channel = match &planted.channel {
            None => usual,
            Some(given) => match (Channel::named(given, mode), usual) {
                (Some(channel), Some(_)) => Some(channel),
                (_, None) => {
                    return refuse(format!(
                        "effect `{name}` reads no channel, but `{given}` was given"
                    ))
                }
                (None, _) => {
                    return refuse(format!(
                        "effect `{name}`: the record has no channel `{given}`"
                    ))
                }
            },
        };
        let input = Extent::of(rig, Channel::Input, recipe);
        let mut extent = Extent::of(rig, channel.unwrap_or(Channel::Input), recipe);
        extent.mean = planted.origin.unwrap_or(extent.mean);
        let regressor = build(name, &extent, &input, rng);
        let sign = regressor
            .as_ref()
            .map_or(1.0, |regressor| regressor.sign(mode, rng));
        let truth = PlantedTruth {
            effect: name.to_owned(),
            channel: channel
                .and_then(|channel| channel.label(mode))
                .map(|label| label.0),
            gain: 0.0,
            shapes: regressor
                .as_ref()
                .map_or_else(Vec::new, |regressor| regressor.shapes.clone()),
            rms: 0.0,
            contribution: Vec::new(),
        };
        Ok(Self {
            truth,
            channel,
            regressor,
            sign,
            mean: extent.mean,
            fine: Vec::new(),
        })
    }

    /// The effect acts on the finished output.
    pub(super) fn is_stage(&self) -> bool {
        self.regressor.is_none()
    }

    pub(super) fn needs(&self, channel: Channel, mode: Mode) -> bool {
        let load = channel == Channel::Load && mode == Mode::Displacement;
        self.channel == Some(channel) || (load && reads_load(&self.truth.effect))
    }

    pub(super) fn step(&mut self, moment: &Moment, is_kept: bool) {
        if let Some(regressor) = &mut self.regressor {
            let mut motion = self
                .channel
                .map(|channel| channel.of(moment))
                .unwrap_or_default();
            motion.x -= self.mean;
            let value = (regressor.step)(moment, motion);
            if is_kept {
                self.fine.push(value);
            }
        }
    }

    /// Chooses the gain so that the sampled contribution has the wanted rms, or takes the
    /// given one.
    pub(super) fn scale(
        &mut self,
        sampled: &[f64],
        wanted: f64,
        given: Option<f64>,
    ) -> Result<(), RecipeError> {
        let count = sampled.len() as f64;
        let size = match self.truth.effect.as_str() {
            "offset" => (sampled.iter().map(|value| value * value).sum::<f64>() / count).sqrt(),
            _ => super::sensor::spread(sampled),
        };
        if !(size > 0.0 && (wanted / size).is_finite()) {
            return refuse(format!(
                "effect `{}` is constant in this record",
                self.truth.effect
            ));
        }
        self.truth.gain = given.unwrap_or(self.sign * wanted / size);
        self.truth.rms = given.map_or(wanted, |gain| gain.abs() * size);
        self.truth.contribution = sampled
            .iter()
            .map(|value| self.truth.gain * value)
            .collect();
        Ok(())
    }
}
