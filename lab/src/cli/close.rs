//! `bowden close`: the main job.

use super::reading::{progress, Reading};
use super::Failure;
use crate::conclude::final_fit::FinalFit;
use crate::conclude::trace::trace;
use crate::export::hand_over::HandOver;
use crate::export::{postcard, vector};
use crate::fit::{fit, Solution};
use crate::model::structure::Structure;
use crate::problem::{HeldOut, Prepared};
use crate::record::{agree, parse, read, Options, Record};
use crate::report::{json, text, Meter, Report, Stage};
use bowden_synth::stored_csv;
use clap::{Args, ValueEnum};
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};

/// Name of the embedded record: the command that writes the same one to a file.
const EMBEDDED: &str = "(embedded: bowden generate --mode torque --effect viscous --seed 7)";

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum PerFile {
    /// B (or kappa_x), kappa_eta and T0 (or the offset).
    Gains,
}

#[derive(Args, Default)]
pub struct Close {
    /// CSV files with a header, several of one rig for one joint model; the embedded
    /// record where none is given. Of three or more the last is held out as a whole.
    #[arg(value_name = "RECORD")]
    records: Vec<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    /// What may differ from file to file, as after a change of the rig's configuration.
    /// Then the end of each file is held out.
    #[arg(long, value_enum, value_name = "WHAT")]
    per_file: Option<PerFile>,
    /// Print one JSON object on stdout instead of tables.
    #[arg(long)]
    json: bool,
    /// Write the model: .toml for tools, .rs or .postcard for firmware; beside it, as
    /// NAME.vector.csv, samples and what the model must answer. With --per-file gains one
    /// for each file: NAME-1.toml, NAME-2.toml, …
    #[arg(long, value_name = "FILE.toml")]
    model_out: Option<PathBuf>,
    /// Write the signals over time as CSV, as the fit sees them: measured, declared, final,
    /// residual, and what each part of the final model adds.
    #[arg(long, value_name = "FILE.csv")]
    trace: Option<PathBuf>,
    /// Fit the model that is written within what a feed-forward can invert: sigma up to
    /// B/(2·kappa_eta·rho), no delay, no lag, no play in series. What was found and the
    /// verdict stay as they are.
    #[arg(long)]
    invertible: bool,
}

impl Close {
    pub fn run(self) -> Result<(), Failure> {
        let options = self.reading.options()?;
        if self.per_file.is_some() && self.records.len() < 2 {
            return Err("--per-file gains: more than one file was expected".to_owned());
        }
        let read: Vec<&Path> = self.records.iter().map(PathBuf::as_path).collect();
        self.can_write(&read)?;
        let mut meter = Meter::start();
        let bar = progress();
        bar.set_message("reading");
        let records = self.read(&options)?;
        meter.begins(Stage::Preparing);
        let label: Vec<&str> = records.iter().map(|r| r.path.as_str()).collect();
        let label = label.join(", ");
        let (mut data, mut structure) = match &records[..] {
            [one] => self.reading.prepare(one)?,
            all => self.reading.prepare_joined(all, self.held_out())?,
        };
        if self.per_file.is_some() {
            if !structure.hysteresis {
                return Err(
                    "--per-file gains: they are those of bouc-wen, which --declare leaves out"
                        .to_owned(),
                );
            }
            structure.own_gains = records.len();
        }
        let ledger = self
            .reading
            .close(&data, &structure, |what| {
                bar.set_message(what.to_owned());
                meter.told();
            })
            .map_err(|message| format!("{label}: {message}"))?;
        if self.per_file.is_none() && records.len() > 1 {
            bar.set_message("trying each file with gains of its own");
            data.notes.extend(hint(&data, &ledger.declared));
        }
        meter.begins(Stage::Concluding);
        bar.set_message("fitting the final model");
        let done = FinalFit::new(&data, &ledger);
        let hand = HandOver::new(&records, &data, &ledger, &done, self.invertible, |what| {
            bar.set_message(what.to_owned());
        });
        // What was found stands, whether firmware can have it or not.
        let hand = match hand {
            Err(message) if self.invertible || self.model_out.is_some() => {
                return Err(format!("{label}: {message}"));
            }
            hand => hand,
        };
        if let (Some(path), Ok(hand)) = (&self.model_out, &hand) {
            write_models(path, &data, hand)?;
        }
        if let Some(path) = &self.trace {
            super::write_whole(path, trace(&data, &ledger, &done)?.as_bytes())?;
        }
        bar.set_message("looking for declared parts that are not needed");
        let hand = hand.as_ref().map_err(String::as_str);
        let report = if self.json {
            let report = Report::new(&label, &data, &ledger, &done, hand);
            json(&report.with_cost(meter.read())).map_err(|e| e.to_string())?
        } else {
            let chosen = self.reading.columns.cutoff.is_some();
            text(&label, &data, &ledger, &done, hand, chosen)
        };
        bar.finish_and_clear();
        super::say(report.trim_end())?;
        // For whoever has watched the spinner; a file or a pipe gets the report alone.
        if !self.json && std::io::stderr().is_terminal() {
            anstream::eprintln!("{}", meter.read().line());
        }
        Ok(())
    }

