//! The simulated rig around a user's own model, and the controllers that were designed for it.

use super::feed::FeedForward;
use super::gains::GainsFile;
use super::lineup::declared_feed;
use super::setup::Setup;
use super::trial::{Controller, Law, MOST_UNDECLARED};
use bowden::control::{Adaptive, AdaptiveSettings, Estimator, OnMissing, Pid};
use bowden::model::{Source, Term};
use bowden::transmission::Transmission;
use bowden_lab::export::{ModelFile, MOST_TERMS};
use bowden_rig::{Rig, RigConfig};

/// Parameters of the rig that are given as options; the others keep their values.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RigChanges {
    /// Torque at the proximal pulley per command unit \[N·m/unit\].
    pub drive_gain: Option<f64>,
    /// Inertia of motor and proximal pulley \[kg·m²\].
    pub motor_inertia: Option<f64>,
    /// Viscous friction of motor and proximal pulley \[N·m·s/rad\].
    pub motor_damping: Option<f64>,
    /// Inertia of the distal pulley \[kg·m²\].
    pub joint_inertia: Option<f64>,
    /// Damping of the distal pulley \[N·m·s/rad\].
    pub joint_damping: Option<f64>,
    /// Stiffness of the springs that load the joint \[N·m/rad\].
    pub load_stiffness: Option<f64>,
    /// Time constant of the current loop \[s\].
    pub drive_lag: Option<f64>,
    /// Time constant of the torque sensors \[s\].
    pub sensor_lag: Option<f64>,
    /// Number of samples between a command and its effect on the drive.
    pub delay: Option<u8>,
}

