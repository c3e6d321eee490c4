//! A model on records of its rig that it has not seen.

use crate::rig::{check, nrmse, Closed};
use bowden::model::Source;
use bowden_lab::check::{Given, Seen, Verdict, HOLDS};
use bowden_lab::export::ShapeFile;
use bowden_lab::facts::Finding;
use bowden_lab::model::Variable;
use bowden_lab::scale::NOISE;
use bowden_synth::{Base, Mode, Planted, Recipe};
use rayon::prelude::*;

const MODES: [Mode; 2] = [Mode::Torque, Mode::Displacement];

fn viscous(mode: Mode, seed: u64) -> Recipe {
    let gain = match mode {
        Mode::Torque => 0.2,
        Mode::Displacement => 0.01,
    };
    Recipe {
        effects: vec![Planted::with_gain("viscous", gain)],
        ..Recipe::of_one_rig(mode, seed)
    }
}

/// The viscous effect as it is declared.
fn name_of(mode: Mode) -> &'static str {
    match mode {
        Mode::Torque => "viscous@phi_p",
        Mode::Displacement => "viscous",
    }
}

fn own_model(mode: Mode, seed: u64, colour: f64) -> Given {
    let recipe = Recipe {
        colour,
        ..viscous(mode, seed)
    };
    Closed::new(&recipe, &["bouc-wen", name_of(mode)], 0).given()
}

/// Twelve pairs of records in each of four cells: white and coloured noise, both modes.
#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn calibration_of_what_holds_on_the_next_record_of_the_same_rig() {
    let cells: Vec<(Mode, f64, u64)> = MODES
        .into_iter()
        .flat_map(|mode| [0.0, 0.95].map(|colour| (mode, colour)))
        .flat_map(|(mode, colour)| (0..12).map(move |k| (mode, colour, k)))
        .collect();
    let found: Vec<(f64, Verdict, bool)> = cells
        .par_iter()
        .map(|&(mode, colour, k)| {
            let given = own_model(mode, 71_000 + k, colour);
            let next = Recipe {
                colour,
                ..viscous(mode, 72_000 + k)
            };
            let found = check(&given, &next);
            let moved = found.line.gain_moved() || found.line.offset_moved(found.deviation);
            let ratio = nrmse(&found) / found.reference().unwrap();
            (ratio, found.verdict, moved)
        })
        .collect();
    let mut sorted: Vec<f64> = found.iter().map(|(ratio, ..)| *ratio).collect();
    sorted.sort_by(f64::total_cmp);
    println!("next record over held out: {sorted:.2?}");
    let held = found.iter().filter(|(_, v, _)| *v == Verdict::Holds);
    assert_eq!(held.count(), found.len(), "{found:?}");
    assert!(found.iter().all(|(.., moved)| !moved), "{found:?}");
    // The limit is above what luck does, and not far above.
    assert!(sorted[sorted.len() - 1] < HOLDS && sorted[sorted.len() - 1] > 1.2);
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn a_gain_that_has_moved_by_ten_percent_is_told_from_a_model_that_does_not_hold() {
    for mode in MODES {
        let given = own_model(mode, 71_100, 0.0);
        let mut next = viscous(mode, 72_100);
        let base = next.base.unwrap();
        next.base = Some(Base {
            gain: 1.1 * base.gain,
            kappa_eta: 1.1 * base.kappa_eta,
            offset: 1.1 * base.offset,
            ..base
        });
        next.effects[0].gain = next.effects[0].gain.map(|gain| 1.1 * gain);
        let found = check(&given, &next);
        assert_eq!(found.verdict, Verdict::GainOrOffsetMoved, "{mode:?}");
        let gain = found.line.gain;
        let [low, high] = gain.ci95.unwrap();
        assert!(high - low < 1e-3, "{gain:?}");
        // The model's own gain is known to some ten-thousandths, this record's likewise.
        assert!((gain.value - 1.1).abs() < 1e-3, "{gain:?}");
        assert!(found.rmse_gain_offset < 0.1 * found.rmse);
        assert!(found.depends_on.is_empty());
        let findings = found.findings();
        assert!(
            matches!(findings[0], Finding::LineChanged { gain: Some(_), .. }),
            "{findings:?}"
        );
    }
}

