//! `bowden compare`: controllers on the simulated rig.

use super::drawing::provenance;
use super::{outputs, Failure};
use crate::view::compare::{json, text, trace};
use crate::view::Width;
use bowden_lab::facts::Source;
use bowden_page::Compare as Page;
use bowden_trials::facts::{compare, other_configuration, Question, RigChanges};
use clap::Args;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct Compare {
    /// White noise of the torque sensors [N·m rms] [default: the noise for which --gains were
    /// designed, 0.02 with --effect, or otherwise 0.28 as in the experiment]. At 0.28, the gains of
    /// Nguyen et al. (2018) amplify the noise so much that the noise hides the improvement from an
    /// identified effect.
    #[arg(long, value_name = "N·m")]
    noise: Option<f64>,
    /// Move the conduit during the trials, so that B, kappa_eta and T0 drift.
    #[arg(long)]
    varying: bool,
    /// Follow a gait, with an ankle push-off once per second, instead of the reference of Nguyen et
    /// al. (2018). With this option, a controller with iterative learning also runs.
    #[arg(long, conflicts_with = "effect")]
    gait: bool,
    /// Length of a trial [s].
    #[arg(long, default_value_t = Question::default().seconds, value_name = "S")]
    seconds: f64,
    /// Number of trials, each with its own seed.
    #[arg(long, default_value_t = Question::default().seeds, value_name = "K")]
    seeds: u64,
    /// Add an effect that the baseline model lacks, identify it on the bench, and feed it forward.
    /// STRENGTH is in N·m rms.
    #[arg(long, value_name = "NAME[@CHANNEL][:STRENGTH]")]
    effect: Option<String>,
    /// Model for the feed-forward: a file written by `identify --model-out`. With --gains or a rig
    /// option, the rig has the transmission and the effects of this model, and the reference stays
    /// within the range of its record. Alternatively, one file with gains, rig and model.
    #[arg(long, value_name = "MODEL.toml")]
    model: Option<PathBuf>,
    /// Gains from `bowden design`, together with their model in --model. Alternatively, one file
    /// with gains, rig and model.
    #[arg(long, value_name = "GAINS.toml")]
    gains: Option<PathBuf>,
    #[command(flatten)]
    rig: RigOptions,
    /// Write the reference, torques, command and estimates of the first trial over time as CSV.
    #[arg(long, value_name = "FILE.csv")]
    trace: Option<PathBuf>,
    /// Write the comparison as one self-contained HTML page: tables and time histories of the
    /// reference, torques, errors and estimates, with the conduit at rest and moving.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
    /// Also print the standard deviations over trials, the transient, and a description of each
    /// controller.
    #[arg(long, short)]
    verbose: bool,
    /// Print one JSON object on stdout instead of text.
    #[arg(long)]
    json: bool,
}

/// Parameters of the rig.
#[derive(Args)]
struct RigOptions {
    /// Torque at the proximal pulley per command unit [N·m] [default: the value in the --gains file
    /// from `bowden design`, or 0.6].
    #[arg(long, value_name = "N·m")]
    drive_gain: Option<f64>,
    /// Inertia of motor and proximal pulley [kg·m²] [default: 0.2].
    #[arg(long, value_name = "KG·M²")]
    inertia: Option<f64>,
    /// Viscous friction of motor and proximal pulley [N·m·s/rad] [default: 2.7].
    #[arg(long, value_name = "N·m·s")]
    damping: Option<f64>,
    /// Inertia of the joint [kg·m²] [default: 0.004].
    #[arg(long, value_name = "KG·M²")]
    joint_inertia: Option<f64>,
    /// Damping of the joint [N·m·s/rad] [default: 0.5].
    #[arg(long, value_name = "N·m·s")]
    joint_damping: Option<f64>,
    /// Stiffness of the spring at the joint [N·m/rad] [default: 150].
    #[arg(long, value_name = "N·m")]
    spring: Option<f64>,
    /// Delay between a command and the drive [samples], 0 to 8 [default: 1].
    #[arg(long, value_name = "SAMPLES", value_parser = clap::value_parser!(u8).range(0..=8))]
    delay: Option<u8>,
    /// Time constant of the drive [s] [default: 0.0005].
    #[arg(long, value_name = "S")]
    drive_lag: Option<f64>,
    /// Time constant of the torque sensors [s] [default: 0.001].
    #[arg(long, value_name = "S")]
    sensor_lag: Option<f64>,
}

impl RigOptions {
    fn changes(&self) -> RigChanges {
        RigChanges {
            drive_gain: self.drive_gain,
            motor_inertia: self.inertia,
            motor_damping: self.damping,
            joint_inertia: self.joint_inertia,
            joint_damping: self.joint_damping,
            load_stiffness: self.spring,
            drive_lag: self.drive_lag,
            sensor_lag: self.sensor_lag,
            delay: self.delay,
        }
    }
}

impl Compare {
    pub fn run(self) -> Result<(), Failure> {
        let given = [self.model.as_deref(), self.gains.as_deref()];
        let read: Vec<&Path> = given.into_iter().flatten().collect();
        let outputs = [("--report", &self.report), ("--trace", &self.trace)];
        let outputs = outputs.map(|(option, file)| Some((option, file.as_deref()?)));
        let outputs: Vec<(&str, &Path)> = outputs.into_iter().flatten().collect();
        outputs::check(&read, &outputs)?;
        let sources: Vec<Source> = match self.report {
            Some(_) => read
                .into_iter()
                .map(Source::of_file)
                .collect::<Result<_, _>>()?,
            None => Vec::new(),
        };
        let question = Question {
            setup: self.model.as_deref(),
            gains: self.gains.as_deref(),
            rig: self.rig.changes(),
            noise: self.noise,
            varying: self.varying,
            gait: self.gait,
            seconds: self.seconds,
            seeds: self.seeds,
            effect: self.effect.as_deref(),
            traced: self.trace.is_some() || self.report.is_some(),
            ..Question::default()
        };
        let compared = compare(&question)?;
        let mut files = Vec::new();
        if let Some(path) = &self.report {
            let mut both = vec![compared.clone()];
            both.extend(other_configuration(&question, &compared)?);
            let page = Page { compared: &both };
            files.push((path.clone(), page.page(&provenance(sources)).into_bytes()));
        }
        if let Some(path) = &self.trace {
            files.push((path.clone(), trace(&compared.traced()).into_bytes()));
        }
        outputs::write_together(&files)?;
        let out = match self.json {
            true => json(&compared),
            false => text(&compared, Width::of_stdout(), self.verbose),
        };
        super::say(out.trim_end())
    }
}
