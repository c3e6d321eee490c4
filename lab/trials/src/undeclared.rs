//! Effects that are active in the rig without the knowledge of the controllers.
//!
//! Shapes are relative to the motion of the joint along the reference. The gain is chosen so that
//! the contribution of the effect along the reference has the requested rms value.

use super::trial::FROM;
use bowden::effect::{Effect, EffectState, Inputs, Motion, Quantity, CATALOGUE};
use bowden::model::{Source, Term};
use bowden_rig::{Reference, RigConfig};

/// Default contribution of an effect \[N·m rms\].
///
/// With larger contributions of some effects, a loop with the paper's gains is unstable. A viscous
/// joint delays its own torque, and friction that decreases with speed is self-exciting.
#[must_use]
pub fn usual_strength(name: &str) -> f64 {
    match name {
        "stribeck" => 0.1,
        "viscous" | "drag-quadratic" | "drag-cubic" | "power-law" => 0.2,
        _ => 0.5,
    }
}

/// The argument of `--effect`: NAME, NAME:STRENGTH or NAME@CHANNEL:STRENGTH.
#[derive(Debug, Clone, PartialEq)]
pub struct Undeclared {
    /// The effect's own name.
    pub name: String,
    /// `phi_p`, `phi_d` or `tau_i`; the usual channel if `None`.
    pub channel: Option<String>,
    /// Contribution along the reference \[N·m rms\].
    pub strength: f64,
}

impl Undeclared {
    /// Reads the text of `--effect`.
    ///
    /// # Errors
    /// A message with the allowed values.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (what, strength) = match text.split_once(':') {
            None => (text, None),
            Some((what, strength)) => {
                let value: f64 = strength.parse().map_err(|_| {
                    format!(
                        "--effect {text}: {strength:?} is not a number [N·m]; write NAME:STRENGTH"
                    )
                })?;
                if !(value.is_finite() && value > 0.0) {
                    return Err(format!(
                        "--effect {text}: the strength [N·m] must be positive"
                    ));
                }
                (what, Some(value))
            }
        };
        let (name, channel) = match what.split_once('@') {
            None => (what, None),
            Some((name, channel)) => (name, Some(channel.to_owned())),
        };
        if !CATALOGUE.iter().any(|info| info.name == name) {
            let names: Vec<&str> = CATALOGUE.iter().map(|info| info.name).collect();
            return Err(format!(
                "--effect {text}: the effect must be one of {}",
                names.join(", ")
            ));
        }
        Ok(Self {
            name: name.to_owned(),
            channel,
            strength: strength.unwrap_or_else(|| usual_strength(name)),
        })
    }

    /// The term, for a rig that follows the reference.
    ///
    /// # Errors
    /// A message if the rig has no such channel, or if the effect is always zero.
    pub fn term(
        &self,
        rig: &RigConfig<f64>,
        reference: &Reference<f64>,
    ) -> Result<Term<f64>, String> {
        let name = self.name.as_str();
        let source = match self.channel.as_deref() {
            None => usual(name).ok_or_else(|| {
                format!("--effect {name}: the rig has no channel that this effect can read")
            })?,
            Some("tau_i") => Source::Input,
            Some("phi_p") => Source::Channel(0),
            Some("phi_d") => Source::Channel(1),
            Some(other) => {
                return Err(format!(
                    "--effect {name}@{other}: the channel must be tau_i, phi_p or phi_d"
                ))
            }
        };
        let path = Path::new(rig, reference);
        let motions = path.motions(source);
        let (middle, reach, speed) = extent(motions);
        let shapes = shapes(name, reach, speed);
        let effect =
            Effect::try_from_name(name, &shapes).map_err(|e| format!("--effect {name}: {e}"))?;
        let origin = match effect.info().reads.contains(&Quantity::Position) {
            // Friction that rises along the way; nowhere on the rig does it push.
            true if name == "position-friction" => middle - 4.0 * reach,
            true => middle,
            false => 0.0,
        };
        let term = |gain| Term {
            effect,
            source,
            origin,
            gain,
        };
        // A delay in seconds, a lag in whole: what reads the sum has no share of its own.
        match name {
            "delay" => return Ok(term(0.010 * self.strength)),
            "lag" => return Ok(term(1.0)),
            _ => {}
        }
        let rms = path.rms(&term(1.0));
        if !(rms > 0.0 && rms.is_finite()) {
            return Err(format!(
                "--effect {name}: this effect is always zero on the rig"
            ));
        }
        // Friction takes away from the torque that arrives.
        Ok(term(-self.strength / rms))
    }
}

