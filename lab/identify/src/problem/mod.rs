//! From a record to the grid on which everything is computed.
//!
//! Time is made uniform, and long gaps are masked. One smoother at 2.5 f_c is applied to the
//! input, every channel **and the output**; velocity and acceleration are derived from the
//! smoothed signals. Then every column of the regression and the output pass the same
//! zero-phase filter at f_c. Noise therefore cannot create a spurious viscous term or delay.
//!
//! Three grids: the record's own rate; the *work* grid, on which hysteresis and effects run (about
//! 24 samples per period of f_c); the *estimation* grid, on which least squares runs (about 4 per
//! period, because the filter removes frequencies above f_c). Starts are searched on a coarser work
//! grid that ends with the fit segment.
//!
//! Several records of one rig follow one another on one set of grids
//! ([`Prepared::joined`]). A filter, the hysteresis and an effect with memory restart with each
//! record.

pub use crate::algebra::Stretch;
use crate::record::{Column, Defect, Mode};
use bowden::effect::Motion;
pub(crate) use filter::is_silent;
use filter::{derivative, ZeroPhase};
use rayon::prelude::*;
use std::ops::Range;

mod against;
mod answered;
mod blind;
mod build;
pub mod clock;
pub mod cost;
pub mod filter;
mod floor;
mod rest;
mod search;
pub mod spectrum;
pub mod still;
mod uniform;

/// Maximum number of records that are fitted together. Each adds its own unknown states, and every
/// step of a search factors the matrix of all parameters, at a cost cubic in their number.
pub const MOST_RECORDS: usize = 64;

/// Checks that this number of records can be fitted together.
///
/// # Errors
/// One sentence with the limit if there are too many.
pub fn together(records: usize) -> Result<(), String> {
    match records > MOST_RECORDS {
        true => Err(format!(
            "{records} records are too many for one model (at most {MOST_RECORDS}); --glob PATTERN --out ROWS.parquet identifies each one separately"
        )),
        false => Ok(()),
    }
}

/// How to prepare the record.
#[derive(Debug, Clone, Copy, Default)]
pub struct Preparation {
    /// Cut-off \[Hz\]; default: from the spectrum of the input.
    pub cutoff: Option<f64>,
}

/// A measured channel on the work grid.
#[derive(Debug, Clone)]
pub struct Channel {
    /// Name as in the record, or as mapped by the user.
    pub name: String,
    /// Unit of the position, if the record states one.
    pub unit: Option<String>,
    /// How it is computed from other measured quantities, if it is not measured itself.
    pub definition: Option<String>,
    /// Position, velocity and acceleration at each work sample.
    pub motion: Vec<Motion<f64>>,
    /// The origin from which effects measure the position: 0 or the mid-range.
    pub origin: f64,
    /// Middle of the range of the position.
    pub middle: f64,
    /// Half of the range of the position.
    pub reach: f64,
    /// Root mean square of the velocity.
    pub speed: f64,
    /// Whether it is only its sensor's noise within each record: it then at most identifies the
    /// record, and no term of the catalogue reads it.
    pub rests: bool,
}

impl Channel {
    /// A channel on the work grid; `used` contains the samples that the fit may use.
    fn new(column: &Column, motion: Vec<Motion<f64>>, used: &[Range<usize>]) -> Self {
        let mut channel = Self {
            name: column.name.clone(),
            unit: column.unit.clone(),
            definition: column.definition.clone(),
            motion,
            origin: 0.0,
            middle: 0.0,
            reach: 0.0,
            speed: 0.0,
            rests: false,
        };
        channel.measure(used.iter().cloned().flatten());
        channel
    }

    /// Takes origin, range and speed from the samples that the fit may see.
    fn measure(&mut self, used: impl Iterator<Item = usize> + Clone) {
        let inside = || used.clone().map(|i| &self.motion[i]);
        let low = inside().map(|m| m.position).fold(f64::INFINITY, f64::min);
        let high = inside()
            .map(|m| m.position)
            .fold(f64::NEG_INFINITY, f64::max);
        let (middle, reach) = (0.5 * (low + high), 0.5 * (high - low));
        let squares: f64 = inside().map(|m| m.velocity * m.velocity).sum();
        self.speed = (squares / used.count().max(1) as f64).sqrt();
        (self.middle, self.reach) = (middle, reach);
        // An axis that is nearly centred keeps its own zero: that is where its physics is.
        self.origin = if middle.abs() < 0.1 * reach {
            0.0
        } else {
            middle
        };
    }
}

/// Position, velocity and acceleration of a smoothed signal on the work grid.
fn motion(smoothed: &[f64], stride: usize, dt: f64) -> Vec<Motion<f64>> {
    let velocity = derivative(smoothed, dt);
    let acceleration = derivative(&velocity, dt);
    (0..smoothed.len())
        .step_by(stride)
        .map(|i| Motion {
            position: smoothed[i],
            velocity: velocity[i],
            acceleration: acceleration[i],
        })
        .collect()
}

