//! Computes gains from an identified model, for `bowden design`.
//!
//! The plant is the transmission of the model, with a slope of the output within [`Slopes`], after
//! a delay. The model does not contain inertias, springs and dampings. Their lag must be part of
//! the given delay. A lag of T counts as a delay of T.
//!
//! ```
//! use bowden_trials::design::{design, Question};
//! let model = r#"
//! schema = "bowden.model/1"
//! mode = "torque"
//! channels = []
//! [transmission]
//! gain = 0.95
//! kappa_eta = 2.0
//! offset = 0.05
//! rho = 0.2
//! sigma = 0.6
//! n = 1.5
//! [about.ranges.input]
//! position = [-12.0, 16.0]
//! velocity = [-40.0, 40.0]
//! acceleration = [-170.0, 170.0]
//! "#;
//! let asked = Question { rate: 1000.0, delay: 0.004, noise: 0.02, drive_gain: 1.0 };
//! let designed = design(model, "model.toml", &asked)?;
//! assert!((designed.slopes.least - 0.47).abs() < 1e-12);
//! assert!(designed.pi.margins.gain >= 2.0 && designed.pi.margins.phase >= 45.0);
//! # Ok::<(), String>(())
//! ```

mod adaptive;
mod linear;
mod pi;
mod plant;
mod promised;
mod rust;

pub use adaptive::AdaptiveDesign;
pub use linear::Margins;
pub use pi::{Asked, ASKED};
pub use plant::Slopes;
pub use promised::Certifies;
pub use rust::rust;

use crate::gains::{message, DesignedFor, GainsFile, SCHEMA};
use adaptive::Around;
use bowden::control::{DerivativeSource, Fallback, Limits, Pid, PidSettings};
use bowden_lab::export::ModelFile;
use linear::Gains;
pub(crate) use plant::rises;
use plant::Plant;
use serde::Serialize;

/// The input of the design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Question {
    /// Sampling rate \[Hz\].
    pub rate: f64,
    /// Delay from a command to its effect in the measured torque \[s\].
    pub delay: f64,
    /// Noise of the measured torque \[N·m rms\].
    pub noise: f64,
    /// Torque at the proximal pulley per command unit \[N·m/command unit\].
    pub drive_gain: f64,
}

/// Maximum number of samples of delay. A slower rate gives the same loop.
const MOST_DELAY: f64 = 1000.0;

/// The derivative is used if it increases the integral gain by at least this factor.
const WORTH: f64 = 1.1;

/// The reason why there is neither a reference nor a certificate.
pub(crate) const TOO_SHORT: &str = "the recorded stroke is too short to traverse the hysteresis loop; record a larger stroke. No output torque occurs both while loading and while unloading, so no reference can be derived";

/// Gain margin that the loop must keep if every step has the longest `dt`.
const LONG_MARGIN: f64 = 1.4;

/// Values that are tried as the longest `dt` \[samples\].
const LONGER: [f64; 6] = [1.25, 1.5, 2.0, 3.0, 4.0, 5.0];

/// The gains of a PI or PID, and the properties of its loop.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PidDesign {
    /// Proportional gain \[command unit/(N·m)\].
    pub k_p: f64,
    /// Integral gain \[command unit/(N·m·s)\].
    pub k_i: f64,
    /// Gain of the derivative \[command unit·s/(N·m)\].
    pub k_d: f64,
    /// Time constant of the derivative's filter \[s\].
    pub derivative_time: f64,
    /// Margins at the design slope.
    pub margins: Margins,
    /// Overshoot after a reference step, as a fraction of the step.
    pub overshoot: f64,
    /// Settling time after such a step, to within 2 % \[s\].
    pub settled: Option<f64>,
}

/// The range of admissible gains.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Admissible {
    /// Upper limit of `k_p` for any `k_i` \[command unit/(N·m)\].
    pub k_p: f64,
    /// Largest `k_i` with the designed `k_p` \[command unit/(N·m·s)\].
    pub k_i: f64,
    /// Largest `k_i` without `k_p` \[command unit/(N·m·s)\].
    pub k_i_alone: f64,
}

/// Whether a derivative helps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Derivative {
    /// Whether the integral gain increases by a tenth or more.
    pub helps: bool,
    /// Integral gain of the PID divided by that of the PI.
    pub integral_gain: f64,
    /// The best PID.
    pub pid: PidDesign,
}

