//! The table of the lab's properties of each effect in the core's catalogue.
//!
//! The core defines how an effect is computed. This table defines how the lab uses it: on which
//! channels and at which shapes it is tried, how `--baseline` names it, over which range each shape
//! is fitted, what it depends on, and which motion reveals it. A new effect of the core needs one
//! entry in `motion` or `whole`; a test names the effect that has none.

mod motion;
mod scale;
mod whole;

pub(crate) use scale::{Bounds, Scale};

use super::kind::{kind, Kind};
use super::variable::Variable;
use crate::problem::{Channel, Prepared};
use crate::record::Mode;
use bowden::effect::{Effect, Info, Quantity, CATALOGUE};
use bowden::model::Source;

/// The motion that shows an asymmetry of any kind.
const BOTH_DIRECTIONS: &str = "the same strokes in both directions, at several speeds";

/// One effect.
pub(crate) struct Entry {
    /// The name of the effect, as in the core's catalogue.
    pub(crate) name: &'static str,
    /// Rank of its family, from the simplest on: of two alternatives the lower one is named.
    pub(crate) rank: usize,
    /// The channels on which it is tried, and the shapes; other channels are left out.
    pub(crate) tried: &'static [Tried],
    /// How it is declared.
    pub(crate) declared: Declared,
    /// The range of each shape, in the core's order.
    pub(crate) bounds: &'static [Bounds],
    /// Range of the gain of an output stage, which is not linear; `None` for all others.
    pub(crate) stage: Option<Stage>,
    /// The origin of the position, if it reads a position.
    pub(crate) zero: Zero,
    /// Whether this origin is fitted.
    pub(crate) fitted_zero: FittedZero,
    /// Whether its gain is a friction coefficient, which dissipates energy.
    pub(crate) takes_energy: bool,
    /// The variable that a candidate is a function of or represents.
    pub(crate) on: &'static [On],
    /// Whether a model can have two of it on one channel.
    pub(crate) several: bool,
    /// How people distinguish two of them.
    pub(crate) told_by: ToldBy,
    /// Whether it remembers motion before the record, so that its initial state is fitted.
    pub(crate) past: bool,
    /// Why it belongs to the record and is not exported; `None` if it belongs to the rig.
    pub(crate) of_the_record: Option<&'static str>,
    /// The motion that shows it.
    pub(crate) shown_by: &'static str,
}

/// Where an effect is tried.
pub(crate) struct Tried {
    pub(crate) place: Place,
    pub(crate) shapes: Trials,
}

/// What an effect is tried on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// The model as a whole: it reads the input, or nothing.
    Whole,
    /// The same, in torque mode without a transmission.
    WholeWithoutTransmission,
    /// A channel that moves.
    Motion,
    /// A channel that moves, if the transmitted load is known.
    LoadedMotion,
    /// The input, if it is a motion.
    InputMotion,
    /// A rotation against gravity: an angle in torque mode with a range that is not small.
    Joint,
    /// The input of the torque mode.
    Torque,
    /// The same, in a record without a motion channel. With an elastic load, the torque's rate is
    /// the only substitute for a velocity.
    TorqueAlone,
    /// The stretch of a cable.
    Stretch,
    /// A temperature.
    Temperature,
    /// Any other channel.
    Other,
}

/// Trial shapes.
pub(crate) enum Trials {
    /// Each of these.
    At(&'static [&'static [Scale]]),
    /// The positions below which the channel stays for these shares of the time.
    Quantiles(&'static [f64]),
    /// Time constants \[s\] that the motion does not already cover.
    TimeConstants(&'static [f64]),
    /// The strongest lines of the residual's order spectrum.
    Orders,
    /// Moments inside the fit segment.
    Moments,
}

/// Maximum gain of an output stage. The minimum is 0: the output of a transmission does not lead
/// its input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Stage {
    /// A number of periods of the cut-off \[s\].
    Periods(f64),
    /// This number: a lag with a gain of 1 is a whole low-pass.
    Number(f64),
}

/// The origin from which an effect measures position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Zero {
    /// The middle of the channel.
    Channel,
    /// The sensor's own zero.
    Sensor,
}

/// Whether the origin from which an effect measures position is fitted: only if moving the origin
/// differs from adding terms that the model already has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FittedZero {
    /// Never: everything that it could add is a separate effect.
    Never,
    /// Always.
    Always,
    /// Unless the model has all of these on the same channel.
    Unless(&'static [&'static str]),
}

/// What people tell two effects of one name and channel apart by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ToldBy {
    /// The name is sufficient.
    Name,
    /// Its first shape, a frequency \[Hz\].
    Frequency,
    /// Its first shape, an angular frequency over the position.
    Order,
}

