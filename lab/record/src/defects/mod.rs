//! Defects of the measurement that are detectable before any fit.
//!
//! The defects are stuck sensors, clipped signals, spikes, coarse steps, gaps in time, and jitter
//! of the time stamps. Each defect is reported with the affected lines of the file. Intervals
//! without a measurement (stuck, clipped) are excluded from the fit, and a straight line replaces
//! spikes. A defect is *grave* if the conclusion is invalid nevertheless. Normal properties of a
//! sensor (noise, the usual steps of a converter, a reference at rest) are not defects.

mod clipping;
mod coarse;
mod companion;
mod gaps;
mod jitter;
mod spikes;
mod stuck;

use super::rows::Table;
use super::scale::{FRACTION, GRAVE, MISSING};
use super::{Column, Record};
pub(super) use clipping::heavy;
pub use coarse::Steps;
use companion::Companion;
use serde::Serialize;
use spikes::Leaps;
use std::borrow::Cow;
use std::ops::Range;

/// The kind of a defect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DefectKind {
    /// A plateau at the end of the sensor range, while the other end of the transmission continues
    /// to move.
    Clipping,
    /// The steps of the sensor are coarse compared with its signal.
    Quantisation,
    /// Time stamps that do not state when the samples were taken.
    Jitter,
    /// Rows are missing.
    Gap,
    /// The value is bit-identical while the other signals move.
    Stuck,
    /// A few samples jump away from the signal and back.
    Spike,
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
            Self::Spike => "spike",
        }
    }
}

/// One fault of one column.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Defect {
    /// The kind of the defect.
    pub kind: DefectKind,
    /// Name of the column in the file for time, input and output, otherwise the name of the
    /// channel.
    pub channel: String,
    /// First and last line of each interval, counted from 1.
    pub ranges: Vec<[usize; 2]>,
    /// Description of the defect in one sentence.
    pub message: String,
    /// Whether the defect invalidates conclusions from this column.
    #[serde(skip)]
    pub grave: bool,
    /// Whether the intervals contain no measurement and are excluded from the fit.
    #[serde(skip)]
    pub left_out: bool,
    /// The intervals as samples of the record.
    #[serde(skip)]
    pub samples: Vec<Range<usize>>,
}

/// The data for the detectors.
pub(super) struct Measured<'a> {
    pub(super) table: &'a Table,
    /// Name of the time column; `None` if the time is computed from the row number.
    pub(super) clock: Option<&'a str>,
    /// Input, output, channels.
    pub(super) columns: Vec<&'a Column>,
    /// For each channel that is a sum or difference, its columns; otherwise empty.
    pub(super) parts: Vec<Vec<Vec<f64>>>,
}

/// All defects: time first, then column by column.
pub(super) fn find<'a>(measured: &Measured<'a>) -> Vec<Defect> {
    let lines = &measured.table.lines;
    let mut all = Vec::new();
    if let Some(clock) = measured.clock {
        let time = &measured.table.time;
        let jitter = jitter::find(time, &measured.columns);
        let gaps = gaps::find(time);
        all.extend(jitter.map(|found| found.named(DefectKind::Jitter, clock, lines, 1.0)));
        all.extend(gaps.map(|found| found.named(DefectKind::Gap, clock, lines, 1.0)));
    }
    let [input, output, ..] = measured.columns.as_slice() else {
        return all;
    };
    let leaps = [Leaps::of(&input.values), Leaps::of(&output.values)];
    let spikes: Vec<Option<Found>> = (0..measured.columns.len())
        .map(|index| match index {
            0 => leaps[0].spikes(&[&leaps[1]], FRACTION),
            1 => leaps[1].spikes(&[&leaps[0]], GRAVE),
            _ => {
                let own = Leaps::of(&measured.columns[index].values);
                own.spikes(&[&leaps[0], &leaps[1]], GRAVE)
            }
        })
        .collect();
    let calm = |(column, spikes): (&&'a Column, &Option<Found>)| {
        let stretches = spikes.iter().flat_map(|found| &found.samples);
        bridged(&column.values, stretches)
    };
    let calm: Vec<Cow<[f64]>> = measured.columns.iter().zip(&spikes).map(calm).collect();
    let (at_input, at_output) = (Companion::new(&calm[0]), Companion::new(&calm[1]));
    for (index, (column, spikes)) in measured.columns.iter().zip(spikes).enumerate() {
        let others = match index {
            0 => vec![&at_output],
            1 => vec![&at_input],
            _ => vec![&at_input, &at_output],
        };
        let values = &calm[index];
        let few = if index == 0 { FRACTION } else { GRAVE };
        let parts = index.checked_sub(2).and_then(|i| measured.parts.get(i));
        let parts = parts.map_or(&[][..], Vec::as_slice);
        let stuck = stuck((column, values), parts, &others, few);
        let spoilt = |plateau: &Range<usize>| {
            let mut stuck = stuck.iter().flat_map(|found| &found.samples);
            stuck.any(|s| s.start < plateau.end && plateau.start < s.end)
        };
        let clipped = match index {
            0 | 1 => clipping::find(values, others[0], few, spoilt),
            _ => None,
        };
        let coarse = coarse::find(values, others[0]);
        let most = if index < 2 { 1.0 } else { MISSING };
        let named = |kind, found: Option<Found>| {
            found.map(|found| found.named(kind, &column.name, lines, most))
        };
        let clipped = named(DefectKind::Clipping, clipped);
        let stuck = stuck.into_iter().map(Some);
        all.extend(named(DefectKind::Spike, spikes));
        all.extend(stuck.filter_map(|found| named(DefectKind::Stuck, found)));
        all.extend(clipped);
        all.extend(named(DefectKind::Quantisation, coarse));
    }
    all
}

