//! The plant of a model file: slopes, ranges, intervals.

use bowden::transmission::{Mode, Transmission};
use bowden_lab::export::{About, ModelFile, TermFile};
use bowden_lab::record::is_same_unit;
use serde::Serialize;

/// Smallest and largest slope of the output versus the input.
///
/// With zeta = eta in the direction of the motion, and p = rho times the path,
/// `d zeta/dp = 1 - zeta^n` while loading and `1 + (2·sigma - 1)·abs(zeta)^n` while unloading. With
/// abs(zeta) <= 1 and 2·sigma >= 1, the slope of eta versus the input is in `0..=2·sigma·rho`. In
/// torque mode (5)-(7), the slope of the output is therefore between `B` and
/// `B - 2·kappa_eta·sigma·rho`. A saturated loop reaches both ends, before and after a reversal.
///
/// ```
/// use bowden::hysteresis::BoucWen;
/// use bowden::transmission::Transmission;
/// use bowden_trials::design::Slopes;
/// let cable = Transmission::torque(1.0, 2.0, 0.0, BoucWen::try_new(0.1, 1.5, 2.0)?)?;
/// let slopes = Slopes::of(&cable);
/// assert!((slopes.least - 0.4).abs() < 1e-12 && slopes.greatest == 1.0);
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Slopes {
    /// Smallest slope.
    pub least: f64,
    /// Largest slope.
    pub greatest: f64,
}

impl Slopes {
    /// The slopes of a transmission.
    #[must_use]
    pub fn of(cable: &Transmission<f64>) -> Self {
        let shape = cable.shape();
        let steepest = shape.rho() * (2.0 * shape.sigma()).max(1.0);
        let against = match cable.mode() {
            Mode::Torque => -cable.kappa_eta(),
            Mode::Displacement => cable.kappa_eta(),
        };
        let other = cable.gain() + against * steepest;
        Self {
            least: cable.gain().min(other),
            greatest: cable.gain().max(other),
        }
    }

    /// The smallest slope, if it is above a hundredth of the largest. Below this limit the model is
    /// at the bound of invertibility, and rates divided by the slope are meaningless.
    #[must_use]
    pub fn rising(&self) -> Option<f64> {
        (self.least > 0.01 * self.greatest).then_some(self.least)
    }

    /// The largest magnitude of the slope, which determines the loop's gain.
    #[must_use]
    pub fn magnitude(&self) -> f64 {
        self.greatest.max(-self.least)
    }
}

/// Rejects a model whose output falls while the input rises, except for the effect of the
/// hysteresis after a reversal. With positive gains, the loop would diverge.
///
/// # Errors
/// One sentence without the file's name.
pub(crate) fn rises(file: &ModelFile) -> Result<(), String> {
    let verdict = file
        .about
        .as_ref()
        .and_then(|about| about.verdict.as_deref());
    if verdict == Some("no-input-dependence") {
        return Err(
            "the model does not describe its records (verdict `no-input-dependence`), so no gains can be derived from it; `bowden identify` prints the reason".to_owned(),
        );
    }
    in_newton_metres(file)?;
    let Some(cable) = &file.transmission else {
        return Ok(());
    };
    let is_share = |term: &&TermFile| term.effect == "gain" && term.source == "input";
    let shares = file.terms.iter().filter(is_share).map(|term| term.gain);
    let gain = cable.gain + shares.sum::<f64>();
    if gain > 0.0 {
        return Ok(());
    }
    Err(format!(
        "the output falls while the input rises (gain {gain:.4}); reverse one of them in the record, fit again, and wire the drive or the sensor accordingly"
    ))
}

/// The unit of torque for noise, limits and gains.
const TORQUE: &str = "N·m";

/// Rejects a torque model in another unit. In mN·m, for example, its limits would be a thousand
/// times too wide.
fn in_newton_metres(file: &ModelFile) -> Result<(), String> {
    let units = file.about.as_ref().map(|about| &about.units);
    let stated = |end: &str| units.and_then(|units| units.get(end));
    for end in ["input", "output"] {
        let other = stated(end).filter(|unit| !is_same_unit(unit, TORQUE));
        if let Some(unit) = other.filter(|_| file.mode == "torque") {
            return Err(format!(
                "its {end} is in {unit}, but it must be in {TORQUE}, the unit of the noise, the limits and the gains; convert the columns of the record and fit again"
            ));
        }
    }
    Ok(())
}

/// A torque model as the plant of a loop.
#[derive(Debug, Clone)]
pub(super) struct Plant {
    pub(super) cable: Transmission<f64>,
    pub(super) slopes: Slopes,
    /// Delays and lags of the model \[s\]. A lag counts as a delay.
    pub(super) own_delay: f64,
    /// Range of the input in the record \[N·m\].
    pub(super) input: [f64; 2],
    pub(super) input_rate: [f64; 2],
    /// Largest magnitude of the effects' sum within the ranges \[N·m\], and their names.
    pub(super) effects: f64,
    /// Terms that the slopes do not include, because they read the input.
    pub(super) left_out: Vec<String>,
    /// 95 % intervals by name, as in the file.
    pub(super) about: About,
}

