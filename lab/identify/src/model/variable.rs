//! The variables that an unmodelled part of the residual may depend on.

use super::kind::{kind, Kind};
use super::units::Unit;
use crate::problem::{Channel, Piece, Prepared};
use crate::record::Mode;
use bowden::effect::Motion;
use bowden::model::Source;
use std::ops::Range;

/// A return by this share of the half-range is a reversal; a smaller one is due to the sensor.
const REVERSAL: f64 = 0.002;

/// A quantity that is measured or computed from measured quantities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variable {
    /// Position, or the value of another channel: a load, a temperature.
    Position(Source),
    /// Velocity.
    Velocity(Source),
    /// Acceleration.
    Acceleration(Source),
    /// Position, with the sign of the velocity.
    DirectedPosition(Source),
    /// The load, with the sign of the channel's velocity.
    DirectedLoad(Source),
    /// The travel since the last reversal.
    ReversalDistance(Source),
    /// The time since the last reversal.
    ReversalTime(Source),
    /// The hysteresis state.
    Eta,
    /// Time.
    Time,
}

impl Variable {
    /// All variables of this record.
    #[must_use]
    pub fn all(data: &Prepared, hysteresis: bool) -> Vec<Self> {
        let mut all = Vec::new();
        let loaded = data.mode == Mode::Torque || data.load.is_some();
        let others = data.channels.iter().enumerate();
        let others = others.filter(|(_, channel)| !channel.rests);
        let channels = std::iter::once((Source::Input, &data.input))
            .chain(others.map(|(i, c)| (Source::Channel(i as u8), c)));
        for (source, channel) in channels {
            let kind = kind(data.mode, source, channel);
            all.push(Self::Position(source));
            if matches!(kind, Kind::Motion | Kind::Torque) {
                all.extend([
                    Self::Velocity(source),
                    Self::Acceleration(source),
                    Self::DirectedPosition(source),
                    Self::ReversalDistance(source),
                    Self::ReversalTime(source),
                ]);
            }
            if kind == Kind::Motion && loaded {
                all.push(Self::DirectedLoad(source));
            }
        }
        if hysteresis {
            all.push(Self::Eta);
        }
        all.push(Self::Time);
        all
    }

