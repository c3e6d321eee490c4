//! Gains of the adaptive law in first-order form that its constructor and its certificate admit.
//!
//! On a static plant, the first-order form is an integral controller. With z = s/(p + lambda) and s
//! = (p + lambda)/p·e, its command near zero is `lambda·beta_hat·(k + delta_hat/epsilon)/p·e`.
//! Therefore `h·lambda·g⁺·(k + delta_max/epsilon)` is the integral gain of one sample. With one
//! sample of delay, the loop is unstable if this gain exceeds two, and the constructor allows at
//! most one. The design uses one half, which gives a gain margin of four. lambda is a fiftieth of
//! this bandwidth, similar to Table 2, and k and delta_max/epsilon contribute half of the gain
//! each.

use super::plant::Plant;
use crate::gains::Known;
use bowden::control::{Adaptive, AdaptiveSettings, Estimator, Fallback, Form, Limits};
use bowden_bound::{Interval, PeakSampled, Plant as Bounds};
use serde::Serialize;

/// Relative uncertainty of the drive gain.
const DRIVE: f64 = 0.02;

/// The adaptive law, or the reason why there is none.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AdaptiveDesign {
    /// Step of the law \[s\]: the smallest multiple of the sampling period that exceeds the delay.
    pub step: f64,
    /// The law is called on every Nth sample; N is this number.
    pub every: usize,
    /// Whether the delay of the plant fits into one sample at the stated rate, as the first-order
    /// form requires. Otherwise the law runs at `step`.
    pub at_the_rate: bool,
    /// h·lambda·g⁺·(k + delta_max/epsilon), at most one.
    pub loop_gain: f64,
    /// The settings; `None` if no gains are admissible.
    pub settings: Option<AdaptiveSettings<f64, 0>>,
    /// The reason why no gains are admissible.
    pub refused: Option<String>,
    /// Bound on abs(e) \[N·m\], from the proof if there is one, otherwise from the sampled peak
    /// certificate.
    pub certificate: Option<f64>,
    /// Whether `bowden certify` proves the file as written; the certificate then includes limits,
    /// slew rate and rounding errors.
    pub proved: bool,
    /// The reason why `bowden certify` does not prove the file, although there is a certificate.
    pub unproved: Option<String>,
    /// The reason why there is no certificate.
    pub uncertified: Option<String>,
    /// The ranges of the plant that the certificate assumes, if they are known.
    pub plant: Option<Known>,
    /// Names of the parameters whose bounds are ±10 %, because the model file has no interval.
    pub assumed: Vec<String>,
}

/// The loop around the adaptive law.
#[derive(Debug, Clone, Copy)]
pub(super) struct Around {
    pub(super) rate: f64,
    pub(super) delay: f64,
    pub(super) drive_gain: f64,
    pub(super) limits: Limits<f64>,
    pub(super) fallback: Fallback<f64>,
    /// Largest rate of the reference \[N·m/s\], if there is one.
    pub(super) reference_rate: Option<f64>,
}

/// The interval of a parameter, and whether the interval was assumed.
fn interval(plant: &Plant, name: &str, value: f64) -> (Interval<f64>, bool) {
    match plant.about.intervals.get(name) {
        Some(&[low, high]) if low <= value && value <= high => (Interval { low, high }, false),
        _ => {
            let (low, high) = (0.9 * value, 1.1 * value);
            (Interval::between(low, high), true)
        }
    }
}

/// The ranges of the true values: alpha, Delta, the rate of D, and the assumed ones.
struct Boxes {
    gain: Interval<f64>,
    alpha: Interval<f64>,
    delta: f64,
    assumed: Vec<String>,
}

impl Boxes {
    fn of(plant: &Plant, drive_gain: f64) -> Self {
        let cable = &plant.cable;
        let mut assumed = Vec::new();
        let mut of = |name: &str, value: f64| {
            let (interval, guessed) = interval(plant, name, value);
            if guessed && value != 0.0 {
                assumed.push(name.to_owned());
            }
            interval
        };
        let gain = of("gain", cable.gain());
        let kappa_eta = of("kappa_eta", cable.kappa_eta());
        let offset = of("offset", cable.offset());
        Self {
            gain,
            alpha: Interval {
                low: gain.low * drive_gain * (1.0 - DRIVE),
                high: gain.high * drive_gain * (1.0 + DRIVE),
            },
            delta: kappa_eta.magnitude() + offset.magnitude() + plant.effects,
            assumed,
        }
    }
}

/// The law for a plant.
pub(super) fn design(plant: &Plant, around: &Around) -> AdaptiveDesign {
    let every = super::samples(around.delay, 1.0 / around.rate) as f64;
    let step = every / around.rate;
    let boxes = Boxes::of(plant, around.drive_gain);
    let mut found = AdaptiveDesign {
        step,
        every: every as usize,
        at_the_rate: every <= 1.0,
        // Half of what the constructor admits.
        loop_gain: 0.5,
        settings: None,
        refused: None,
        certificate: None,
        proved: false,
        unproved: None,
        uncertified: None,
        plant: None,
        assumed: boxes.assumed.clone(),
    };
    let settings = match settings(plant, around, &boxes, &found) {
        Ok(settings) => settings,
        Err(why) => {
            found.refused = Some(why);
            return found;
        }
    };
    found.settings = Some(settings);
    let certified = known(plant, around, &boxes).and_then(|known| {
        found.plant = Some(known);
        certificate(&known, settings)
    });
    match certified {
        Ok((value, settings)) => {
            found.certificate = Some(value);
            found.settings = Some(settings);
        }
        Err(why) => found.uncertified = Some(why),
    }
    found
}

