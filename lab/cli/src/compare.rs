//! `bowden compare`: controllers on the simulated rig.

use super::drawing::provenance;
use super::{outputs, Failure};
use crate::view::compare::{json, text, trace};
use bowden_lab::facts::Source;
use bowden_page::Compare as Page;
use bowden_trials::facts::{compare, Question, RigChanges};
use clap::Args;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct Compare {
    /// White noise of the torque sensors [N·m rms]; where not given, what the --gains of
    /// `bowden design` were designed for, or the experiment's 0.28, and 0.02 with --effect:
    /// through the paper's gains 0.28 hides what is gained.
    #[arg(long, value_name = "N·m")]
    noise: Option<f64>,
    /// The conduit is moved during the trials: B, kappa_eta and T0 wander.
    #[arg(long)]
    varying: bool,
    /// Follow a gait, an ankle's push-off once a second, in place of the paper's reference; a
    /// controller that learns from step to step runs beside the others.
    #[arg(long, conflicts_with = "effect")]
    gait: bool,
    /// Length of a trial [s].
    #[arg(long, default_value_t = 60.0, value_name = "S")]
    seconds: f64,
    /// Number of trials, each with its own seed.
    #[arg(long, default_value_t = 6, value_name = "K")]
    seeds: u64,
    /// Switch an effect on that nobody declared, find it on the bench, use it.
    /// NAME, NAME:STRENGTH or NAME@CHANNEL:STRENGTH, strength in N·m rms.
    #[arg(long, value_name = "NAME[@CHANNEL][:STRENGTH]")]
    effect: Option<String>,
    /// A file of `close --model-out`, which is fed forward. With --gains or a number of the rig
    /// the rig has its transmission and effects, and the reference stays within what its
    /// record has covered. Or gains, rig and model in one file.
    #[arg(long, value_name = "MODEL.toml")]
    model: Option<PathBuf>,
    /// Gains of `bowden design`, with the model that they were designed for in --model; or
    /// gains, rig and model in one file.
    #[arg(long, value_name = "GAINS.toml")]
    gains: Option<PathBuf>,
    #[command(flatten)]
    rig: RigOptions,
    /// Reference, torques, command and estimates over time of the first trial, as CSV.
    #[arg(long, value_name = "FILE.csv")]
    trace: Option<PathBuf>,
    /// Write the comparison as one HTML page that loads nothing: tables, and reference, torques,
    /// errors and estimates over time, with the conduit at rest and moved.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
    /// Print one JSON object on stdout instead of tables.
    #[arg(long)]
    json: bool,
}

/// Numbers of the rig.
#[derive(Args)]
struct RigOptions {
    /// Torque at the proximal pulley per command unit [N·m]; where not given, that of the
    /// --gains of `bowden design`, or 0.6.
    #[arg(long, value_name = "N·m")]
    drive_gain: Option<f64>,
    /// Inertia of motor and proximal pulley [kg·m²]; 0.2 where not given.
    #[arg(long, value_name = "KG·M²")]
    inertia: Option<f64>,
    /// Viscous friction of motor and proximal pulley [N·m·s/rad]; 2.7 where not given.
    #[arg(long, value_name = "N·m·s")]
    damping: Option<f64>,
    /// Inertia of the joint [kg·m²]; 0.004 where not given.
    #[arg(long, value_name = "KG·M²")]
    joint_inertia: Option<f64>,
    /// Damping of the joint [N·m·s/rad]; 0.5 where not given.
    #[arg(long, value_name = "N·m·s")]
    joint_damping: Option<f64>,
    /// Spring that the joint works against [N·m/rad]; 150 where not given.
    #[arg(long, value_name = "N·m")]
    spring: Option<f64>,
    /// Samples between a command and the drive, 0 to 8; 1 where not given.
    #[arg(long, value_name = "SAMPLES", value_parser = clap::value_parser!(u8).range(0..=8))]
    delay: Option<u8>,
    /// Time constant of the drive [s]; 0.0005 where not given.
    #[arg(long, value_name = "S")]
    drive_lag: Option<f64>,
    /// Time constant of the torque sensors [s]; 0.001 where not given.
    #[arg(long, value_name = "S")]
    sensor_lag: Option<f64>,
}

impl RigOptions {
    /// Numbers that no rig has are told by the option that names them.
    fn check(&self) -> Result<(), Failure> {
        let positive = [
            ("--drive-gain", self.drive_gain),
            ("--inertia", self.inertia),
            ("--joint-inertia", self.joint_inertia),
            ("--spring", self.spring),
            ("--drive-lag", self.drive_lag),
            ("--sensor-lag", self.sensor_lag),
        ];
        let not_negative = [
            ("--damping", self.damping),
            ("--joint-damping", self.joint_damping),
        ];
        for (option, value) in positive {
            if let Some(value) = value.filter(|v| !(v.is_finite() && *v > 0.0)) {
                return Err(format!(
                    "{option} {value}: a number above zero was expected"
                ));
            }
        }
        for (option, value) in not_negative {
            if let Some(value) = value.filter(|v| !(v.is_finite() && *v >= 0.0)) {
                return Err(format!("{option} {value}: zero or more was expected"));
            }
        }
        Ok(())
    }

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
        self.check()?;
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
        };
        let compared = compare(&question)?;
        let mut files = Vec::new();
        if let Some(path) = &self.report {
            let mut both = vec![compared.clone()];
            // The paper has each law with the conduit at rest (Figure 7) and moved (Figure 8).
            if self.effect.is_none() {
                let varying = !compared.heading.varying;
                let other = compare(&Question {
                    varying,
                    ..question
                })?;
                // A setup may move the conduit by itself.
                both.extend((other.heading.varying == varying).then_some(other));
            }
            let page = Page { compared: &both };
            files.push((path.clone(), page.page(&provenance(sources)).into_bytes()));
        }
        if let Some(path) = &self.trace {
            files.push((path.clone(), trace(&compared.traced()).into_bytes()));
        }
        outputs::write_together(&files)?;
        let out = match self.json {
            true => json(&compared),
            false => text(&compared),
        };
        super::say(out.trim_end())
    }

    fn check(&self) -> Result<(), Failure> {
        if !(self.seconds.is_finite() && (8.0..=3600.0).contains(&self.seconds)) {
            return Err(format!(
                "--seconds {}: between 8 and 3600 was expected",
                self.seconds
            ));
        }
        if !(1..=1000).contains(&self.seeds) {
            return Err(format!(
                "--seeds {}: between 1 and 1000 was expected",
                self.seeds
            ));
        }
        self.rig.check()
    }
}
