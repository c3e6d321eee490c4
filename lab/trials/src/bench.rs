//! The rig's own open-loop bench record, and its identification.
//!
//! A multisine drives the motor, and a slower multisine drives the joint. The torque covers the
//! range that the reference needs. The angle of the joint is independent of the torque; with the
//! spring alone, it would not be. The loop is open. The record is written as CSV, and read and
//! identified like any user's record.

use super::feed::{FeedForward, Surroundings};
use super::trial::{MOST_UNDECLARED, RATE};
use bowden::control::BenchRange;
use bowden::effect::Motion;
use bowden::model::{Source, Term};
use bowden_lab::export::{ModelFile, MOST_TERMS};
use bowden_lab::fit::Solution;
use bowden_lab::ledger::Ledger;
use bowden_lab::model::declared::structure;
use bowden_lab::model::structure::FitTerm;
use bowden_lab::problem::{Channel, Preparation, Prepared};
use bowden_lab::record::{parse, Options};
use bowden_lab::search::close;
use bowden_rig::{Noise, Rig, RigConfig};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Cut-off of the filter \[Hz\], above all frequencies of the multisines.
const CUTOFF: f64 = 8.0;

/// A mean and sinusoids of random phase.
struct Multisine {
    mean: f64,
    /// Amplitude, frequency \[Hz\], phase.
    tones: Vec<(f64, f64, f64)>,
}

impl Multisine {
    fn new(mean: f64, tones: &[(f64, f64)], noise: &mut Noise) -> Self {
        Self {
            mean,
            tones: tones
                .iter()
                .map(|&(amplitude, f)| (amplitude, f, TAU * noise.uniform()))
                .collect(),
        }
    }

    /// The signal at a time. A ramp at the start avoids transients.
    fn at(&self, t: f64) -> f64 {
        let fade = (t / 2.0).clamp(0.0, 1.0);
        let sum: f64 = self
            .tones
            .iter()
            .map(|(a, f, phase)| a * (TAU * f * t + phase).sin())
            .sum();
        fade * (self.mean + sum)
    }
}

/// The record, as two CSV files.
#[derive(Debug, Clone)]
pub struct Record {
    /// The columns t, tau_i, tau_o, phi_p and phi_d, which `bowden identify` reads.
    pub csv: String,
    /// The same record with the command and the load, from which drive, spring and cable are
    /// identified.
    surroundings: String,
}

/// Runs the rig in open loop.
///
/// # Errors
/// The error of the core for an invalid parameter of the rig, or an error if the rig diverges.
pub fn record(
    config: &RigConfig<f64>,
    undeclared: &[Term<f64>],
    seed: u64,
) -> Result<Record, String> {
    let rig = Rig::<f64, MOST_UNDECLARED>::try_new(*config, undeclared)
        .map_err(|e| format!("the rig: {e}"))?;
    let mut dice = Noise::new(seed ^ 0x5EED_BE9C);
    // In units of the drive: from rest beyond the reference's 38 N·m plus friction, and
    // down again; amplitudes, so that the small loops of the hysteresis are there too.
    let to_units = 1.0 / config.drive_gain;
    let torque = [
        (13.0, 0.11),
        (8.0, 0.27),
        (4.5, 0.53),
        (2.0, 0.97),
        (1.0, 1.7),
    ];
    let tones: Vec<(f64, f64)> = torque.iter().map(|(a, f)| (a * to_units, *f)).collect();
    let drive = Multisine::new(26.0 * to_units, &tones, &mut dice);
    let hand = Multisine::new(
        0.0,
        &[(8.0, 0.07), (6.0, 0.19), (4.0, 0.41), (2.0, 0.83)],
        &mut dice,
    );
    let mut state = rig.start(seed);
    let mut csv = String::from("t [s],tau_i [N·m],tau_o [N·m],phi_p [rad],phi_d [rad]\n");
    let mut all = String::from("t [s],tau_i [N·m],tau_o [N·m],out [N·m],phi_p [rad],phi_d [rad],command [N·m],hand [N·m]\n");
    let step = 1.0 / RATE;
    // Ninety seconds.
    for k in 0..(90.0 * RATE) as usize {
        let t = k as f64 * step;
        let (command, load) = (drive.at(t), hand.at(t));
        let now = state.sample();
        let (p, d) = (now.proximal.position, now.distal.position);
        let (i, o) = (now.measured_input, now.measured);
        let _ = writeln!(csv, "{t:.4},{i:.6},{o:.6},{p:.8},{d:.8}");
        let _ = writeln!(
            all,
            "{t:.4},{i:.6},{o:.6},{o:.6},{p:.8},{d:.8},{command:.6},{load:.6}"
        );
        if rig.step_with_load(&mut state, command, load, step).diverged {
            return Err("the simulated rig diverged during the bench record".to_owned());
        }
    }
    Ok(Record {
        csv,
        surroundings: all,
    })
}

