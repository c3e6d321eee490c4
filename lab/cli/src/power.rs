//! `bowden power`: the effects that the search would have found in this record.

use super::progress::{progress, telling};
use super::reading::{file, Reading};
use super::Failure;
use crate::view::{power_json, power_text, Width};
use bowden_lab::facts::{power, PowerQuestion, TRIALS, TRIALS_RANGE};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct Power {
    /// A record: CSV, JSON, .xlsx, .mat (v5, v7.3), Parquet, .npz or .npy.
    record: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// Test only these effects or families. NAME@CHANNEL tests one channel.
    #[arg(long, value_delimiter = ',', value_name = "NAME,…")]
    effects: Vec<String>,
    /// Number of trials for each amplitude, 5 to 200.
    #[arg(long, value_name = "K", default_value_t = TRIALS)]
    trials: usize,
    /// Also print every effect, and the construction of the trials.
    #[arg(long, short)]
    verbose: bool,
    /// Print one JSON object on stdout instead of text.
    #[arg(long)]
    json: bool,
}

impl Power {
    pub fn run(self) -> Result<(), Failure> {
        if !TRIALS_RANGE.contains(&self.trials) {
            return Err(format!(
                "--trials {} is out of range ({} to {})",
                self.trials,
                TRIALS_RANGE.start(),
                TRIALS_RANGE.end()
            ));
        }
        let asked = self.reading.asked()?;
        let bar = progress();
        bar.set_message("reading");
        let record = asked.read(&file(&self.record)?)?;
        let question = PowerQuestion {
            effects: self.effects,
            trials: self.trials,
        };
        let table = power(&record, &asked, &question, &telling(&bar))?;
        bar.finish_and_clear();
        if self.json {
            super::say(&power_json(&table).map_err(|e| e.to_string())?)
        } else {
            super::say(power_text(&table, Width::of_stdout(), self.verbose).trim_end())
        }
    }
}
