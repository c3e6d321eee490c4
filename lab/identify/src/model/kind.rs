//! The kind of a channel, as far as the effects need it.

use crate::problem::Channel;
use crate::record::Mode;
use bowden::effect::Effect;
use bowden::model::Source;

/// The kind of a channel for the effects, determined from its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// An angle or a displacement: something moves.
    Motion,
    /// The transmitted torque, input of the torque mode.
    Torque,
    Temperature,
    /// The stretch of a cable: the difference of the angles at its ends.
    Stretch,
    Load,
    Other,
}

pub(crate) fn kind(mode: Mode, source: Source, channel: &Channel) -> Kind {
    match (source, mode) {
        (Source::Input, Mode::Displacement) => Kind::Motion,
        (Source::Input, Mode::Torque) => Kind::Torque,
        _ if channel.name.starts_with("phi") || channel.name.starts_with("angle") => Kind::Motion,
        _ if channel.name.starts_with("temp") => Kind::Temperature,
        _ if channel.name.starts_with("stretch") => Kind::Stretch,
        _ if channel.name == "load" => Kind::Load,
        _ => Kind::Other,
    }
}

/// Whether an effect acts on the whole input or output; no compensator can have such a term.
#[must_use]
pub fn is_stage(effect: &Effect<f64>) -> bool {
    effect.is_output_stage() || effect.is_input_stage()
}
