//! How far the parameters may deviate before the loop with the observer may become unstable, and
//! before learning may diverge from cycle to cycle.

use super::data_sheet::{nominal, shown};
use super::lineup::{Laws, GAIT, RATE};
use super::setup::Setup;
use bowden::Error;
use bowden_bound::{Interval, IterativeLearningConvergence, ObserverStability, PlantRange};
use bowden_rig::RigConfig;
use serde::Serialize;

/// The greatest share by which all numbers of the plant may be off at once, with the loop shown to
/// be stable, or its learning to converge, for every one of them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tolerance {
    /// The law that it is of.
    pub law: &'static str,
    /// `stability` or `convergence`.
    pub kind: &'static str,
    /// Of gain, damping ratio, c/K of the joint and latency; of wn half of it. Rounded down to
    /// 0.001, of the learning to 0.01.
    pub share: Option<f64>,
    /// Why there is none.
    pub refused: Option<String>,
    /// The plant in the middle.
    pub plant: Middle,
    /// What the user must check.
    pub assumptions: &'static [&'static str],
}

/// A plant as the rig's data sheet has it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Middle {
    /// alpha \[N·m/unit\], that of a cable without hysteresis.
    pub gain: f64,
    /// Least and greatest slope of the cable, as a share of B.
    pub slopes: [f64; 2],
    /// wn \[rad/s\].
    pub natural_frequency: f64,
    /// zeta.
    pub damping_ratio: f64,
    /// c/K of the joint \[s\].
    pub joint: f64,
    /// From command to what is measured \[s\].
    pub latency: f64,
}

/// Steps of the share that is told of a stability, from 0 to 1.
const STEPS: u32 = 1000;

/// What a cycle leaves of what is yet to be learned of a tone, at most.
const FACTOR: f64 = 0.99;

/// By how much a cycle may be longer or shorter than the gait's, as a share.
const CADENCE: f64 = 0.1;

static ASSUMPTIONS: &[&str] = &[
    "the plant is f*alpha*e^(-theta*s)/(1 + f*(s^2/wn^2 + 2*zeta*s/wn)/(1 + c/K*s)), with constant parameters",
    "the rig is of that form: the joint's inertia, and the cable's position before the hysteresis, are neglected",
    "continuous time: samples much shorter than tau and 1/wn; hold, delay and the lags of drive and sensor act as a delay",
    "friction and load are bounded disturbances; f is any constant slope of the hysteresis",
    "neither the limit of the command nor the limit of the observer is active, and no sample is bad",
];

static OF_LEARNING: &[&str] = &[
    ASSUMPTIONS[0],
    ASSUMPTIONS[1],
    "continuous time: many samples per cell; hold, delay and the lags of drive and sensor act as a delay",
    "a constant cycle time from 0.9 to 1.1 s, and a phase that is uniform in time",
    "friction and load repeat, or are bounded disturbances; f is any constant slope of the hysteresis",
    "neither the limit of the command nor the limit of the learned values is active, and no sample is bad",
    "the remaining error is not bounded: near and above the filter's corner frequency it may exceed the error without learning",
];

impl Middle {
    /// The numbers of a rig whose commands take so long to show \[s\].
    fn of(rig: &RigConfig<f64>, latency: f64) -> Result<Self, Error> {
        let sheet = nominal(rig)?;
        Ok(Self {
            gain: sheet.gain(),
            slopes: slopes(rig),
            natural_frequency: sheet.natural_frequency(),
            damping_ratio: sheet.damping_ratio(),
            joint: rig.joint_damping / rig.load_stiffness,
            latency,
        })
    }

    fn within(&self, share: f64) -> PlantRange {
        let around = |x: f64, by: f64| Interval {
            low: x * (1.0 - by),
            high: x * (1.0 + by),
        };
        PlantRange {
            gain: Interval::between(self.gain * (1.0 - share), self.gain * (1.0 + share)),
            slope: Interval {
                low: self.slopes[0],
                high: self.slopes[1],
            },
            natural_frequency: around(self.natural_frequency, 0.5 * share),
            damping_ratio: around(self.damping_ratio, share),
            joint: around(self.joint, share),
            latency: around(self.latency, share),
        }
    }
}

