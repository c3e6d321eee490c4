//! Where a record goes beyond what a model has seen.

use super::given::{Given, Reads, Seen};
use crate::problem::{Channel, Prepared};
use bowden::effect::Motion;

/// Ranges further than this share of what the model has seen beyond its ends are listed: two
/// records of one motion differ by less.
const BEYOND: f64 = 0.05;

/// A range of what the model reads that goes beyond what it has seen.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Outside {
    /// The input's name, or the channel's.
    pub channel: String,
    /// `position`, `velocity` or `acceleration`.
    pub quantity: &'static str,
    /// The unit, where the record states one.
    pub unit: Option<String>,
    /// What the model has seen.
    pub seen: [f64; 2],
    /// What this record covers.
    pub here: [f64; 2],
    /// Share of this record's samples that lie outside.
    pub share: f64,
}

/// All of them that the model reads, the input first.
pub(super) fn outside(data: &Prepared, given: &Given) -> Vec<Outside> {
    let channels = data.channels.iter().map(|c| (c.name.as_str(), c));
    let all = std::iter::once(("input", &data.input)).chain(channels);
    let mut found = Vec::new();
    for (name, channel) in all {
        if let Some(seen) = given.about.ranges.get(name) {
            found.extend(beyond(data, channel, seen, given.reads_of(name)));
        }
    }
    found
}

type Of = fn(&Motion<f64>) -> f64;

fn beyond(data: &Prepared, channel: &Channel, seen: &Seen, reads: Reads) -> Vec<Outside> {
    let read = |is_read: bool, range: Option<[f64; 2]>| range.filter(|_| is_read);
    let position = read(reads.position, seen.position);
    let velocity = read(reads.velocity, seen.velocity);
    let acceleration = read(reads.acceleration, seen.acceleration);
    let quantities: [(&'static str, Option<[f64; 2]>, Of, i32); 3] = [
        ("position", position, |m| m.position, 0),
        ("velocity", velocity, |m| m.velocity, 1),
        ("acceleration", acceleration, |m| m.acceleration, 2),
    ];
    let rows = &data.split.fit;
    let mut found = Vec::new();
    for (quantity, seen, of, per_second) in quantities {
        let Some([low, high]) = seen else {
            continue;
        };
        let values = || rows.iter().map(|&i| of(&channel.motion[i * data.stride]));
        let here = [
            values().fold(f64::INFINITY, f64::min),
            values().fold(f64::NEG_INFINITY, f64::max),
        ];
        let margin = BEYOND * (high - low);
        if here[0] < low - margin || here[1] > high + margin {
            let out = values().filter(|v| *v < low || *v > high).count();
            found.push(Outside {
                channel: channel.name.clone(),
                quantity,
                unit: crate::model::units::Unit::one()
                    .times(channel.unit.as_deref(), 1)
                    .times(Some("s"), -per_second)
                    .text(),
                seen: [low, high],
                here,
                share: out as f64 / rows.len().max(1) as f64,
            });
        }
    }
    found
}
