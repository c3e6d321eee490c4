//! The controllers of a comparison: the four controllers of the paper, and further controllers for
//! a fair comparison.

use super::data_sheet::{latency, observer};
use super::feed::{FeedForward, Surroundings};
use super::learned::Learned;
use super::setup::{AdaptiveGains, Setup};
use super::trial::{Controller, Law, ThreeRegressors, RATE};
use bowden::control::{
    Adaptive, AdaptiveSettings, DisturbanceObserver, Estimator, Pid, PidSettings,
};
use bowden::hysteresis::BoucWen;
use bowden::model::{Model, Source, Term};
use bowden::transmission::Transmission;
use bowden_lab::export::MOST_TERMS;
use bowden_rig::RigConfig;

/// The cycle of [`Reference::gait`](bowden_rig::Reference::gait), over which iterative learning
/// works \[s\].
pub const GAIT: f64 = 1.0;

/// All laws of a setup, checked.
#[derive(Debug, Clone, Copy)]
pub struct Laws {
    /// PI (15).
    pub pi: Pid<f64>,
    /// PID (14).
    pub pid: Pid<f64>,
    /// PIV (16).
    pub piv: Pid<f64>,
    /// PI with the integral gain of the adaptive law.
    pub matched_pi: Pid<f64>,
    /// The PI with the observer.
    pub observed_pi: Pid<f64>,
    /// The observer.
    pub observer: DisturbanceObserver<f64>,
    /// The PI with iterative learning.
    pub learning_pi: Pid<f64>,
    /// Iterative learning over the cycle of the gait.
    pub learning: Learned,
    /// The adaptive law.
    pub adaptive: ThreeRegressors,
}

impl Laws {
    /// Checks every law of the setup.
    ///
    /// # Errors
    /// The table of the rejected law, and the error of the core.
    pub fn new(setup: &Setup) -> Result<Self, (&'static str, bowden::Error)> {
        let pid = |name, settings| Pid::try_new(settings).map_err(|e| (name, e));
        let paper = Pid::<f64>::paper_pi();
        Ok(Self {
            pi: pid("pi", setup.pi.over(paper.settings()))?,
            pid: pid("pid", setup.pid.over(Pid::paper_pid().settings()))?,
            piv: pid("piv", setup.piv.over_piv(Pid::paper_piv().settings()))?,
            matched_pi: pid(
                "matched_pi",
                // The effective integral gain of the paper's adaptive law: without this PI, the
                // effect of a higher gain would count as adaptation.
                setup.matched_pi.over(&PidSettings::unlimited(30.0, 320.0)),
            )?,
            observed_pi: pid(
                "observer",
                PidSettings::unlimited(setup.observer.k_p, setup.observer.k_i),
            )?,
            observer: observer(&setup.observer, &setup.rig, RATE).map_err(|e| ("observer", e))?,
            learning_pi: pid(
                "learning",
                PidSettings::unlimited(setup.learning.k_p, setup.learning.k_i),
            )?,
            learning: Learned::new(&setup.learning, GAIT, &setup.rig, RATE)
                .map_err(|e| ("learning", e))?,
            adaptive: adaptive(&setup.adaptive, 0.0).map_err(|e| ("adaptive", e))?,
        })
    }
}

/// The adaptive law with a prior for the third regressor; zero omits it.
///
/// # Errors
/// The error of the core for an invalid gain.
pub fn adaptive(gains: &AdaptiveGains, prior: f64) -> Result<ThreeRegressors, bowden::Error> {
    Adaptive::try_new(gains.settings(prior))
}

impl Surroundings {
    /// The nominal parameters of the rig.
    #[must_use]
    pub fn of(rig: &RigConfig<f64>) -> Self {
        Self {
            drive_gain: rig.drive_gain,
            motor_damping: rig.motor_damping,
            motor_inertia: rig.motor_inertia,
            load_stiffness: rig.load_stiffness,
            joint_damping: rig.joint_damping,
            cable_stiffness: rig.cable_stiffness,
            latency: latency(rig, RATE),
        }
    }
}

