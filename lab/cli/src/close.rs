//! `bowden identify`: the main job.

use super::drawing::{provenance, Drawing};
use super::progress::{progress, telling};
use super::reading::{files, Reading};
use super::rows::Rows;
use super::{outputs, Failure};
use crate::view::{cost_line, json, loop_text, terminal_width, text, Report, Width};
use bowden_lab::facts::{
    close, Asked, Close as Question, Closed, Detail, Form, Handed, Meter, Record, Source,
};
use bowden_page::Close as Page;
use bowden_synth::stored_csv;
use clap::{Args, ValueEnum};
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};

/// Name of the built-in record: the command that writes the same one to a file.
const EMBEDDED: &str =
    "built-in synthetic record (bowden generate --mode torque --effect viscous --seed 7)";

/// Least width of a terminal in which the loop is drawn.
const WIDE: u16 = 80;

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum PerFile {
    /// B (or kappa_x), kappa_eta and T0 (or the offset).
    Gains,
}

#[derive(Args, Default)]
pub struct Close {
    /// One or more records of one rig, or a pattern such as 'runs/*.csv' [default: the built-in
    /// record]. Formats: CSV, JSON, .xlsx, .mat (v5, v7.3), Parquet, .npz and .npy, optionally
    /// compressed with gzip. Several records give one joint model. With three or more, the whole
    /// last record is held out.
    #[arg(value_name = "RECORD")]
    records: Vec<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    /// Parameters that may differ between files, for example after the conduit was bent. The end of
    /// each file is then held out.
    #[arg(long, value_enum, value_name = "WHAT")]
    per_file: Option<PerFile>,
    /// Print one JSON object on stdout instead of text.
    #[arg(long)]
    json: bool,
    /// Also print the tests of each term, the rejected terms and the planned experiments.
    #[arg(long, short)]
    verbose: bool,
    /// Write the model: .toml for tools, .rs or .postcard for firmware. The test vector
    /// NAME.vector.csv contains samples and the outputs that the model must reproduce. With
    /// --per-file gains, each file has its own model: NAME-1.toml, NAME-2.toml, …
    #[arg(long, value_name = "FILE.toml")]
    model_out: Option<PathBuf>,
    /// Write the filtered signals over time as CSV: measured, baseline, final, residual, and each
    /// part of the final model.
    #[arg(long, value_name = "FILE.csv")]
    trace: Option<PathBuf>,
    #[command(flatten)]
    drawing: Drawing,
    /// Fit the exported model so that a feed-forward can invert it, with sigma up to
    /// B/(2·kappa_eta·rho), and without delay, lag or play in series. The report describes this
    /// model. The terms and the verdict do not change.
    #[arg(long)]
    invertible: bool,
    #[command(flatten)]
    rows: Rows,
}

impl Close {
    pub fn run(mut self) -> Result<(), Failure> {
        if self.rows.is_wanted() {
            return self.rows.run(&self.reading.asked()?);
        }
        self.rows.check_unused()?;
        let found = files(&self.records)?;
        let left_out = found.note();
        self.records = found.paths;
        let asked = self.reading.asked()?;
        if self.per_file.is_some() && self.records.len() < 2 {
            return Err("--per-file gains needs more than one file".to_owned());
        }
        self.check_files()?;
        let meter = Meter::start();
        let bar = progress();
        bar.set_message("reading");
        let (records, sources) = self.read(&asked)?;
        let chosen_cutoff = asked.cutoff.is_some();
        let wide = terminal_width().is_some_and(|width| width >= WIDE);
        let draws_loop = !self.json && wide && std::io::stdout().is_terminal();
        let question = Question {
            asked,
            own_gains: self.per_file.is_some(),
            invertible: self.invertible,
            models: self.model_out.is_some(),
            trace: self.trace.is_some(),
            figures: self.drawing.is_wanted() || draws_loop,
            detail: match self.json {
                true => Detail::EachRound,
                false => Detail::Ledger,
            },
            meter,
        };
        let mut closed = close(&records, &question, &telling(&bar))?;
        closed.facts.record.notes.extend(left_out);
        outputs::write_together(&self.files(&closed, sources)?)?;
        let report = match self.json {
            true => json(&closed.facts, Some(&closed.cost)).map_err(|e| e.to_string())?,
            false => text(
                &closed.facts,
                Report {
                    width: Width::of_stdout(),
                    verbose: self.verbose,
                    chosen_cutoff,
                },
            ),
        };
        bar.finish_and_clear();
        let drawn = closed.figures.as_ref().filter(|_| draws_loop);
        if let Some(drawn) = drawn.and_then(|figures| loop_text(&figures.signals)) {
            super::say(&drawn)?;
        }
        super::say(report.trim_end())?;
        // For whoever has watched the bar; a file or a pipe gets the report alone.
        if !self.json && std::io::stderr().is_terminal() {
            anstream::eprintln!("{}", cost_line(&closed.cost));
        }
        Ok(())
    }

