//! `bowden design`: gains from an identified model.

use super::{outputs, Failure};
use crate::view::design::{json, text};
use crate::view::Width;
use bowden_trials::facts::{design, design_rust, DesignQuestion};
use clap::Args;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct Design {
    /// The model: a file written by `identify --model-out` in torque mode.
    #[arg(value_name = "MODEL.toml")]
    model: PathBuf,
    /// Sampling rate of the controller [Hz].
    #[arg(long, value_name = "HZ")]
    rate: f64,
    /// Delay from a command to its effect on the measured torque [s]: transport, computation, and
    /// the time constants of drive, sensor and joint. The program adds half a sample for the
    /// zero-order hold.
    #[arg(long, value_name = "SECONDS")]
    delay: f64,
    /// Noise of the measured torque [N·m rms], which determines the lowest slew-rate limit.
    #[arg(
        long,
        value_name = "N·m",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    noise: f64,
    /// Torque at the proximal pulley per command unit [N·m]. The rig of `compare --gains` also uses
    /// this value.
    #[arg(
        long,
        value_name = "N·m",
        default_value_t = 1.0,
        allow_negative_numbers = true
    )]
    drive_gain: f64,
    /// Write the gains: .toml for `compare --gains` and for firmware with serde, or .rs for other
    /// firmware.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Also print the required margins, the admissible gains, and the origin of the limits and
    /// bounds.
    #[arg(long, short)]
    verbose: bool,
    /// Print one JSON object on stdout instead of text.
    #[arg(long)]
    json: bool,
}

impl Design {
    pub fn run(self) -> Result<(), Failure> {
        let rust = self.out.as_deref().map(is_rust).transpose()?;
        if let Some(path) = &self.out {
            outputs::check(&[&self.model], &[("--out", path)])?;
        }
        let question = DesignQuestion {
            rate: self.rate,
            delay: self.delay,
            noise: self.noise,
            drive_gain: self.drive_gain,
        };
        question.check()?;
        let label = self.model.display().to_string();
        let designed = design(&super::check::load(&self.model)?, &label, &question)?;
        if let (Some(path), Some(rust)) = (&self.out, rust) {
            let written = match rust {
                true => design_rust(&designed),
                false => designed.gains.toml().map_err(|e| e.to_string())?,
            };
            outputs::write_whole(path, written.as_bytes())?;
        }
        let report = match self.json {
            true => json(&designed).map_err(|e| e.to_string())?,
            false => text(&designed, Width::of_stdout(), self.verbose),
        };
        super::say(report.trim_end())
    }
}

/// Whether a file of gains is one for a compiler.
fn is_rust(path: &Path) -> Result<bool, Failure> {
    match path.extension().and_then(|e| e.to_str()) {
        Some("rs") => Ok(true),
        Some("toml") => Ok(false),
        _ => Err(format!(
            "--out {}: the file name must end in .toml or .rs",
            path.display()
        )),
    }
}