    /// Refuses before anything is computed what could not be written afterwards.
    fn can_write(&self, read: &[&Path]) -> Result<(), Failure> {
        if let Some(path) = &self.model_out {
            model_form(path)?;
            let several = self.per_file.is_some();
            for file in written(path, if several { read.len() } else { 1 }) {
                super::writable("--model-out", &file, read)?;
                super::writable("--model-out", &vector_of(&file), read)?;
            }
        }
        match &self.trace {
            Some(path) => super::writable("--trace", path, read),
            None => Ok(()),
        }
    }

    /// With gains of its own a file says nothing of another one's: the end of each is held
    /// out then.
    fn held_out(&self) -> HeldOut {
        match self.per_file.is_none() && self.records.len() > 2 {
            true => HeldOut::LastRecord,
            false => HeldOut::Trailing,
        }
    }

    fn read(&self, options: &Options) -> Result<Vec<Record>, Failure> {
        if self.records.is_empty() {
            return Ok(vec![embedded(options)?]);
        }
        for (index, path) in self.records.iter().enumerate() {
            if self.records[..index].contains(path) {
                return Err(format!("{}: given twice", path.display()));
            }
        }
        let read = |path: &PathBuf| read(path, options).map_err(|e| e.to_string());
        let mut records = self
            .records
            .iter()
            .map(read)
            .collect::<Result<Vec<_>, _>>()?;
        agree(&mut records).map_err(|e| e.to_string())?;
        Ok(records)
    }
}

/// Files of several configurations fitted as one: gains of their own for each leave less
/// than this share of the declared model's error.
const OTHER_CONFIGURATION: f64 = 0.5;

/// What to try where the files do not seem to be of one configuration.
fn hint(data: &Prepared, declared: &Solution) -> Option<String> {
    if !declared.structure.hysteresis {
        return None;
    }
    let structure = Structure {
        own_gains: data.pieces.len(),
        ..declared.structure.clone()
    };
    let own = fit(data, &structure, None, 0.0)?.rmse.fit / declared.rmse.fit;
    (own < OTHER_CONFIGURATION).then(|| {
        format!(
            "with gains of its own for each file the declared model leaves {:.0} % of this error on the fit segments: try --per-file gains",
            100.0 * own
        )
    })
}

fn embedded(options: &Options) -> Result<Record, Failure> {
    parse(stored_csv().as_bytes(), EMBEDDED, options).map_err(|e| e.to_string())
}

/// Writes the model and its test vector; where each file has gains of its own, one of both
/// for each. All are written or none.
fn write_models(path: &Path, data: &Prepared, hand: &HandOver) -> Result<(), Failure> {
    let mut all = Vec::new();
    let paths = written(path, hand.files.len());
    for (record, (file, own)) in hand.files.iter().zip(paths).enumerate() {
        let named = |e: String| format!("{}: {e}", own.display());
        let model = match model_form(path)? {
            Form::Toml => file.toml().map_err(|e| named(e.to_string()))?.into_bytes(),
            Form::Rust => file.rust().map_err(named)?.into_bytes(),
            Form::Postcard => postcard(file).map_err(named)?,
        };
        let samples = vector::csv(data, record, file).map_err(named)?;
        let beside = vector_of(&own);
        all.push((own, model));
        all.push((beside, samples.into_bytes()));
    }
    super::write_together(&all)
}

/// The files of so many models.
fn written(path: &Path, models: usize) -> Vec<PathBuf> {
    match models {
        1 => vec![path.to_owned()],
        _ => (0..models).map(|record| numbered(path, record)).collect(),
    }
}

/// The test vector of a model, beside it.
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

enum Form {
    Toml,
    Rust,
    Postcard,
}

fn model_form(path: &Path) -> Result<Form, Failure> {
    match path.extension().and_then(|e| e.to_str()) {
        Some("toml") => Ok(Form::Toml),
        Some("rs") => Ok(Form::Rust),
        Some("postcard") => Ok(Form::Postcard),
        _ => Err(format!(
            "--model-out {}: a name that ends in .toml, .rs or .postcard was expected",
            path.display()
        )),
    }
}
