//! The fit within what a compensator can invert.

use crate::hand_over::{demo, recipe, Told, STEEP};
use crate::shell::{has, refuses, Folder};
use bowden::control::{Compensator, CompensatorInput, CompensatorState};
use bowden::effect::Motion;
use bowden::model::{ModelState, Sample};
use bowden_lab::export::ModelFile;
use bowden_lab::facts::percent;
use bowden_lab::model::columns::raw_columns;
use bowden_lab::model::structure::Role;
use bowden_synth::{Base, Mode, Recipe};

fn accepted(file: &ModelFile) -> bool {
    let single = Compensator::try_new(&file.model_in::<f32, 8>().unwrap());
    let double = Compensator::try_new(&file.model_in::<f64, 8>().unwrap());
    assert_eq!(single.is_ok(), double.is_ok());
    single.is_ok()
}

#[test]
fn the_demo_model_drives_a_compensator_once_it_is_fitted_invertible() {
    assert!(!accepted(&demo(false).file));
    let verdict = &demo(false).json["final"]["feed_forward"];
    assert_eq!(verdict["invertible"], false);
    let because = verdict["reason"].as_str().unwrap();
    let sigma = "sigma 2.97 > 0.543 = B/(2·kappa_eta·rho)";
    assert!(because.starts_with(sigma), "{because}");

    let (file, json) = (&demo(true).file, &demo(true).json);
    assert!(accepted(file));
    assert_eq!(json["final"]["feed_forward"]["invertible"], true);
    assert!(json["final"]["feed_forward"]["reason"].is_null());
    // What was found and what it explains do not depend on what is handed over.
    assert_eq!(json["verdict"], "explained");
    assert_eq!(json["final"]["effects"][1], "viscous@phi_p");

    // Turned round and run forwards again it gives what was wanted.
    let model = file.model::<8>().unwrap();
    let compensator = Compensator::try_new(&model).unwrap();
    let (mut inverse, mut forward) = (CompensatorState::new(), ModelState::new());
    for k in 0..2000 {
        let t = f64::from(k) * 1e-3;
        let desired = 6.0 * (4.0 * t).sin() + 2.0 * (17.0 * t).sin();
        let mut channels = [Motion::default(); 2];
        channels[0].velocity = (3.0 * t).cos();
        let at = CompensatorInput {
            channels: &channels,
            ..CompensatorInput::new(1e-3, desired)
        };
        let command = compensator.step(&mut inverse, &at).command;
        let sample = Sample {
            dt: 1e-3,
            input: Motion {
                position: command,
                ..Motion::default()
            },
            load: command,
            channels: &channels,
        };
        let output = model.step(&mut forward, &sample);
        // The inverse solves to 16 machine epsilons of the magnitudes, here of 30 N·m.
        assert!((output - desired).abs() < 1e-11, "{output} {desired}");
    }
}

#[test]
fn what_it_costs_is_said_and_a_new_fit_costs_less_than_a_lower_sigma() {
    let (free, within) = (&demo(false).json["final"], &demo(true).json["final"]);
    for segment in ["fit", "held_out"] {
        let nearest = free["feed_forward"]["nearest"]["nrmse"][segment].as_f64();
        let fitted = within["exported_model"]["nrmse"][segment].as_f64();
        assert!(fitted > free["nrmse"][segment].as_f64(), "{segment}");
        assert!(fitted.unwrap() < 0.9 * nearest.unwrap(), "{segment}");
    }
    let compared = "compared with 0.14 % for the unconstrained model";
    has(&demo(true).ledger, &["feed-forward: yes", compared]);
    has(
        &demo(false).ledger,
        &["feed-forward: no, because sigma", "--invertible"],
    );
}

/// Whether the number that follows a name on a line is this one, to its last digit.
fn is_printed(line: &str, name: &str, value: f64) -> bool {
    let (_, rest) = line.split_once(&format!("{name} ")).unwrap();
    let number = rest.split([' ', ',', '\n']).next().unwrap();
    let decimals = number.split_once('.').map_or(0, |(_, d)| d.len());
    let half = 0.5001 * 0.1_f64.powi(decimals as i32);
    (number.parse::<f64>().unwrap() - value).abs() <= half
}

/// What is between two words.
fn between<'a>(text: &'a str, begin: &str, end: &str) -> &'a str {
    let (_, rest) = text.split_once(begin).unwrap();
    rest.split_once(end).unwrap().0
}

