//! Logging errors: a record on which the model would hold if one of its columns had been logged
//! correctly.
//!
//! A sensor with the opposite sign, degrees instead of radians, two swapped columns, a late output:
//! each of these makes a correct model fail. The residual then depends on a measured variable,
//! which seems to blame the rig. Each alteration is undone in turn, with gain and offset refitted;
//! if the model then holds, the record is suspected first.

use super::given::{Given, Seen};
use super::play::{rms, Played};
use super::Check;
use crate::algebra::line;
use crate::alteration::{Alteration, Suspicion};
use crate::problem::Prepared;
use crate::record::{is_same_unit, Column, Record};
use crate::scale::{HALF, PART, QUARTER};

/// Factors between units that a header does not state: milli and kilo, degrees instead of radians,
/// inches instead of millimetres, and the inverse factors.
const FACTORS: [f64; 6] = [
    1e3,
    1e-3,
    180.0 / std::f64::consts::PI,
    std::f64::consts::PI / 180.0,
    25.4,
    1.0 / 25.4,
];
/// Longest time by which the output may come late \[s\], if that is a part of the record. A choice.
const LATEST: f64 = 1.0;

/// The alterations of a record's columns that may be undone.
fn alterations(record: &Record, given: &Given) -> Vec<Alteration> {
    let reads = given.reads();
    let read = |column: &&Column| reads.contains(&column.name.as_str());
    let sources = std::iter::once(&record.input).chain(record.channels.iter().filter(read));
    let sources: Vec<&Column> = sources.collect();
    let mut all = Vec::new();
    for (index, column) in sources.iter().enumerate() {
        let own = || column.name.clone();
        all.push(Alteration::Reversed { column: own() });
        let name = if index == 0 { "input" } else { &column.name };
        let seen = given.about.ranges.get(name);
        let factors = FACTORS.into_iter();
        let alike = factors.filter(|by| seen.is_some_and(|seen| is_alike(column, seen, *by)));
        all.extend(alike.map(|factor| Alteration::Scaled {
            column: own(),
            factor,
        }));
        let others = sources[index + 1..].iter().copied().chain([&record.output]);
        let alike = others.filter(|other| match (&column.unit, &other.unit) {
            (Some(one), Some(other)) => is_same_unit(one, other),
            _ => true,
        });
        all.extend(alike.map(|other| Alteration::Swapped {
            column: own(),
            other: other.name.clone(),
        }));
    }
    all.push(Alteration::Reversed {
        column: record.output.name.clone(),
    });
    all
}

/// Whether the range of a column, divided by a factor, is about that of the model's own record: between a
/// quarter and four times.
fn is_alike(column: &Column, seen: &Seen, factor: f64) -> bool {
    let Some([low, high]) = seen.position else {
        return false;
    };
    let values = &column.values;
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let ratio = (most - least) / factor / (high - low);
    (QUARTER..=1.0 / QUARTER).contains(&ratio)
}

/// Rms error of a prediction on the rows that count, with gain and offset refitted; `None` where
/// the gain is not above zero.
fn error(data: &Prepared, prediction: &[f64]) -> Option<f64> {
    let rows = data.split.fit.iter();
    let (gain, offset) = line(rows.map(|&i| (prediction[i], data.target[i])));
    let pairs = data.target.iter().zip(prediction);
    let rest: Vec<f64> = pairs.map(|(y, p)| y - gain * p - offset).collect();
    (gain > 0.0).then(|| rms(data, &rest, 0.0))
}

/// What a column is at a place between two samples, by a cubic through four.
fn between(values: &[f64], place: f64) -> f64 {
    let last = values.len() - 1;
    let at = |i: isize| values[i.clamp(0, last as isize) as usize];
    let i = place.floor();
    let (u, i) = (place - i, i as isize);
    let (a, b, c, d) = (at(i - 1), at(i), at(i + 1), at(i + 2));
    let slope = (0.5 * (c - a), 0.5 * (d - b));
    let (u2, u3) = (u * u, u * u * u);
    b * (2.0 * u3 - 3.0 * u2 + 1.0)
        + c * (3.0 * u2 - 2.0 * u3)
        + slope.0 * (u3 - 2.0 * u2 + u)
        + slope.1 * (u3 - u2)
}

/// By how many rows the output comes late, and the error with that undone.
fn late(data: &Prepared, prediction: &[f64]) -> Option<(f64, f64)> {
    let row = data.dt * data.stride as f64;
    let most = (LATEST / row)
        .min(PART * data.split.fit.len() as f64)
        .floor();
    let of = |rows: f64| {
        let places = (0..prediction.len()).map(|i| between(prediction, i as f64 - rows));
        Some((rows, error(data, &places.collect::<Vec<f64>>())?))
    };
    let best =
        |all: &mut dyn Iterator<Item = f64>| all.filter_map(of).min_by(|a, b| a.1.total_cmp(&b.1));
    let most = most as i32;
    let mut found = best(&mut (-most..=most).map(f64::from))?;
    let mut step = 1.0;
    for _ in 0..4 {
        step /= 4.0;
        let around = found.0;
        found = best(&mut (-4..=4).map(|k| around + step * f64::from(k)))?;
    }
    Some(found)
}

impl Check {
    /// The alteration that undone leaves the least error, if the model then holds.
    pub(super) fn suspicion(
        &self,
        record: &Record,
        given: &Given,
        cutoff: Option<f64>,
    ) -> Option<Suspicion> {
        let holds = |data: &Prepared, deviation: f64, rms: f64| {
            let allowed = super::by_share(data, &given.about, deviation)?;
            (rms <= allowed).then_some(rms / deviation)
        };
        let with = |alteration: Alteration| {
            let other = Played::of(&alteration.undone(record), given, cutoff).ok()?;
            let rms = error(&other.data, &other.model.prediction)?;
            Some((holds(&other.data, other.deviation(), rms)?, alteration))
        };
        let late = || {
            let (rows, rms) = late(&self.data, &self.model.prediction)?;
            let seconds = rows * self.data.dt * self.data.stride as f64;
            // Less than half a sample is an error of the model that resembles a delay.
            let shows = seconds.abs() * self.data.rate >= HALF;
            let after = holds(&self.data, self.deviation, rms).filter(|_| shows)?;
            Some((after, Alteration::Late { seconds }))
        };
        let undone = alterations(record, given).into_iter().filter_map(with);
        let best = undone.chain(late()).min_by(|a, b| a.0.total_cmp(&b.0));
        // Gain and offset are refitted on both sides; a model cannot have a negative gain.
        let before = error(&self.data, &self.model.prediction).unwrap_or(self.deviation);
        let before = before / self.deviation;
        let (after, alteration) = best.filter(|(after, _)| *after <= HALF * before)?;
        Some(Suspicion {
            alteration,
            path: None,
            terms: Vec::new(),
            before,
            after,
        })
    }
}
