//! Quantities of a motion that exceed the ranges of the model's record.

use crate::problem::{Channel, Prepared};
use crate::scale::TWENTIETH;
use bowden::effect::Motion;

/// A quantity that the model reads and whose range exceeds that of the model's record.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Outside {
    /// The input's name, or the channel's.
    pub channel: String,
    /// `position`, `velocity` or `acceleration`.
    pub quantity: &'static str,
    /// The unit, if the record states one.
    pub unit: Option<String>,
    /// The range in the model's record.
    pub seen: [f64; 2],
    /// The range in this record.
    pub here: [f64; 2],
    /// Share of this record's samples that lie outside.
    pub share: f64,
}

/// A quantity of a motion: its name, its value, and how often time divides its unit.
pub(crate) type Of = (&'static str, fn(&Motion<f64>) -> f64, i32);

pub(crate) const POSITION: Of = ("position", |m| m.position, 0);
pub(crate) const VELOCITY: Of = ("velocity", |m| m.velocity, 1);
pub(crate) const ACCELERATION: Of = ("acceleration", |m| m.acceleration, 2);

fn values<'a>(
    data: &'a Prepared,
    channel: &'a Channel,
    rows: &'a [usize],
    of: Of,
) -> impl Iterator<Item = f64> + 'a {
    let motion = move |&row: &usize| of.1(&channel.motion[row * data.stride]);
    rows.iter().map(motion)
}

/// The range of a quantity over some rows.
pub(crate) fn range(data: &Prepared, channel: &Channel, rows: &[usize], of: Of) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    values(data, channel, rows, of).fold(none, |[low, high], v| [low.min(v), high.max(v)])
}

/// The excess of a quantity beyond its recorded range, over some rows.
pub(crate) fn beyond(
    data: &Prepared,
    channel: &Channel,
    rows: &[usize],
    of: Of,
    seen: [f64; 2],
) -> Option<Outside> {
    let [low, high] = seen;
    let here = range(data, channel, rows, of);
    let margin = TWENTIETH * (high - low);
    if here[0] >= low - margin && here[1] <= high + margin {
        return None;
    }
    let out = values(data, channel, rows, of).filter(|v| *v < low || *v > high);
    Some(Outside {
        channel: channel.name.clone(),
        quantity: of.0,
        unit: crate::model::units::Unit::one()
            .times(channel.unit.as_deref(), 1)
            .times(Some("s"), -of.2)
            .text(),
        seen,
        here,
        share: out.count() as f64 / rows.len().max(1) as f64,
    })
}
