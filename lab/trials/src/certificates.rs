//! Certificates for the control laws of a setup, with their assumptions.

use super::setup::Setup;
use super::trial::RATE;
use bowden::control::{Adaptive, AdaptiveSettings, Estimator, Form};
use bowden::Error;
use bowden_bound::{
    Certificate, Interval, Known, PeakContinuous, PeakSampled, PerStep, Plant, Rms, RmsSampled,
    Theorem1, Tightest,
};
use bowden_rig::RigConfig;
use serde::Serialize;
use std::collections::BTreeMap;

/// One certificate of one law, or the reason why there is none.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Promise {
    /// The control law.
    pub law: String,
    /// The theorem: `theorem1`, `theorem1-tightest`, `rms`, `peak-continuous`, `peak-sampled`,
    /// `per-step`, `rms-sampled`.
    pub kind: &'static str,
    /// The bounded quantity.
    pub bounds: Option<&'static str>,
    /// The bound \[N·m\].
    pub value: Option<f64>,
    /// Unit of the value.
    pub unit: &'static str,
    /// Whether the bound is vacuous: larger than the largest reference.
    pub vacuous: bool,
    /// The violated condition, if there is no value.
    pub refused: Option<String>,
    /// The assumptions that the user must check.
    pub assumptions: &'static [&'static str],
    /// The largest term of the bound and its fraction of all terms, if reported.
    pub mostly: Option<Mostly>,
}

/// The largest term of a bound.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Mostly {
    /// Name of the term.
    pub term: &'static str,
    /// Fraction of the sum of all terms.
    pub share: f64,
}

/// Largest reference of the paper's experiment \[N·m\].
const REFERENCE: f64 = 38.0;

/// The known ranges of the rig as the plant (11), with beta known to within `spread`.
fn plant(rig: &RigConfig<f64>, spread: f64) -> Plant<f64, 2> {
    let alpha = rig.drive_gain * rig.b;
    let slope = rig.rho * (2.0 * rig.sigma).max(1.0) * rig.kappa_eta;
    // Velocity and acceleration of the proximal pulley while the reference is followed.
    let compliance = 1.0 / rig.load_stiffness + 1.0 / rig.cable_stiffness;
    let reference_rate = 22.24; // y_r' of the paper's experiment [N·m/s]
    let speed = reference_rate * compliance;
    let acceleration = 39.0 * compliance; // |y_r''| <= 10·(pi/2)² + 3·(2·pi·0.346)²
    let known = |theta: f64, magnitude: f64, rate: f64| Known {
        theta: Interval::exactly(theta),
        magnitude,
        rate,
    };
    Plant {
        alpha: Interval {
            low: alpha * (1.0 - spread),
            high: alpha * (1.0 + spread),
        },
        delta_rate: slope / (rig.b - slope).max(1e-6) * reference_rate,
        reference: REFERENCE,
        reference_rate,
        regressors: [
            known(rig.b * rig.motor_damping, speed, acceleration),
            known(rig.b * rig.motor_inertia, acceleration, 80.0 * compliance),
        ],
        ..Plant::new(alpha, rig.kappa_eta + rig.t0.abs())
    }
}

fn line(law: &str, kind: &'static str, certificate: Result<Certificate<f64>, Error>) -> Promise {
    match certificate {
        Ok(certificate) => Promise {
            law: law.to_owned(),
            kind,
            bounds: Some(certificate.bounds()),
            value: Some(certificate.value),
            unit: certificate.unit(),
            vacuous: certificate.value > REFERENCE,
            refused: None,
            assumptions: certificate.assumptions(),
            mostly: None,
        },
        Err(e) => Promise {
            law: law.to_owned(),
            kind,
            bounds: None,
            value: None,
            unit: "N·m",
            vacuous: false,
            refused: Some(e.to_string()),
            assumptions: &[],
            mostly: None,
        },
    }
}

/// Theorem 1 with the best choice of its free constants, and the dominant term.
fn tightest(law: &str, found: Result<Tightest<f64>, Error>) -> Promise {
    let blamed = found.map(|found| found.dominant_term());
    Promise {
        mostly: blamed.ok().map(|(term, share)| Mostly { term, share }),
        ..line(law, "theorem1-tightest", found.map(|c| c.certificate()))
    }
}

/// The assumptions of the machine-checked box: a constant reference and a constant disturbance.
const RESTING: &str = "first-order form, 1 kHz, constant |D| <= 8 N·m, g 20 %";

