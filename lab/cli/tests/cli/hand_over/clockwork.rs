//! What belongs to the record stays with the record, and the rest is fitted again.

use crate::hand_over::{recipe, Told};
use crate::shell::has;
use bowden::effect::{Effect, Quantity, CATALOGUE};
use bowden_lab::export::clockwork::is_clockwork;
use bowden_lab::export::invertible::is_stage;
use bowden_lab::fit::Segments;
use bowden_synth::Mode;

/// A record with an effect of thirty times the noise, so that its absence shows.
fn strong(effect: &str, declared: &str) -> Told {
    let recipe = recipe(Mode::Torque, 5, &[(effect, 30.0), ("viscous", 3.0)]);
    let told = Told::new(&recipe, &["bouc-wen", "viscous@phi_p", declared]);
    let terms = &told.done.solution.structure.terms;
    assert!(terms.iter().any(|term| term.effect.name() == effect));
    told
}

#[test]
fn a_drift_and_a_degradation_are_fitted_but_not_handed_over() {
    for (effect, declared) in [("drift", "drift"), ("degradation", "degradation@tau_i")] {
        let hand = strong(effect, declared).hand_over(false);
        let file = &hand.files[0];
        let kept: Vec<&str> = file.terms.iter().map(|t| t.effect.as_str()).collect();
        assert_eq!(kept, ["viscous"], "{effect}");
        assert_eq!(hand.left_out.len(), 1);
        assert_eq!(hand.left_out[0].effect, effect);
        has(
            &file.toml().unwrap(),
            &[&format!("effect = \"{effect}\"\nreason")],
        );
        has(&file.rust().unwrap(), &[&format!("Excluded: {effect}")]);
    }
}

#[test]
fn the_error_that_is_said_is_that_of_the_model_without_it_fitted_again() {
    let told = strong("drift", "drift");
    let (hand, done) = (told.hand_over(false), &told.done);
    // Thirty times the noise are missing: the error cannot be that of the final model.
    let (own, as_fitted) = (hand.nrmse.held_out, hand.as_fitted.held_out);
    assert!(own > 5.0 * as_fitted, "{own} {as_fitted}");
    assert_eq!(
        hand.as_fitted,
        done.rmse.normalised(&told.data, &told.data.target)
    );
    // The others' gains as they were, the drift's column taken away.
    let last = &done.solution;
    let drift = last.gains.len() - 1;
    let column = &last.columns[drift];
    let rows = last.residual.iter().enumerate();
    let without = rows.map(|(i, r)| r + last.gains[drift] * column[i]);
    let without: Vec<f64> = without.collect();
    let plain = Segments::of(&done.data, &without).fit;
    let refitted = Segments::of(&done.data, &hand.fitted.solution.residual).fit;
    assert!(refitted < 0.99 * plain, "refitted {refitted} of {plain}");
    let about = hand.files[0].about.clone().unwrap();
    assert_eq!(about.nrmse.held_out, own);
    assert_eq!(about.nrmse.held_out_as_fitted, as_fitted);
}

#[test]
fn a_model_without_clockwork_is_handed_over_as_it_was_fitted() {
    let recipe = recipe(Mode::Displacement, 8, &[("viscous", 3.0)]);
    let told = Told::new(&recipe, &["bouc-wen", "viscous", "lag"]);
    let hand = told.hand_over(false);
    assert!(hand.left_out.is_empty());
    assert_eq!(hand.fitted.solution.values, told.done.solution.values);
    assert_eq!(hand.fitted.solution.gains, told.done.solution.gains);
    assert_eq!(hand.nrmse, hand.as_fitted);
}

#[test]
fn clockwork_is_what_reads_the_time_or_the_path_from_the_start() {
    let mut clocks = Vec::new();
    for info in CATALOGUE {
        let mut tried = (0..3).map(|n| Effect::<f64>::try_from_name(info.name, &vec![0.5; n]));
        let effect = tried.find_map(Result::ok).unwrap();
        assert!(!(is_clockwork(&effect) && is_stage(&effect)));
        if is_clockwork(&effect) {
            clocks.push(info.name);
        } else {
            // Whatever reads the clock is clockwork.
            assert!(!info.reads.contains(&Quantity::Time), "{}", info.name);
        }
    }
    assert_eq!(clocks, ["drift", "degradation", "pretension", "tone"]);
}
