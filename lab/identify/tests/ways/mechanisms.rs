//! What is missing, by mechanism; terms as candidates; stages within what is physical.

use crate::rig::{record, Closed};
use bowden_lab::conclude::mechanisms::{mechanisms, Lack};
use bowden_lab::conclude::verdict::sentence;
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
    assert!(lack.share > 0.8 && lack.share < 1.0, "{lack:?}");
    assert_eq!(closed.ledger.rounds[0].grade, Grade::High);
    let told = sentence(&closed.data, &closed.ledger, &closed.done);
    assert!(
        told.starts_with("The baseline model lacks friction over the velocity of x. With "),
        "{told}"
    );
    assert!(!told.contains("candidate"), "{told}");
}

/// A search that ends early leaves a model above the noise, whatever it has found.
#[test]
fn terms_of_a_model_above_the_noise_are_candidates_and_the_mechanism_stands() {
    let mut recipe = planted("drag-quadratic", 6.0);
    recipe.effects.push(Planted {
        strength: 3.0,
        ..Planted::new("stiffness-cubic")
    });
    let closed = Closed::new(&recipe, &["bouc-wen"], 1);
    assert!(closed
        .ledger
        .rounds
        .iter()
        .all(|round| round.grade == Grade::Low));
    let all = lacks(&closed);
    assert_eq!((all.len(), all[0].confidence), (1, Grade::High), "{all:?}");
    let told = sentence(&closed.data, &closed.ledger, &closed.done);
    assert!(told.contains("The term is a candidate"), "{told}");
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
