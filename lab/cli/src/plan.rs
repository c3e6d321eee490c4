//! `bowden plan`: the experiment that would tell what this record cannot.

use super::progress::{progress, telling};
use super::reading::{file, Reading};
use super::{outputs, Failure};
use bowden_lab::facts::plan;
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct Plan {
    /// A record: CSV, .mat (v5, v7.3) or Parquet.
    record: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// Where to write the trajectory; stdout where it is not given.
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
}

impl Plan {
    pub fn run(self) -> Result<(), Failure> {
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
        let open = found.inseparable.join("; nor ");
        let (first, experiment) = match open.is_empty() {
            true => ("nothing is confounded".to_owned(), "is needed"),
            false => (
                format!("no planned motion would tell {open}"),
                "of this kind helps",
            ),
        };
        if let Some(verdict) = &found.undescribed {
            anstream::eprintln!("{verdict}");
        }
        let Some(planned) = found.planned else {
            let ends = match &found.undescribed {
                Some(_) => "; what the model does not describe is to be mended first".to_owned(),
                None => format!(": no experiment {experiment}"),
            };
            anstream::eprintln!(
                "{first}, and no planned motion would show an unknown parameter better{ends}"
            );
            return Ok(());
        };
        match &self.out {
            Some(path) => outputs::write_whole(path, planned.csv.as_bytes())?,
            None => super::pour(planned.csv.as_bytes())?,
        }
        let experiment = &planned.experiment;
        if !planned.confounded {
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
        Ok(())
    }
}
