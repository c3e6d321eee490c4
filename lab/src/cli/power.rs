//! `bowden power`: what would have been found on this record.

use super::reading::{progress, Reading};
use super::Failure;
use crate::foresight::power::{power, Question, TRIALS, TRIALS_RANGE};
use crate::record::read;
use crate::report::{power_json, power_text};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct Power {
    /// A CSV file with a header.
    record: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// Only these effects or families; NAME@CHANNEL for one channel.
    #[arg(long, value_delimiter = ',', value_name = "NAME,…")]
    effects: Vec<String>,
    /// Trials of each amplitude, 5 to 200.
    #[arg(long, value_name = "K", default_value_t = TRIALS)]
    trials: usize,
    /// Print one JSON object on stdout instead of a table.
    #[arg(long)]
    json: bool,
}

impl Power {
    pub fn run(self) -> Result<(), Failure> {
        if !TRIALS_RANGE.contains(&self.trials) {
            return Err(format!(
                "--trials {}: {} to {} were expected",
                self.trials,
                TRIALS_RANGE.start(),
                TRIALS_RANGE.end()
            ));
        }
        let options = self.reading.options()?;
        let bar = progress();
        bar.set_message("reading");
        let label = self.record.display().to_string();
        let record = read(&self.record, &options).map_err(|e| e.to_string())?;
        let (data, structure) = self.reading.prepare(&record)?;
        let ledger = self
            .reading
            .close(&data, &structure, |what| bar.set_message(what.to_owned()))
            .map_err(|message| format!("{label}: {message}"))?;
        let question = Question {
            effects: self.effects,
            trials: self.trials,
        };
        let table = power(&data, &ledger, &question, |done, all| {
            bar.set_message(format!("planting: {done} of {all} effects"));
        })?;
        bar.finish_and_clear();
        if self.json {
            super::say(&power_json(&label, &data, &ledger, &table).map_err(|e| e.to_string())?)
        } else {
            super::say(power_text(&label, &data, &ledger, &table).trim_end())
        }
    }
}
