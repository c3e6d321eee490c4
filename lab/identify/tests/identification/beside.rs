//! Three effects at once, of which the first names that are found are not the right ones.
//!
//! Together two effects over one variable look like a third: a friction and a cubic drag
//! like a viscous term, a Stribeck and a viscous friction like a Coulomb friction and a
//! quadratic drag. Only beside each other are they found.

use crate::rig::Made;
use bowden_synth::{Mode, Planted, Recipe};

/// Mode, seed, and what is planted with how many times the noise.
type Triple = (Mode, u64, [(&'static str, f64); 3]);

const TRIPLES: [Triple; 4] = [
    (
        Mode::Displacement,
        76,
        [("pinching", 1.5), ("drag-cubic", 1.4), ("coulomb", 1.4)],
    ),
    (
        Mode::Displacement,
        75,
        [("viscous", 2.4), ("stribeck", 1.3), ("degradation", 1.7)],
    ),
    (
        Mode::Displacement,
        73,
        [
            ("drag-cubic", 2.7),
            ("delay", 1.7),
            ("asymmetry-viscous", 1.9),
        ],
    ),
    (
        Mode::Torque,
        74,
        [
            ("back-drive-friction", 1.8),
            ("drag-cubic", 1.4),
            ("stiffness-cubic", 1.0),
        ],
    ),
];

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn names_that_only_together_are_right_are_found_together() {
    for (mode, seed, planted) in TRIPLES {
        let recipe = Recipe {
            seed,
            effects: planted
                .map(|(effect, strength)| Planted {
                    strength,
                    ..Planted::new(effect)
                })
                .to_vec(),
            ..Recipe::new(mode)
        };
        let made = Made::new(&recipe);
        let ledger = made.closed();
        let named: Vec<Vec<&'static str>> = ledger
            .rounds
            .iter()
            .map(|round| round.possible().map(|one| one.family).collect())
            .collect();
        let family = |name| {
            bowden::effect::CATALOGUE
                .iter()
                .find(|i| i.name == name)
                .unwrap()
                .family
        };
        let planted = planted.map(|(name, _)| family(name));
        let is_named = |one: &&str| named.iter().any(|round| round.contains(one));
        let is_planted = |round: &Vec<&'static str>| planted.iter().any(|one| round.contains(one));
        assert!(planted.iter().all(is_named), "{seed}: {named:?}");
        assert!(named.iter().all(is_planted), "{seed}: {named:?}");
        assert!(ledger.unknown.is_none(), "{seed}");
    }
}
