//! The fit within what a compensator can invert.

use crate::hand_over::rig::{files, record, with, Told};
use crate::shell::{bowden, said, Folder};
use bowden::control::{Compensator, CompensatorInput, CompensatorState};
use bowden::effect::Motion;
use bowden::model::{ModelState, Sample};
use bowden_lab::export::ModelFile;
use bowden_lab::facts::percent;
use bowden_synth::{Base, Mode, Recipe};

/// The demo's command, as the README has it.
fn demo(more: &[&str]) -> (ModelFile, serde_json::Value) {
    let folder = Folder::new();
    let path = folder.path("model.toml");
    let mut arguments = vec!["identify", "--json", "--model-out", &path];
    arguments.extend(more);
    let json = serde_json::from_str(&said(&arguments)).unwrap();
    let file = toml::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
    (file, json)
}

fn accepted(file: &ModelFile) -> bool {
    let single = Compensator::try_new(&file.model_in::<f32, 8>().unwrap());
    let double = Compensator::try_new(&file.model_in::<f64, 8>().unwrap());
    assert_eq!(single.is_ok(), double.is_ok());
    single.is_ok()
}

#[test]
fn the_demo_model_drives_a_compensator_once_it_is_fitted_invertible() {
    let (free, json) = demo(&[]);
    assert!(!accepted(&free));
    let verdict = &json["final"]["feed_forward"];
    assert_eq!(verdict["invertible"], false);
    let because = verdict["reason"].as_str().unwrap();
    assert!(
        because.starts_with("sigma 2.97 > 0.543 = B/(2·kappa_eta·rho)"),
        "{because}"
    );

    let (file, json) = demo(&["--invertible"]);
    assert!(accepted(&file));
    assert_eq!(json["final"]["feed_forward"]["invertible"], true);
    assert!(json["final"]["feed_forward"]["reason"].is_null());
    // What was found and what it explains do not depend on what is handed over.
    assert_eq!(json["verdict"], "explained");
    assert_eq!(json["final"]["effects"][1], "viscous@phi_p");

    // Turned round and run forwards again it gives what was wanted.
    let model = file.model::<8>().unwrap();
    let compensator = Compensator::try_new(&model).unwrap();
    let mut inverse = CompensatorState::new();
    let mut forward = ModelState::new();
    for k in 0..2000 {
        let t = f64::from(k) * 1e-3;
        let desired = 6.0 * (4.0 * t).sin() + 2.0 * (17.0 * t).sin();
        let moving = Motion {
            velocity: (3.0 * t).cos(),
            ..Motion::default()
        };
        let channels = [moving, Motion::default()];
        let at = CompensatorInput {
            channels: &channels,
            ..CompensatorInput::new(1e-3, desired)
        };
        let command = compensator.step(&mut inverse, &at).command;
        let input = Motion {
            position: command,
            ..Motion::default()
        };
        let sample = Sample {
            dt: 1e-3,
            input,
            load: command,
            channels: &channels,
        };
        let output = model.step(&mut forward, &sample);
        // The inverse solves to 16 machine epsilons of the magnitudes, here of 30 N·m.
        assert!((output - desired).abs() < 1e-11, "{output} {desired}");
    }
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn what_it_costs_is_said_and_a_new_fit_costs_less_than_a_lower_sigma() {
    let (_, free) = demo(&[]);
    let (_, within) = demo(&["--invertible"]);
    let nearest = &free["final"]["feed_forward"]["nearest"]["nrmse"];
    let fitted = &within["final"]["exported_model"]["nrmse"];
    for segment in ["fit", "held_out"] {
        let number = |v: &serde_json::Value| v[segment].as_f64().unwrap();
        let best = number(&free["final"]["nrmse"]);
        assert!(number(fitted) > best, "{segment}");
        assert!(
            number(fitted) < 0.9 * number(nearest),
            "{segment}: {fitted} {nearest}"
        );
    }
    let ledger = said(&["identify", "--invertible"]);
    assert!(ledger.contains("feed-forward: yes"), "{ledger}");
    assert!(
        ledger.contains("compared with 0.14 % for the unconstrained model"),
        "{ledger}"
    );
    let ledger = said(&["identify"]);
    assert!(
        ledger.contains("feed-forward: no, because sigma"),
        "{ledger}"
    );
    assert!(ledger.contains("--invertible"), "{ledger}");
}

/// Whether the number that follows a name on a line is this one, to its last digit.
fn is_printed(line: &str, name: &str, value: f64) -> bool {
    let (_, rest) = line.split_once(&format!("{name} ")).unwrap();
    let number = rest.split([' ', ',', '\n']).next().unwrap();
    let decimals = number.split_once('.').map_or(0, |(_, d)| d.len());
    let half = 0.5001 * 0.1_f64.powi(decimals as i32);
    (number.parse::<f64>().unwrap() - value).abs() <= half
}

/// The page has both models, the exported one first.
fn assert_page(page: &str, errors: [f64; 2], all: &[(&str, f64)]) {
    let (_, numbers) = page.split_once("<dl class=\"numbers\">").unwrap();
    let (numbers, _) = numbers.split_once("</dl>").unwrap();
    let shown: Vec<&str> = errors
        .map(|share| format!(">{}</data>", percent(share)))
        .iter()
        .map(|cell| &numbers[numbers.find(cell.as_str()).unwrap()..])
        .collect();
    assert!(shown[0].len() > shown[1].len(), "{numbers}");
    assert!(page.contains(">unconstrained model: explained<"));
    let (_, own_table) = page.split_once("Parameters of the exported model").unwrap();
    let (own_table, other_table) = own_table
        .split_once("Parameters of the unconstrained model")
        .unwrap();
    for (name, value) in all {
        let cell = format!("<data value=\"{value}\">");
        assert!(own_table.contains(&cell), "{name} {cell}");
        assert!(!other_table.contains(&cell), "{name} {cell}");
    }
}

/// "explained … 0.14 %" would be said of another model than the one in the file.
#[test]
fn headline_parameters_summary_and_page_are_those_of_the_file() {
    let folder = Folder::new();
    let path = |name: &str| folder.path(name);
    let (model, page) = (path("model.toml"), path("page.html"));
    let asked = [
        "identify",
        "--invertible",
        "--model-out",
        &model,
        "--report",
        &page,
    ];
    let report = said(&asked);
    let file: ModelFile = toml::from_str(&std::fs::read_to_string(&model).unwrap()).unwrap();
    let about = file.about.as_ref().unwrap();
    let (own, other) = (about.nrmse.held_out, about.nrmse.held_out_as_fitted);
    assert!(own > 10.0 * other, "{own} {other}");

    let (headline, rest) = report.split_once("\nData").unwrap();
    let error = format!(
        "held-out error of {} of the output's standard deviation, compared with {}",
        percent(own),
        percent(other)
    );
    assert!(headline.contains(&error), "{error}: {headline}");
    let (_, rest) = rest.split_once("\nModel").unwrap();
    let (parameters, _) = rest.split_once("\nUse it").unwrap();
    let t = file.transmission.as_ref().unwrap();
    let viscous = ("viscous@phi_p", file.terms[0].gain);
    let all = [
        ("B", t.gain),
        ("kappa_eta", t.kappa_eta),
        ("T0", t.offset),
        ("rho", t.rho),
        ("sigma", t.sigma),
        ("n", t.n),
        viscous,
    ];
    let of_numbers = |line: &&str| !line.contains(" = ") && !line.contains("is fixed");
    let lines: Vec<&str> = parameters.lines().filter(of_numbers).collect();
    for (name, value) in all {
        let name = format!(" {name}");
        let mut named = lines
            .iter()
            .filter(|line| line.contains(&format!("{name} ")));
        let line = named.next().unwrap();
        assert!(is_printed(line, &name, value), "{line}: {value}");
    }
    let line = headline
        .lines()
        .find(|l| l.contains("in the exported model"));
    assert!(
        is_printed(line.unwrap(), viscous.0, viscous.1),
        "{headline}"
    );

    let page = std::fs::read_to_string(&page).unwrap();
    assert_page(&page, [own, other], &all);
    // What is said to programs is what is said to people.
    let asked = ["identify", "--invertible", "--json"];
    let json: serde_json::Value = serde_json::from_str(&said(&asked)).unwrap();
    assert!(headline.contains(json["summary"].as_str().unwrap()));
    let exported = &json["final"]["exported_model"];
    let parameters = exported["parameters"].as_array().unwrap();
    for (name, value) in all {
        let own = parameters.iter().find(|p| p["name"] == name).unwrap();
        assert!((own["value"].as_f64().unwrap() / value - 1.0).abs() < 1e-12);
    }
}

/// Rig with a steep loop: 2·sigma·rho·kappa_eta is 3.4 times its gain.
const STEEP: Base = Base {
    gain: 0.95,
    kappa_eta: 4.0,
    offset: 0.05,
    rho: 0.3,
    sigma: 1.35,
    n: 1.6,
};

fn steep(mode: Mode) -> Recipe {
    // In displacement mode a hysteresis that lags its input has kappa_eta below zero.
    let kappa_eta = match mode {
        Mode::Torque => STEEP.kappa_eta,
        Mode::Displacement => -STEEP.kappa_eta,
    };
    Recipe {
        seed: 12,
        base: Some(Base { kappa_eta, ..STEEP }),
        ..Recipe::new(mode)
    }
}

#[test]
fn the_constrained_fit_is_on_the_bound_and_at_an_optimum_there() {
    for mode in [Mode::Torque, Mode::Displacement] {
        let told = Told::new(record(&steep(mode)), &["bouc-wen"], None);
        assert!(!told.hand_over(false).feed_forward.invertible);
        let hand = told.hand_over(true);
        assert!(accepted(&hand.files[0]));
        let t = hand.files[0].transmission.unwrap();
        let slope = 2.0 * t.sigma * t.rho * t.kappa_eta.abs();
        // The margin of the bound: seven roundings of f32 fit into it.
        assert!(
            (slope / t.gain.abs() - 1.0).abs() < 2e-6,
            "{mode:?}: {slope} {}",
            t.gain
        );

        // No neighbour on the bound is better: sigma moved by a tenth, rho with it so that
        // the bound is kept, and the gains as they are.
        let sse = |s: f64| {
            let solution = &hand.fitted.solution;
            let mut values = solution.values.clone();
            for (free, value) in solution.free.iter().zip(&mut values) {
                match free.role {
                    bowden_lab::model::structure::Role::Rho => *value /= s,
                    bowden_lab::model::structure::Role::Sigma => *value *= s,
                    _ => {}
                }
            }
            let structure = &solution.structure;
            let raw = bowden_lab::model::columns::raw_columns(
                &told.done.data,
                structure,
                &solution.free,
                &values,
            );
            let raw = raw.unwrap();
            let prediction: Vec<f64> = (0..told.data.work_len())
                .map(|i| {
                    raw.columns
                        .iter()
                        .zip(&solution.gains)
                        .map(|(c, g)| g * c[i])
                        .sum()
                })
                .collect();
            let prediction = told.data.filtered(&prediction);
            let rows = &told.done.data.split.fit;
            rows.iter()
                .map(|&i| (told.data.target[i] - prediction[i]).powi(2))
                .sum::<f64>()
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
        seed: 3,
        base: Some(gentle),
        ..Recipe::new(Mode::Torque)
    };
    let told = Told::new(record(&recipe), &["bouc-wen"], None);
    let (free, within) = (told.hand_over(false), told.hand_over(true));
    assert!(free.feed_forward.invertible);
    assert_eq!(free.files[0].transmission, within.files[0].transmission);
    assert_eq!(within.nrmse, within.as_fitted);
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn no_stage_is_handed_over_as_invertible_and_its_loss_is_said() {
    let recipe = Recipe {
        seed: 61,
        ..Recipe::new(Mode::Displacement)
    };
    let told = Told::new(record(&with(recipe, &["lag"])), &["bouc-wen", "lag"], None);
    let free = told.hand_over(false);
    let words = free.feed_forward.words();
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
    let path = folder.path("model.toml");
    let arguments = [
        "identify",
        "--baseline",
        "viscous",
        "--invertible",
        "--model-out",
        &path,
    ];
    let output = bowden(&arguments);
    assert_eq!(output.status.code(), Some(2));
    let line = String::from_utf8(output.stderr).unwrap();
    assert!(
        line.contains("--invertible") && line.contains("bouc-wen"),
        "{line}"
    );
    assert_eq!(line.trim_end().lines().count(), 1);
    assert!(files(folder.root()).is_empty());
}