/// The identification of a bench record.
#[derive(Debug, Clone)]
pub struct Identified {
    /// The results table of the identification.
    pub ledger: Ledger,
    /// The parameters of drive, spring and cable.
    pub surroundings: Surroundings,
    /// The baseline model.
    pub declared: ModelFile,
    /// The baseline model with the found terms. Among the models whose terms can all be fed
    /// forward, this model has the smallest error on the selection segment.
    pub found: ModelFile,
    /// Rms error of the baseline model on the held-out part \[N·m\].
    pub before: f64,
    /// Rms error of the model with the found terms on the held-out part \[N·m\].
    pub after: f64,
    /// The found terms that are fed forward, in words.
    pub names: Vec<String>,
    /// The found terms that are not fed forward, because they read the sum or increase the error on
    /// the selection segment.
    pub left_out: Vec<String>,
    ranges: Vec<BenchRange<f64>>,
}

/// Identifies a model from the record.
///
/// # Errors
/// The error message of `bowden identify`.
pub fn identify(record: &Record) -> Result<Identified, String> {
    let options = Options {
        // The fade-in is over, and so is what the start has left behind.
        skip: 3.0,
        ..Options::default()
    };
    let preparation = Preparation {
        cutoff: Some(CUTOFF),
    };
    let read = parse(record.csv.as_bytes(), "(bench)", &options).map_err(|e| e.to_string())?;
    let data = Prepared::new(&read, preparation)?;
    let declared = structure(&["bouc-wen".to_owned()], &data)?;
    let ledger = close(&data, &declared, |_| {})?;
    let surroundings = surroundings(record, &options, preparation)?;

    let solutions: Vec<&Solution> = std::iter::once(&ledger.declared)
        .chain(ledger.rounds.iter().map(|round| &round.solution))
        .collect();
    // Chosen on the stop-check, so that the held-out figures are of data that chose nothing.
    // A round with a stage that cannot be turned round would be fed forward without it,
    // beside gains that were fitted with it.
    let solution = solutions
        .iter()
        .filter(|s| s.structure.terms.iter().all(|t| t.is_linear()))
        .min_by(|a, b| a.rmse.selection.total_cmp(&b.rmse.selection))
        .map_or(&ledger.declared, |found| *found);
    let named = |solution: &Solution| -> Vec<String> {
        let name = |term: &FitTerm| {
            let channel = match term.source {
                Source::Input => "tau_i",
                Source::Channel(_) => data.channel(term.source).map_or("?", |c| c.name.as_str()),
            };
            format!("{}@{channel}", term.effect.name())
        };
        solution.structure.terms.iter().map(name).collect()
    };
    let names = named(solution);
    let mut left_out = solutions.last().map_or_else(Vec::new, |last| named(last));
    left_out.retain(|name| !names.contains(name));
    let mut ranges = vec![range(Source::Input, &data.input)];
    for (index, channel) in data.channels.iter().enumerate() {
        let index = u8::try_from(index).map_err(|_| "too many channels".to_owned())?;
        ranges.push(range(Source::Channel(index), channel));
    }
    Ok(Identified {
        declared: ModelFile::new(&data, &ledger.declared),
        found: ModelFile::new(&data, solution),
        before: ledger.declared.rmse.held_out,
        after: solution.rmse.held_out,
        names,
        left_out,
        ranges,
        surroundings,
        ledger,
    })
}

