//! A power law of the velocity is told from viscous and Coulomb friction, and from what else
//! rises with the velocity.

use crate::rig::{names, with_effects, Made, MODES};
use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::ledger::{Grade, Ledger};
use bowden_synth::{Mode, Recipe};

/// The record of some effects at that many times the noise, and what is found in it.
fn closed(mode: Mode, effects: &[(&str, f64)], seed: u64) -> (Made, Ledger) {
    let made = Made::new(&with_effects(mode, effects, seed));
    let ledger = made.closed();
    (made, ledger)
}

fn families(ledger: &Ledger) -> Vec<&'static str> {
    let rounds = ledger.rounds.iter().chain(&ledger.beyond);
    let candidates = rounds.flat_map(|round| round.possible());
    candidates.map(|candidate| candidate.family).collect()
}

#[test]
fn a_planted_power_law_is_the_one_name_with_its_exponent() {
    for mode in MODES {
        let (made, ledger) = closed(mode, &[("power-law", 3.0)], 5001);
        assert_eq!(names(&ledger), ["power-law"], "{mode:?}");
        assert_eq!(ledger.rounds[0].grade, Grade::High, "{mode:?}");
        let planted = made.synthetic.truth.effects[0].shapes[0].1;
        let done = FinalFit::new(&made.data, &ledger);
        let parameters = made.parameters(&done.solution);
        let own = parameters.iter().find(|p| p.name.ends_with(".a")).unwrap();
        let [low, high] = own.ci95.unwrap();
        assert!(
            low < planted && planted < high,
            "{mode:?}: {own:?}, {planted}"
        );
    }
}

/// Each neighbour, and the pair that a power law lies between, keeps its own names.
#[test]
fn no_neighbour_of_a_power_law_is_called_one() {
    let neighbours: [&[(&str, f64)]; 7] = [
        &[("viscous", 3.0)],
        &[("coulomb", 3.0)],
        &[("viscous", 1.0), ("coulomb", 1.0)],
        &[("viscous", 3.0), ("coulomb", 3.0)],
        &[("coulomb", 3.0), ("stribeck", 3.0)],
        &[("viscous", 1.0), ("drag-quadratic", 3.0)],
        &[("viscous", 3.0), ("coulomb", 2.0), ("stribeck", 1.0)],
    ];
    for mode in MODES {
        for planted in neighbours {
            let (_, ledger) = closed(mode, planted, 5001);
            let found = families(&ledger);
            assert!(!found.is_empty(), "{mode:?} {planted:?}");
            assert!(
                !found.contains(&"power-law"),
                "{mode:?} {planted:?}: {found:?}"
            );
        }
    }
}

/// A Stribeck effect whose gain opposes the Coulomb friction beside it is a way to say that the
/// friction rises from rest on.
#[test]
fn no_stribeck_effect_opposes_the_coulomb_friction_beside_it() {
    for mode in MODES {
        for seed in 5001..5005 {
            let (_, ledger) = closed(mode, &[("power-law", 3.0)], seed);
            let last = ledger.last();
            let gain = |name: &str| {
                let terms = &last.structure.terms;
                let at = terms.iter().position(|t| t.effect.name() == name);
                at.map(|at| last.gain(at))
            };
            if let (Some(coulomb), Some(stribeck)) = (gain("coulomb"), gain("stribeck")) {
                assert!(coulomb * stribeck > 0.0, "{mode:?} {seed}");
            }
            assert!(families(&ledger).contains(&"power-law"), "{mode:?} {seed}");
        }
    }
}

/// Viscous, Coulomb and Stribeck friction fit a power law to the noise; a curve over the velocity
/// does as well.
#[test]
fn a_power_law_takes_the_place_of_three_names_and_of_a_curve() {
    let beside: &[(&str, f64)] = &[("rate", 1.2), ("creep", 2.0), ("power-law", 1.5)];
    for seed in [5001, 5004, 5008] {
        let recipe = Recipe {
            seconds: 60.0,
            ..with_effects(MODES[0], beside, seed)
        };
        let mut names = names(&Made::new(&recipe).closed());
        names.sort_unstable();
        assert_eq!(names, ["creep", "power-law", "rate"], "{seed}");
    }
    for (strength, seed) in [(4.0, 5004), (10.0, 5006)] {
        let (_, ledger) = closed(MODES[0], &[("power-law", strength)], seed);
        assert_eq!(names(&ledger), ["power-law"], "{strength} {seed}");
        assert!(ledger.last().structure.table.is_none());
    }
}