fn settings(
    plant: &Plant,
    around: &Around,
    boxes: &Boxes,
    found: &AdaptiveDesign,
) -> Result<AdaptiveSettings<f64, 0>, String> {
    let (h, bandwidth) = (found.step, found.loop_gain / found.step);
    let Boxes { alpha, delta, .. } = *boxes;
    if boxes.gain.low <= 0.0 {
        return Err(format!(
            "the interval for B includes values down to {:.4}, but the adaptive law needs a positive gain",
            boxes.gain.low
        ));
    }
    let beta = Interval {
        low: 1.0 / alpha.high,
        high: 1.0 / alpha.low,
    };
    let plant_gain = alpha
        .high
        .max(plant.slopes.magnitude() * around.drive_gain * (1.0 + DRIVE));
    let g = plant_gain * beta.high;
    // From k > 1/lambda² with k = bandwidth/(2·lambda·g), twice over.
    let lambda = (bandwidth / 50.0).max(4.0 * g / bandwidth);
    if h * lambda > 1.0 {
        return Err(format!(
            "k > 1/lambda² and h·lambda <= 1 cannot both hold at a step of {h} s, the smallest whole number of samples longer than the delay; the step must be at most {:.3} s, so raise the rate or shorten the delay",
            (0.25 * found.loop_gain / g).sqrt()
        ));
    }
    let k = bandwidth / (2.0 * lambda * g);
    let epsilon = delta / k;
    // In a hundred time constants of the loop an estimate crosses its box, at abs(s) = epsilon.
    let time = 100.0 / bandwidth;
    let leakage = 0.1 / time;
    let [low, high] = plant.ends();
    let torque = low.abs().max(high.abs()).max(f64::MIN_POSITIVE);
    let initial = 1.0 / (plant.cable.gain() * around.drive_gain);
    let drive = time * lambda * epsilon;
    let lag = Form::FirstOrder {
        step: h,
        plant_gain,
    };
    // The law counts its own steps, and may be called on one sample in several.
    let after = super::fallback_after(around.delay, h.recip());
    let safe = around.fallback.command().unwrap_or(0.0);
    let fallback = Fallback::try_new(after, safe).map_err(|e| e.to_string())?;
    let settings = AdaptiveSettings {
        beta: Estimator {
            prior: initial,
            ..Estimator::fixed(initial)
                .within(beta.low, beta.high)
                .adapting((beta.high - beta.low) / (drive * torque), leakage)
        },
        delta: Estimator::fixed(0.0)
            .within(0.0, delta)
            .adapting(delta / drive, leakage),
        // As far as the integral of PI can go.
        z_limit: torque.max(1.0) / lambda,
        ..AdaptiveSettings::new(lag, k, lambda, epsilon, around.limits, h, fallback)
    };
    let longest_dt = settings.largest_step().unwrap_or(h).max(h);
    let settings = AdaptiveSettings {
        longest_dt,
        ..settings
    };
    Adaptive::try_new(settings).map_err(|e| e.to_string())?;
    Ok(settings)
}

/// The ranges of the plant from the model and its record.
fn known(plant: &Plant, around: &Around, boxes: &Boxes) -> Result<Known, String> {
    let super::Slopes { least, greatest } = plant.slopes;
    let Some(reference_rate) = around.reference_rate else {
        return Err(format!(
            "the rate of the hysteresis has no useful bound, because the smallest slope of the output is {least:.4}"
        ));
    };
    let [low, high] = plant.output().ok_or(super::TOO_SHORT)?;
    let cutoff = plant.about.cutoff_hz;
    if plant.effects > 0.0 && !(cutoff.is_finite() && cutoff > 0.0) {
        return Err(
            "the rate of the effects has no bound, because the model file has no about.cutoff_hz"
                .to_owned(),
        );
    }
    // Bernstein: what is band-limited to f and stays below M has a rate below 2·pi·f·M.
    let effects = match plant.effects > 0.0 {
        true => std::f64::consts::TAU * cutoff * plant.effects,
        false => 0.0,
    };
    Ok(Known {
        alpha: [boxes.alpha.low, boxes.alpha.high],
        disturbance: boxes.delta,
        disturbance_rate: (greatest - least) / least * reference_rate + effects,
        reference: low.abs().max(high.abs()),
        reference_rate,
    })
}

/// The sampled peak certificate, and the settings with a limit on the accumulated error that is
/// large enough.
fn certificate(
    known: &Known,
    settings: AdaptiveSettings<f64, 0>,
) -> Result<(f64, AdaptiveSettings<f64, 0>), String> {
    let [low, high] = known.alpha;
    let bounds = Bounds::<f64, 0> {
        alpha: Interval { low, high },
        delta_rate: known.disturbance_rate,
        reference: known.reference,
        reference_rate: known.reference_rate,
        ..Bounds::new(1.0, known.disturbance)
    };
    let free = AdaptiveSettings {
        z_limit: f64::MAX,
        ..settings
    };
    let law = Adaptive::try_new(free).map_err(|e| e.to_string())?;
    let peak = PeakSampled::try_new(&law, &bounds).map_err(|e| e.to_string())?;
    if peak.bound > known.reference {
        return Err(format!(
            "its bound of {:.3} N·m would exceed the largest output of {:.3} N·m",
            peak.bound, known.reference
        ));
    }
    let z_limit = settings.z_limit.max(1.01 * peak.s / settings.lambda);
    Ok((
        peak.bound,
        AdaptiveSettings {
            z_limit,
            ..settings
        },
    ))
}
