//! `bowden plan`: the experiment that would tell what this record cannot.

use super::reading::{progress, Reading};
use super::Failure;
use crate::conclude::final_fit::FinalFit;
use crate::foresight::plan::{separate_first, strengthen, trajectory};
use crate::record::read;
use clap::Args;
use std::io::Write as _;
use std::path::PathBuf;

#[derive(Args)]
pub struct Plan {
    /// A CSV file with a header.
    record: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// Where to write the trajectory; stdout where it is not given.
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
}

impl Plan {
    pub fn run(self) -> Result<(), Failure> {
        let options = self.reading.options()?;
        let bar = progress();
        bar.set_message("reading");
        let record = read(&self.record, &options).map_err(|e| e.to_string())?;
        let (data, structure) = self.reading.prepare(&record)?;
        let ledger = self
            .reading
            .close(&data, &structure, |what| bar.set_message(what.to_owned()))
            .map_err(|message| format!("{}: {message}", record.path))?;
        bar.set_message("planning");
        let separated = separate_first(&data, &ledger);
        let confounded = separated.is_some();
        let planned = separated.or_else(|| {
            let done = FinalFit::new(&data, &ledger);
            strengthen(&done.data, &done.solution)
        });
        bar.finish_and_clear();
        let Some(experiment) = planned else {
            anstream::eprintln!(
                "nothing is confounded, and no planned motion would show an unknown parameter better: no experiment is needed"
            );
            return Ok(());
        };
        let csv = trajectory(&data, experiment.kind).csv();
        match &self.out {
            Some(path) => super::write_whole(path, csv.as_bytes())?,
            None => match std::io::stdout().write_all(csv.as_bytes()) {
                // Whoever reads has had enough (`| head`).
                Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => {
                    return Err(format!("stdout: {e}"))
                }
                _ => {}
            },
        }
        if !confounded {
            anstream::eprintln!("nothing is confounded; for what the record does not identify:");
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
