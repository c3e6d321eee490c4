//! Options for reading records, and options that all searches share.

use super::source::{read_with_source, Source};
use crate::ledger::Ledger;
use crate::model::declared::structure;
use crate::model::structure::Structure;
use crate::problem::{together, HeldOut, Preparation, Prepared};
use crate::record::{agree, parse, read, Options, Record, RecordError};
use crate::search::{close_within, Limits, MOST_NAMES};
use std::path::{Path, PathBuf};

/// Columns, filter, baseline model and length of the search.
#[derive(Debug, Clone, Default)]
pub struct Asked {
    /// The columns, and the part of the record that is read.
    pub options: Options,
    /// Cut-off of the filter \[Hz\]; default: from the spectrum of the input.
    pub cutoff: Option<f64>,
    /// The baseline model; `bouc-wen` if the list is empty.
    pub declare: Vec<String>,
    /// Maximum number of effects that may be added.
    pub rounds: Option<usize>,
    /// Time \[s\] after which the search returns the best model so far.
    pub budget: Option<f64>,
}

/// The names of some records.
pub(super) fn label(records: &[Record]) -> String {
    let all: Vec<&str> = records.iter().map(|r| r.path.as_str()).collect();
    all.join(", ")
}

impl Asked {
    /// Reads one record.
    ///
    /// # Errors
    /// A message with the file.
    pub fn read(&self, path: &Path) -> Result<Record, String> {
        self.read_or_refuse(path).map_err(|e| e.to_string())
    }

    /// Reads a record.
    ///
    /// # Errors
    /// The error, with its position in the file.
    pub fn read_or_refuse(&self, path: &Path) -> Result<Record, RecordError> {
        read(path, &self.options)
    }

    /// Reads a record together with the hash of the same bytes, because a file may change between
    /// two reads and a pipe can be read only once.
    ///
    /// # Errors
    /// The error, with its position in the file.
    pub fn read_with_source(&self, path: &Path) -> Result<(Record, Source), RecordError> {
        read_with_source(path, &self.options)
    }

    /// Reads a record in memory. `label` replaces the name of its file.
    ///
    /// # Errors
    /// A message with the label.
    pub fn read_text(&self, csv: &[u8], label: &str) -> Result<Record, String> {
        parse(csv, label, &self.options).map_err(|e| e.to_string())
    }

    /// The same as [`read_text`](Self::read_text), but with the error as a type.
    ///
    /// # Errors
    /// The error, with its position.
    pub fn read_text_or_refuse(&self, csv: &[u8], label: &str) -> Result<Record, RecordError> {
        parse(csv, label, &self.options)
    }

    /// Reads several records of one rig, in common units.
    ///
    /// # Errors
    /// A message with the file. Identical files, files with the same samples, files with different
    /// columns, and too many files are also errors.
    pub fn read_together(&self, paths: &[PathBuf]) -> Result<Vec<Record>, String> {
        Self::all_of(paths, |path| self.read(path))
    }

    /// The same as [`read_together`](Self::read_together), with the hash of each record.
    ///
    /// # Errors
    /// The same as [`read_together`](Self::read_together).
    pub fn read_together_with_sources(
        &self,
        paths: &[PathBuf],
    ) -> Result<(Vec<Record>, Vec<Source>), String> {
        let mut sources = Vec::new();
        let records = Self::all_of(paths, |path| {
            let (record, source) = self.read_with_source(path).map_err(|e| e.to_string())?;
            sources.push(source);
            Ok(record)
        })?;
        Ok((records, sources))
    }

    /// Like [`read_together_with_sources`](Self::read_together_with_sources), for files in memory,
    /// each with a label instead of its name.
    ///
    /// # Errors
    /// The same as [`read_together`](Self::read_together).
    pub fn read_together_in_memory(
        &self,
        files: &[(&str, &[u8])],
    ) -> Result<(Vec<Record>, Vec<Source>), String> {
        let paths: Vec<PathBuf> = files.iter().map(|(label, _)| label.into()).collect();
        let mut rest = files.iter();
        let records = Self::all_of(&paths, |_| {
            let (label, bytes) = rest.next().ok_or("no file remains")?;
            self.read_text(bytes, label)
        })?;
        let sources = files
            .iter()
            .map(|(label, bytes)| Source::of_bytes(label, bytes));
        Ok((records, sources.collect()))
    }

    fn all_of(
        paths: &[PathBuf],
        read: impl FnMut(&PathBuf) -> Result<Record, String>,
    ) -> Result<Vec<Record>, String> {
        for (index, path) in paths.iter().enumerate() {
            if paths[..index].contains(path) {
                return Err(format!("{}: given twice", path.display()));
            }
        }
        together(paths.len())?;
        let mut records = paths.iter().map(read).collect::<Result<Vec<_>, _>>()?;
        agree(&mut records).map_err(|e| e.to_string())?;
        Ok(records)
    }

    /// The same options with this cut-off \[Hz\].
    pub(super) fn at(&self, cutoff: f64) -> Self {
        Self {
            cutoff: Some(cutoff),
            ..self.clone()
        }
    }

    /// A record on its grids, and the baseline model.
    pub(super) fn prepare(&self, record: &Record) -> Result<(Prepared, Structure), String> {
        let named = |message: String| format!("{}: {message}", record.path);
        let cutoff = self.cutoff;
        let data = Prepared::new(record, Preparation { cutoff }).map_err(named)?;
        let structure = self.declared(&data).map_err(named)?;
        Ok((data, structure))
    }

    /// The same as [`prepare_all`](Self::prepare_all), for records with a motion.
    pub(super) fn prepare_moving(
        &self,
        records: &[Record],
    ) -> Result<(Prepared, Structure), String> {
        let (data, structure) = self.prepare_all(records, false)?;
        let label = label(records);
        if data.is_shuffled() {
            return Err(format!(
                "{label}: neighbouring rows of `{}` are unrelated, but the output follows the input row by row; the rows must be in time order",
                data.input.name
            ));
        }
        match data.is_at_rest() {
            true => Err(format!(
                "{label}: the input `{}` is at rest and shows only sensor noise; record a motion",
                data.input.name
            )),
            false => Ok((data, structure)),
        }
    }

    /// One record, or several on common grids, and the baseline model.
    ///
    /// With separate gains, one file does not determine the gains of another file. The end of each
    /// file is therefore held out.
    pub(super) fn prepare_all(
        &self,
        records: &[Record],
        own_gains: bool,
    ) -> Result<(Prepared, Structure), String> {
        if let [one] = records {
            return self.prepare(one);
        }
        let held_out = match !own_gains && records.len() > 2 {
            true => HeldOut::LastRecord,
            false => HeldOut::Trailing,
        };
        let cutoff = self.cutoff;
        let data = Prepared::joined(records, Preparation { cutoff }, held_out)?;
        let structure = self.declared(&data)?;
        Ok((data, structure))
    }

    /// Runs the search within the requested limits.
    pub(super) fn search(
        &self,
        data: &Prepared,
        structure: &Structure,
        tell: &dyn Fn(&str),
    ) -> Result<Ledger, String> {
        let limits = Limits {
            names: self.rounds.unwrap_or(MOST_NAMES),
            seconds: self.budget,
        };
        close_within(data, structure, limits, tell)
    }

    pub(super) fn declared(&self, data: &Prepared) -> Result<Structure, String> {
        match self.declare.is_empty() {
            true => structure(&["bouc-wen".to_owned()], data),
            false => structure(&self.declare, data),
        }
    }
}
