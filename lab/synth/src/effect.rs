//! The effects that can be planted, by name.

use super::recipe::Mode;
use super::regressor::{Extent, Regressor};
use super::rig::Channel;
use super::{friction, memory, outside, shape};
use rand_chacha::ChaCha8Rng;

/// The last three need angles.
const NAMES: [&str; 45] = [
    "offset",
    "gain",
    "viscous",
    "drag-quadratic",
    "drag-cubic",
    "coulomb",
    "stribeck",
    "asymmetry-viscous",
    "asymmetry-drag",
    "asymmetry-eta",
    "asymmetry-eta-squared",
    "load-friction",
    "capstan",
    "drive-friction",
    "back-drive-friction",
    "inertia",
    "stiffness-linear",
    "stiffness-quadratic",
    "stiffness-cubic",
    "stiffness-progressive",
    "hinge",
    "ripple",
    "position-friction",
    "position-hysteresis",
    "backlash",
    "dead-zone",
    "delay",
    "lag",
    "creep",
    "rate",
    "rate-symmetric",
    "presliding",
    "degradation",
    "pinching",
    "drift",
    "pretension",
    "temperature",
    "saturation-upper",
    "saturation-lower",
    "tone",
    "crosstalk",
    "power-law",
    "gravity",
    "stretch-linear",
    "stretch-cubic",
];

/// Names of the effects that can be planted in that mode.
pub fn effects(mode: Mode) -> &'static [&'static str] {
    match mode {
        Mode::Torque => &NAMES,
        Mode::Displacement => &NAMES[..NAMES.len() - 3],
    }
}

/// The channel that an effect reads where the recipe names none.
pub(super) fn usual_channel(effect: &str, mode: Mode) -> Option<Channel> {
    match (effect, mode) {
        ("offset" | "drift" | "pretension" | "tone" | "delay" | "lag", _) => None,
        ("asymmetry-eta" | "asymmetry-eta-squared" | "degradation" | "pinching", _) => None,
        ("reversal-spike", _) => None,
        ("bump-load", Mode::Displacement) => Some(Channel::Load),
        ("bump-load", Mode::Torque) => Some(Channel::Input),
        ("temperature", _) => Some(Channel::Temperature),
        ("stretch-linear" | "stretch-cubic", _) => Some(Channel::Stretch),
        ("crosstalk", _) => Some(Channel::Auxiliary),
        ("gain", Mode::Displacement) => Some(Channel::Load),
        (_, Mode::Displacement) => Some(Channel::Input),
        ("gain" | "creep" | "rate" | "rate-symmetric", _) => Some(Channel::Input),
        ("saturation-upper" | "saturation-lower", _) => Some(Channel::Input),
        (_, Mode::Torque) => Some(Channel::Proximal),
    }
}

/// Whether an effect reads the transmitted load besides its channel.
pub(super) fn reads_load(effect: &str) -> bool {
    [
        "load-friction",
        "capstan",
        "drive-friction",
        "back-drive-friction",
    ]
    .contains(&effect)
}

/// The effect of that name with shapes drawn for a channel of that extent.
pub(super) fn build(
    effect: &str,
    extent: &Extent,
    input: &Extent,
    rng: &mut ChaCha8Rng,
) -> Option<Regressor> {
    friction::build(effect, extent, rng)
        .or_else(|| shape::build(effect, extent, rng))
        .or_else(|| memory::build(effect, extent, input, rng))
        .or_else(|| outside::build(effect, extent, input, rng))
}