/// Limits and fallback, which do not follow from the margins.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bounds {
    /// Smallest command \[command unit\] of the record.
    pub low: f64,
    /// Largest command \[command unit\] of the record.
    pub high: f64,
    /// Smallest slew rate that does not limit the response to noise,
    /// `2·(k_p + k_i/rate)·6·noise·rate` \[command unit/s\]. If a derivative helps, `k_p` is
    /// increased by `k_d/(derivative_time + 1/rate)`.
    pub slew_of_noise: f64,
    /// Largest rate of the input in the record \[command unit/s\].
    pub slew_of_record: f64,
    /// The larger of the two.
    pub slew: f64,
    /// Largest rate of a reference for which the input is no faster than in the record \[N·m/s\];
    /// `None` if the smallest slope is below a hundredth of the largest.
    pub reference_rate: Option<f64>,
    /// Range of outputs that the recorded inputs reach in both directions \[N·m\]; `None` if the
    /// stroke of the record is shorter than the hysteresis.
    pub output: Option<[f64; 2]>,
    /// Longest `dt` \[s\].
    pub longest_dt: f64,
    /// Number of consecutive bad samples after which the safe command is applied.
    pub fallback_after: u32,
    /// The safe command \[command unit\].
    pub fallback_command: f64,
}

/// The result of the design.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Designed {
    /// Smallest and largest slope of the output versus the proximal torque.
    pub slopes: Slopes,
    /// The slope for which the gains are designed: the largest magnitude.
    pub design_slope: f64,
    /// The delay, including that of the model \[s\].
    pub delay: f64,
    /// Number of samples from a command to its first measured effect.
    pub delay_samples: usize,
    /// The required margins.
    pub asked: Asked,
    /// PI.
    pub pi: PidDesign,
    /// The range of admissible gains.
    pub admissible: Admissible,
    /// Whether a derivative helps.
    pub derivative: Derivative,
    /// Limits, slew rate, longest `dt`, fallback.
    pub bounds: Bounds,
    /// The adaptive law.
    pub adaptive: AdaptiveDesign,
    /// Notes for the user.
    pub notes: Vec<String>,
    /// The same data as a gains file.
    #[serde(skip)]
    pub gains: GainsFile,
}

impl Question {
    /// Rejects an invalid rate, delay, noise or gain.
    ///
    /// # Errors
    /// A message with the option.
    pub fn check(&self) -> Result<(), String> {
        for (value, option, unit, above) in [
            (self.rate, "--rate", "Hz", true),
            (self.delay, "--delay", "s", false),
            (self.noise, "--noise", "N·m rms", false),
            (self.drive_gain, "--drive-gain", "N·m/command unit", true),
        ] {
            if !(value.is_finite() && value >= 0.0 && (value > 0.0 || !above)) {
                let from = if above { "positive" } else { "nonnegative" };
                return Err(format!(
                    "{option} {value}: the value [{unit}] must be {from}"
                ));
            }
        }
        Ok(())
    }

    /// The conditions of the design, with the name of the model file without folders.
    fn of_model(&self, label: &str) -> DesignedFor {
        let name = std::path::Path::new(label).file_name();
        DesignedFor {
            by: format!("bowden {}", env!("CARGO_PKG_VERSION")),
            model: name.map_or_else(|| label.to_owned(), |n| n.to_string_lossy().into_owned()),
            rate: self.rate,
            delay: self.delay,
            drive_gain: self.drive_gain,
            noise: self.noise,
        }
    }
}

/// Number of samples after which the effect of a command is first measured. A command is sent right
/// after its sample, and a torque that arrives with a sample is measured at the next sample. On
/// average, this is the delay plus half a sample for the hold. It is never less than the delay.
fn samples(delay: f64, step: f64) -> usize {
    (delay / step + 1e-9).floor() as usize + 1
}