    /// Its name in the JSON.
    #[must_use]
    pub fn name(self, data: &Prepared) -> &'static str {
        match self {
            Self::Position(source) => match data.channel(source) {
                Some(channel) => match kind(data.mode, source, channel) {
                    Kind::Motion | Kind::Stretch => "position",
                    Kind::Torque | Kind::Load => "load",
                    Kind::Temperature => "temperature",
                    Kind::Other => "value",
                },
                None => "position",
            },
            Self::Velocity(_) => "velocity",
            Self::Acceleration(_) => "acceleration",
            Self::DirectedPosition(_) => "directed-position",
            Self::DirectedLoad(_) => "directed-load",
            Self::ReversalDistance(_) => "reversal-distance",
            Self::ReversalTime(_) => "reversal-time",
            Self::Eta => "eta",
            Self::Time => "time",
        }
    }

    /// The channel that it belongs to.
    #[must_use]
    pub fn source(self) -> Source {
        match self {
            Self::Position(s)
            | Self::Velocity(s)
            | Self::Acceleration(s)
            | Self::DirectedPosition(s)
            | Self::DirectedLoad(s)
            | Self::ReversalDistance(s)
            | Self::ReversalTime(s) => s,
            Self::Eta | Self::Time => Source::Input,
        }
    }

    /// In words, with the channel's name.
    #[must_use]
    pub fn words(self, data: &Prepared) -> String {
        let channel = data.channel(self.source()).map_or("?", |c| c.name.as_str());
        match self {
            Self::Position(_) => channel.to_owned(),
            Self::Velocity(_) => format!("the velocity of {channel}"),
            Self::Acceleration(_) => format!("the acceleration of {channel}"),
            Self::DirectedPosition(_) => format!("{channel} times the sign of its velocity"),
            Self::DirectedLoad(_) => format!("the load times the sign of {channel}'s velocity"),
            Self::ReversalDistance(_) => format!("the travel since {channel} last reversed"),
            Self::ReversalTime(_) => format!("the time since {channel} last reversed"),
            Self::Eta => "the hysteresis state".to_owned(),
            Self::Time => "time".to_owned(),
        }
    }

    /// Its unit, where the record states it.
    #[must_use]
    pub fn unit(self, data: &Prepared) -> Option<String> {
        let load = match (self, data.load) {
            (Self::DirectedLoad(_), Some(index)) => data.channels.get(index),
            (Self::DirectedLoad(_), None) => Some(&data.input),
            _ => data.channel(self.source()),
        };
        let per_second = match self {
            Self::Velocity(_) => 1,
            Self::Acceleration(_) => 2,
            Self::Eta => return None,
            Self::Time | Self::ReversalTime(_) => return Some("s".to_owned()),
            _ => 0,
        };
        Unit::one()
            .times(load?.unit.as_deref(), 1)
            .times(Some("s"), -per_second)
            .text()
    }

    /// Its values on the work grid.
    #[must_use]
    pub fn values(self, data: &Prepared, eta: &[f64]) -> Option<Vec<f64>> {
        let channel = data.channel(self.source())?;
        let each = |of: fn(&Motion<f64>) -> f64| channel.motion.iter().map(of).collect();
        Some(match self {
            Self::Position(_) => each(|m| m.position),
            Self::Velocity(_) => each(|m| m.velocity),
            Self::Acceleration(_) => each(|m| m.acceleration),
            Self::DirectedPosition(_) => {
                let origin = channel.origin;
                let directed = |m: &Motion<f64>| sign(m.velocity) * (m.position - origin);
                channel.motion.iter().map(directed).collect()
            }
            Self::DirectedLoad(_) => {
                let load = match data.load {
                    Some(index) => &data.channels.get(index)?.motion,
                    None => &data.input.motion,
                };
                let pairs = channel.motion.iter().zip(load);
                pairs.map(|(m, l)| sign(m.velocity) * l.position).collect()
            }
            Self::ReversalDistance(_) => {
                let own = |p: &Piece| since_reversal(channel, &p.work, 1.0).0;
                data.pieces.iter().flat_map(own).collect()
            }
            Self::ReversalTime(_) => {
                let own = |p: &Piece| since_reversal(channel, &p.work, data.dt).1;
                data.pieces.iter().flat_map(own).collect()
            }
            Self::Eta => eta.to_vec(),
            Self::Time => {
                let own = |p: &Piece| (0..p.work.len()).map(|i| i as f64 * data.dt);
                data.pieces.iter().flat_map(own).collect()
            }
        })
    }

    /// Whether it restarts with each stroke.
    #[must_use]
    pub fn is_local(self) -> bool {
        matches!(self, Self::ReversalDistance(_) | Self::ReversalTime(_))
    }
}

fn sign(v: f64) -> f64 {
    if v < 0.0 {
        -1.0
    } else {
        1.0
    }
}

/// The samples of a stretch at which a channel turns, to move back by more than `back`.
pub(crate) fn turns(channel: &Channel, record: &Range<usize>, back: f64) -> Vec<usize> {
    let mut turns = Vec::new();
    let (mut low, mut high) = (record.start, record.start);
    let mut rising: Option<bool> = None;
    let at = |i: usize| channel.motion[i].position;
    for i in record.clone().skip(1) {
        if at(i) > at(high) {
            high = i;
        }
        if at(i) < at(low) {
            low = i;
        }
        if rising != Some(false) && at(i) < at(high) - back {
            if rising.is_some() {
                turns.push(high);
            }
            (rising, low) = (Some(false), i);
        } else if rising != Some(true) && at(i) > at(low) + back {
            if rising.is_some() {
                turns.push(low);
            }
            (rising, high) = (Some(true), i);
        }
    }
    turns
}

/// Travel and time since the channel's last reversal in a record; before the first reversal, the
/// largest of all.
fn since_reversal(channel: &Channel, record: &Range<usize>, dt: f64) -> (Vec<f64>, Vec<f64>) {
    let turns = turns(channel, record, REVERSAL * channel.reach);
    let mut next = turns.iter().peekable();
    let mut last: Option<usize> = None;
    let (mut way, mut time) = (Vec::new(), Vec::new());
    for i in record.clone() {
        let motion = &channel.motion[i];
        if next.peek().is_some_and(|&&turn| turn <= i) {
            last = next.next().copied();
        }
        match last {
            Some(turn) => {
                way.push((motion.position - channel.motion[turn].position).abs());
                time.push((i - turn) as f64 * dt);
            }
            None => {
                way.push(f64::NAN);
                time.push(f64::NAN);
            }
        }
    }
    for values in [&mut way, &mut time] {
        let most = values.iter().copied().fold(0.0, f64::max);
        for value in values.iter_mut().filter(|v| v.is_nan()) {
            *value = most;
        }
    }
    (way, time)
}