impl Plant {
    /// The note on a model whose record does not state its units.
    pub(super) fn without_unit(&self) -> Option<&'static str> {
        let stated = |end: &str| self.about.units.contains_key(end);
        (!(stated("input") && stated("output"))).then_some(
            "the record has no torque unit, so N·m is assumed. If the unit is mN·m, all limits are a thousand times too wide",
        )
    }

    /// The plant of a model file. The error is one sentence without the name of the file.
    pub(super) fn new(file: &ModelFile) -> Result<Self, String> {
        if file.mode != "torque" {
            return Err(format!(
                "mode {:?} must be torque, because the loop commands a torque",
                file.mode
            ));
        }
        let model = file.model::<{ bowden_lab::export::MOST_TERMS }>()?;
        let Some(cable) = model.transmission().copied() else {
            return Err("the model has no `transmission` table".to_owned());
        };
        let about = file.about.clone().ok_or(
            "the model has no `about` table, but the limits come from `about.ranges`, which `bowden identify --model-out` writes",
        )?;
        let seen = about.ranges.get("input").ok_or(
            "the model has no `about.ranges.input` table, from which the limits come; `bowden identify --model-out` writes it",
        )?;
        let (input, input_rate) = (seen.position, seen.velocity);
        for (range, name) in [(input, "position"), (input_rate, "velocity")] {
            if !(range[0].is_finite() && range[1].is_finite() && range[0] < range[1]) {
                return Err(format!(
                    "about.ranges.input.{name}: must be two numbers, the lower one first"
                ));
            }
        }
        let mut plant = Self {
            slopes: Slopes::of(&cable),
            cable,
            own_delay: 0.0,
            input,
            input_rate,
            effects: 0.0,
            left_out: Vec::new(),
            about,
        };
        for term in &file.terms {
            plant.add(term)?;
        }
        rises(file)?;
        Ok(plant)
    }

    /// Adds the contribution of a term to the delay, the slope or the disturbance.
    fn add(&mut self, term: &TermFile) -> Result<(), String> {
        let name = match term.source.as_str() {
            "input" => term.effect.clone(),
            channel => format!("{}@{channel}", term.effect),
        };
        match term.effect.as_str() {
            "delay" => self.own_delay += term.gain.max(0.0),
            "lag" => self.own_delay += term.shapes.first().map_or(0.0, |s| s.value).max(0.0),
            "gain" if term.source == "input" => {
                self.slopes.least += term.gain;
                self.slopes.greatest += term.gain;
            }
            _ if term.source == "input" => self.left_out.push(name),
            _ => self.effects += self.largest(term)?,
        }
        Ok(())
    }

    /// The largest contribution of a term over the corners and the middle of the record's ranges.
    fn largest(&self, term: &TermFile) -> Result<f64, String> {
        use bowden::effect::{EffectState, Inputs, Motion};
        let Some(span) = self.about.ranges.get(&term.source) else {
            return Err(format!(
                "the model has no `about.ranges.{}` table, but the term {} reads this channel",
                term.source, term.effect
            ));
        };
        let shapes: Vec<f64> = term.shapes.iter().map(|shape| shape.value).collect();
        let effect = bowden::effect::Effect::try_from_name(&term.effect, &shapes)
            .map_err(|e| format!("terms: {}: {e}", term.effect))?;
        let grid = 8;
        let along = |[low, high]: [f64; 2], k: usize| low + (high - low) * k as f64 / grid as f64;
        let mut most = 0.0_f64;
        for (i, j) in (0..=grid).flat_map(|i| (0..=grid).map(move |j| (i, j))) {
            for (k, load) in [(0, self.input[0]), (grid, self.input[1])] {
                let motion = Motion {
                    position: along(span.position, i) - term.origin,
                    velocity: along(span.velocity, j),
                    acceleration: along(span.acceleration, k),
                };
                let at = Inputs {
                    dt: 0.0,
                    motion,
                    input: Motion {
                        position: load,
                        ..Motion::default()
                    },
                    load,
                    ..Inputs::default()
                };
                let share = term.gain * effect.regressor(&mut EffectState::new(), &at);
                if share.is_finite() {
                    most = most.max(share.abs());
                }
            }
        }
        Ok(most)
    }

    /// Range of outputs that the recorded input reaches in both directions with saturated
    /// hysteresis \[N·m\]; `None` if the stroke is shorter than the hysteresis.
    pub(super) fn output(&self) -> Option<[f64; 2]> {
        let [low, high] = self.ends();
        (low < high).then_some([low, high])
    }

    /// Output at the ends of the recorded input range \[N·m\], each reached from inside the range.
    pub(super) fn ends(&self) -> [f64; 2] {
        let [low, high] = self.input;
        [self.cable.output(low, -1.0), self.cable.output(high, 1.0)]
    }

    /// Largest rate of the input in the record \[N·m/s\].
    pub(super) fn greatest_rate(&self) -> f64 {
        self.input_rate[1].max(-self.input_rate[0])
    }
}
