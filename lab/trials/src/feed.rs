//! The identified model along the reference, as a feed-forward without noise.
//!
//! The motions that the effects read are computed from the reference. The motion of the joint
//! follows from its identified spring. The motion of the proximal pulley follows from the stretch
//! of the cable under the torque that the baseline transmission needs. No measured signal is used,
//! so neither noise nor an unstable zero of an effect can make the loop diverge.

use bowden::control::{BenchRange, Changed, Compensator, CompensatorInput, CompensatorState};
use bowden::effect::Motion;
use bowden::model::{Model, Source, Term};
use bowden::signal::{Derivative, DerivativeState};
use bowden_lab::export::MOST_TERMS;
use bowden_rig::Reference;

/// Parameters of the drive and the load, from a bench record or from nominal values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surroundings {
    /// Motor torque per command unit \[N·m/unit\].
    pub drive_gain: f64,
    /// Viscous friction of motor and proximal pulley \[N·m·s/rad\].
    pub motor_damping: f64,
    /// Inertia of motor and proximal pulley \[kg·m²\].
    pub motor_inertia: f64,
    /// Stiffness of the load's spring \[N·m/rad\].
    pub load_stiffness: f64,
    /// Damping of the joint \[N·m·s/rad\].
    pub joint_damping: f64,
    /// Stiffness of the cable \[N·m/rad\].
    pub cable_stiffness: f64,
    /// Time from a command to its torque \[s\].
    pub latency: f64,
}

/// Output of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fed {
    /// The command of the model \[units\].
    pub command: f64,
    /// The contribution of the effects to the output \[N·m\].
    pub effects: f64,
}

/// Time constant that smooths the rates of the torque \[s\].
const SMOOTHING: f64 = 0.005;

/// One pass: the effects of one motion, then the inverse of the transmission.
#[derive(Debug, Clone)]
struct Pass {
    compensator: Compensator<f64, MOST_TERMS>,
    state: CompensatorState<f64, MOST_TERMS>,
    derivative: Derivative<f64>,
    rates: [DerivativeState<f64>; 2],
    /// The torque that this pass needs, with its rates.
    torque: Motion<f64>,
}

impl Pass {
    fn new(compensator: Compensator<f64, MOST_TERMS>) -> Result<Self, bowden::Error> {
        Ok(Self {
            compensator,
            state: CompensatorState::new(),
            derivative: Derivative::try_new(SMOOTHING)?,
            rates: [DerivativeState::new(); 2],
            torque: Motion::default(),
        })
    }

    fn step(&mut self, at: &CompensatorInput<f64>) -> f64 {
        let out = self.compensator.step(&mut self.state, at);
        let [first, second] = &mut self.rates;
        let velocity = self.derivative.step(first, out.command, at.dt);
        self.torque = Motion {
            position: out.command,
            velocity,
            acceleration: self.derivative.step(second, velocity, at.dt),
        };
        out.effects
    }
}

/// An identified model as a feed-forward along a reference that is known in advance.
#[derive(Debug, Clone)]
pub struct FeedForward {
    surroundings: Surroundings,
    /// The first pass has no effects. Each further pass uses the effects of the motion from the
    /// previous pass.
    passes: Vec<Pass>,
    channels: Vec<Channel>,
    changed: Changed<f64, MOST_TERMS>,
    changed_words: String,
}

/// The pulley that a channel of the model measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Channel {
    Proximal,
    Distal,
}