impl RigChanges {
    /// Each number with its option.
    #[must_use]
    pub fn options(&self) -> [(&'static str, Option<f64>); 9] {
        [
            ("--drive-gain", self.drive_gain),
            ("--inertia", self.motor_inertia),
            ("--damping", self.motor_damping),
            ("--joint-inertia", self.joint_inertia),
            ("--joint-damping", self.joint_damping),
            ("--spring", self.load_stiffness),
            ("--delay", self.delay.map(f64::from)),
            ("--drive-lag", self.drive_lag),
            ("--sensor-lag", self.sensor_lag),
        ]
    }

    /// An error names the option with a number that is invalid for a rig.
    pub(crate) fn check(&self) -> Result<(), String> {
        for (option, value) in self.options() {
            let Some(value) = value else { continue };
            let (is_valid, allowed) = match option {
                "--damping" | "--joint-damping" => (value >= 0.0, " (0 or more)"),
                "--delay" => (value <= 8.0, " (0 to 8)"),
                _ => (value > 0.0, "; it must be positive"),
            };
            if !(is_valid && value.is_finite()) {
                return Err(format!("{option} {value} is out of range{allowed}"));
            }
        }
        Ok(())
    }

    /// The rig with these parameters. A sub-step that is too long for them is shortened.
    ///
    /// # Errors
    /// A message with the invalid parameter.
    pub fn apply(&self, rig: RigConfig<f64>) -> Result<RigConfig<f64>, String> {
        let mut rig = RigConfig {
            drive_gain: self.drive_gain.unwrap_or(rig.drive_gain),
            motor_inertia: self.motor_inertia.unwrap_or(rig.motor_inertia),
            motor_damping: self.motor_damping.unwrap_or(rig.motor_damping),
            joint_inertia: self.joint_inertia.unwrap_or(rig.joint_inertia),
            joint_damping: self.joint_damping.unwrap_or(rig.joint_damping),
            load_stiffness: self.load_stiffness.unwrap_or(rig.load_stiffness),
            drive_lag: self.drive_lag.unwrap_or(rig.drive_lag),
            sensor_lag: self.sensor_lag.unwrap_or(rig.sensor_lag),
            delay: self.delay.unwrap_or(rig.delay),
            ..rig
        };
        if !(rig.drive_gain > 0.0 && rig.drive_gain.is_finite()) {
            return Err(format!(
                "the rig: drive_gain {} is out of range; it must be positive",
                rig.drive_gain
            ));
        }
        let none: [Term<f64>; 0] = [];
        // A light rig is resolved by 64 times as many sub-steps at most.
        for _ in 0..6 {
            match Rig::<f64, 0>::try_new(rig, &none) {
                Err(bowden::Error::Inadmissible(_)) => rig.sub_step *= 0.5,
                _ => break,
            }
        }
        match Rig::<f64, 0>::try_new(rig, &none) {
            Ok(_) => Ok(rig),
            Err(e) => Err(format!("the rig: {e}")),
        }
    }
}

/// The rig with the transmission of a model.
#[must_use]
pub fn with_transmission(rig: &RigConfig<f64>, cable: &Transmission<f64>) -> RigConfig<f64> {
    let shape = cable.shape();
    RigConfig {
        b: cable.gain(),
        kappa_eta: cable.kappa_eta(),
        t0: cable.offset(),
        rho: shape.rho(),
        sigma: shape.sigma(),
        n: shape.n(),
        ..*rig
    }
}

/// The transmission of a model file.
///
/// # Errors
/// A message if the file has no transmission.
pub fn transmission(file: &ModelFile) -> Result<Transmission<f64>, String> {
    let model = file.model::<MOST_TERMS>()?;
    let cable = model.transmission().copied();
    cable.ok_or_else(|| "the model has no `transmission` table".to_owned())
}

/// The effects of a model for the rig, whose pulleys are the channels `phi_p` and `phi_d`.
///
/// # Errors
/// A message if the rig has no such channel, or if there are too many effects.
pub fn effects(file: &ModelFile) -> Result<Vec<Term<f64>>, String> {
    let model = file.model::<MOST_TERMS>()?;
    let terms = model.terms().iter().map(|term| {
        let source = match term.source {
            Source::Input => Source::Input,
            Source::Channel(index) => match file.channels.get(usize::from(index)) {
                Some(name) if name == "phi_p" => Source::Channel(0),
                Some(name) if name == "phi_d" => Source::Channel(1),
                other => {
                    let name = other.map_or("?", String::as_str);
                    let own = term.effect.name();
                    return Err(format!(
                        "the term {own}@{name} reads a channel other than phi_p and phi_d, the channels of the rig"
                    ));
                }
            },
        };
        Ok(Term { source, ..*term })
    });
    let terms: Vec<Term<f64>> = terms.collect::<Result<_, String>>()?;
    match terms.len() > MOST_UNDECLARED {
        true => Err(format!(
            "{} terms are too many; the rig accepts at most {MOST_UNDECLARED}",
            terms.len()
        )),
        false => Ok(terms),
    }
}

/// Range of the reference: four fifths of the range of outputs in the record of the model \[N·m\];
/// `None` if the file does not specify this range.
///
/// # Errors
/// A message if the record does not reach any output in both directions.
pub fn reference(file: &ModelFile, cable: &Transmission<f64>) -> Result<Option<[f64; 2]>, String> {
    let ranges = file.about.as_ref().map(|about| &about.ranges);
    let Some(seen) = ranges.and_then(|ranges| ranges.get("input")) else {
        return Ok(None);
    };
    let [low, high] = seen.position;
    let (low, high) = (cable.output(low, -1.0), cable.output(high, 1.0));
    let (middle, half) = (0.5 * (low + high), 0.4 * (high - low));
    if !(half.is_finite() && middle.is_finite()) {
        return Ok(None);
    }
    match half > 0.0 {
        true => Ok(Some([middle - half, middle + half])),
        false => Err(crate::design::TOO_SHORT.to_owned()),
    }
}

/// The controllers of a gains file, and the PI with the inverse of the model as a feed-forward.
///
/// # Errors
/// A message if a law is rejected or the model cannot be inverted.
pub fn designed(setup: &Setup, gains: &GainsFile) -> Result<Vec<Controller>, String> {
    let rate = gains.design.rate;
    let plain = Controller::alone;
    let pid = |name: &'static str, settings| {
        let law = Pid::try_new(settings).map_err(|e| format!("[{name}]: {e}"))?;
        Ok::<_, String>(Law::Pid(law))
    };
    let pi = pid("pi", gains.pi)?;
    let mut all = vec![plain("pi", pi, rate)];
    if let Some(settings) = gains.pid {
        all.push(plain("pid", pid("pid", settings)?, rate));
    }
    if let Some(settings) = gains.adaptive {
        let law = Adaptive::try_new(padded(&settings)).map_err(|e| format!("[adaptive]: {e}"))?;
        all.push(Controller {
            every: gains.adaptive_every(),
            ..plain("adaptive", Law::Adaptive(law), rate)
        });
    }
    let feed: FeedForward = declared_feed(setup)?;
    all.push(Controller {
        feed: Some(feed),
        ..plain("pi-feed-forward", pi, rate)
    });
    Ok(all)
}

/// The law without regressors as a law with three unused regressors.
fn padded(own: &AdaptiveSettings<f64, 0>) -> AdaptiveSettings<f64, 3> {
    AdaptiveSettings {
        form: own.form,
        gain: own.gain,
        lambda: own.lambda,
        epsilon: own.epsilon,
        smooth_sign: own.smooth_sign,
        beta: own.beta,
        delta: own.delta,
        theta: [Estimator::fixed(0.0); 3],
        z_limit: own.z_limit,
        frozen: own.frozen,
        missing: [OnMissing::DropRegressor; 3],
        limits: own.limits,
        longest_dt: own.longest_dt,
        fallback: own.fallback,
    }
}
