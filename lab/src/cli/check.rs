//! `bowden check`: does a model still hold on the next record?

use super::reading::{Columns, ModeName};
use super::Failure;
use crate::check::{Check as Checked, Given};
use crate::record::{read, Mode};
use crate::report::{check_json, check_text};
use clap::Args;
use std::path::{Path, PathBuf};

/// A model file larger than this is none.
const LARGEST: u64 = 1 << 20;

#[derive(Args)]
pub struct Check {
    /// The model, a file of `close --model-out`.
    #[arg(value_name = "MODEL.toml")]
    model: PathBuf,
    /// A record of the same rig that the model has not seen, as CSV with a header.
    #[arg(value_name = "RECORD.csv")]
    record: PathBuf,
    #[command(flatten)]
    columns: Columns,
    /// Print one JSON object on stdout instead of text.
    #[arg(long)]
    json: bool,
    /// Write the signals over time as CSV: measured, the model as it is and with gain and
    /// offset, what each leaves, and what each part of the model adds.
    #[arg(long, value_name = "FILE.csv")]
    trace: Option<PathBuf>,
}

impl Check {
    pub fn run(self) -> Result<(), Failure> {
        let of_model = |message: String| format!("{}: {message}", self.model.display());
        let mut options = self.columns.options()?;
        let given = Given::parse(&load(&self.model)?).map_err(of_model)?;
        let mode = given.mode().map_err(of_model)?;
        let asked = self.columns.mode.map(|asked| match asked {
            ModeName::Torque => Mode::Torque,
            ModeName::Displacement => Mode::Displacement,
        });
        if asked.is_some_and(|asked| asked != mode) {
            return Err(of_model(format!(
                "--mode: the model is of {} mode",
                given.file.mode
            )));
        }
        options.mode = Some(mode);
        if let Some(path) = &self.trace {
            let read: [&Path; 2] = [&self.model, &self.record];
            super::writable("--trace", path, &read)?;
        }
        let record = read(&self.record, &options)
            .map_err(|e| format!("{e} (the model is of {} mode)", given.file.mode))?;
        let label = record.path.clone();
        let checked = Checked::new(record, &given, self.columns.cutoff)
            .map_err(|message| named(&label, &message))?;
        if let Some(path) = &self.trace {
            super::write_whole(path, checked.trace()?.as_bytes())?;
        }
        let model = self.model.display().to_string();
        let report = match self.json {
            true => check_json(&model, &label, &checked).map_err(|e| e.to_string())?,
            false => check_text(&model, &label, &checked),
        };
        super::say(report.trim_end())
    }
}

/// The message with the record's name, once.
fn named(label: &str, message: &str) -> String {
    match message.starts_with(label) {
        true => message.to_owned(),
        false => format!("{label}: {message}"),
    }
}

fn load(path: &Path) -> Result<String, Failure> {
    let failed = |message: &dyn std::fmt::Display| format!("{}: {message}", path.display());
    let size = std::fs::metadata(path).map_err(|e| failed(&e))?.len();
    if size > LARGEST {
        return Err(failed(
            &"is larger than any model; a file of `close --model-out` was expected",
        ));
    }
    let bytes = std::fs::read(path).map_err(|e| failed(&e))?;
    String::from_utf8(bytes)
        .map_err(|_| failed(&"is no text; a TOML file of `close --model-out` was expected"))
}