/// The held-out part of several records.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum HeldOut {
    /// The last quarter of each.
    #[default]
    Trailing,
    /// The last record as a whole; the last fifth of each other record is the selection segment.
    LastRecord,
    /// Nothing: all of each record is one segment, for a model that is only tried on it.
    Nothing,
}

/// One of the records that are fitted together: its position on the grids.
#[derive(Debug, Clone)]
pub struct Piece {
    /// Its source, as named in messages.
    pub path: String,
    /// Samples after cutting.
    pub samples: usize,
    /// Rows that were left out because of their contents.
    pub dropped: usize,
    /// Its own rate \[Hz\], after making time uniform.
    pub rate: f64,
    /// Its samples on the work grid.
    pub work: Range<usize>,
    /// Its samples on the estimation grid.
    pub rows: Range<usize>,
    /// Total duration of the records before it \[s\].
    pub since: f64,
    /// Whether any of it is part of the fit segment.
    pub fitted: bool,
    /// Whether its input is nothing but noise.
    pub rests: bool,
    /// Whether the output nevertheless follows the input row by row.
    pub shuffled: bool,
}

impl Piece {
    /// Its rows among those of a segment, which are in ascending order.
    pub(crate) fn rows_of<'a>(&self, segment: &'a [usize]) -> &'a [usize] {
        let begin = segment.partition_point(|&row| row < self.rows.start);
        let end = segment.partition_point(|&row| row < self.rows.end);
        &segment[begin..end]
    }
}

/// The segments: fit, selection, held-out. They are in this order, except for a record that is held
/// out as a whole.
#[derive(Debug, Clone, Default)]
pub struct Split {
    /// The first 60 % (80 % if a whole record is held out), on which parameters are fitted and
    /// effects are proposed.
    pub fit: Vec<usize>,
    /// The next 15 % (20 %), on which a round must not raise the error.
    pub selection: Vec<usize>,
    /// The last 25 %, or the last record, which is only reported and never used.
    pub held_out: Vec<usize>,
}

/// A record, or several of one rig, on common grids, ready to be fitted.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// Torque or displacement input.
    pub mode: Mode,
    /// The records, in their order: at least one.
    pub pieces: Vec<Piece>,
    /// Samples after cutting, of all records.
    pub samples: usize,
    /// Rate \[Hz\], after making time uniform: that of the fastest record.
    pub rate: f64,
    /// Cut-off f_c \[Hz\].
    pub cutoff: f64,
    /// Step of the work grid \[s\].
    pub dt: f64,
    /// Work samples per estimation sample.
    pub stride: usize,
    /// The transmission's input on the work grid.
    pub input: Channel,
    /// The other channels.
    pub channels: Vec<Channel>,
    /// Index into `channels` of a measured load, if there is one.
    pub load: Option<usize>,
    /// The output's name and unit.
    pub output_name: String,
    /// The output's unit.
    pub output_unit: Option<String>,
    /// The output after the smoother, on the work grid.
    output: Vec<f64>,
    /// The output through the filter, on the estimation grid.
    pub target: Vec<f64>,
    /// The output as recorded (uniform time, not filtered) on the estimation grid.
    pub target_raw: Vec<f64>,
    /// Estimation samples of each segment.
    pub split: Split,
    /// Whether the output has the opposite sign to the motion of the input, so that dissipative
    /// terms have a negative gain; not tested in torque mode, in which the channels may have either
    /// sign.
    pub against: bool,
    /// Rms of the output's noise that passes the filter, taken as white.
    pub noise_floor: f64,
    /// The same over the held-out segment, which may be a file with another rate.
    pub held_out_floor: f64,
    /// The input range's travelled distance up to each estimation sample.
    pub path: Vec<f64>,
    /// Remarks for the user.
    pub notes: Vec<String>,
    /// Defects of the measurement.
    pub defects: Vec<Defect>,
    smoother: ZeroPhase,
}

impl Prepared {
    /// The output after the smoother, on the work grid.
    #[must_use]
    pub fn output(&self) -> &[f64] {
        &self.output
    }

