//! How far a data sheet may be off before the loop with the observer may swing.

use super::data_sheet::nominal;
use super::lineup::Laws;
use super::setup::Setup;
use bowden::bound::{Interval, ObserverStability, PlantRange};
use bowden::control::{DisturbanceObserver, Pid};
use bowden_rig::RigConfig;
use serde::Serialize;

/// The greatest share by which all numbers of the plant may be off at once, with the loop shown to
/// be stable for every one of them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tolerance {
    /// The law that it is of.
    pub law: &'static str,
    /// `stability`.
    pub kind: &'static str,
    /// Of gain, damping ratio, c/K of the joint and latency; of wn half of it. Rounded down to
    /// 0.001.
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

/// Steps of the share that is told, from 0 to 1.
const STEPS: u32 = 1000;

static ASSUMPTIONS: &[&str] = &[
    "the plant is f*alpha*e^(-theta*s)/(1 + f*(s^2/wn^2 + 2*zeta*s/wn)/(1 + c/K*s)), its numbers constant",
    "the rig is of that form: the joint's inertia, and the cable's place before the hysteresis, are left out",
    "continuous time: samples much shorter than tau and 1/wn; hold, delay and the lags of drive and sensor act as a delay",
    "friction and load are disturbances that stay bounded; f is any slope of the hysteresis, and does not change",
    "neither a limit of the command nor that of the observer is met, and no sample is bad",
];

impl Middle {
    /// The numbers of a rig whose commands take so long to show \[s\].
    fn of(rig: &RigConfig<f64>, latency: f64) -> Result<Self, bowden::Error> {
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
    let laws = Laws::new(setup).map_err(|(what, e)| format!("[{what}]: {e}"))?;
    let plant =
        Middle::of(&setup.rig, laws.observer.latency()).map_err(|e| format!("[rig]: {e}"))?;
    let (share, refused) = match shown(&laws.observer, &laws.observed_pi, &plant, 0.0) {
        Ok(()) => (Some(most(&laws.observer, &laws.observed_pi, &plant)), None),
        Err(e) => (None, Some(e.to_string())),
    };
    Ok(Tolerance {
        law: "pi-observer",
        kind: "stability",
        share,
        refused,
        plant,
        assumptions: ASSUMPTIONS,
    })
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

fn shown(
    observer: &DisturbanceObserver<f64>,
    law: &Pid<f64>,
    plant: &Middle,
    share: f64,
) -> Result<(), bowden::Error> {
    ObserverStability::try_new(observer, law, &plant.within(share)).map(|_| ())
}

/// The greatest share that is shown: of a wider range nothing more can be, so halving finds it.
fn most(observer: &DisturbanceObserver<f64>, law: &Pid<f64>, plant: &Middle) -> f64 {
    let share = |step: u32| f64::from(step) / f64::from(STEPS);
    let (mut good, mut bad) = (0, STEPS);
    while bad - good > 1 {
        let middle = u32::midpoint(good, bad);
        match shown(observer, law, plant, share(middle)) {
            Ok(()) => good = middle,
            Err(_) => bad = middle,
        }
    }
    share(good)
}