    /// Models, trace, page and figure, each with its file.
    fn files(
        &self,
        closed: &Closed,
        sources: Vec<Source>,
    ) -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
        let mut files = Vec::new();
        if let Some(path) = &self.model_out {
            files.extend(model_files(path, &closed.models)?);
        }
        if let (Some(path), Some(trace)) = (&self.trace, &closed.trace) {
            files.push((path.clone(), trace.as_bytes().to_vec()));
        }
        if let Some(figures) = &closed.figures {
            let page = Page {
                facts: &closed.facts,
                figures,
                models: &closed.models,
            };
            let page = || page.page(&provenance(sources));
            files.extend(self.drawing.files(figures, page));
        }
        Ok(files)
    }

    /// Whether all that is to be written can be, before anything is computed for it.
    fn check_files(&self) -> Result<(), Failure> {
        let read: Vec<&Path> = self.records.iter().map(PathBuf::as_path).collect();
        let mut models = Vec::new();
        if let Some(path) = &self.model_out {
            model_form(path)?;
            let several = self.per_file.is_some();
            for file in written(path, if several { read.len() } else { 1 }) {
                models.extend([vector_of(&file), file]);
            }
        }
        let models = models.iter().map(|path| ("--model-out", path.as_path()));
        let trace = self.trace.as_deref().map(|path| ("--trace", path));
        let outputs: Vec<_> = models.chain(trace).chain(self.drawing.outputs()).collect();
        outputs::check(&read, &outputs)
    }

    /// The records; for a page, with the hashes of their bytes.
    fn read(&self, asked: &Asked) -> Result<(Vec<Record>, Vec<Source>), Failure> {
        if self.records.is_empty() {
            let stored = stored_csv();
            let record = asked.read_text(stored.as_bytes(), EMBEDDED)?;
            return Ok((
                vec![record],
                vec![Source::of_bytes(EMBEDDED, stored.as_bytes())],
            ));
        }
        match self.drawing.is_page() {
            true => asked.read_together_with_sources(&self.records),
            false => Ok((asked.read_together(&self.records)?, Vec::new())),
        }
    }
}

/// The model and its test vector, each with its file; with separate gains, one pair for each
/// record.
fn model_files(path: &Path, models: &[Handed]) -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
    let form = model_form(path)?;
    let mut all = Vec::new();
    for (model, own) in models.iter().zip(written(path, models.len())) {
        let named = |e: String| format!("{}: {e}", own.display());
        let bytes = model.file(form).map_err(named)?;
        let vector = model.vector().map_err(named)?.as_bytes().to_vec();
        let beside = vector_of(&own);
        all.push((own, bytes));
        all.push((beside, vector));
    }
    Ok(all)
}

/// The files of the given number of models.
fn written(path: &Path, models: usize) -> Vec<PathBuf> {
    match models {
        1 => vec![path.to_owned()],
        _ => (0..models).map(|record| numbered(path, record)).collect(),
    }
}

/// The test vector of a model, in the same folder.
fn vector_of(model: &Path) -> PathBuf {
    model.with_extension("vector.csv")
}

/// `name.toml` as `name-1.toml` for the first record.
fn numbered(path: &Path, record: usize) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!("-{}", record + 1));
    if let Some(extension) = path.extension() {
        name.push(".");
        name.push(extension);
    }
    path.with_file_name(name)
}

fn model_form(path: &Path) -> Result<Form, Failure> {
    match path.extension().and_then(|e| e.to_str()) {
        Some("toml") => Ok(Form::Toml),
        Some("rs") => Ok(Form::Rust),
        Some("postcard") => Ok(Form::Postcard),
        _ => Err(format!(
            "--model-out {}: the file name must end in .toml, .rs or .postcard",
            path.display()
        )),
    }
}