#[test]
fn an_offset_that_has_moved_is_called_an_offset() {
    let given = own_model(Mode::Displacement, 71_101, 0.0);
    let mut next = viscous(Mode::Displacement, 72_101);
    let base = next.base.unwrap();
    next.base = Some(Base {
        offset: base.offset + 2.0,
        ..base
    });
    let found = check(&given, &next);
    assert_eq!(found.verdict, Verdict::GainOrOffsetMoved);
    // Two newtons; the two records tell the offset to some hundredths.
    assert!((found.mean - 2.0).abs() < 0.05, "{}", found.mean);
    let findings = found.findings();
    assert!(
        matches!(findings[0], Finding::LineChanged { gain: None, .. }),
        "{findings:?}"
    );
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn an_effect_that_came_after_the_model_makes_it_not_hold_and_its_variable_is_named() {
    for (mode, effect, gain, variable) in [
        (
            Mode::Displacement,
            "viscous",
            0.05,
            Variable::Velocity(Source::Input),
        ),
        (
            Mode::Torque,
            "viscous",
            1.0,
            Variable::Velocity(Source::Channel(0)),
        ),
        (
            Mode::Displacement,
            "stiffness-cubic",
            0.005,
            Variable::Position(Source::Input),
        ),
    ] {
        let given = Closed::new(&Recipe::of_one_rig(mode, 71_102), &["bouc-wen"], 0).given();
        let next = Recipe {
            effects: vec![Planted::with_gain(effect, gain)],
            ..Recipe::of_one_rig(mode, 72_102)
        };
        let found = check(&given, &next);
        assert_eq!(found.verdict, Verdict::DoesNotHold, "{effect} {mode:?}");
        let first = found.depends_on.first().expect("a variable");
        assert_eq!(first.variable, variable, "{:?}", found.depends_on);
        let (variable, is_tested) = (Some(variable.words(&found.data)), first.p.is_some());
        let finding = Finding::ResidualDependsOn {
            variable,
            is_tested,
        };
        assert!(found.findings().contains(&finding));
    }
}

#[test]
fn where_the_model_holds_nothing_is_searched() {
    let given = own_model(Mode::Displacement, 71_103, 0.0);
    let next = viscous(Mode::Displacement, 72_103);
    let found = check(&given, &next);
    assert_eq!(found.verdict, Verdict::Holds);
    assert!(found.depends_on.is_empty());
    let findings = found.findings();
    assert!(
        matches!(findings[..], [Finding::ErrorAsExpected { .. }]),
        "{findings:?}"
    );
}

#[test]
fn a_record_beyond_what_the_model_has_seen_is_said_to_be() {
    let mut given = own_model(Mode::Displacement, 71_104, 0.0);
    let seen = Seen {
        position: Some([-11.0, 11.0]),
        velocity: Some([-10.0, 10.0]),
        acceleration: None,
    };
    given.about.ranges.insert("input".to_owned(), seen);
    let next = viscous(Mode::Displacement, 72_104);
    let found = check(&given, &next);
    // Within ±10 mm, but faster than ±10 mm/s.
    let listed: Vec<_> = found
        .outside
        .iter()
        .map(|o| (o.channel.as_str(), o.quantity))
        .collect();
    assert_eq!(listed, [("x", "velocity")]);
    let one = &found.outside[0];
    assert!(
        one.here[1] > 10.0 && one.share > 0.1 && one.share < 1.0,
        "{one:?}"
    );
    assert_eq!(one.unit.as_deref(), Some("mm/s"));
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn without_a_held_out_error_only_noise_is_judged() {
    let mut given = own_model(Mode::Displacement, 71_105, 0.0);
    given.about.nrmse = None;
    let next = viscous(Mode::Displacement, 72_105);
    let found = check(&given, &next);
    assert_eq!(
        found.verdict,
        Verdict::Holds,
        "{} of the floor",
        found.rmse / found.data.noise_floor
    );
    assert!(matches!(found.findings()[0], Finding::ErrorIsNoise { .. }));
    let more = Recipe {
        effects: vec![Planted::with_gain("viscous", 0.05)],
        ..next
    };
    let found = check(&given, &more);
    assert_eq!(found.verdict, Verdict::CannotTell);
    assert!(matches!(
        found.findings()[0],
        Finding::ErrorWithoutLimit { .. }
    ));
}

#[test]
fn a_model_that_explains_nothing_does_not_hold_however_bad_it_was_before() {
    let mut given = own_model(Mode::Displacement, 71_106, 0.0);
    if let Some(errors) = &mut given.about.nrmse {
        errors.held_out = Some(5.0);
    }
    given.file.transmission.as_mut().unwrap().gain = -2.0;
    let next = viscous(Mode::Displacement, 72_106);
    assert_eq!(check(&given, &next).verdict, Verdict::DoesNotHold);
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn the_start_of_the_record_does_not_count_and_less_of_it_does_not_for_a_model_without_memory() {
    let given = own_model(Mode::Displacement, 71_107, 0.0);
    let next = viscous(Mode::Displacement, 72_107);
    let found = check(&given, &next);
    assert!(
        found.left_out > 0.5 && found.left_out <= 5.0,
        "{}",
        found.left_out
    );
    // By then the three states before the record have become one.
    assert!(
        found.start < 0.05 * found.rmse,
        "{} {}",
        found.start,
        found.rmse
    );
    let line = Closed::new(&next, &["stiffness", "viscous", "offset"], 0).given();
    let found = check(&line, &next);
    assert_eq!(found.left_out, 0.0);
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn the_check_of_a_models_own_record_gives_its_own_error_again() {
    for mode in MODES {
        let recipe = viscous(mode, 71_108);
        let closed = Closed::new(&recipe, &["bouc-wen", name_of(mode)], 0);
        let found = check(&closed.given(), &recipe);
        let (rows, residual) = (&found.data.split.fit, &closed.done.solution.residual);
        let squares: f64 = rows.iter().map(|&i| residual[i].powi(2)).sum();
        let own = (squares / rows.len() as f64).sqrt();
        // The same rows; only eta(0) differs, and by then it is forgotten.
        assert!(
            (found.rmse / own - 1.0).abs() < 0.01,
            "{} {own}",
            found.rmse
        );
    }
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn an_output_stage_and_a_play_in_series_run_as_they_were_fitted() {
    let recipe = Recipe {
        play: 0.5,
        ..Recipe::of_one_rig(Mode::Displacement, 71_109)
    };
    let closed = Closed::new(&recipe, &["bouc-wen"], 2);
    let mut given = closed.given();
    let terms = &given.file.terms;
    assert!(terms.iter().any(|t| t.effect == "play-in-series"));
    let next = Recipe {
        seed: 72_109,
        ..recipe
    };
    assert_eq!(check(&given, &next).verdict, Verdict::Holds);
    // A wider play is another rig.
    let wider = |shape: &mut ShapeFile| shape.value *= 1.5;
    let shapes = given.file.terms.iter_mut().flat_map(|t| &mut t.shapes);
    shapes.for_each(wider);
    assert_eq!(check(&given, &next).verdict, Verdict::DoesNotHold);

    let lag = Recipe {
        effects: vec![Planted::new("lag")],
        ..Recipe::of_one_rig(Mode::Displacement, 71_110)
    };
    let closed = Closed::new(&lag, &["bouc-wen", "lag"], 0);
    let found = check(&closed.given(), &lag);
    assert_eq!(found.verdict, Verdict::Holds);
    assert!(found.rmse <= HOLDS.max(NOISE) * closed.done.rmse.held_out);
}

#[test]
fn a_record_that_hardly_moves_cannot_tell() {
    let given = own_model(Mode::Displacement, 71_111, 0.0);
    let still = Recipe {
        amplitude: 1e-3,
        noise: 0.5,
        effects: Vec::new(),
        ..Recipe::of_one_rig(Mode::Displacement, 72_111)
    };
    let found = check(&given, &still);
    assert_eq!(found.verdict, Verdict::CannotTell);
    assert_eq!(found.findings(), [Finding::OutputAtNoise]);
}