/// The law of the proofs: the setup's gains in first-order form, g = alpha·beta_hat in 0.8..=1.2.
fn resting(settings: &AdaptiveSettings<f64, 2>) -> Result<Adaptive<f64, 0>, Error> {
    let lag = Form::FirstOrder {
        step: 1.0 / RATE,
        plant_gain: 1.0,
    };
    let gains = AdaptiveSettings::unlimited(lag, settings.gain, settings.lambda, settings.epsilon);
    Adaptive::try_new(AdaptiveSettings {
        beta: Estimator {
            initial: 1.0,
            ..settings.beta
        }
        .within(0.8, 1.2),
        delta: Estimator {
            initial: 0.0,
            ..settings.delta
        }
        .within(0.0, 4.0),
        ..gains
    })
}

/// The certificates of the form as published.
fn continuous(name: &str, law: &Adaptive<f64, 2>, known: &Plant<f64, 2>) -> Vec<Promise> {
    let peak = PeakContinuous::try_new(law, known);
    vec![
        line(
            name,
            "theorem1",
            Theorem1::try_new(law, known).map(|c| c.certificate()),
        ),
        tightest(name, Tightest::try_new(law, known)),
        line(
            name,
            "rms",
            Rms::try_new(law, known).map(|c| c.certificate()),
        ),
        line(name, "peak-continuous", peak.map(|c| c.certificate())),
    ]
}

/// The certificates of the laws of the setup, both without changes and with the bounds that
/// firmware would set.
///
/// # Errors
/// A message if the core rejects the gains.
pub fn all(setup: &Setup) -> Result<Vec<Promise>, String> {
    let refused = |e: Error| format!("[adaptive]: {e}");
    let settings = setup.adaptive.paper_settings();
    let law = Adaptive::try_new(settings).map_err(refused)?;
    let known = plant(&setup.rig, 0.0);
    let as_given = "adaptive, as given";
    let mut lines = continuous(as_given, &law, &known);
    let alpha = known.alpha.low;
    let boxed = |spread: f64, form: Form<f64>, epsilon: f64| {
        let wide = |at: f64, by: f64| (at * (1.0 - by), at * (1.0 + by));
        let (low, high) = wide(1.0 / alpha, spread);
        let beta = Estimator {
            initial: 1.0 / alpha,
            ..settings.beta
        };
        let delta = Estimator {
            initial: settings.delta.initial.clamp(0.0, known.delta),
            ..settings.delta
        };
        let theta = |i: usize| {
            let truth = known.regressors[i].theta.high;
            let (low, high) = wide(truth, 0.3);
            Estimator {
                initial: truth,
                ..settings.theta[i]
            }
            .within(low, high)
        };
        Adaptive::try_new(AdaptiveSettings {
            form,
            epsilon,
            beta: beta.within(low, high),
            delta: delta.within(0.0, known.delta),
            theta: [theta(0), theta(1)],
            ..settings
        })
    };
    let lag = Form::FirstOrder {
        step: 1.0 / RATE,
        plant_gain: alpha,
    };
    let resting = resting(&settings).and_then(|law| {
        let peak = PeakSampled::try_new(&law, &Plant::new(1.0, 8.0))?;
        Ok(peak.certificate())
    });
    lines.push(line(RESTING, "peak-sampled", resting));
    // Wide enough for one sample of delay: h·lambda·g·(k + Delta/epsilon) <= 1.
    let epsilon = settings.epsilon.max(0.2);
    for spread in [0.0, 0.05, 0.10, 0.20, 0.30] {
        let percent = 100.0 * spread;
        let name = format!("adaptive, bounded, beta within {percent:.0} %");
        let continuous = boxed(spread, settings.form, settings.epsilon)
            .and_then(|law| PeakContinuous::try_new(&law, &known))
            .map(|c| c.certificate());
        lines.push(line(&name, "peak-continuous", continuous));
        let name = format!("first-order form, 1 kHz, bounded, beta within {percent:.0} %");
        let sampled = boxed(spread, lag, epsilon);
        let peak = sampled.and_then(|law| PeakSampled::try_new(&law, &known));
        lines.push(line(&name, "peak-sampled", peak.map(|c| c.certificate())));
        if spread == 0.05 {
            let step = sampled.and_then(|law| PerStep::try_new(&law, &known));
            lines.push(line(&name, "per-step", step.map(|c| c.certificate())));
            let rms = sampled.and_then(|law| RmsSampled::try_new(&law, &known));
            lines.push(line(&name, "rms-sampled", rms.map(|c| c.certificate())));
        }
    }
    Ok(lines)
}

/// The certificate of each controller of `bowden compare`, by name.
///
/// # Errors
/// The same as [`all`].
pub fn named(setup: &Setup) -> Result<BTreeMap<String, Promise>, String> {
    let lines = all(setup)?;
    let rms = lines.iter().find(|l| l.kind == "rms" && l.value.is_some());
    Ok(rms
        .map(|line| ("adaptive".to_owned(), line.clone()))
        .into_iter()
        .collect())
}
