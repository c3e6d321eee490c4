//! The parameter deviations up to which the loop with the observer is proved stable, and iterative
//! learning is proved to converge.

use super::data_sheet::{nominal, shown};
use super::lineup::{Laws, GAIT};
use super::setup::Setup;
use super::trial::RATE;
use bowden::Error;
use bowden_bound::{Interval, IterativeLearningConvergence, ObserverStability, PlantRange};
use bowden_rig::RigConfig;
use serde::Serialize;

/// The largest fraction by which all parameters of the plant may deviate simultaneously. Up to this
/// fraction, the loop is proved stable, or its iterative learning is proved to converge.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tolerance {
    /// The control law.
    pub law: &'static str,
    /// `stability` or `convergence`.
    pub kind: &'static str,
    /// Tolerance of gain, damping ratio, c/K of the joint and latency, and twice the tolerance of
    /// wn. The value is rounded down to 0.001, or to 0.01 for iterative learning.
    pub share: Option<f64>,
    /// The reason why there is no tolerance.
    pub refused: Option<String>,
    /// The plant at the centre.
    pub plant: Middle,
    /// The assumptions that the user must check.
    pub assumptions: &'static [&'static str],
}

/// The nominal plant of the rig.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Middle {
    /// alpha \[N·m/unit\] of a cable without hysteresis.
    pub gain: f64,
    /// Smallest and largest slope of the cable, as fractions of B.
    pub slopes: [f64; 2],
    /// wn \[rad/s\].
    pub natural_frequency: f64,
    /// zeta.
    pub damping_ratio: f64,
    /// c/K of the joint \[s\].
    pub joint: f64,
    /// Time from a command to its effect in the measurement \[s\].
    pub latency: f64,
}

static ASSUMPTIONS: &[&str] = &[
    "the plant is f*alpha*e^(-theta*s)/(1 + f*(s^2/wn^2 + 2*zeta*s/wn)/(1 + c/K*s)), with constant parameters",
    "for the rig, this form neglects the inertia of the joint and treats the elasticity of the cable as if it were downstream of the hysteresis",
    "continuous time: the sampling period is much shorter than tau and 1/wn; the hold, the delay and the lags of drive and sensor act as one delay",
    "friction and load are bounded disturbances; f is any constant slope of the hysteresis",
    "neither the command limit nor the limit of the observer is active, and no sample is bad",
];

static OF_LEARNING: &[&str] = &[
    ASSUMPTIONS[0],
    ASSUMPTIONS[1],
    "continuous time: many samples per cell; the hold, the delay and the lags of drive and sensor act as one delay",
    "a constant cycle time from 0.9 to 1.1 s, and a phase that advances at a constant rate",
    "friction and load repeat, or are bounded disturbances; f is any constant slope of the hysteresis",
    "neither the command limit nor the limit of the learned values is active, and no sample is bad",
    "no bound on the remaining error is proved; near and above the corner frequency of the filter, it may exceed the error without iterative learning",
];

impl Middle {
    /// The nominal plant of a rig with this latency \[s\].
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

/// The tolerance of the setup's PI with its observer, around the parameters of its rig.
///
/// # Errors
/// A message if the core rejects the gains or the rig's parameters.
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

/// The tolerance of the setup's PI with iterative learning, over a gait whose cycle is up to a
/// tenth longer or shorter.
///
/// # Errors
/// The same as [`tolerance`].
pub fn convergence(setup: &Setup) -> Result<Tolerance, String> {
    let laws = laws(setup)?;
    let plant = middle(setup, shown(&setup.rig, RATE))?;
    let cycle = Interval {
        low: 0.9 * GAIT,
        high: 1.1 * GAIT,
    };
    let (learning, cells) = (&laws.learning.learning, laws.learning.cells);
    // What a cycle leaves of what is yet to be learned of a tone, at most.
    let factor = 0.99;
    let converges = |share: f64| {
        let (law, range) = (&laws.learning_pi, plant.within(share));
        IterativeLearningConvergence::try_new(learning, cells, &cycle, law, &range, factor)
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

/// The largest proved tolerance, or the reason why there is no proof for the nominal plant of the
/// rig.
fn found<S: Fn(f64) -> Result<(), Error>>(
    shown: S,
    most: fn(&S) -> f64,
) -> (Option<f64>, Option<String>) {
    match shown(0.0) {
        Ok(()) => (Some(most(&shown)), None),
        Err(e) => (None, Some(e.to_string())),
    }
}

/// Smallest and largest slope of the torque versus the input torque, as fractions of B. Along a
/// path, `d eta/d tau_i` is `rho·(1 − |eta|^n)` away from zero and
/// `rho·(1 + (2·sigma − 1)·|eta|^n)` towards zero. It is therefore between `rho·min(0, 2·sigma)`
/// and `rho·max(1, 2·sigma)`.
fn slopes(rig: &RigConfig<f64>) -> [f64; 2] {
    let share = rig.kappa_eta * rig.rho / rig.b;
    let (least, most) = ((2.0 * rig.sigma).min(0.0), (2.0 * rig.sigma).max(1.0));
    let (a, b) = (1.0 - share * most, 1.0 - share * least);
    [a.min(b), a.max(b)]
}

/// The largest tolerance that is proved, in steps of 0.001, found by bisection. Bisection is
/// sufficient, because a wider range is never easier to prove.
fn most<S: Fn(f64) -> Result<(), Error>>(shown: &S) -> f64 {
    let share = |step: u32| f64::from(step) / 1000.0;
    let (mut good, mut bad) = (0, 1000);
    while bad - good > 1 {
        let middle = u32::midpoint(good, bad);
        match shown(share(middle)) {
            Ok(()) => good = middle,
            Err(_) => bad = middle,
        }
    }
    share(good)
}

/// The largest tolerance that is proved, in steps of 0.01 from below, because a proof that fails
/// takes much longer than a proof that succeeds.
fn most_in_hundredths<S: Fn(f64) -> Result<(), Error>>(shown: &S) -> f64 {
    let share = |step: u32| f64::from(step) / 100.0;
    let failed = (1..100).find(|step| shown(share(*step)).is_err());
    share(failed.map_or(99, |step| step - 1))
}