    /// Whether the input is nothing but noise in every record.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.pieces.iter().all(|piece| piece.rests)
    }

    /// Whether that noise is a motion whose rows are not in the order of time.
    #[must_use]
    pub fn is_shuffled(&self) -> bool {
        self.pieces.iter().any(|piece| piece.shuffled)
    }

    /// Removes the note that the output has the opposite sign to the motion.
    pub(crate) fn unsay_against(&mut self) {
        let words = against::words(&self.output_name, &self.input.name);
        self.notes.retain(|note| *note != words);
    }

    /// The same record with another output, given on the work grid.
    #[must_use]
    pub fn with_output(&self, output: Vec<f64>) -> Self {
        Self {
            target: self.filtered(&output),
            target_raw: output.iter().step_by(self.stride).copied().collect(),
            output,
            ..self.clone()
        }
    }

    /// The same record, with the selection segment as part of the fit segment.
    #[must_use]
    pub fn with_stop_fitted(&self) -> Self {
        let mut wide = self.clone();
        wide.split.fit.extend(&self.split.selection);
        // Each of several records has its own selection segment, between the others' segments.
        wide.split.fit.sort_unstable();
        wide
    }

    /// The same records with only the rows of the fit segment for which `kept` is true.
    #[must_use]
    pub fn with_rows(mut self, kept: impl Fn(usize) -> bool) -> Self {
        self.split.fit.retain(|&row| kept(row));
        self
    }

    /// Samples on the work grid.
    #[must_use]
    pub fn work_len(&self) -> usize {
        self.input.motion.len()
    }

    /// A column of the work grid through the filter, on the estimation grid.
    #[must_use]
    pub fn filtered(&self, column: &[f64]) -> Vec<f64> {
        filtered(&self.smoother, &self.pieces, self.stride, column)
    }

    /// Several columns, each as by [`filtered`](Self::filtered), at a lower cost than one by one.
    #[must_use]
    pub fn filtered_all(&self, columns: &[&[f64]]) -> Vec<Vec<f64>> {
        filtered_all(&self.smoother, &self.pieces, self.stride, columns)
    }

    /// Columns of the work grid through the filter, on the estimation grid: each only on the
    /// records on which it is not zero.
    #[must_use]
    pub fn filtered_stretches(&self, columns: &[&Stretch]) -> Vec<Stretch> {
        let columns = columns.iter().map(|c| (c.range().start, c.values()));
        let columns: Vec<(usize, &[f64])> = columns.collect();
        filtered_stretches(&self.smoother, &self.pieces, self.stride, &columns)
    }

    /// Time of a row \[s\], with the records one after another.
    #[must_use]
    pub fn moment(&self, row: usize) -> f64 {
        let piece = self.pieces.iter().find(|p| p.rows.contains(&row));
        piece.map_or(0.0, |p| {
            p.since + (row - p.rows.start) as f64 * self.stride as f64 * self.dt
        })
    }

    /// The channel that an effect reads.
    #[must_use]
    pub fn channel(&self, source: bowden::model::Source) -> Option<&Channel> {
        match source {
            bowden::model::Source::Input => Some(&self.input),
            bowden::model::Source::Channel(i) => self.channels.get(usize::from(i)),
        }
    }
}

/// A column of the work grid through the filter, each record by itself.
fn filtered(smoother: &ZeroPhase, pieces: &[Piece], stride: usize, column: &[f64]) -> Vec<f64> {
    let all = filtered_all(smoother, pieces, stride, &[column]);
    all.into_iter().flatten().collect()
}

/// Columns of the work grid through the filter, each record by itself.
fn filtered_all(
    smoother: &ZeroPhase,
    pieces: &[Piece],
    stride: usize,
    columns: &[&[f64]],
) -> Vec<Vec<f64>> {
    let whole: Vec<(usize, &[f64])> = columns.iter().map(|&column| (0, column)).collect();
    let all = filtered_stretches(smoother, pieces, stride, &whole);
    all.into_iter().map(Stretch::into_values).collect()
}

/// The same of columns that begin at some sample and are zero on some of the records, on which
/// they stay so.
fn filtered_stretches(
    smoother: &ZeroPhase,
    pieces: &[Piece],
    stride: usize,
    columns: &[(usize, &[f64])],
) -> Vec<Stretch> {
    cost::COLUMNS_FILTERED.add(columns.len());
    let reached = |piece: &Piece, (start, values): (usize, &[f64])| {
        !piece.work.is_empty()
            && start <= piece.work.start
            && piece.work.end <= start + values.len()
    };
    let of = |piece: &Piece| {
        let own = columns.iter().filter(|column| reached(piece, **column));
        let own =
            own.map(|(start, values)| &values[piece.work.start - start..piece.work.end - start]);
        let own: Vec<&[f64]> = own.collect();
        smoother.apply_all(&own, stride)
    };
    let mut by_piece: Vec<_> = match pieces {
        [piece] => vec![of(piece)],
        several => several.par_iter().map(of).collect(),
    };
    let mut by_piece: Vec<_> = by_piece.iter_mut().map(|own| own.drain(..)).collect();
    let gather = |column: &(usize, &[f64])| {
        let (mut start, mut values) = (None, Vec::new());
        for (piece, own) in pieces.iter().zip(&mut by_piece) {
            if reached(piece, *column) {
                start.get_or_insert(piece.rows.start);
                let next = own.next().unwrap_or_default();
                match values.is_empty() {
                    true => values = next,
                    false => values.extend(next),
                }
            }
        }
        Stretch::at(start.unwrap_or(0), values)
    };
    columns.iter().map(gather).collect()
}

#[cfg(test)]
mod tests;