/// How an effect is declared, with the shapes from which the fit starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Declared {
    /// On the channel that the user names, or on the usual one.
    OnChannel(&'static [Scale]),
    /// On the input, from the sensor's zero, for any named channel.
    OnInput(&'static [Scale]),
    /// On the channel that is the stretch of a cable; it has no shapes.
    OnStretch,
    /// Its shapes are only found by a search.
    Never,
}

/// The variable of a candidate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum On {
    /// The quantities that it reads according to the core, the fastest first.
    Read,
    /// The position, with the sign of the velocity.
    DirectedPosition,
    /// The load, with the sign of the velocity.
    DirectedLoad,
    /// The position.
    Position,
    /// Distance and time since the last reversal.
    Reversal,
}

/// Strokes over the whole range: the motion for effects that need nothing else.
const WHOLE_RANGE: &str = "strokes over the whole range, in both directions";

/// An effect without shapes that is tried nowhere: the defaults of an entry.
const PLAIN: Entry = Entry {
    name: "",
    rank: 0,
    tried: &[],
    declared: Declared::OnChannel(&[]),
    bounds: &[],
    stage: None,
    zero: Zero::Channel,
    fitted_zero: FittedZero::Never,
    takes_energy: false,
    on: &[On::Read],
    several: false,
    told_by: ToldBy::Name,
    past: false,
    of_the_record: None,
    shown_by: WHOLE_RANGE,
};

/// Nothing to choose: an effect without shapes.
const AS_IT_IS: Trials = Trials::At(&[&[]]);

const fn on(place: Place, shapes: Trials) -> Tried {
    Tried { place, shapes }
}

/// Every effect of the core's catalogue, in the order in which they are tried.
pub(crate) fn table() -> impl Iterator<Item = &'static Entry> {
    whole::WHOLE.iter().chain(motion::MOTION)
}

/// The entry of an effect; `None` if the table lacks it, which a test excludes.
pub(crate) fn entry(name: &str) -> Option<&'static Entry> {
    table().find(|entry| entry.name == name)
}

/// The first effect of a family, in the order of the core's catalogue.
pub(crate) fn first_of(family: &str) -> Option<&'static Entry> {
    let mut all = CATALOGUE.iter();
    let first = all.find(|info| info.family == family)?;
    entry(first.name)
}

/// Rank of an effect's family among alternatives; the lowest rank is named.
pub(crate) fn rank(name: &str) -> usize {
    entry(name).map_or(CATALOGUE.len(), |entry| entry.rank)
}

/// The motion that shows an effect.
pub(crate) fn shown_by(name: &str) -> &'static str {
    entry(name).map_or(WHOLE_RANGE, |entry| entry.shown_by)
}

/// Why a family belongs to the record on which it was found; `None` if it belongs to the rig.
pub(crate) fn of_the_record(family: &'static str) -> Option<&'static str> {
    let is_of = |entry: &&Entry| info(entry.name).is_some_and(|info| info.family == family);
    table().find(is_of)?.of_the_record
}

fn info(name: &str) -> Option<&'static Info> {
    let mut all = CATALOGUE.iter();
    all.find(|info| info.name == name).copied()
}

/// A joint whose range about its middle is smaller than this does not show gravity \[rad\].
const LEAST_SWING: f64 = 0.3;

/// Whether anything in a record moves.
fn moves(data: &Prepared) -> bool {
    let is_motion = |(index, channel): (usize, &Channel)| {
        kind(data.mode, Source::Channel(index as u8), channel) == Kind::Motion
    };
    data.channels.iter().enumerate().any(is_motion)
}

impl Place {
    /// Whether a channel of that kind is such a place.
    pub(crate) fn is(self, data: &Prepared, source: Source, channel: &Channel) -> bool {
        let kind = kind(data.mode, source, channel);
        match self {
            Self::Whole | Self::WholeWithoutTransmission => false,
            Self::Motion => kind == Kind::Motion,
            Self::LoadedMotion => {
                kind == Kind::Motion && (data.mode == Mode::Torque || data.load.is_some())
            }
            // A torque has no slack: only a motion can be handed on late.
            Self::InputMotion => kind == Kind::Motion && source == Source::Input,
            Self::Joint => {
                let is_angle = matches!(channel.unit.as_deref(), None | Some("rad"));
                kind == Kind::Motion
                    && is_angle
                    && data.mode == Mode::Torque
                    && channel.reach > LEAST_SWING
            }
            Self::Torque => kind == Kind::Torque,
            Self::TorqueAlone => kind == Kind::Torque && !moves(data),
            Self::Stretch => kind == Kind::Stretch,
            Self::Temperature => kind == Kind::Temperature,
            Self::Other => matches!(kind, Kind::Load | Kind::Other),
        }
    }
}

