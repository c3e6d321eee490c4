//! Faults of the measurement that show before anything is fitted.
//!
//! A sensor that stands still while the rest moves, one at the end of its range, steps so
//! coarse that they shape the signal, gaps in time, time stamps that jitter: each
//! is named with the lines of the file that it spoils. Stretches that hold no measurement
//! (stuck, clipped) are left out of the fit. A defect is *grave* where that does not save
//! the conclusion. What belongs to any sensor (noise, a converter's usual steps, a
//! reference that rests) is no defect.

mod coarse;
mod companion;
mod gaps;
mod jitter;
mod stuck;

use super::rows::Table;
use super::{clipping, Column};
use companion::Companion;
use serde::Serialize;
use std::ops::Range;

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DefectKind {
    /// A flat top where the other end of the transmission goes on: the sensor's range ends.
    Clipping,
    /// The steps of the sensor are coarse against its signal.
    Quantisation,
    /// Time stamps that do not say when the samples were taken.
    Jitter,
    /// Rows are missing.
    Gap,
    /// Bit for bit the same value, although the rest of the record moves.
    Stuck,
}

impl DefectKind {
    /// The name in the JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Clipping => "clipping",
            Self::Quantisation => "quantisation",
            Self::Jitter => "jitter",
            Self::Gap => "gap",
            Self::Stuck => "stuck",
        }
    }
}

/// One fault of one column.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Defect {
    /// What is wrong.
    pub kind: DefectKind,
    /// The column: as in the file for time, input and output, else the channel's name.
    pub channel: String,
    /// First and last line of each stretch, counted as an editor does.
    pub ranges: Vec<[usize; 2]>,
    /// One sentence.
    pub message: String,
    /// Whether it spoils what is concluded from this column.
    #[serde(skip)]
    pub grave: bool,
    /// Whether the stretches hold no measurement and are left out of the fit.
    #[serde(skip)]
    pub left_out: bool,
    /// The stretches as samples of the record.
    #[serde(skip)]
    pub samples: Vec<Range<usize>>,
}

/// Share of the record that a channel's defects may take out of the fit.
const MOST_OF_A_CHANNEL: f64 = 0.1;

/// Share of blind samples from which a conclusion is spoilt. They are left out; but what was
/// not seen of the input goes on to act through the hysteresis.
const GRAVE: f64 = 0.05;
const GRAVE_INPUT: f64 = 0.01;

/// What the detectors look at.
pub(super) struct Measured<'a> {
    pub(super) table: &'a Table,
    /// Name of the time's column; `None` where time comes from the row number.
    pub(super) clock: Option<&'a str>,
    /// Input, output, channels.
    pub(super) columns: Vec<&'a Column>,
    /// Of each channel what it is the sum or difference of; nothing where it is a column.
    pub(super) parts: Vec<Vec<Vec<f64>>>,
}

/// All defects: time first, then column by column.
pub(super) fn find(measured: &Measured<'_>) -> Vec<Defect> {
    let lines = &measured.table.lines;
    let mut all = Vec::new();
    if let Some(clock) = measured.clock {
        let time = &measured.table.time;
        let jitter = jitter::find(time, &measured.columns);
        let gaps = gaps::find(time);
        all.extend(jitter.map(|found| found.named(DefectKind::Jitter, clock, lines)));
        all.extend(gaps.map(|found| found.named(DefectKind::Gap, clock, lines)));
    }
    let [input, output, ..] = measured.columns.as_slice() else {
        return all;
    };
    let (at_input, at_output) = (
        Companion::new(&input.values),
        Companion::new(&output.values),
    );
    for (index, column) in measured.columns.iter().enumerate() {
        let (others, other) = match index {
            0 => (vec![&at_output], &output.values),
            1 => (vec![&at_input], &input.values),
            _ => (vec![&at_input, &at_output], &input.values),
        };
        let few = if index == 0 { GRAVE_INPUT } else { GRAVE };
        let parts = index.checked_sub(2).and_then(|i| measured.parts.get(i));
        let stuck = stuck(column, parts.map_or(&[], Vec::as_slice), &others, few);
        let spoilt = |plateau: &Range<usize>| {
            let mut stuck = stuck.iter().flat_map(|found| &found.samples);
            stuck.any(|s| s.start < plateau.end && plateau.start < s.end)
        };
        let clipped = match index {
            0 | 1 => clipped(&column.values, other, few, spoilt),
            _ => None,
        };
        let coarse = coarse::find(&column.values, others[0]);
        let most = if index < 2 { 1.0 } else { MOST_OF_A_CHANNEL };
        let named = |kind, found: Option<Found>| {
            found.map(|found| Found { most, ..found }.named(kind, &column.name, lines))
        };
        let clipped = named(DefectKind::Clipping, clipped);
        let stuck = stuck.into_iter().map(Some);
        all.extend(stuck.filter_map(|found| named(DefectKind::Stuck, found)));
        all.extend(clipped);
        all.extend(named(DefectKind::Quantisation, coarse));
    }
    all
}