impl Record {
    /// Index and steps of each column from a coarse sensor. Index 0 is the input, and the channels
    /// follow.
    pub fn steps(&self) -> Vec<(usize, Steps)> {
        let output = Companion::new(&self.output.values);
        let columns = std::iter::once(&self.input).chain(&self.channels);
        let measured = columns.enumerate().filter(|(_, c)| c.definition.is_none());
        measured
            .filter_map(|(place, c)| Some((place, Steps::of(&c.values, &output)?)))
            .collect()
    }

    /// The record with linear interpolation between the edges of these steps.
    pub fn without_steps(&self) -> Self {
        let mut finer = self.clone();
        for (place, _) in self.steps() {
            let column = match place.checked_sub(1) {
                None => &mut finer.input,
                Some(index) => &mut finer.channels[index],
            };
            column.values = coarse::through_edges(&column.values);
        }
        finer
    }
}

/// A signal with a straight line in some intervals.
pub fn bridged<'a, 'b>(
    signal: &'a [f64],
    stretches: impl IntoIterator<Item = &'b Range<usize>>,
) -> Cow<'a, [f64]> {
    let mut values = Cow::Borrowed(signal);
    for stretch in stretches {
        let before = stretch.start.checked_sub(1).map(|i| signal[i]);
        let after = signal.get(stretch.end).copied();
        let (Some(from), Some(to)) = (before.or(after), after.or(before)) else {
            continue;
        };
        let steps = (stretch.len() + 1) as f64;
        for (k, value) in values.to_mut()[stretch.clone()].iter_mut().enumerate() {
            *value = from + (to - from) * (k + 1) as f64 / steps;
        }
    }
    values
}

/// A defect before its lines in the file are known.
struct Found {
    samples: Vec<Range<usize>>,
    message: String,
    grave: bool,
}

impl Found {
    /// `most` is the fraction of the record that may be excluded because of the defect.
    fn named(self, kind: DefectKind, column: &str, lines: &[usize], most: f64) -> Defect {
        let line = |sample: usize| lines.get(sample).copied().unwrap_or(sample + 2);
        let range = |s: &Range<usize>| [line(s.start), line(s.end.max(s.start + 1) - 1)];
        let blind = matches!(kind, DefectKind::Clipping | DefectKind::Stuck);
        Defect {
            left_out: blind && share(&self.samples, lines.len()) <= most,
            kind,
            channel: column.to_owned(),
            ranges: self.samples.iter().map(range).collect(),
            message: self.message,
            grave: self.grave,
            samples: self.samples,
        }
    }
}

/// A sum or difference is constant if its columns move together. It is stuck only if one of its
/// columns is stuck.
fn stuck(
    (column, values): (&Column, &[f64]),
    parts: &[Vec<f64>],
    others: &[&Companion],
    few: f64,
) -> Vec<Found> {
    let Some(definition) = &column.definition else {
        return stuck::find(values, others, few).into_iter().collect();
    };
    let found = |(part, which): (&Vec<f64>, &str)| {
        let found = stuck::find(part, others, few)?;
        let message = format!("the {which} column of {definition} is {}", found.message);
        Some(Found { message, ..found })
    };
    let named = parts.iter().zip(["first", "second"]);
    named.filter_map(found).collect()
}

fn share(samples: &[Range<usize>], of: usize) -> f64 {
    samples.iter().map(ExactSizeIterator::len).sum::<usize>() as f64 / of.max(1) as f64
}
