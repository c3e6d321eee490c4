//! At most so many effects.

use crate::rig::Closed;
use bowden_lab::conclude::finding::Finding;
use bowden_lab::conclude::findings::{findings, sentence};
use bowden_lab::conclude::verdict::{verdict, Verdict};
use bowden_synth::{Mode, Planted, Recipe};

/// A rig that lacks three effects.
fn three() -> Recipe {
    let strong = |effect| Planted {
        strength: 2.0,
        ..Planted::new(effect)
    };
    Recipe {
        effects: vec![
            Planted::new("viscous"),
            strong("stiffness-cubic"),
            strong("inertia"),
        ],
        ..Recipe::of_one_rig(Mode::Displacement, 73_000)
    }
}

#[test]
fn no_rounds_fit_what_is_declared_and_claim_nothing_of_what_is_missing() {
    let closed = Closed::new(&three(), &["bouc-wen"], 0);
    assert!(closed.ledger.rounds.is_empty() && closed.ledger.rejected.is_empty());
    assert!(closed.ledger.unknown.is_none());
    assert_eq!(closed.ledger.stopped_by_request, Some(0));
    assert_eq!(
        verdict(&closed.data, &closed.ledger, &closed.done),
        Verdict::Stopped
    );
    let told = sentence(&closed.data, &closed.ledger, &closed.done);
    assert!(told.contains("The program did not search"), "{told}");
    assert!(!told.contains("lacks"), "{told}");
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn rounds_end_where_they_were_asked_to_and_the_sentence_says_so() {
    for most in [1, 2] {
        let closed = Closed::new(&three(), &["bouc-wen"], most);
        assert_eq!(closed.ledger.rounds.len(), most);
        assert_eq!(closed.ledger.stopped_by_request, Some(most));
        let found = verdict(&closed.data, &closed.ledger, &closed.done);
        // Rivals of what was found go before what was not looked for.
        let rivals = closed.ledger.rounds.iter().any(|r| !r.rivals.is_empty());
        let expected = match rivals {
            true => Verdict::Ambiguous,
            false => Verdict::Stopped,
        };
        assert_eq!(found, expected, "{most}");
        let all = findings(&closed.data, &closed.ledger, &closed.done, found);
        let stopped = Finding::SearchStopped {
            seconds: None,
            terms: Some(most),
        };
        assert!(all.contains(&stopped), "{all:#?}");
    }
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn a_search_that_ends_before_its_limit_has_not_been_stopped() {
    let recipe = Recipe {
        effects: vec![Planted::with_gain("viscous", 0.02)],
        ..Recipe::of_one_rig(Mode::Displacement, 73_001)
    };
    let closed = Closed::new(&recipe, &["bouc-wen"], 5);
    assert_eq!(closed.ledger.rounds.len(), 1);
    assert_eq!(closed.ledger.stopped_by_request, None);
    let found = verdict(&closed.data, &closed.ledger, &closed.done);
    let all = findings(&closed.data, &closed.ledger, &closed.done, found);
    let is_stopped = |f: &Finding| matches!(f, Finding::SearchStopped { .. });
    assert!(!all.iter().any(is_stopped), "{all:#?}");
}

#[test]
fn a_declared_model_at_the_noise_is_explained_without_a_search_but_nothing_is_claimed() {
    let closed = Closed::new(
        &Recipe::of_one_rig(Mode::Displacement, 73_002),
        &["bouc-wen"],
        0,
    );
    assert_eq!(
        verdict(&closed.data, &closed.ledger, &closed.done),
        Verdict::Explained
    );
    let told = sentence(&closed.data, &closed.ledger, &closed.done);
    assert!(told.contains("The program did not search"), "{told}");
    assert!(
        !told.contains("no effect is missing from the baseline model"),
        "{told}"
    );
}

/// A bump over the position is in no catalogue: with a search it becomes a table.
#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn no_rounds_draw_no_curve_of_what_has_no_name() {
    let recipe = Recipe {
        effects: vec![Planted::new("bump-position")],
        ..Recipe::of_one_rig(Mode::Displacement, 73_003)
    };
    for (most, is_drawn) in [(8, true), (0, false)] {
        let ledger = Closed::new(&recipe, &["bouc-wen"], most).ledger;
        assert_eq!(ledger.unknown.is_some(), is_drawn, "{most}");
    }
}
