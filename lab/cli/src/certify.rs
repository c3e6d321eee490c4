//! `bowden certify`: gains in, certificates out.

use super::Failure;
use crate::view::certificates::{json, text};
use bowden_trials::facts::certify;
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct Certify {
    /// Gains and rig; the paper's and the reference rig's where not given.
    #[arg(long, visible_alias = "model", value_name = "FILE.toml")]
    gains: Option<PathBuf>,
    /// Print one JSON object on stdout instead of a table.
    #[arg(long)]
    json: bool,
}

impl Certify {
    pub fn run(self) -> Result<(), Failure> {
        let certificates = certify(self.gains.as_deref())?;
        super::say(
            match self.json {
                true => json(&certificates),
                false => text(&certificates),
            }
            .trim_end(),
        )
    }
}