impl Entry {
    /// Whether a shape is a moment of the record, which moves by whole samples.
    pub(crate) fn is_moment(&self, shape: usize) -> bool {
        self.bounds.get(shape) == Some(&Bounds::FitSegment)
    }

    /// What an effect on a source is a function of.
    pub(crate) fn variables(&self, effect: &Effect<f64>, source: Source) -> Vec<Variable> {
        let mut all = Vec::new();
        for on in self.on {
            match on {
                On::Read => all.push(read(effect, source)),
                On::DirectedPosition => all.push(Variable::DirectedPosition(source)),
                On::DirectedLoad => all.push(Variable::DirectedLoad(source)),
                On::Position => all.push(Variable::Position(source)),
                On::Reversal => all.extend([
                    Variable::ReversalDistance(source),
                    Variable::ReversalTime(source),
                ]),
            }
        }
        all
    }
}

fn read(effect: &Effect<f64>, source: Source) -> Variable {
    let reads = effect.info().reads;
    let on = |quantity| reads.contains(&quantity);
    if on(Quantity::Acceleration) {
        Variable::Acceleration(source)
    } else if on(Quantity::Velocity) {
        Variable::Velocity(source)
    } else if on(Quantity::Eta) {
        Variable::Eta
    } else if on(Quantity::Time) {
        Variable::Time
    } else {
        Variable::Position(source)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// How many shapes the core's effect has: it takes that many values and no other number.
    fn shapes_of(name: &str) -> usize {
        let takes = |n: &usize| Effect::try_from_name(name, &[1.0; 4][..*n]).is_ok();
        (0..4).find(takes).unwrap()
    }

    #[test]
    fn every_effect_of_the_core_has_one_entry_and_every_entry_is_an_effect() {
        for info in CATALOGUE {
            let own = table().filter(|entry| entry.name == info.name);
            assert_eq!(own.count(), 1, "{}", info.name);
        }
        assert_eq!(table().count(), CATALOGUE.len());
    }

    #[test]
    fn an_entry_agrees_with_what_the_core_says_of_its_effect() {
        for entry in table() {
            let name = entry.name;
            let info = info(name).unwrap();
            let shapes = shapes_of(name);
            assert_eq!(entry.bounds.len(), shapes, "{name}: bounds");
            for tried in entry.tried {
                let given = match tried.shapes {
                    Trials::At(list) => list.iter().map(|trial| trial.len()).collect(),
                    Trials::Orders => vec![2],
                    _ => vec![1],
                };
                assert!(given.iter().all(|n| *n == shapes), "{name}: trial shapes");
            }
            if let Declared::OnChannel(own) | Declared::OnInput(own) = entry.declared {
                assert_eq!(own.len(), shapes, "{name}: declared shapes");
            }
            let is_stage = info.reads.contains(&Quantity::Output);
            assert_eq!(entry.stage.is_some(), is_stage, "{name}: range of its gain");
            assert!(info.memory || !entry.past, "{name} remembers nothing");
            let is_named = entry.told_by == ToldBy::Name;
            assert!(is_named || shapes > 0, "{name}: no shape to tell it by");
            if entry.fitted_zero != FittedZero::Never {
                let has_zero = info.reads.contains(&Quantity::Position);
                assert!(has_zero, "{name} measures no position");
            }
            if let FittedZero::Unless(others) = entry.fitted_zero {
                for other in others {
                    assert!(super::entry(other).is_some(), "{name}: {other}");
                }
            }
        }
    }

    #[test]
    fn a_family_stands_for_its_first_effect() {
        for (family, first) in [
            ("drag", "drag-quadratic"),
            ("asymmetry", "asymmetry-viscous"),
            ("direction", "drive-friction"),
            ("stiffness", "stiffness-linear"),
            ("saturation", "saturation-upper"),
        ] {
            assert_eq!(first_of(family).unwrap().name, first);
        }
    }

    #[test]
    fn what_holds_of_a_family_holds_of_all_its_effects() {
        for one in table() {
            let family = |entry: &Entry| info(entry.name).unwrap().family;
            for other in table().filter(|other| family(other) == family(one)) {
                let names = (one.name, other.name);
                assert_eq!(one.rank, other.rank, "{names:?}");
                assert_eq!(one.of_the_record, other.of_the_record, "{names:?}");
            }
        }
    }
}