impl Identified {
    /// A model as a feed-forward within the ranges of the bench record.
    ///
    /// # Errors
    /// A message if the model cannot be inverted.
    pub fn feed(&self, model: &ModelFile, latency: f64) -> Result<FeedForward, String> {
        let surroundings = Surroundings {
            latency,
            ..self.surroundings
        };
        FeedForward::new(
            &model.model::<MOST_TERMS>()?,
            &model.channels,
            &self.ranges,
            surroundings,
        )
    }
}

/// The range of one channel in the bench record.
fn range(source: Source, channel: &Channel) -> BenchRange<f64> {
    let over = |of: fn(&Motion<f64>) -> f64| {
        let values = channel.motion.iter().map(of);
        (
            values.clone().fold(f64::INFINITY, f64::min),
            values.fold(f64::NEG_INFINITY, f64::max),
        )
    };
    let (position, velocity, acceleration) = (
        over(|m| m.position),
        over(|m| m.velocity),
        over(|m| m.acceleration),
    );
    BenchRange {
        source,
        low: Motion {
            position: position.0,
            velocity: velocity.0,
            acceleration: acceleration.0,
        },
        high: Motion {
            position: position.1,
            velocity: velocity.1,
            acceleration: acceleration.1,
        },
    }
}

/// Drive, spring and cable by three linear regressions on the smoothed record.
fn surroundings(
    record: &Record,
    options: &Options,
    preparation: Preparation,
) -> Result<Surroundings, String> {
    let options = Options {
        channels: ["command", "hand", "out"]
            .iter()
            .map(|name| ((*name).to_owned(), (*name).to_owned()))
            .collect(),
        ..options.clone()
    };
    let read =
        parse(record.surroundings.as_bytes(), "(bench)", &options).map_err(|e| e.to_string())?;
    let data = Prepared::new(&read, preparation)?;
    let motion = |name: &str| {
        data.channels
            .iter()
            .find(|c| c.name == name)
            .map(|c| c.motion.as_slice())
            .ok_or_else(|| format!("the bench record has no column {name}"))
    };
    let (p, d) = (motion("phi_p")?, motion("phi_d")?);
    let (command, hand, out) = (motion("command")?, motion("hand")?, motion("out")?);
    let input = &data.input.motion;
    // The filter has no past at the ends.
    let edge = (1.0 / (CUTOFF * data.dt)) as usize * 3;
    let rows = edge..input.len().saturating_sub(edge);

    let drive = regress(&rows, 4, |k| {
        let row = [command[k].position, p[k].velocity, p[k].acceleration, 1.0];
        (row.to_vec(), input[k].position)
    })?;
    let spring = regress(&rows, 3, |k| {
        let row = [d[k].position, d[k].velocity, 1.0];
        (row.to_vec(), out[k].position + hand[k].position)
    })?;
    let cable = regress(&rows, 2, |k| {
        let row = [p[k].position - d[k].position, 1.0];
        (row.to_vec(), input[k].position)
    })?;
    let found = Surroundings {
        drive_gain: drive[0],
        motor_damping: -drive[1],
        motor_inertia: -drive[2],
        load_stiffness: spring[0],
        joint_damping: spring[1],
        cable_stiffness: cable[0],
        latency: 0.0,
    };
    for (value, name) in [
        (found.drive_gain, "the drive's gain"),
        (found.load_stiffness, "the spring"),
        (found.cable_stiffness, "the cable's stiffness"),
    ] {
        if !(value.is_finite() && value > 0.0) {
            return Err(format!("the bench record does not determine {name}"));
        }
    }
    Ok(found)
}

/// Least squares over the rows.
fn regress(
    rows: &std::ops::Range<usize>,
    width: usize,
    row: impl Fn(usize) -> (Vec<f64>, f64),
) -> Result<Vec<f64>, String> {
    let mut gram = DMatrix::<f64>::zeros(width, width);
    let mut score = DVector::<f64>::zeros(width);
    for k in rows.clone() {
        let (x, y) = row(k);
        for i in 0..width {
            score[i] += x[i] * y;
            for j in 0..width {
                gram[(i, j)] += x[i] * x[j];
            }
        }
    }
    nalgebra::SVD::new(gram, true, true)
        .solve(&score, 1e-14)
        .map(|solution| solution.iter().copied().collect())
        .map_err(|e| format!("the bench record: {e}"))
}