/// The gains for the model in the text of a model file; `label` is the name of the file.
///
/// # Errors
/// A message with the option, or with file, line and column, and the allowed values.
pub fn design(text: &str, label: &str, asked: &Question) -> Result<Designed, String> {
    asked.check()?;
    let file = read(text, label)?;
    let plant = Plant::new(&file).map_err(|e| format!("{label}: {e}"))?;
    let h = 1.0 / asked.rate;
    let delay = asked.delay + plant.own_delay;
    if delay * asked.rate > MOST_DELAY {
        return Err(format!(
            "--rate {}: the delay of {delay} s is longer than {MOST_DELAY} samples; lower the rate",
            asked.rate
        ));
    }
    let count = samples(delay, h);
    let slope = plant.slopes.magnitude();
    let unit = Units {
        gain: slope * asked.drive_gain,
        h,
    };
    let pi = pi::pi(count);
    let pid = pi::pid(count);
    let derivative = Derivative {
        helps: pid.gains.k_i >= WORTH * pi.gains.k_i,
        integral_gain: pid.gains.k_i / pi.gains.k_i,
        pid: unit.pid(&pid),
    };
    let mut used = pi.gains;
    if derivative.helps {
        used.k_p += pid.gains.k_d / (pid.gains.tau + 1.0);
    }
    let longest_dt = longest_step(pi.gains, delay, h);
    let bounds = bounds(&plant, asked, unit, used, (delay, longest_dt))?;
    let safety = Safety::new(&bounds).map_err(|e| format!("{label}: {e}"))?;
    let admissible = Admissible {
        k_p: pi::greatest_proportional() / unit.gain,
        k_i: pi.gains.k_i / (unit.gain * h),
        k_i_alone: pi::greatest_integral(Gains::default(), count) / (unit.gain * h),
    };
    let around = Around {
        rate: asked.rate,
        delay,
        drive_gain: asked.drive_gain,
        limits: safety.limits,
        fallback: safety.fallback,
        reference_rate: bounds.reference_rate,
    };
    let mut adaptive = adaptive::design(&plant, &around);
    let pi = unit.pid(&pi);
    let told = |e: bowden::Error| format!("{label}: {e}");
    let pid = match derivative.helps {
        true => Some(safety.settings(&derivative.pid).map_err(told)?),
        false => None,
    };
    let gains = GainsFile {
        schema: SCHEMA.to_owned(),
        design: asked.of_model(label),
        pi: safety.settings(&pi).map_err(told)?,
        pid,
        adaptive: adaptive.settings,
        plant: adaptive.plant,
    };
    let gains = promised(gains, &mut adaptive);
    Ok(Designed {
        slopes: plant.slopes,
        design_slope: slope,
        delay,
        delay_samples: count,
        asked: ASKED,
        pi,
        admissible,
        derivative,
        bounds,
        notes: notes(&plant, &adaptive),
        adaptive,
        gains,
    })
}

/// The gains file that is proved, if there is one. The law is changed with it.
fn promised(gains: GainsFile, adaptive: &mut AdaptiveDesign) -> GainsFile {
    if adaptive.certificate.is_none() {
        return gains;
    }
    match promised::settled(&gains) {
        Ok((proved, proof)) => {
            adaptive.certificate = Some(proof.error.high);
            adaptive.settings = proved.adaptive;
            adaptive.plant = proved.plant;
            adaptive.proved = true;
            proved
        }
        Err(why) => {
            adaptive.unproved = Some(why);
            gains
        }
    }
}

/// Limits and fallback of a controller.
#[derive(Debug, Clone, Copy)]
struct Safety {
    limits: Limits<f64>,
    longest_dt: f64,
    fallback: Fallback<f64>,
}

impl Safety {
    fn new(bounds: &Bounds) -> Result<Self, bowden::Error> {
        Ok(Self {
            limits: Limits::try_new(bounds.low, bounds.high)?.with_slew(bounds.slew)?,
            longest_dt: bounds.longest_dt,
            fallback: Fallback::try_new(bounds.fallback_after, bounds.fallback_command)?,
        })
    }

    /// Settings of PI or PID, checked.
    fn settings(&self, own: &PidDesign) -> Result<PidSettings<f64>, bowden::Error> {
        let Self {
            limits,
            longest_dt,
            fallback,
        } = *self;
        let plain = PidSettings::new(own.k_p, own.k_i, limits, longest_dt, fallback);
        let settings = match own.k_d == 0.0 {
            true => plain,
            false => PidSettings {
                k_d: own.k_d,
                derivative_time: own.derivative_time,
                damping: DerivativeSource::on_measurement(),
                ..plain
            },
        };
        Pid::try_new(settings).map(|pid| *pid.settings())
    }
}

/// Reads a model file. An error contains its position.
fn read(text: &str, label: &str) -> Result<ModelFile, String> {
    if text.trim().is_empty() {
        return Err(format!(
            "{label}: the file is empty; pass a model written by `bowden identify --model-out`"
        ));
    }
    let file: ModelFile = toml::from_str(text).map_err(|e| message(&e, text, label))?;
    if file.schema != "bowden.model/1" {
        return Err(format!(
            "{label}: schema {:?} must be \"bowden.model/1\"",
            file.schema
        ));
    }
    Ok(file)
}

