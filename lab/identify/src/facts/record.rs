//! The record as it was read, filtered and split.

use crate::problem::{Piece, Prepared};
use crate::record::{Defect, Mode};
use bowden::model::Source;
use serde::Serialize;

/// One record, or several joined records of one rig.
#[derive(Debug, Clone)]
pub struct RecordFacts {
    /// Torque or displacement.
    pub mode: Mode,
    /// Name of the input column.
    pub input: String,
    /// Name of the output column.
    pub output: String,
    /// Unit of the output, if the record states it.
    pub unit: Option<String>,
    /// Names of the further channels.
    pub channels: Vec<String>,
    /// The files, in the order in which they were given.
    pub files: Vec<FileFacts>,
    /// Number of samples in all files together.
    pub samples: usize,
    /// Common sampling rate \[Hz\].
    pub rate: f64,
    /// Duration of all files together \[s\].
    pub seconds: f64,
    /// Cut-off of the filter \[Hz\].
    pub cutoff: f64,
    /// Rms sensor noise after the filter, in the unit of the output; 0 if unknown.
    pub noise_floor: f64,
    /// The same noise for the held-out data.
    pub held_out_floor: f64,
    /// Remarks on how the columns were read.
    pub notes: Vec<String>,
    /// Defects of the measurement.
    pub defects: Vec<Defect>,
}

/// One file.
#[derive(Debug, Clone, PartialEq)]
pub struct FileFacts {
    /// Its path.
    pub path: String,
    /// Number of its samples.
    pub samples: usize,
    /// Number of rows that `--drop-bad` dropped.
    pub dropped: usize,
    /// Its own sampling rate \[Hz\].
    pub rate: f64,
    /// The held-out part.
    pub held_out: HeldOutOf,
}

/// The held-out part of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum HeldOutOf {
    /// All of it.
    Whole,
    /// Nothing, because another file is held out.
    Nothing,
    /// Its end.
    Trailing,
}

impl RecordFacts {
    /// The facts of a record on its grids.
    #[must_use]
    pub fn new(data: &Prepared) -> Self {
        let own = data.pieces.iter().map(|p| p.samples as f64 / p.rate);
        Self {
            mode: data.mode,
            input: data.input.name.clone(),
            output: data.output_name.clone(),
            unit: data.output_unit.clone(),
            channels: data.channels.iter().map(|c| c.name.clone()).collect(),
            files: data.pieces.iter().map(|p| file(data, p)).collect(),
            samples: data.samples,
            rate: data.rate,
            seconds: match data.pieces.len() {
                0 | 1 => data.samples as f64 / data.rate,
                _ => own.sum(),
            },
            cutoff: data.cutoff,
            noise_floor: data.noise_floor,
            held_out_floor: data.held_out_floor,
            notes: data.notes.clone(),
            defects: data.defects.clone(),
        }
    }

    /// An error as a multiple of the noise floor; `None` if the floor is unknown.
    #[must_use]
    pub fn floors(&self, rmse: f64) -> Option<f64> {
        (self.noise_floor > 0.0).then(|| rmse / self.noise_floor)
    }

    /// A held-out error as a multiple of the noise floor there; `None` if the floor is unknown.
    #[must_use]
    pub fn held_out_floors(&self, rmse: f64) -> Option<f64> {
        (self.held_out_floor > 0.0).then(|| rmse / self.held_out_floor)
    }
}

fn file(data: &Prepared, piece: &Piece) -> FileFacts {
    let whole = data.pieces.iter().any(|p| !p.fitted);
    FileFacts {
        path: piece.path.clone(),
        samples: piece.samples,
        dropped: piece.dropped,
        rate: piece.rate,
        held_out: match (piece.fitted, whole) {
            (false, _) => HeldOutOf::Whole,
            (true, true) => HeldOutOf::Nothing,
            (true, false) => HeldOutOf::Trailing,
        },
    }
}

/// The name of a channel; empty if the record has none.
pub(super) fn channel_name(data: &Prepared, source: Source) -> String {
    data.channel(source)
        .map_or_else(String::new, |c| c.name.clone())
}
