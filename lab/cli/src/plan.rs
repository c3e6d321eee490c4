//! `bowden plan`: the experiment that would tell what this record cannot.

use super::progress::{progress, telling};
use super::reading::{file, Reading};
use super::{outputs, Failure};
use bowden_lab::facts::plan;
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Args)]
pub struct Plan {
    /// A record: CSV, .mat (v5, v7.3) or Parquet.
    record: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// Where to write the trajectory; stdout where it is not given. Exit status 1 where nothing
    /// is planned: no file is written then.
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
        if let Some(verdict) = &found.undescribed {
            anstream::eprintln!("{verdict}");
        }
        let Some(planned) = &found.planned else {
            let why = nothing_planned(&found);
            return Ok(match &self.out {
                Some(path) => {
                    anstream::eprintln!("{why}; {} is not written", path.display());
                    ExitCode::from(NOTHING_TO_WRITE)
                }
                None => {
                    anstream::eprintln!("{why}");
                    ExitCode::SUCCESS
                }
            });
        };
        match &self.out {
            Some(path) => outputs::write_whole(path, planned.csv.as_bytes())?,
            None => super::pour(planned.csv.as_bytes())?,
        }
        let experiment = &planned.experiment;
        if !planned.confounded {
            let first = confounded(&found);
            anstream::eprintln!("{first}; for what the record does not identify:");
        }
        anstream::eprintln!(
            "{}; {:.1} s, speeds up to {:.2} times the recorded ones",
            experiment.trajectory,
            experiment.seconds,
            experiment.speed
        );
        for aim in &experiment.aims {
            anstream::eprintln!("  {}", aim.words());
        }
        if planned.confounded && !found.inseparable.is_empty() {
            let open = found.inseparable.join("; nor ");
            anstream::eprintln!("it does not tell {open}{}", apart(&found));
        }
        Ok(ExitCode::SUCCESS)
    }
}

/// What the record confounds and no planned motion tells.
fn confounded(found: &bowden_lab::facts::Plan) -> String {
    match found.inseparable.is_empty() {
        true => "nothing is confounded".to_owned(),
        false => format!(
            "no planned motion would tell {}{}",
            found.inseparable.join("; nor "),
            apart(found)
        ),
    }
}

/// What tells two effects of two channels apart: the planned motions keep what hung together.
fn apart(found: &bowden_lab::facts::Plan) -> String {
    let pairs = found.together.iter();
    let pairs: Vec<String> = pairs.map(|[a, b]| format!("`{a}` without `{b}`")).collect();
    match pairs.is_empty() {
        true => String::new(),
        false => format!(" (a motion of {} would)", pairs.join(", of ")),
    }
}

/// Why nothing is planned.
fn nothing_planned(found: &bowden_lab::facts::Plan) -> String {
    let parameters = match found.unidentified.as_slice() {
        [] => "every parameter is known".to_owned(),
        names => format!("no planned motion would make {} known", names.join(", ")),
    };
    let is_settled = found.inseparable.is_empty() && found.unidentified.is_empty();
    let ends = match (&found.undescribed, is_settled) {
        (Some(_), _) => "; what the model does not describe is to be mended first",
        (None, true) => ": no experiment is needed",
        (None, false) => ": no experiment of this kind helps",
    };
    format!("{}, and {parameters}{ends}", confounded(found))
}