/// The plant model of a controller; `None` if its law has none.
#[must_use]
pub fn knows(controller: &str) -> Option<&'static str> {
    match controller {
        "pi-observer" => Some("the rig's drive gain, inertia, damping and stiffness"),
        "pi-learning" => {
            Some("the phase of the gait, and the rig's drive gain, inertia, damping and stiffness")
        }
        "adaptive-frozen" => Some("the rig's drive gain and the gain of its cable"),
        "adaptive-feed-forward" => {
            Some("the transmission of the rig, or the model given with --model")
        }
        "pi-feed-forward" => {
            Some("the transmission of the rig, which is the model given with --model")
        }
        _ => None,
    }
}

/// The eight controllers of `bowden compare`, in the order of its output, and a ninth with
/// iterative learning if the reference repeats.
///
/// # Errors
/// A message if a law is rejected or the model cannot be inverted.
pub fn lineup(setup: &Setup, repeats: bool) -> Result<Vec<Controller>, String> {
    let laws = Laws::new(setup).map_err(|(what, e)| format!("[{what}]: {e}"))?;
    let plain = |name: &str, law: Law| Controller::alone(name, law, RATE);
    let mut all = vec![
        plain("pi", Law::Pid(laws.pi)),
        plain("pid", Law::Pid(laws.pid)),
        plain("piv", Law::Pid(laws.piv)),
        plain("matched-pi", Law::Pid(laws.matched_pi)),
        Controller {
            observer: Some(laws.observer),
            ..plain("pi-observer", Law::Pid(laws.observed_pi))
        },
        plain("adaptive", Law::Adaptive(laws.adaptive)),
        plain("adaptive-frozen", Law::Adaptive(frozen(setup)?)),
        Controller {
            feed: Some(declared_feed(setup)?),
            own_share: 1.0 / (setup.rig.drive_gain * setup.rig.b),
            ..plain("adaptive-feed-forward", Law::Adaptive(laws.adaptive))
        },
    ];
    if repeats {
        all.push(Controller {
            learned: Some(laws.learning),
            ..plain("pi-learning", Law::Pid(laws.learning_pi))
        });
    }
    Ok(all)
}

/// The adaptive law with constant estimates. beta_hat corresponds to the drive gain.
fn frozen(setup: &Setup) -> Result<ThreeRegressors, String> {
    let settings = setup.adaptive.settings(0.0);
    let beta = match settings.beta.initial {
        // From the singular point nothing would ever be commanded.
        0.0 => 1.0 / (setup.rig.drive_gain * setup.rig.b),
        given => given,
    };
    Adaptive::try_new(AdaptiveSettings {
        beta: Estimator::fixed(beta),
        frozen: true,
        ..settings
    })
    .map_err(|e| format!("[adaptive]: {e}"))
}

/// The model of the setup, or the rig's own transmission, as a feed-forward.
///
/// # Errors
/// A message if the model cannot be inverted.
pub fn declared_feed(setup: &Setup) -> Result<FeedForward, String> {
    let surroundings = Surroundings::of(&setup.rig);
    match &setup.model {
        Some(file) => FeedForward::new(
            &file.model::<MOST_TERMS>()?,
            &file.channels,
            &[],
            surroundings,
        ),
        None => {
            let rig = &setup.rig;
            let none: [Term<f64>; 0] = [];
            let model = BoucWen::try_new(rig.rho, rig.sigma, rig.n)
                .and_then(|shape| Transmission::torque(rig.b, rig.kappa_eta, rig.t0, shape))
                .and_then(|cable| Model::try_new(Some(cable), &none))
                .map_err(|e| format!("[rig]: {e}"))?;
            FeedForward::new(&model, &[], &[], surroundings)
        }
    }
}

/// The signal that a term of a model reads, in words.
#[must_use]
pub fn source_name(source: Source) -> &'static str {
    match source {
        Source::Input => "tau_i",
        Source::Channel(0) => "phi_p",
        Source::Channel(_) => "phi_d",
    }
}
