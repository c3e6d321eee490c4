//! What is missing, by mechanism; terms as candidates; stages within what is physical.

use crate::rig::{record, Closed};
use bowden_lab::conclude::findings::sentence;
use bowden_lab::conclude::mechanisms::{mechanisms, Lack};
use bowden_lab::ledger::Grade;
use bowden_lab::model::declared::structure;
use bowden_lab::model::mechanism::Mechanism;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::Record;
use bowden_lab::search::close;
use bowden_synth::{Mode, Planted, Recipe};

fn planted(effect: &str, strength: f64) -> Recipe {
    Recipe {
        effects: vec![Planted {
            strength,
            ..Planted::new(effect)
        }],
        ..Recipe::of_one_rig(Mode::Displacement, 73_100)
    }
}

fn lacks(closed: &Closed) -> Vec<Lack> {
    mechanisms(&closed.data, &closed.ledger, &closed.done)
}

#[test]
fn a_complete_model_names_the_mechanism_and_a_term_of_high_confidence() {
    let closed = Closed::new(&planted("drag-quadratic", 3.0), &["bouc-wen"], 8);
    let all = lacks(&closed);
    let [lack] = &all[..] else {
        panic!("{all:?}");
    };
    assert_eq!(
        (lack.mechanism, lack.confidence),
        (Mechanism::Friction, Grade::High)
    );
    assert_eq!(lack.channel, "x");
    // The only one: what it removes alone is what it removes beyond the others.
    let share = lack.share;
    assert_eq!(share.alone, share.beyond_others);
    assert!(
        share.alone.value > 0.8 && share.alone.value < 1.0,
        "{share:?}"
    );
    assert_eq!(closed.ledger.rounds[0].grade, Grade::High);
    let told = sentence(&closed.data, &closed.ledger, &closed.done);
    assert!(
        told.starts_with("The baseline model lacks friction over the velocity of x. With "),
        "{told}"
    );
    assert!(!told.contains("candidate"), "{told}");
}

/// A search that ends early leaves a model above the noise, whatever it has found; the mechanisms
/// do not wait for names.
#[test]
fn the_terms_of_a_model_above_the_noise_are_candidates_and_both_mechanisms_are_found() {
    let mut recipe = planted("drag-quadratic", 6.0);
    recipe.effects.push(Planted {
        strength: 3.0,
        ..Planted::new("stiffness-cubic")
    });
    let closed = Closed::new(&recipe, &["bouc-wen"], 1);
    let rounds = &closed.ledger.rounds;
    assert!(rounds.iter().all(|round| round.grade == Grade::Low));
    let all = lacks(&closed);
    let mechanisms: Vec<_> = all.iter().map(|l| (l.mechanism, l.confidence)).collect();
    assert_eq!(
        mechanisms,
        [
            (Mechanism::Friction, Grade::High),
            (Mechanism::Elastic, Grade::High)
        ]
    );
    // Only one of them has a term.
    assert_eq!(all.iter().map(|l| l.members.len()).sum::<usize>(), 1);
    let told = sentence(&closed.data, &closed.ledger, &closed.done);
    assert!(told.contains("The term is a candidate"), "{told}");
}

/// The curve of a mechanism is the planted function, of which it knows nothing.
#[test]
fn the_curve_of_a_mechanism_follows_what_was_planted_within_its_intervals() {
    let closed = Closed::new(&planted("drag-quadratic", 5.0), &["bouc-wen"], 8);
    let curve = &lacks(&closed)[0].curve;
    assert_eq!(curve.over, "the velocity of x");
    let gain = closed.done.solution.gain(0);
    let planted = |v: f64| gain * v * v.abs();
    let [first, .., last] = &curve.points[..] else {
        panic!("{curve:?}");
    };
    let reach = planted(last.at) - planted(first.at);
    let within = curve.points.iter().filter(|knot| {
        let [low, high] = knot.ci95.unwrap();
        // A bin is as wide as a tenth of the samples: its mean is not the value at its middle.
        let width = 0.05 * reach.abs();
        (low - width..=high + width).contains(&planted(knot.at))
    });
    assert!(within.count() >= curve.points.len() - 1, "{curve:?} {gain}");
}

