//! A power law of the velocity is told from viscous and Coulomb friction, and from what else
//! rises with the velocity.

use crate::rig::{Made, MODES};
use bowden::effect::Family;
use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::ledger::{Grade, Ledger};
use bowden_lab::search::close;
use bowden_synth::{Planted, Recipe};

/// The record of some effects at that many times the noise, and what is found in it.
fn closed(mode: bowden_synth::Mode, effects: &[(&str, f64)], seed: u64) -> (Made, Ledger) {
    let planted = effects.iter().map(|&(effect, strength)| Planted {
        strength,
        ..Planted::new(effect)
    });
    let made = Made::new(&Recipe {
        seed,
        effects: planted.collect(),
        ..Recipe::new(mode)
    });
    let ledger = close(&made.data, &made.declare(&["bouc-wen"]), |_| ()).unwrap();
    (made, ledger)
}

fn families(ledger: &Ledger) -> Vec<Family> {
    let rounds = ledger.rounds.iter().chain(&ledger.beyond);
    let candidates = rounds.flat_map(|round| round.rivals.iter().chain([&round.candidate]));
    candidates.map(|candidate| candidate.family).collect()
}

#[test]
fn a_planted_power_law_is_the_one_name_with_its_exponent() {
    for mode in MODES {
        let (made, ledger) = closed(mode, &[("power-law", 3.0)], 5001);
        let names: Vec<&str> = ledger
            .rounds
            .iter()
            .map(|r| r.candidate.term.effect.name())
            .collect();
        assert_eq!(names, ["power-law"], "{mode:?}");
        assert_eq!(ledger.rounds[0].grade, Grade::Firm, "{mode:?}");
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
    let neighbours: [&[(&str, f64)]; 6] = [
        &[("viscous", 3.0)],
        &[("coulomb", 3.0)],
        &[("viscous", 1.0), ("coulomb", 1.0)],
        &[("viscous", 3.0), ("coulomb", 3.0)],
        &[("coulomb", 3.0), ("stribeck", 3.0)],
        &[("viscous", 1.0), ("drag-quadratic", 3.0)],
    ];
    for mode in MODES {
        for planted in neighbours {
            let (_, ledger) = closed(mode, planted, 5001);
            let found = families(&ledger);
            assert!(!found.is_empty(), "{mode:?} {planted:?}");
            assert!(
                !found.contains(&Family::PowerLaw),
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
            assert!(
                families(&ledger).contains(&Family::PowerLaw),
                "{mode:?} {seed}"
            );
        }
    }
}
