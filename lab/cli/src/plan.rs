//! `bowden plan`: the experiment that would tell what this record cannot.

use super::progress::{progress, telling};
use super::reading::{file, Reading};
use super::{outputs, Failure};
use crate::view::{plan_text, Width};
use bowden_lab::facts::plan;
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Args)]
pub struct Plan {
    /// A record: CSV, JSON, .mat (v5, v7.3), Parquet or .npz.
    record: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// File for the trajectory [default: stdout]. If there is no trajectory, the exit status is 1
    /// and no file is written.
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
}

/// Exit status where a file was asked for and nothing is planned that could be written.
const NOTHING_TO_WRITE: u8 = 1;

impl Plan {
    pub fn run(self) -> Result<ExitCode, Failure> {
        let asked = self.reading.asked()?;
        let path = file(&self.record)?;
        if let Some(out) = &self.out {
            outputs::check(&[&path], &[("--out", out)])?;
        }
        let bar = progress();
        bar.set_message("reading");
        let record = asked.read(&path)?;
        let found = plan(&record, &asked, &telling(&bar))?;
        bar.finish_and_clear();
        let report = plan_text(&record.path, &found, Width::of_stderr());
        anstream::eprintln!("{}", report.trim_end());
        let Some(planned) = &found.planned else {
            return Ok(match &self.out {
                Some(path) => {
                    anstream::eprintln!("{} was not written", path.display());
                    ExitCode::from(NOTHING_TO_WRITE)
                }
                None => ExitCode::SUCCESS,
            });
        };
        match &self.out {
            Some(path) => outputs::write_whole(path, planned.csv.as_bytes())?,
            None => super::pour(planned.csv.as_bytes())?,
        }
        Ok(ExitCode::SUCCESS)
    }
}