impl FeedForward {
    /// A feed-forward from a model, the names of its channels, and the ranges of the bench record.
    ///
    /// If the model has no inverse, the nearest invertible model is used
    /// ([`Compensator::try_nearest`]); [`changed`](Self::changed) states the differences.
    ///
    /// # Errors
    /// A message if the model cannot be inverted.
    pub fn new(
        model: &Model<f64, MOST_TERMS>,
        channels: &[String],
        ranges: &[BenchRange<f64>],
        surroundings: Surroundings,
    ) -> Result<Self, String> {
        let refused = |e: bowden::Error| format!("the feed-forward from the model: {e}");
        let (nearest, changed) = Compensator::try_nearest(model).map_err(refused)?;
        let is_fed = |place: usize| changed.left_out().all(|left_out| left_out != place);
        let changed_words = bowden_lab::export::invertible::words(&changed, model.terms());
        let places = model.terms().iter().enumerate();
        let terms: Vec<&Term<f64>> = places
            .filter_map(|(place, term)| is_fed(place).then_some(term))
            .collect();
        let channels = channels
            .iter()
            .map(|name| match name.as_str() {
                "phi_p" => Ok(Channel::Proximal),
                "phi_d" => Ok(Channel::Distal),
                other => Err(format!(
                    "the feed-forward from the model: channel {other:?} is neither phi_p nor phi_d"
                )),
            })
            .collect::<Result<Vec<_>, _>>()?;
        let read: Vec<BenchRange<f64>> = ranges
            .iter()
            .filter(|range| {
                range.source == Source::Input || terms.iter().any(|t| t.source == range.source)
            })
            .copied()
            .collect();
        let bare = Model::try_new(Some(*nearest.transmission()), &[]).map_err(refused)?;
        let bare = Compensator::try_new(&bare).map_err(refused)?;
        let mut passes = vec![Pass::new(bare).map_err(refused)?];
        if !terms.is_empty() {
            let with_effects = nearest.with_ranges(&read).map_err(refused)?;
            for _ in 0..2 {
                passes.push(Pass::new(with_effects).map_err(refused)?);
            }
        }
        // The rig starts at rest: from there the hysteresis is loaded.
        let rest = vec![Motion::default(); channels.len()];
        for pass in &mut passes {
            pass.step(&CompensatorInput {
                channels: &rest,
                ..CompensatorInput::new(SMOOTHING, 0.0)
            });
        }
        Ok(Self {
            surroundings,
            passes,
            channels,
            changed,
            changed_words,
        })
    }

    /// The differences between the model of the feed-forward and the given model.
    #[must_use]
    pub fn changed(&self) -> &Changed<f64, MOST_TERMS> {
        &self.changed
    }

    /// These differences in words, if there are any.
    #[must_use]
    pub fn changed_words(&self) -> Option<&str> {
        (!self.changed_words.is_empty()).then_some(&self.changed_words)
    }

    /// Computes one sample for the reference at the time when the command becomes torque.
    pub fn step(&mut self, reference: &Reference<f64>, t: f64, dt: f64) -> Fed {
        let s = &self.surroundings;
        // Held over one sample, the command acts half of one later in the mean.
        let wanted = reference.motion(t + s.latency + 0.5 * dt);
        let slack = s.joint_damping / s.load_stiffness;
        let distal = Motion {
            position: (wanted.position - slack * wanted.velocity) / s.load_stiffness,
            velocity: (wanted.velocity - slack * wanted.acceleration) / s.load_stiffness,
            acceleration: wanted.acceleration / s.load_stiffness,
        };
        let (mut torque, mut proximal) = (Motion::default(), distal);
        let mut effects = 0.0;
        for pass in &mut self.passes {
            let motions: Vec<Motion<f64>> = self
                .channels
                .iter()
                .map(|channel| match channel {
                    Channel::Proximal => proximal,
                    Channel::Distal => distal,
                })
                .collect();
            effects = pass.step(&CompensatorInput {
                input: torque,
                load: torque.position,
                channels: &motions,
                ..CompensatorInput::new(dt, wanted.position)
            });
            torque = pass.torque;
            let stretched =
                |of_joint: f64, of_torque: f64| of_joint + of_torque / s.cable_stiffness;
            proximal = Motion {
                position: stretched(distal.position, torque.position),
                velocity: stretched(distal.velocity, torque.velocity),
                acceleration: stretched(distal.acceleration, torque.acceleration),
            };
        }
        let motor = torque.position
            + s.motor_damping * proximal.velocity
            + s.motor_inertia * proximal.acceleration;
        Fed {
            command: motor / s.drive_gain,
            effects,
        }
    }
}