/// The usual channel of an effect, if the effect reads a channel.
fn usual(name: &str) -> Option<Source> {
    match name {
        "temperature" | "crosstalk" | "stretch-linear" | "stretch-cubic" => None,
        "gain" | "rate" | "rate-symmetric" | "creep" | "saturation-upper" | "saturation-lower" => {
            Some(Source::Input)
        }
        _ => Some(Source::Channel(1)),
    }
}

/// Plausible shapes, in the order of the core.
fn shapes(name: &str, reach: f64, speed: f64) -> Vec<f64> {
    match name {
        "coulomb"
        | "load-friction"
        | "position-friction"
        | "drive-friction"
        | "back-drive-friction" => vec![0.08 * speed],
        "stribeck" => vec![0.3 * speed, 1.3],
        "capstan" => vec![0.08 * speed, 0.3 / reach],
        // Two and a half waves over what the reference covers.
        "ripple" => vec![2.5 * std::f64::consts::PI / reach, 0.4],
        "gravity" => vec![0.4],
        "hinge" => vec![0.1 * reach],
        "backlash" | "dead-zone" => vec![0.15 * reach],
        "lag" => vec![0.02],
        "creep" => vec![1.0],
        "presliding" | "presliding-dahl" => vec![0.2 * reach],
        "degradation" => vec![100.0],
        "pinching" => vec![0.3],
        "pretension" => vec![15.0],
        "saturation-upper" => vec![0.7 * reach],
        "saturation-lower" => vec![-0.7 * reach],
        "tone" => vec![3.3, 0.4],
        "hardening" => vec![0.3 / reach, 1.0 / reach],
        "power-law" => vec![0.4],
        "curve-position" => vec![-0.2 * reach, 0.5 * reach],
        "curve-velocity" => vec![-0.2 * speed, 0.5 * speed],
        _ => Vec::new(),
    }
}

/// The motion of the rig along the reference with an ideal controller.
struct Path {
    input: Vec<Motion<f64>>,
    proximal: Vec<Motion<f64>>,
    distal: Vec<Motion<f64>>,
}

/// Time step for the computation of strengths along the reference \[s\].
const STEP: f64 = 0.005;

impl Path {
    fn new(rig: &RigConfig<f64>, reference: &Reference<f64>) -> Self {
        let scaled = |m: Motion<f64>, by: f64| Motion {
            position: m.position * by,
            velocity: m.velocity * by,
            acceleration: m.acceleration * by,
        };
        // A minute from where errors count.
        let times = (0..(60.0 / STEP) as usize).map(|k| FROM + STEP * k as f64);
        let input: Vec<_> = times.map(|t| reference.motion(t)).collect();
        let distal = 1.0 / rig.load_stiffness;
        let proximal = distal + 1.0 / rig.cable_stiffness;
        Self {
            distal: input.iter().map(|m| scaled(*m, distal)).collect(),
            proximal: input.iter().map(|m| scaled(*m, proximal)).collect(),
            input,
        }
    }

    fn motions(&self, source: Source) -> &[Motion<f64>] {
        match source {
            Source::Input => &self.input,
            Source::Channel(0) => &self.proximal,
            Source::Channel(_) => &self.distal,
        }
    }

    /// Rms of the contribution, or of its variation if the effect is not constant.
    fn rms(&self, term: &Term<f64>) -> f64 {
        let mut memory = EffectState::new();
        let values: Vec<f64> = self
            .motions(term.source)
            .iter()
            .zip(&self.input)
            .enumerate()
            .map(|(k, (motion, input))| {
                let mut motion = *motion;
                motion.position -= term.origin;
                let at = Inputs {
                    dt: STEP,
                    time: STEP * k as f64,
                    motion,
                    input: *input,
                    load: input.position,
                    eta: input.velocity.signum(),
                    output: input.position,
                };
                term.gain * term.effect.regressor(&mut memory, &at)
            })
            .collect();
        let n = values.len() as f64;
        let square = values.iter().map(|v| v * v).sum::<f64>() / n;
        if term.effect.name() == "offset" {
            return square.sqrt();
        }
        let mean = values.iter().sum::<f64>() / n;
        (square - mean * mean).max(0.0).sqrt()
    }
}

/// Middle and half of the range, and rms speed.
fn extent(motions: &[Motion<f64>]) -> (f64, f64, f64) {
    let positions = motions.iter().map(|m| m.position);
    let low = positions.clone().fold(f64::INFINITY, f64::min);
    let high = positions.fold(f64::NEG_INFINITY, f64::max);
    let square: f64 = motions.iter().map(|m| m.velocity * m.velocity).sum();
    (
        0.5 * (low + high),
        0.5 * (high - low),
        (square / motions.len().max(1) as f64).sqrt(),
    )
}
