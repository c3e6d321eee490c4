//! `bowden identify --glob PATTERN --out ROWS.parquet`: identifies each of many records separately
//! and writes one row per record.
//!
//! A separate process identifies each record: the program itself with `--row`. A failure of this
//! process, such as running out of memory, affects only the row of that record, and the counts in a
//! row are those of one record.

mod row;
mod table;

use crate::bar::{ProgressBar, ProgressStyle};
use crate::view::json;
use crate::{outputs, reading, Failure};
use bowden_lab::facts::{close, Asked, Close as Question, Detail, Meter};
use clap::Args;
use row::Row;
use std::ffi::OsString;
use std::io::IsTerminal as _;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

/// Of `identify`: what concerns many records.
#[derive(Args, Default)]
#[group(id = "rows")]
pub struct Rows {
    /// Identify a separate model from each record of a pattern such as 'runs/*.csv', and write one
    /// row per record to --out. If an identification fails, its row contains the error.
    #[arg(long, value_name = "PATTERN", requires = "out", conflicts_with_all = ["records", "per_file", "json", "model_out", "trace", "invertible", "Drawing"])]
    glob: Option<PathBuf>,
    /// File for the rows of --glob.
    #[arg(long, value_name = "ROWS.parquet")]
    out: Option<PathBuf>,
    /// Number of records that --glob processes at a time [default: the number of processors].
    #[arg(long, value_name = "N")]
    workers: Option<NonZeroUsize>,
    /// Print the row of this record as JSON: what --glob has its processes do.
    #[arg(long, hide = true, value_name = "FILE")]
    row: Option<PathBuf>,
}

impl Rows {
    /// Whether rows are requested instead of a results table.
    pub fn is_wanted(&self) -> bool {
        self.glob.is_some() || self.row.is_some()
    }

    /// Checks that no option is given that only `--glob` reads. The parser does not ask for an
    /// option that another argument excludes, as a record excludes `--glob`.
    pub fn check_unused(&self) -> Result<(), Failure> {
        if let Some(out) = &self.out {
            return Err(format!(
                "--out {} needs --glob; to write the model, use --model-out FILE.toml",
                out.display()
            ));
        }
        match self.workers {
            Some(workers) => Err(format!("--workers {workers} needs --glob")),
            None => Ok(()),
        }
    }

    /// Identifies a model from one record or from each of many.
    pub fn run(&self, asked: &Asked) -> Result<(), Failure> {
        if let Some(file) = &self.row {
            return crate::say(&one(file, asked).json()?);
        }
        let (Some(pattern), Some(out)) = (&self.glob, &self.out) else {
            return Err("--glob and --out must be given together".to_owned());
        };
        let found = reading::files(std::slice::from_ref(pattern))?;
        let left_out = found
            .note()
            .map_or_else(String::new, |note| format!("; {note}"));
        let files = found.paths;
        let read: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
        outputs::check(&read, &[("--out", out)])?;
        let rows = all(&files, self.workers)?;
        let errors = rows.iter().filter(|row| row.is_error()).count();
        outputs::write_whole(out, &table::parquet(&rows)?)?;
        crate::say(&format!(
            "{}: {} rows, one per record; {errors} records could not be identified{left_out}",
            out.display(),
            rows.len()
        ))
    }
}

/// The row of one record.
fn one(file: &Path, asked: &Asked) -> Row {
    let meter = Meter::start();
    let name = file.to_string_lossy();
    let record = match asked.read_or_refuse(file) {
        Ok(record) => record,
        Err(error) => return Row::refused(&name, &error),
    };
    let question = Question {
        asked: asked.clone(),
        own_gains: false,
        invertible: false,
        models: false,
        trace: false,
        figures: false,
        detail: Detail::EachRound,
        meter,
    };
    let closed = close(&[record], &question, &|_| ());
    let text = closed.and_then(|closed| {
        json(&closed.facts, Some(&closed.cost)).map_err(|error| error.to_string())
    });
    match text.and_then(|text| Row::of_json(&name, &text)) {
        Ok(row) => row,
        Err(message) => Row::failed(&name, message),
    }
}

/// The rows of all records, in their order.
fn all(files: &[PathBuf], workers: Option<NonZeroUsize>) -> Result<Vec<Row>, Failure> {
    let program = std::env::current_exe()
        .map_err(|e| format!("cannot find the executable of this program: {e}"))?;
    let processors = || thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let workers = workers.map_or_else(processors, NonZeroUsize::get);
    let bar = progress(files.len());
    let next = AtomicUsize::new(0);
    let work = || {
        let mut rows = Vec::new();
        while let Some((index, file)) = {
            let index = next.fetch_add(1, Ordering::Relaxed);
            files.get(index).map(|file| (index, file))
        } {
            rows.push((index, in_a_process(&program, file)));
            bar.inc(1);
        }
        rows
    };
    let mut rows: Vec<(usize, Row)> = thread::scope(|scope| {
        let running: Vec<_> = (0..workers.min(files.len()))
            .map(|_| scope.spawn(work))
            .collect();
        running
            .into_iter()
            .filter_map(|worker| worker.join().ok())
            .flatten()
            .collect()
    });
    bar.finish_and_clear();
    rows.sort_by_key(|(index, _)| *index);
    if rows.len() < files.len() {
        return Err("a worker process failed, so at least one record has no row".to_owned());
    }
    Ok(rows.into_iter().map(|(_, row)| row).collect())
}

/// The row of a record from a separate process: this command with `--row`.
fn in_a_process(program: &Path, file: &Path) -> Row {
    let name = file.to_string_lossy();
    let mut asked = OsString::from("--row=");
    asked.push(file);
    let output = Command::new(program)
        .args(std::env::args_os().skip(1))
        .arg(asked)
        // The numbers do not depend on it; the records side by side fill the processors.
        .env("RAYON_NUM_THREADS", "1")
        .stdin(Stdio::null())
        .output();
    match output {
        Ok(output) if output.status.success() => {
            let text = String::from_utf8_lossy(&output.stdout);
            Row::parse(&text).unwrap_or_else(|e| Row::failed(&name, e))
        }
        Ok(output) => {
            let words = String::from_utf8_lossy(&output.stderr);
            let last = words.trim().lines().last().unwrap_or_default();
            Row::failed(&name, format!("{name}: {}: {last}", output.status))
        }
        Err(error) => Row::failed(&name, format!("{name}: cannot start a process: {error}")),
    }
}

/// A bar over the records on a terminal, nothing elsewhere.
fn progress(records: usize) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(records as u64);
    let template = "{elapsed} {bar:24} {pos} of {len} records, about {eta} left";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.progress_chars("━╸─"));
    }
    bar.enable_steady_tick(Duration::from_millis(100));
    bar
}
