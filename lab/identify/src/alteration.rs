//! Records that may have been logged differently: alterations that are undone in turn, and the bar
//! that each must pass: an alteration is suspected if undoing it leaves at most half of the RMS error
//! (of a record that is identified, beyond the noise).

use crate::record::{Column, Record};
use serde::Serialize;

/// RMS error beyond the noise floor.
pub(crate) fn beyond_noise(rmse: f64, floor: f64) -> f64 {
    (rmse.powi(2) - floor.powi(2)).max(0.0).sqrt()
}

/// A way in which a record may have been logged.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "what", rename_all = "kebab-case")]
pub enum Alteration {
    /// A column has the opposite sign.
    Reversed {
        /// The column.
        column: String,
    },
    /// A column is a multiple of the expected values.
    Scaled {
        /// The column.
        column: String,
        /// The multiple.
        factor: f64,
    },
    /// Two columns are swapped.
    Swapped {
        /// One of them.
        column: String,
        /// The other one.
        other: String,
    },
    /// The output is late.
    Late {
        /// The delay \[s\]; negative if the output is early.
        seconds: f64,
    },
}

/// An alteration that satisfies the condition.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Suspicion {
    /// The alteration.
    #[serde(flatten)]
    pub alteration: Alteration,
    /// The affected file; `None` if every file is affected.
    pub path: Option<String>,
    /// The terms that the search finds once it is undone; none if there was no search.
    pub terms: Vec<String>,
    /// RMS error, as a share of the output's standard deviation.
    pub before: f64,
    /// The same once the alteration is undone.
    pub after: f64,
}

/// The column of a record with this name.
fn column<'a>(record: &'a mut Record, name: &str) -> Option<&'a mut Column> {
    let Record {
        input,
        output,
        channels,
        ..
    } = record;
    let mut all = [input, output].into_iter().chain(channels);
    all.find(|column| column.name == name)
}

impl Alteration {
    /// The record without this alteration. A late output is not altered: its prediction is shifted
    /// instead.
    #[must_use]
    pub fn undone(&self, record: &Record) -> Record {
        let mut record = record.clone();
        let mut scale = |name: &str, by: f64| {
            let column = column(&mut record, name);
            let values = column.into_iter().flat_map(|column| &mut column.values);
            values.for_each(|value| *value *= by);
        };
        match self {
            Self::Reversed { column } => scale(column, -1.0),
            Self::Scaled { column, factor } => scale(column, 1.0 / factor),
            Self::Swapped { column: one, other } => {
                let values = |record: &mut Record, name: &str, new: Vec<f64>| {
                    column(record, name).map(|own| std::mem::replace(&mut own.values, new))
                };
                let first = values(&mut record, one, Vec::new()).unwrap_or_default();
                let second = values(&mut record, other, first).unwrap_or_default();
                values(&mut record, one, second);
            }
            Self::Late { .. } => {}
        }
        record
    }
}
