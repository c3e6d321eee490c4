//! Logging errors: a record on which the model would hold if one of its columns had been logged
//! correctly.
//!
//! A sensor with the opposite sign, degrees instead of radians, two swapped columns, a delayed
//! output: each of these makes a correct model fail. The residual then depends on a measured
//! variable, which seems to blame the rig. Each is undone in turn; where the model then holds, with
//! gain and offset refitted, that is asked about first.

use super::given::{Given, Seen};
use super::play::{rms, Played};
use super::{Check, MENDED};
use crate::algebra::line;
use crate::problem::Prepared;
use crate::record::{is_same_unit, Column, Record};

/// What may have been done to a record.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(tag = "what", rename_all = "kebab-case")]
pub enum Way {
    /// A column counts the other way.
    Turned {
        /// Its name.
        column: String,
    },
    /// A column is this multiple of what the model was fitted to.
    Scaled {
        /// Its name.
        column: String,
        /// The multiple.
        factor: f64,
    },
    /// Two columns stand in each other's place.
    Exchanged {
        /// The first of both.
        column: String,
        /// The other one.
        other: String,
    },
    /// The output comes later than the model says, or earlier.
    Late {
        /// By so much \[s\]; below zero where it comes earlier.
        seconds: f64,
    },
}

/// A way to log the record with which the model holds.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Otherwise {
    /// What was done.
    #[serde(flatten)]
    pub way: Way,
    /// Rms error with that undone and gain and offset refitted, over the output's standard
    /// deviation.
    pub nrmse: f64,
}

/// Factors between units that a header does not state: milli and kilo, degrees in place of
/// radians, inches in place of millimetres, and back.
const FACTORS: [f64; 6] = [
    1e3,
    1e-3,
    180.0 / std::f64::consts::PI,
    std::f64::consts::PI / 180.0,
    25.4,
    1.0 / 25.4,
];
/// A factor is tried where it brings the range of the column to within this multiple of what the
/// model has seen. A choice.
const ALIKE: f64 = 4.0;
/// Longest time by which the output may come late \[s\], and the share of the record. A choice.
const LATEST: (f64, f64) = (1.0, 0.1);
/// Least number of the record's rows by which an output is called late. A choice: less is no
/// logger's delay, but an error of the model that resembles one.
const LEAST_LATE: f64 = 0.5;

/// The columns that a model reads.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    Input,
    Output,
    Channel(usize),
}

fn column(record: &mut Record, place: Place) -> &mut Column {
    match place {
        Place::Input => &mut record.input,
        Place::Output => &mut record.output,
        Place::Channel(index) => &mut record.channels[index],
    }
}

/// A way to undo, with its name.
struct Undone {
    way: Way,
    record: Record,
}

/// Everything but the clock that may be undone.
fn undone(record: &Record, given: &Given) -> Vec<Undone> {
    let reads = given.reads();
    let channels = record.channels.iter().enumerate();
    let read = channels.filter(|(_, c)| reads.contains(&c.name.as_str()));
    let read: Vec<(Place, String)> = read
        .map(|(index, c)| (Place::Channel(index), c.name.clone()))
        .collect();
    let mut sources = vec![(Place::Input, record.input.name.clone())];
    sources.extend(read);
    let mut all = Vec::new();
    let mut add = |way: Way, change: &dyn Fn(&mut Record)| {
        let mut record = record.clone();
        change(&mut record);
        all.push(Undone { way, record });
    };
    for (place, name) in &sources {
        let (place, own) = (*place, || name.clone());
        let times = |factor: f64| {
            move |record: &mut Record| {
                let values = &mut column(record, place).values;
                values.iter_mut().for_each(|v| *v *= factor);
            }
        };
        add(Way::Turned { column: own() }, &times(-1.0));
        let seen = given.about.ranges.get(match place {
            Place::Input => "input",
            _ => name,
        });
        for factor in FACTORS {
            if seen.is_some_and(|seen| is_alike(record, place, seen, factor)) {
                let way = Way::Scaled {
                    column: own(),
                    factor,
                };
                add(way, &times(1.0 / factor));
            }
        }
    }
    let output = (Place::Output, record.output.name.clone());
    for (i, (one, name)) in sources.iter().enumerate() {
        let rest = sources[i + 1..].iter().chain(std::iter::once(&output));
        for (other, second) in rest {
            let (mut a, mut b) = (record.clone(), record.clone());
            let units = (&column(&mut a, *one).unit, &column(&mut b, *other).unit);
            let are_alike = match units {
                (Some(one), Some(other)) => is_same_unit(one, other),
                _ => true,
            };
            if are_alike {
                let way = Way::Exchanged {
                    column: name.clone(),
                    other: second.clone(),
                };
                add(way, &|record: &mut Record| {
                    let first = std::mem::take(&mut column(record, *one).values);
                    let second = std::mem::replace(&mut column(record, *other).values, first);
                    column(record, *one).values = second;
                });
            }
        }
    }
    all
}

/// Whether the range of a column over a factor is about what the model has seen.
fn is_alike(record: &Record, place: Place, seen: &Seen, factor: f64) -> bool {
    let Some([low, high]) = seen.position else {
        return false;
    };
    let values = match place {
        Place::Input => &record.input.values,
        Place::Output => &record.output.values,
        Place::Channel(index) => &record.channels[index].values,
    };
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let ratio = (most - least) / factor / (high - low);
    (1.0 / ALIKE..=ALIKE).contains(&ratio)
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
    let most = (LATEST.0 / row)
        .min(LATEST.1 * data.split.fit.len() as f64)
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
    /// The way to log the record with which the model errs least, if it holds with it.
    pub(super) fn logged_otherwise(
        &self,
        record: &Record,
        given: &Given,
        cutoff: Option<f64>,
    ) -> Option<Otherwise> {
        let with = |undone: Undone| {
            let other = Played::of(&undone.record, given, cutoff).ok()?;
            let rms = error(&other.data, &other.model.prediction)?;
            let deviation = other.deviation();
            let allowed = super::by_share(&other.data, &given.about, deviation)?;
            (rms <= allowed).then_some(Otherwise {
                way: undone.way,
                nrmse: rms / deviation,
            })
        };
        let mut all: Vec<Otherwise> = undone(record, given).into_iter().filter_map(with).collect();
        if let Some((rows, rms)) = late(&self.data, &self.model.prediction) {
            let seconds = rows * self.data.dt * self.data.stride as f64;
            let shows = seconds.abs() * self.data.rate >= LEAST_LATE;
            let allowed = super::by_share(&self.data, &given.about, self.deviation);
            if shows && allowed.is_some_and(|allowed| rms <= allowed) {
                all.push(Otherwise {
                    way: Way::Late { seconds },
                    nrmse: rms / self.deviation,
                });
            }
        }
        // A way with which most of the error stays is none that explains it. Each has its own gain
        // and offset, so that the error which it has to explain is the one behind these.
        let most = MENDED.sqrt() * self.rmse_gain_offset / self.deviation;
        all.retain(|way| way.nrmse <= most);
        all.into_iter().min_by(|a, b| a.nrmse.total_cmp(&b.nrmse))
    }
}