/// "explained … 0.14 %" would be said of another model than the one in the file.
#[test]
fn headline_parameters_summary_and_page_are_those_of_the_file() {
    let told = demo(true);
    let nrmse = &told.file.about.as_ref().unwrap().nrmse;
    let (own, other) = (nrmse.held_out, nrmse.held_out_as_fitted);
    assert!(own > 10.0 * other, "{own} {other}");
    let (headline, _) = told.ledger.split_once("\nData").unwrap();
    let [ours, theirs] = [own, other].map(percent);
    let of_output = "of the output's standard deviation, compared with";
    has(
        headline,
        &[&format!("held-out error of {ours} {of_output} {theirs}")],
    );
    // What is said to programs is what is said to people.
    has(headline, &[told.json["summary"].as_str().unwrap()]);
    let t = told.file.transmission.as_ref().unwrap();
    let viscous = ("viscous@phi_p", told.file.terms[0].gain);
    let mut exported = headline.lines();
    let line = exported.find(|l| l.contains("in the exported model"));
    assert!(
        is_printed(line.unwrap(), viscous.0, viscous.1),
        "{headline}"
    );
    let parameters = between(&told.ledger, "\nModel", "\nUse it").lines();
    let of_numbers = |line: &&str| !line.contains(" = ") && !line.contains("is fixed");
    let lines: Vec<&str> = parameters.filter(of_numbers).collect();
    let json = told.json["final"]["exported_model"]["parameters"].as_array();

    // The page has both models, the exported one first.
    let page = &told.page;
    let numbers = between(page, "<dl class=\"numbers\">", "</dl>");
    let [ours, theirs] = [ours, theirs].map(|p| numbers.find(&format!(">{p}</data>")).unwrap());
    assert!(ours < theirs, "{numbers}");
    has(page, &[">unconstrained model: explained<"]);
    let heads = ["exported", "unconstrained"].map(|of| format!("Parameters of the {of} model"));
    let (_, own_table) = page.split_once(&heads[0]).unwrap();
    let (own_table, other_table) = own_table.split_once(&heads[1]).unwrap();
    for (name, value) in [
        ("B", t.gain),
        ("kappa_eta", t.kappa_eta),
        ("T0", t.offset),
        ("rho", t.rho),
        ("sigma", t.sigma),
        ("n", t.n),
        viscous,
    ] {
        let named = format!(" {name}");
        let line = lines
            .iter()
            .find(|l| l.contains(&format!("{named} ")))
            .unwrap();
        assert!(is_printed(line, &named, value), "{line}: {value}");
        let cell = format!("<data value=\"{value}\">");
        assert!(own_table.contains(&cell), "{name} {cell}");
        assert!(!other_table.contains(&cell), "{name} {cell}");
        let own = json.unwrap().iter().find(|p| p["name"] == name).unwrap();
        assert!((own["value"].as_f64().unwrap() / value - 1.0).abs() < 1e-12);
    }
}

#[test]
fn the_constrained_fit_is_on_the_bound_and_at_an_optimum_there() {
    // In displacement mode a hysteresis that lags its input has kappa_eta below zero.
    for (mode, sign) in [(Mode::Torque, 1.0), (Mode::Displacement, -1.0)] {
        let base = Base {
            kappa_eta: sign * STEEP.kappa_eta,
            ..STEEP
        };
        let recipe = Recipe {
            base: Some(base),
            ..recipe(mode, 12, &[])
        };
        let told = Told::new(&recipe, &["bouc-wen"]);
        assert!(!told.hand_over(false).feed_forward.invertible);
        let hand = told.hand_over(true);
        assert!(accepted(&hand.files[0]));
        let t = hand.files[0].transmission.unwrap();
        let slope = 2.0 * t.sigma * t.rho * t.kappa_eta.abs() / t.gain.abs();
        // The margin of the bound: seven roundings of f32 fit into it.
        assert!((slope - 1.0).abs() < 2e-6, "{mode:?}: {slope}");

        // No neighbour on the bound is better: sigma moved by a tenth, rho with it so that
        // the bound is kept, and the gains as they are.
        let sse = |s: f64| -> f64 {
            let solution = &hand.fitted.solution;
            let mut values = solution.values.clone();
            for (free, value) in solution.free.iter().zip(&mut values) {
                match free.role {
                    Role::Rho => *value /= s,
                    Role::Sigma => *value *= s,
                    _ => {}
                }
            }
            let (structure, free) = (&solution.structure, &solution.free);
            let raw = raw_columns(&told.done.data, structure, free, &values).unwrap();
            let mut prediction = vec![0.0; told.data.work_len()];
            for (column, gain) in raw.columns.iter().zip(&solution.gains) {
                let rows = prediction.iter_mut().enumerate();
                rows.for_each(|(i, sum)| *sum += gain * column[i]);
            }
            let prediction = told.data.filtered(&prediction);
            let error = |&i: &usize| (told.data.target[i] - prediction[i]).powi(2);
            told.done.data.split.fit.iter().map(error).sum()
        };
        let (here, there) = (sse(1.0), sse(1.1));
        assert!(here < there, "{mode:?}: {here} {there}");
    }
}

#[test]
fn a_rig_whose_own_model_has_an_inverse_is_handed_over_as_it_is() {
    let gentle = Base {
        sigma: 0.6,
        kappa_eta: 1.5,
        ..STEEP
    };
    let recipe = Recipe {
        base: Some(gentle),
        ..recipe(Mode::Torque, 3, &[])
    };
    let told = Told::new(&recipe, &["bouc-wen"]);
    let (free, within) = (told.hand_over(false), told.hand_over(true));
    assert!(free.feed_forward.invertible);
    assert_eq!(free.files[0].transmission, within.files[0].transmission);
    assert_eq!(within.nrmse, within.as_fitted);
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn no_stage_is_handed_over_as_invertible_and_its_loss_is_said() {
    let recipe = recipe(Mode::Displacement, 61, &[("lag", 3.0)]);
    let told = Told::new(&recipe, &["bouc-wen", "lag"]);
    let words = told.hand_over(false).feed_forward.words();
    assert!(
        words.starts_with("no, because lag acts on the whole output"),
        "{words}"
    );
    let within = told.hand_over(true);
    assert!(within.feed_forward.invertible && accepted(&within.files[0]));
    assert_eq!(within.left_out[0].effect, "lag");
    assert!(within.nrmse.held_out > within.as_fitted.held_out);
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn without_bouc_wen_there_is_nothing_to_invert_and_the_program_says_so() {
    let folder = Folder::new();
    let model = folder.path("model.toml");
    let asked = format!("identify --baseline viscous --invertible --model-out {model}");
    refuses(&asked, &["--invertible", "Bouc-Wen"]);
    assert!(folder.names().is_empty());
}
