//! The signals of a run on the estimation grid, as plain data for the figures.

use super::trace::{parts, position, Column};
use crate::fit::Solution;
use crate::problem::Prepared;
use std::ops::Range;

/// The segment that a sample belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Segment {
    /// At an end or in a gap: not used.
    Dropped,
    /// Fitted.
    Fit,
    /// Selection.
    Stop,
    /// Held out.
    HeldOut,
    /// In a validation: all samples that count.
    Checked,
}

/// One file on the common grid.
#[derive(Debug, Clone, PartialEq)]
pub struct File {
    /// The path of the file.
    pub path: String,
    /// Its samples.
    pub rows: Range<usize>,
    /// The sample with the largest model error.
    pub worst: Option<Worst>,
}

/// The sample with the largest model error.
#[derive(Debug, Clone, PartialEq)]
pub struct Worst {
    /// The sample.
    pub row: usize,
    /// Measured minus predicted at this sample, for each model.
    pub errors: [f64; 2],
    /// The samples around it: one period of the input's highest tone to either side.
    pub around: Range<usize>,
}

/// The contribution of one part of the last model.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// The part over time.
    pub signal: Column,
    /// Its standard deviation over all samples that count, as a share of the output's.
    pub share: f64,
}

/// All signals of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Signals {
    /// The files, in their order.
    pub files: Vec<File>,
    /// Step of the grid \[s\].
    pub step: f64,
    /// The segment of each sample.
    pub segments: Vec<Segment>,
    /// The input through the filter.
    pub input: Column,
    /// The channels through the filter.
    pub channels: Vec<Column>,
    /// The output through the filter.
    pub measured: Column,
    /// The predictions of two models: the baseline and the final model, or the model without and
    /// with gain and offset.
    pub models: [Column; 2],
    /// The residual of each model.
    pub residuals: [Vec<f64>; 2],
    /// The parts of the model that [`parts`](super::trace) writes.
    pub parts: Vec<Part>,
}

impl Signals {
    /// The signals of two models on a record; `whole` is the one whose parts are given.
    ///
    /// # Errors
    /// A message if the parts of the model cannot be computed.
    pub fn of(
        data: &Prepared,
        models: [(&str, &[f64]); 2],
        whole: &Solution,
    ) -> Result<Self, String> {
        let unit = data.output_unit.as_deref();
        let mut segments = vec![Segment::Dropped; data.target.len()];
        let first = match data.split.selection.is_empty() && data.split.held_out.is_empty() {
            true => Segment::Checked,
            false => Segment::Fit,
        };
        for (segment, rows) in [
            (first, &data.split.fit),
            (Segment::Stop, &data.split.selection),
            (Segment::HeldOut, &data.split.held_out),
        ] {
            rows.iter().for_each(|&row| segments[row] = segment);
        }
        let residual = |prediction: &[f64]| -> Vec<f64> {
            let pairs = data.target.iter().zip(prediction);
            pairs.map(|(y, p)| y - p).collect()
        };
        let residuals = models.map(|(_, prediction)| residual(prediction));
        let deviation = deviation(&segments, &data.target);
        let part = |signal: Column| Part {
            share: self::deviation(&segments, &signal.values) / deviation,
            signal,
        };
        let files = data.pieces.iter().map(|piece| File {
            path: piece.path.clone(),
            rows: piece.rows.clone(),
            worst: worst(data, &segments, &residuals, &piece.rows),
        });
        Ok(Self {
            files: files.collect(),
            step: data.stride as f64 * data.dt,
            input: position(data, &data.input),
            channels: data.channels.iter().map(|c| position(data, c)).collect(),
            measured: Column::new(data.output_name.clone(), unit, data.target.clone()),
            models: models.map(|(name, values)| Column::new(name, unit, values.to_vec())),
            parts: parts(data, whole)?.into_iter().map(part).collect(),
            residuals,
            segments,
        })
    }

    /// The samples that count, in ascending order.
    #[must_use]
    pub fn counting(&self) -> Vec<usize> {
        let all = 0..self.segments.len();
        all.filter(|&row| self.segments[row] != Segment::Dropped)
            .collect()
    }

    /// Time of a sample since the start of its file \[s\].
    #[must_use]
    pub fn time(&self, row: usize) -> f64 {
        let file = self.files.iter().find(|file| file.rows.contains(&row));
        (row - file.map_or(0, |file| file.rows.start)) as f64 * self.step
    }
}

/// Standard deviation over the samples that count.
fn deviation(segments: &[Segment], signal: &[f64]) -> f64 {
    let own = || {
        let pairs = segments.iter().zip(signal);
        pairs
            .filter(|(s, _)| **s != Segment::Dropped)
            .map(|(_, v)| *v)
    };
    let n = own().count().max(1) as f64;
    let mean = own().sum::<f64>() / n;
    (own().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt()
}

/// Where a residual is largest, on the held-out samples of a file or, if it has none, on all.
fn worst(
    data: &Prepared,
    segments: &[Segment],
    residuals: &[Vec<f64>; 2],
    rows: &Range<usize>,
) -> Option<Worst> {
    let error = |row: usize| residuals[0][row].abs().max(residuals[1][row].abs());
    let of = |wanted: &dyn Fn(Segment) -> bool| {
        let own = rows.clone().filter(|&row| wanted(segments[row]));
        own.max_by(|&a, &b| error(a).total_cmp(&error(b)))
    };
    let row = of(&|s| s == Segment::HeldOut).or_else(|| of(&|s| s != Segment::Dropped))?;
    // The default cut-off is eight times the input's highest tone.
    let reach = (8.0 / (data.cutoff * data.dt * data.stride as f64)).ceil() as usize;
    Some(Worst {
        row,
        errors: residuals.each_ref().map(|r| r[row]),
        around: row.saturating_sub(reach).max(rows.start)..(row + reach + 1).min(rows.end),
    })
}