/// The tolerance of the setup's PI with its observer, about the numbers of its rig.
///
/// # Errors
/// One sentence where the core refuses the gains or the rig's numbers.
pub fn tolerance(setup: &Setup) -> Result<Tolerance, String> {
    let laws = laws(setup)?;
    let plant = middle(setup, laws.observer.latency())?;
    let stable = |share: f64| {
        let range = plant.within(share);
        ObserverStability::try_new(&laws.observer, &laws.observed_pi, &range).map(drop)
    };
    let (share, refused) = found(stable, most);
    Ok(Tolerance {
        law: "pi-observer",
        kind: "stability",
        share,
        refused,
        plant,
        assumptions: ASSUMPTIONS,
    })
}

/// The same of the setup's PI with its learning, over a gait whose cycle is a tenth longer or shorter.
///
/// # Errors
/// As [`tolerance`].
pub fn convergence(setup: &Setup) -> Result<Tolerance, String> {
    let laws = laws(setup)?;
    let plant = middle(setup, shown(&setup.rig, RATE))?;
    let cycle = Interval {
        low: GAIT * (1.0 - CADENCE),
        high: GAIT * (1.0 + CADENCE),
    };
    let (learning, cells) = (&laws.learning.learning, laws.learning.cells);
    let converges = |share: f64| {
        let (law, range) = (&laws.learning_pi, plant.within(share));
        IterativeLearningConvergence::try_new(learning, cells, &cycle, law, &range, FACTOR)
            .map(drop)
    };
    let (share, refused) = found(converges, most_in_hundredths);
    Ok(Tolerance {
        law: "pi-learning",
        kind: "convergence",
        share,
        refused,
        plant,
        assumptions: OF_LEARNING,
    })
}

fn laws(setup: &Setup) -> Result<Laws, String> {
    Laws::new(setup).map_err(|(what, e)| format!("[{what}]: {e}"))
}

fn middle(setup: &Setup, latency: f64) -> Result<Middle, String> {
    Middle::of(&setup.rig, latency).map_err(|e| format!("[rig]: {e}"))
}

/// The greatest share that is shown, or why the rig's own plant is not.
fn found<S: Fn(f64) -> Result<(), Error>>(
    shown: S,
    most: fn(&S) -> f64,
) -> (Option<f64>, Option<String>) {
    match shown(0.0) {
        Ok(()) => (Some(most(&shown)), None),
        Err(e) => (None, Some(e.to_string())),
    }
}

/// Least and greatest slope of the torque over the input torque, as a share of B: along a path
/// `d eta/d tau_i` is `rho·(1 − |eta|^n)` away from zero and `rho·(1 + (2·sigma − 1)·|eta|^n)` towards
/// it, so between `rho·min(0, 2·sigma)` and `rho·max(1, 2·sigma)`.
fn slopes(rig: &RigConfig<f64>) -> [f64; 2] {
    let share = rig.kappa_eta * rig.rho / rig.b;
    let (least, most) = ((2.0 * rig.sigma).min(0.0), (2.0 * rig.sigma).max(1.0));
    let (a, b) = (1.0 - share * most, 1.0 - share * least);
    [a.min(b), a.max(b)]
}

/// The greatest share that is shown: of a wider range nothing more can be, so halving finds it.
fn most<S: Fn(f64) -> Result<(), Error>>(shown: &S) -> f64 {
    let share = |step: u32| f64::from(step) / f64::from(STEPS);
    let (mut good, mut bad) = (0, STEPS);
    while bad - good > 1 {
        let middle = u32::midpoint(good, bad);
        match shown(share(middle)) {
            Ok(()) => good = middle,
            Err(_) => bad = middle,
        }
    }
    share(good)
}

/// The same by steps of 0.01: a proof that fails takes far longer than one that does not.
fn most_in_hundredths<S: Fn(f64) -> Result<(), Error>>(shown: &S) -> f64 {
    let share = |step: u32| f64::from(step) / 100.0;
    let failed = (1..100).find(|step| shown(share(*step)).is_err());
    share(failed.map_or(99, |step| step - 1))
}