/// A defect before it has a place in the file.
struct Found {
    samples: Vec<Range<usize>>,
    message: String,
    grave: bool,
    /// Share of the record that may be left out for it.
    most: f64,
}

impl Found {
    fn named(self, kind: DefectKind, column: &str, lines: &[usize]) -> Defect {
        let line = |sample: usize| lines.get(sample).copied().unwrap_or(sample + 2);
        let range = |s: &Range<usize>| [line(s.start), line(s.end.max(s.start + 1) - 1)];
        let blind = matches!(kind, DefectKind::Clipping | DefectKind::Stuck);
        Defect {
            left_out: blind && share(&self.samples, lines.len()) <= self.most,
            kind,
            channel: column.to_owned(),
            ranges: self.samples.iter().map(range).collect(),
            message: self.message,
            grave: self.grave,
            samples: self.samples,
        }
    }
}

/// A sum or difference rests where what it is made of moves together: it is stuck where one of
/// its columns is.
fn stuck(column: &Column, parts: &[Vec<f64>], others: &[&Companion], few: f64) -> Vec<Found> {
    let Some(definition) = &column.definition else {
        return stuck::find(&column.values, others, few)
            .into_iter()
            .collect();
    };
    let found = |(part, which): (&Vec<f64>, &str)| {
        let found = stuck::find(part, others, few)?;
        let message = format!("the {which} column of {definition} is {}", found.message);
        Some(Found { message, ..found })
    };
    let named = parts.iter().zip(["first", "second"]);
    named.filter_map(found).collect()
}

/// Clipping too mild to be refused.
fn clipped(
    signal: &[f64],
    other: &[f64],
    few: f64,
    spoilt: impl Fn(&Range<usize>) -> bool,
) -> Option<Found> {
    let mut samples: Vec<Range<usize>> = Vec::new();
    let mut levels = Vec::new();
    for clipped in clipping::ends(signal, other) {
        let own = clipped.plateaus.into_iter().filter(|p| !spoilt(p));
        let before = samples.len();
        samples.extend(own);
        if samples.len() > before {
            levels.push(clipped.level.to_string());
        }
    }
    samples.sort_by_key(|plateau| plateau.start);
    let share = share(&samples, signal.len());
    (!samples.is_empty()).then(|| Found {
        message: format!(
            "clipped: flat at {} {}, {:.2} % of the samples; a wider range of the sensor was expected",
            levels.join(" and "),
            times(samples.len()),
            100.0 * share
        ),
        grave: share > few,
        most: 1.0,
        samples,
    })
}

fn share(samples: &[Range<usize>], of: usize) -> f64 {
    samples.iter().map(ExactSizeIterator::len).sum::<usize>() as f64 / of.max(1) as f64
}

/// "once", "3 times".
fn times(count: usize) -> String {
    match count {
        1 => "once".to_owned(),
        _ => format!("{count} times"),
    }
}
