//! `bowden compare`: controllers on the simulated rig.

use super::drawing::provenance;
use super::Failure;
use crate::view::compare::{json, text, trace};
use bowden_lab::facts::Source;
use bowden_page::Compare as Page;
use bowden_trials::facts::{compare, Question};
use clap::Args;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct Compare {
    /// White noise of the torque sensors [N·m rms]; where not given, the experiment's
    /// 0.28, and 0.02 with --effect: through the paper's gains 0.28 hides what is gained.
    #[arg(long, value_name = "N·m")]
    noise: Option<f64>,
    /// The conduit is moved during the trials: B, kappa_eta and T0 wander.
    #[arg(long)]
    varying: bool,
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
    /// Gains, rig and the model that is fed forward; also a file of `close --model-out`.
    #[arg(long, visible_alias = "gains", value_name = "FILE.toml")]
    model: Option<PathBuf>,
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

impl Compare {
    pub fn run(self) -> Result<(), Failure> {
        self.check()?;
        let read: Vec<&Path> = self.model.as_deref().into_iter().collect();
        if let Some(path) = &self.report {
            super::writable("--report", path, &read)?;
        }
        let sources: Vec<Source> = match self.report {
            Some(_) => read
                .into_iter()
                .map(Source::of_file)
                .collect::<Result<_, _>>()?,
            None => Vec::new(),
        };
        let question = Question {
            setup: self.model.as_deref(),
            noise: self.noise,
            varying: self.varying,
            seconds: self.seconds,
            seeds: self.seeds,
            effect: self.effect.as_deref(),
            traced: self.trace.is_some() || self.report.is_some(),
        };
        let compared = compare(&question)?;
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
            super::write_whole(path, page.page(&provenance(sources)).as_bytes())?;
        }
        if let Some(path) = &self.trace {
            super::write_whole(path, trace(&compared.traced()).as_bytes())?;
        }
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
        Ok(())
    }
}