/// The units of the plant and of the sample.
#[derive(Debug, Clone, Copy)]
struct Units {
    /// Slope of the measured torque versus the command \[N·m/command unit\].
    gain: f64,
    h: f64,
}

impl Units {
    fn pid(&self, found: &pi::Found) -> PidDesign {
        let (own, Self { gain, h }) = (found.gains, *self);
        PidDesign {
            k_p: own.k_p / gain,
            k_i: own.k_i / (gain * h),
            k_d: own.k_d * h / gain,
            derivative_time: if own.k_d == 0.0 { 0.0 } else { own.tau * h },
            margins: found.margins,
            overshoot: found.response.overshoot,
            settled: found.response.settled.map(|k| k as f64 * h),
        }
    }
}

/// The longest of these steps at which the PI loop keeps [`LONG_MARGIN`] \[s\].
fn longest_step(gains: Gains, delay: f64, h: f64) -> f64 {
    let mut longest = 1.0;
    for ratio in LONGER {
        let own = linear::margins(gains.at_step(ratio), samples(delay, ratio * h));
        if own.gain < LONG_MARGIN {
            break;
        }
        longest = ratio;
    }
    longest * h
}

fn bounds(
    plant: &Plant,
    asked: &Question,
    unit: Units,
    used: Gains,
    (delay, longest_dt): (f64, f64),
) -> Result<Bounds, String> {
    let [low, high] = plant.input.map(|torque| torque / asked.drive_gain);
    let proportional = (used.k_p + used.k_i) / unit.gain;
    // The largest change between two samples of white noise is six times its rms.
    let slew_of_noise = 2.0 * proportional * 6.0 * asked.noise * asked.rate;
    let slew_of_record = plant.greatest_rate() / asked.drive_gain;
    Ok(Bounds {
        low,
        high,
        slew_of_noise,
        slew_of_record,
        slew: slew_of_noise.max(slew_of_record),
        reference_rate: plant
            .slopes
            .rising()
            .map(|least| least * plant.greatest_rate()),
        output: plant.output(),
        longest_dt,
        fallback_after: fallback_after(delay, asked.rate),
        fallback_command: 0.0_f64.clamp(low, high),
    })
}

/// Number of consecutive bad samples after which the safe command is applied: 20 ms or twice the
/// delay \[s\], at the given rate.
fn fallback_after(delay: f64, rate: f64) -> u32 {
    let after = (0.02_f64.max(2.0 * delay) * rate).ceil();
    after.clamp(2.0, 1e6) as u32
}

fn notes(plant: &Plant, adaptive: &AdaptiveDesign) -> Vec<String> {
    let mut notes = Vec::new();
    let least = plant.slopes.least;
    if least < 0.0 {
        notes.push(format!(
            "the smallest slope is {least:.4}, so after a reversal the output moves against the input, and no margin covers this case; `bowden identify --invertible` fits a model without negative slopes"
        ));
    }
    if plant.output().is_none() {
        notes.push(TOO_SHORT.to_owned());
    }
    let [low, high] = plant.input;
    if adaptive.certificate.is_some() && low * high >= 0.0 {
        notes.push(
            "the command limits are on one side of zero, as in the record. `bowden certify` rejects such a file, because its theorem needs limits on both sides. The certificate above ignores the limits".to_owned(),
        );
    } else if let Some(why) = &adaptive.unproved {
        notes.push(format!(
            "`bowden certify` cannot prove a bound for this file, because {why}. The certificate above ignores the command limits and the slew-rate limit"
        ));
    }
    if plant.own_delay > 0.0 {
        notes.push(format!(
            "the model's own delay and lag, {} s, are added to --delay",
            plant.own_delay
        ));
    }
    if !plant.left_out.is_empty() {
        notes.push(format!(
            "the slopes do not include the other terms that read the input: {}",
            plant.left_out.join(", ")
        ));
    }
    if let Some(note) = plant.without_unit() {
        notes.push(note.to_owned());
    }
    if !adaptive.assumed.is_empty() {
        notes.push(format!(
            "the model file has no interval for {}, so ±10 % was assumed",
            adaptive.assumed.join(", ")
        ));
    }
    notes
}
