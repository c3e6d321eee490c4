//! Shapes and their ranges in units of the record's own ranges.

use crate::model::range::Range;
use crate::problem::{Channel, Prepared};

/// A trial shape, in units of the record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Scale {
    /// Unscaled.
    Number(f64),
    /// Times the channel's usual speed.
    Speed(f64),
    /// Times the channel's half-range.
    Reach(f64),
    /// Over the channel's half-range.
    PerReach(f64),
    /// Times the time in which the usual speed covers the half-range.
    Stroke(f64),
    /// Times the path that the input has covered.
    Path(f64),
    /// The middle of the channel.
    Middle,
}

impl Scale {
    /// The shape on a channel.
    pub(crate) fn on(self, data: &Prepared, channel: &Channel) -> f64 {
        match self {
            Self::Number(value) => value,
            Self::Speed(share) => share * channel.speed,
            Self::Reach(share) => share * channel.reach,
            Self::PerReach(share) => share / channel.reach,
            Self::Stroke(share) => share * channel.reach / channel.speed.max(1e-300),
            Self::Path(share) => share * path(data),
            Self::Middle => channel.middle,
        }
    }
}

/// The range over which a shape is fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Bounds {
    /// Logarithmic, unscaled.
    Number(f64, f64),
    /// Linear, unscaled.
    Linear(f64, f64),
    /// Logarithmic, times the channel's usual speed.
    Speed(f64, f64),
    /// Logarithmic, times the channel's half-range.
    Reach(f64, f64),
    /// Logarithmic, over the channel's half-range.
    PerReach(f64, f64),
    /// Logarithmic, times the path that the input has covered.
    Path(f64, f64),
    /// Logarithmic, times the value from which the fit starts.
    Value(f64, f64),
    /// From a number of samples to a number of strokes, logarithmic \[s\].
    SamplesToStrokes(f64, f64),
    /// From a number of samples to a share of the record, logarithmic \[s\].
    SamplesToRecord(f64, f64),
    /// The half-range about the origin.
    WithinReach,
    /// The fit segment.
    FitSegment,
    /// A phase.
    Phase,
    /// Not fitted.
    Held,
}

impl Bounds {
    /// The range on a channel; `None` if the shape stays as it was set.
    pub(crate) fn on(self, data: &Prepared, channel: &Channel, value: f64) -> Option<Range> {
        let (reach, speed) = (channel.reach, channel.speed);
        if !(reach > 0.0 && speed > 0.0) {
            return None;
        }
        Some(match self {
            Self::Number(low, high) => Range::Log(low, high),
            Self::Linear(low, high) => Range::Linear(low, high),
            Self::Speed(low, high) => Range::Log(low * speed, high * speed),
            Self::Reach(low, high) => Range::Log(low * reach, high * reach),
            Self::PerReach(low, high) => Range::Log(low / reach, high / reach),
            Self::Path(low, high) => {
                let path = path(data);
                Range::Log(low * path, high * path)
            }
            Self::Value(low, high) => Range::Log(low * value, high * value),
            Self::SamplesToStrokes(low, high) => Range::Log(low * data.dt, high * reach / speed),
            Self::SamplesToRecord(low, high) => {
                let seconds = data.work_len() as f64 * data.dt;
                Range::Log(low * data.dt, high * seconds)
            }
            Self::WithinReach => Range::Linear(-reach, reach),
            Self::FitSegment => {
                let at = |row: Option<&usize>| row.map_or(0.0, |&r| data.moment(r));
                Range::Linear(at(data.split.fit.first()), at(data.split.fit.last()))
            }
            Self::Phase => Range::Free,
            Self::Held => return None,
        })
    }
}

/// The path length of the input.
fn path(data: &Prepared) -> f64 {
    data.path.last().copied().unwrap_or(1.0)
}
