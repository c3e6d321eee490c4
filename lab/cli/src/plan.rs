//! `bowden plan`: the experiment that would tell what these records cannot.

use super::progress::{progress, telling};
use super::reading::{files, Reading};
use super::{outputs, Failure};
use crate::view::{plan_text, Width};
use bowden_lab::facts::plan;
use clap::Args;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Args)]
pub struct Plan {
    /// One or more records of one rig: CSV, JSON, .xlsx, .mat (v5, v7.3), Parquet, .npz or .npy.
    #[arg(required = true, value_name = "RECORD")]
    records: Vec<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    /// File for the trajectory [default: stdout]. If there is no trajectory, the exit status is 1
    /// and no file is written.
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
}

impl Plan {
    pub fn run(self) -> Result<ExitCode, Failure> {
        let asked = self.reading.asked()?;
        let found = files(&self.records)?;
        let (excluded, paths) = (found.note(), found.paths);
        if let Some(out) = &self.out {
            let read: Vec<&Path> = paths.iter().map(PathBuf::as_path).collect();
            outputs::check(&read, &[("--out", out)])?;
        }
        let bar = progress();
        bar.set_message("reading");
        let records = asked.read_together(&paths)?;
        let found = plan(&records, &asked, &telling(&bar))?;
        bar.finish_and_clear();
        let label: Vec<&str> = records.iter().map(|r| r.path.as_str()).collect();
        let report = plan_text(&label.join(" "), &found, Width::of_stderr());
        anstream::eprintln!("{}", report.trim_end());
        if let Some(note) = excluded {
            anstream::eprintln!("Note    {note}");
        }
        let Some(planned) = &found.planned else {
            return Ok(match &self.out {
                Some(path) => {
                    anstream::eprintln!("{} was not written", path.display());
                    ExitCode::FAILURE
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
