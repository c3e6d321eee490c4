//! `bowden validate`: does a model still hold on the next record?

use super::drawing::{provenance, Drawing};
use super::pattern::LARGEST;
use super::reading::{file, Columns, ModeName};
use super::{outputs, Failure};
use crate::view::{check_json, check_text, Width};
use bowden_lab::facts::{check, CheckQuestion, ModelOfFile, Source};
use bowden_page::Check as Page;
use clap::Args;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct Check {
    /// The model: a file written by `identify --model-out`.
    #[arg(value_name = "MODEL.toml")]
    model: PathBuf,
    /// Another record from the same rig: CSV, JSON, .xlsx, .mat (v5, v7.3), Parquet, .npz or .npy.
    #[arg(value_name = "RECORD")]
    record: PathBuf,
    #[command(flatten)]
    columns: Columns,
    /// Print one JSON object on stdout instead of text.
    #[arg(long)]
    json: bool,
    /// Write the signals over time as CSV: measured, the model without and with a fitted gain and
    /// offset, both residuals, and each part of the model.
    #[arg(long, value_name = "FILE.csv")]
    trace: Option<PathBuf>,
    #[command(flatten)]
    drawing: Drawing,
}

impl Check {
    pub fn run(mut self) -> Result<(), Failure> {
        self.record = file(&self.record)?;
        let read: [&Path; 2] = [&self.model, &self.record];
        let trace = self.trace.as_deref().map(|path| ("--trace", path));
        let outputs: Vec<_> = trace.into_iter().chain(self.drawing.outputs()).collect();
        outputs::check(&read, &outputs)?;
        let of_model = |message: String| format!("{}: {message}", self.model.display());
        let asked = self.columns.asked()?;
        let given = ModelOfFile::parse(&load(&self.model)?).map_err(of_model)?;
        given.could_hold().map_err(of_model)?;
        let mode = self.columns.mode.map(ModeName::mode);
        if mode.is_some_and(|mode| mode != given.mode()) {
            return Err(of_model(format!(
                "--mode must be {}, the mode of the model",
                given.mode().name()
            )));
        }
        let question = CheckQuestion {
            asked,
            trace: self.trace.is_some(),
            figures: self.drawing.is_wanted(),
        };
        let sources = match self.drawing.is_page() {
            true => read
                .map(Source::of_file)
                .into_iter()
                .collect::<Result<_, _>>()?,
            false => Vec::new(),
        };
        let checked = check(&given, &self.record, &question)?;
        let mut files = Vec::new();
        if let (Some(path), Some(trace)) = (&self.trace, &checked.trace) {
            files.push((path.clone(), trace.as_bytes().to_vec()));
        }
        let model = self.model.display().to_string();
        let (label, facts) = (&checked.label, &checked.facts);
        if let Some(figures) = &checked.figures {
            let page = Page {
                model: &model,
                record: label,
                facts,
                figures,
            };
            let from = provenance(sources);
            files.extend(self.drawing.files(figures, || page.page(&from)));
        }
        outputs::write_together(&files)?;
        let report = match self.json {
            true => check_json(&model, label, facts).map_err(|e| e.to_string())?,
            false => check_text(&model, label, facts, Width::of_stdout()),
        };
        super::say(report.trim_end())
    }
}

pub fn load(path: &Path) -> Result<String, Failure> {
    let failed = |message: &dyn std::fmt::Display| format!("{}: {message}", path.display());
    let size = std::fs::metadata(path).map_err(|e| failed(&e))?.len();
    if size > LARGEST {
        return Err(failed(
            &"the file is larger than any model file; pass a file written by `identify --model-out`",
        ));
    }
    let bytes = std::fs::read(path).map_err(|e| failed(&e))?;
    String::from_utf8(bytes).map_err(|_| {
        failed(&"the file is not text; pass a TOML file written by `identify --model-out`")
    })
}
