//! What belongs to the record stays with the record.

use crate::hand_over::rig::{record, with, Told};
use bowden_lab::export::clockwork::is_clockwork;
use bowden_lab::export::invertible::is_stage;
use bowden_lab::fit::Segments;
use bowden_synth::{Mode, Planted, Recipe};

fn names(told: &Told) -> Vec<&'static str> {
    let terms = &told.done.solution.structure.terms;
    terms.iter().map(|t| t.effect.name()).collect()
}

/// A record with an effect of thirty times the noise, so that its absence shows.
fn strong(effect: &str) -> Recipe {
    let planted = Planted {
        strength: 30.0,
        ..Planted::new(effect)
    };
    Recipe {
        seed: 5,
        effects: vec![planted, Planted::new("viscous")],
        ..Recipe::new(Mode::Torque)
    }
}

#[test]
fn a_drift_and_a_degradation_are_fitted_but_not_handed_over() {
    for (effect, declared) in [("drift", "drift"), ("degradation", "degradation@tau_i")] {
        let list = ["bouc-wen", "viscous@phi_p", declared];
        let told = Told::new(record(&strong(effect)), &list, None);
        assert!(names(&told).contains(&effect));
        let hand = told.hand_over(false);
        let file = &hand.files[0];
        let kept: Vec<&str> = file.terms.iter().map(|t| t.effect.as_str()).collect();
        assert_eq!(kept, ["viscous"], "{effect}");
        assert_eq!(hand.left_out.len(), 1);
        assert_eq!(hand.left_out[0].effect, effect);
        let text = file.toml().unwrap() + &file.rust().unwrap();
        assert!(text.contains(&format!("Excluded: {effect}")), "{text}");
        assert!(
            text.contains(&format!("effect = \"{effect}\"\nreason")),
            "{text}"
        );
    }
}

#[test]
fn the_error_that_is_said_is_that_of_the_model_without_it_fitted_again() {
    let list = ["bouc-wen", "viscous@phi_p", "drift"];
    let told = Told::new(record(&strong("drift")), &list, None);
    let hand = told.hand_over(false);
    // Thirty times the noise are missing: the error cannot be that of the final model.
    assert!(
        hand.nrmse.held_out > 5.0 * hand.as_fitted.held_out,
        "{:?}",
        hand.nrmse
    );
    assert_eq!(
        hand.as_fitted,
        told.done.rmse.normalised(&told.data, &told.data.target)
    );

    // The others' gains as they were, the drift's column taken away.
    let last = &told.done.solution;
    let drift = last.gains.len() - 1;
    let without: Vec<f64> = (0..last.residual.len())
        .map(|i| last.residual[i] + last.gains[drift] * last.columns[drift][i])
        .collect();
    let plain = Segments::of(&told.done.data, &without);
    let refitted = Segments::of(&told.done.data, &hand.fitted.solution.residual);
    assert!(
        refitted.fit < 0.99 * plain.fit,
        "refitted {} of {}",
        refitted.fit,
        plain.fit
    );
    let about = hand.files[0].about.clone().unwrap();
    assert_eq!(about.nrmse.held_out, hand.nrmse.held_out);
    assert_eq!(about.nrmse.held_out_as_fitted, hand.as_fitted.held_out);
}

#[test]
fn a_model_without_clockwork_is_handed_over_as_it_was_fitted() {
    let recipe = with(
        Recipe {
            seed: 8,
            ..Recipe::new(Mode::Displacement)
        },
        &["viscous"],
    );
    let told = Told::new(record(&recipe), &["bouc-wen", "viscous", "lag"], None);
    let hand = told.hand_over(false);
    assert!(hand.left_out.is_empty());
    assert_eq!(hand.fitted.solution.values, told.done.solution.values);
    assert_eq!(hand.fitted.solution.gains, told.done.solution.gains);
    assert_eq!(hand.nrmse, hand.as_fitted);
}

#[test]
fn clockwork_is_what_reads_the_time_or_the_path_from_the_start() {
    use bowden::effect::{Effect, Quantity, CATALOGUE};
    let mut clocks = Vec::new();
    for info in CATALOGUE {
        let effect = (0..3)
            .find_map(|n| Effect::<f64>::try_from_name(info.name, &vec![0.5; n]).ok())
            .unwrap();
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
