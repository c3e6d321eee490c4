//! `bowden close`: the main job.

use super::reading::{progress, Reading};
use super::Failure;
use crate::closing::close;
use crate::export::ModelFile;
use crate::record::{parse, read};
use crate::report::{json, text, Report};
use crate::synth::{generate, Planted, Recipe};
use clap::Args;
use std::path::{Path, PathBuf};

/// Name of the embedded record: the command that writes the same one to a file.
const EMBEDDED: &str = "(embedded: bowden record --mode torque --effect viscous --seed 7)";

#[derive(Args, Default)]
pub struct Close {
    /// A CSV file with a header; the embedded record where it is not given.
    record: Option<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    /// Print one JSON object on stdout instead of tables.
    #[arg(long)]
    json: bool,
    /// Write the final model: .toml for tools, .rs for firmware.
    #[arg(long, value_name = "FILE.toml")]
    model_out: Option<PathBuf>,
}

impl Close {
    pub fn run(self) -> Result<(), Failure> {
        let options = self.reading.options()?;
        if let Some(path) = &self.model_out {
            model_form(path)?;
        }
        let bar = progress();
        bar.set_message("reading");
        let (label, record) = match &self.record {
            Some(path) => {
                let label = path.display().to_string();
                (label, read(path, &options).map_err(|e| e.to_string())?)
            }
            None => {
                let recipe = Recipe {
                    effects: vec![Planted::new("viscous")],
                    seed: 7,
                    ..Recipe::new(crate::synth::Mode::Torque)
                };
                let csv = generate(&recipe).map_err(|e| e.to_string())?.to_csv();
                (
                    EMBEDDED.to_owned(),
                    parse(csv.as_bytes(), EMBEDDED, &options).map_err(|e| e.to_string())?,
                )
            }
        };
        let (data, structure) = self.reading.prepare(&record)?;
        let ledger = close(&data, &structure, |what| bar.set_message(what.to_owned()))
            .map_err(|message| format!("{label}: {message}"))?;
        bar.finish_and_clear();
        if let Some(path) = &self.model_out {
            let file = ModelFile::new(&data, ledger.last());
            let remark = format!(
                "Identified by bowden {} from {label}",
                env!("CARGO_PKG_VERSION")
            );
            let text = match model_form(path)? {
                Form::Toml => file
                    .toml(&remark)
                    .map_err(|e| format!("{}: {e}", path.display()))?,
                Form::Rust => file.rust(&remark),
            };
            super::write_whole(path, text.as_bytes())?;
        }
        if self.json {
            let text = json(&Report::new(&label, &data, &ledger)).map_err(|e| e.to_string())?;
            super::say(&text)
        } else {
            super::say(text(&label, &data, &ledger, self.reading.cutoff.is_some()).trim_end())
        }
    }
}

enum Form {
    Toml,
    Rust,
}

fn model_form(path: &Path) -> Result<Form, Failure> {
    match path.extension().and_then(|e| e.to_str()) {
        Some("toml") => Ok(Form::Toml),
        Some("rs") => Ok(Form::Rust),
        _ => Err(format!(
            "--model-out {}: a name that ends in .toml or .rs was expected",
            path.display()
        )),
    }
}