/// The search may name one effect: what the other one leaves hides which drag it is. A complete
/// model has alternatives of its terms.
#[test]
fn an_incomplete_model_lists_other_terms_of_a_mechanism_and_a_complete_one_none() {
    let mut recipe = planted("drag-quadratic", 6.0);
    recipe.effects.push(Planted {
        strength: 5.0,
        ..Planted::new("bump-position")
    });
    let incomplete = Closed::new(&recipe, &["bouc-wen"], 1);
    let all = lacks(&incomplete);
    let described: Vec<_> = all.iter().flat_map(|lack| &lack.described_by).collect();
    assert!(!described.is_empty(), "{all:?}");
    for one in described {
        assert!(one.effects.len() == 1 && one.error_ratio > 0.0, "{one:?}");
    }
    for lack in &all {
        let ratios = lack.described_by.iter().map(|one| one.error_ratio);
        let ratios: Vec<f64> = ratios.collect();
        assert!(ratios.is_sorted() && ratios.len() <= 3, "{ratios:?}");
        // 1.25 in the squared error, of the best set or of the terms found.
        let least = ratios.first().map_or(1.0, |least| least.min(1.0));
        assert!(
            ratios.iter().all(|r| (r / least).powi(2) <= 1.25 + 1e-9),
            "{ratios:?}"
        );
    }
    let complete = Closed::new(&planted("drag-quadratic", 3.0), &["bouc-wen"], 8);
    assert!(lacks(&complete)
        .iter()
        .all(|lack| lack.described_by.is_empty()));
}

/// No effect of the catalogue describes a bump over the position; its mechanism does.
#[test]
fn the_mechanism_of_a_dependence_outside_the_catalogue_is_found_without_a_name() {
    let closed = Closed::new(&planted("bump-position", 5.0), &["bouc-wen"], 8);
    let all = lacks(&closed);
    assert_eq!(
        (all[0].mechanism, all[0].confidence),
        (Mechanism::Elastic, Grade::High),
        "{all:?}"
    );
    assert!(closed.ledger.rounds.iter().all(|r| r.grade == Grade::Low));
}

#[test]
fn a_complete_baseline_lacks_nothing() {
    let recipe = Recipe::of_one_rig(Mode::Displacement, 73_100);
    let closed = Closed::new(&recipe, &["bouc-wen"], 8);
    assert!(lacks(&closed).is_empty());
}

/// The record with an output that is so many samples early.
fn early(recipe: &Recipe, samples: usize) -> Record {
    let mut record = record(recipe);
    record.output.values.rotate_left(samples);
    record
}

#[test]
fn a_lead_is_a_note_and_no_term_and_a_delay_is_a_term_and_no_note() {
    let recipe = Recipe::of_one_rig(Mode::Displacement, 73_100);
    let declared = vec!["bouc-wen".to_owned()];
    let data = Prepared::new(&early(&recipe, 8), Preparation::default()).unwrap();
    let ledger = close(&data, &structure(&declared, &data).unwrap(), |_| ()).unwrap();
    let lead = ledger.lead.unwrap();
    assert!((lead - 8.0 / data.rate).abs() < 0.5 / data.rate, "{lead}");
    // The clocks explain as much as any term.
    assert!(!ledger.rounds.is_empty());
    assert!(ledger.rounds.iter().all(|round| round.grade == Grade::Low));
    let is_stage = |name: &str| ["delay", "lag"].contains(&name);
    let last = ledger.last();
    for (index, term) in last.structure.terms.iter().enumerate() {
        assert!(
            !is_stage(term.effect.name()) || last.gain(index) >= 0.0,
            "{term:?}"
        );
    }

    let late = Closed::new(&planted("delay", 5.0), &["bouc-wen"], 8);
    assert_eq!(late.ledger.lead, None);
    let round = &late.ledger.rounds[0];
    assert!(is_stage(round.term().effect.name()), "{:?}", round.term());
    assert_eq!(lacks(&late)[0].mechanism, Mechanism::Friction);
}
