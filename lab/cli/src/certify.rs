//! `bowden certify`: gains in, certificates out.

use super::Failure;
use crate::view::{certificates, proof};
use bowden_trials::facts::{certify, prove};
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Args)]
pub struct Certify {
    /// Your gains of the lag form and what is known of the plant: is the box of the error
    /// proved for the controller as it computes, every rounding included? Exit status 1
    /// where it is not.
    #[arg(value_name = "GAINS.toml", conflicts_with = "gains")]
    own: Option<PathBuf>,
    /// Gains and rig; the paper's and the reference rig's where not given.
    #[arg(long, visible_alias = "model", value_name = "FILE.toml")]
    gains: Option<PathBuf>,
    /// Print one JSON object on stdout instead of a table.
    #[arg(long)]
    json: bool,
}

/// Exit status of gains that are not proved.
const NOT_PROVED: u8 = 1;

impl Certify {
    pub fn run(self) -> Result<ExitCode, Failure> {
        let Some(path) = &self.own else {
            let all = certify(self.gains.as_deref())?;
            let report = match self.json {
                true => certificates::json(&all),
                false => certificates::text(&all),
            };
            super::say(report.trim_end())?;
            return Ok(ExitCode::SUCCESS);
        };
        let proof = prove(path)?;
        let report = match self.json {
            true => proof::json(&proof).map_err(|e| e.to_string())?,
            false => proof::text(&proof, &path.display().to_string()),
        };
        super::say(report.trim_end())?;
        Ok(match proof.proved {
            true => ExitCode::SUCCESS,
            false => ExitCode::from(NOT_PROVED),
        })
    }
}
