//! `bowden certify`: certificates for gains.

use super::{outputs, Failure};
use crate::view::{certificates, proof, Width};
use bowden_trials::facts::{certify, coq, gappa, prove, Proof};
use clap::Args;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Args)]
pub struct Certify {
    /// Your gains for the first-order form, and the known ranges of the plant parameters. The
    /// program then tries to prove an error bound for the controller in its float type, including
    /// every rounding error. The exit status is 1 if the proof fails.
    #[arg(value_name = "GAINS.toml", conflicts_with = "gains")]
    own: Option<PathBuf>,
    /// Gains and rig [default: the gains of Nguyen et al. (2018) and the reference rig].
    #[arg(long, alias = "model", value_name = "FILE.toml")]
    gains: Option<PathBuf>,
    /// Also print the assumptions, the reason for each missing bound, and each inequality of a
    /// proof.
    #[arg(long, short)]
    verbose: bool,
    /// Print one JSON object on stdout instead of text.
    #[arg(long)]
    json: bool,
    /// Write the proof for your gains as a theorem that `coqc` checks independently.
    #[arg(long, value_name = "FILE.v", requires = "own")]
    coq: Option<PathBuf>,
    /// Write the rounding errors of one step as a script that `gappa` checks independently.
    #[arg(long, value_name = "FILE.g", requires = "own")]
    gappa: Option<PathBuf>,
}

impl Certify {
    pub fn run(self) -> Result<ExitCode, Failure> {
        let width = Width::of_stdout();
        let Some(path) = &self.own else {
            let all = certify(self.gains.as_deref())?;
            let label = self.gains.as_ref().map(|path| path.display().to_string());
            let report = match self.json {
                true => certificates::json(&all),
                false => certificates::text(&all, label.as_deref(), width, self.verbose),
            };
            super::say(report.trim_end())?;
            return Ok(ExitCode::SUCCESS);
        };
        let outputs = [("--coq", &self.coq), ("--gappa", &self.gappa)];
        let outputs = outputs.map(|(option, file)| Some((option, file.as_deref()?)));
        let outputs: Vec<(&str, &Path)> = outputs.into_iter().flatten().collect();
        outputs::check(&[path], &outputs)?;
        let proof = prove(path)?;
        if proof.proved {
            self.write(&proof)?;
        }
        let report = match self.json {
            true => proof::json(&proof).map_err(|e| e.to_string())?,
            false => proof::text(&proof, &path.display().to_string(), width, self.verbose),
        };
        super::say(report.trim_end())?;
        Ok(match proof.proved {
            true => ExitCode::SUCCESS,
            false => ExitCode::FAILURE,
        })
    }

    /// All files that are asked for, or none.
    fn write(&self, proof: &Proof) -> Result<(), Failure> {
        type Text = fn(&Proof) -> Result<String, String>;
        let asked: [(&Option<PathBuf>, Text); 2] = [(&self.coq, coq), (&self.gappa, gappa)];
        let mut files = Vec::new();
        for (path, text) in asked {
            if let Some(path) = path {
                files.push((Path::to_path_buf(path), text(proof)?.into_bytes()));
            }
        }
        outputs::write_together(&files)
    }
}
