//! Records with planted effects.

use bowden::effect::CATALOGUE;
use bowden_synth::{Mode, Planted, Recipe};

/// The family of an effect of the catalogue.
pub fn family_of(effect: &str) -> Option<&'static str> {
    CATALOGUE
        .iter()
        .find(|info| info.name == effect)
        .map(|info| info.family)
}

/// A record of that kind with those effects at those strengths.
pub fn recipe(mode: Mode, planted: &[(&str, f64)], colour: f64, seed: u64) -> Recipe {
    let names = |words: &[&str]| {
        planted
            .iter()
            .any(|(effect, _)| words.iter().any(|w| effect.contains(w)))
    };
    Recipe {
        seed,
        colour,
        effects: planted
            .iter()
            .map(|&(effect, strength)| Planted {
                strength,
                ..Planted::new(effect)
            })
            .collect(),
        load: mode == Mode::Displacement && names(&["load", "capstan", "drive"]),
        ..Recipe::new(mode)
    }
}

/// What is no part of the baseline model under another name.
pub fn can_be_missing(mode: Mode, effect: &str) -> bool {
    let absorbed = match mode {
        Mode::Torque => ["offset", "gain", ""],
        // A gain on the load channel is that channel's crosstalk.
        Mode::Displacement => ["offset", "gain", "stiffness-linear"],
    };
    !absorbed.contains(&effect)
}
