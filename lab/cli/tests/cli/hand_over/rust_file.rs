//! `model.rs`: what a firmware engineer opens.
// Numbers near constants are what the lints of a firmware's build must not stumble over.
#![allow(clippy::approx_constant)]

use crate::compiler::{compiled_and_run, module};
use crate::shell::{args, said, Folder};
use bowden::effect::{Effect, Range, Viscous, CATALOGUE};
use bowden_lab::export::{About, ModelFile, ShapeFile, Span, TermFile};

/// A model of one effect, with all that can stand in its file.
fn of_effect(effect: &Effect<f64>, transmission: bool) -> ModelFile {
    let shapes = effect.info().shapes.iter().enumerate();
    let shapes: Vec<ShapeFile> = shapes
        .map(|(index, info)| ShapeFile {
            name: info.name.to_owned(),
            value: effect.shape(index).unwrap(),
        })
        .collect();
    let span = Span {
        position: [-1.5, 1.5],
        velocity: [-3.0, 3.0],
        acceleration: [-20.0, 20.0],
    };
    let about = About {
        rates_time_constant_s: 0.01,
        ranges: [("input".to_owned(), span), ("phi_p".to_owned(), span)].into(),
        ..About::default()
    };
    ModelFile {
        schema: "bowden.model/1".to_owned(),
        mode: "torque".to_owned(),
        channels: vec!["phi_p".to_owned()],
        transmission: transmission.then_some(bowden_lab::export::TransmissionFile {
            gain: 0.95,
            kappa_eta: 2.29,
            offset: 0.05,
            rho: 0.1,
            sigma: 0.6,
            n: 1.5,
        }),
        terms: vec![TermFile {
            effect: effect.name().to_owned(),
            source: "phi_p".to_owned(),
            origin: 0.0,
            // Near pi: no lint may take it for that.
            gain: 3.1415,
            shapes,
        }],
        about: Some(about),
    }
}

/// All effects of the catalogue; their shapes have four digits each.
fn all() -> Vec<Effect<f64>> {
    let effect = |name: &str| {
        let tried = (0..3).find_map(|n| Effect::try_from_name(name, &vec![0.3183; n]).ok());
        let effect: Effect<f64> = tried.unwrap();
        let ranges = effect.info().shapes.iter().map(|s| s.range);
        assert!(ranges
            .into_iter()
            .all(|r| matches!(r, Range::Finite | Range::Positive)));
        effect
    };
    CATALOGUE.iter().map(|info| effect(info.name)).collect()
}

#[test]
fn model_rs_compiles_without_warnings_for_every_effect_and_is_that_model() {
    let effects = all();
    assert_eq!(effects.len(), 50);
    let mut program = String::from("#![deny(warnings)]\n");
    let mut calls = String::new();
    let mut expected = String::new();
    for (index, effect) in effects.iter().enumerate() {
        // With and without a transmission: the imports differ.
        let file = of_effect(effect, index % 2 == 0);
        let text = file.rust().unwrap();
        assert!(!text.contains("try_from_name"), "{text}");
        program += &module(&format!("model_{index}"), &text);
        calls += &format!("    println!(\"{{:?}}\", model_{index}::model().unwrap());\n");
        expected += &format!("{:?}\n", file.model_in::<f32, 1>().unwrap());
    }
    program += &format!("fn main() {{\n{calls}}}\n");
    let folder = Folder::new();
    assert_eq!(compiled_and_run(&program, folder.root()), expected);
}

#[test]
fn a_model_of_more_terms_than_a_fixed_one_holds_is_written_as_one_of_any_effect() {
    let most = 16;
    for terms in [most, most + 1] {
        let mut file = of_effect(&Viscous.into(), true);
        let coulomb = of_effect(&Effect::try_from_name("coulomb", &[0.3]).unwrap(), true);
        file.terms.extend(vec![coulomb.terms[0].clone(); terms - 1]);
        let text = file.rust().unwrap();
        assert_eq!(text.contains("FixedModel"), terms == most);
        let program = module("a", &text)
            + "fn main() { println!(\"{:?}\", a::model().map(|m| m.terms().to_vec())); }";
        let folder = Folder::new();
        let model = file.model_in::<f32, 17>().unwrap();
        assert_eq!(model.terms().len(), terms);
        let expected = format!("Ok({:?})\n", model.terms());
        assert_eq!(compiled_and_run(&program, folder.root()), expected);
    }
}

#[test]
fn a_model_of_nothing_but_a_transmission_compiles_too() {
    let mut file = of_effect(&Viscous.into(), true);
    file.terms.clear();
    let with_ranges = file.rust().unwrap();
    file.about = None;
    let plain = file.rust().unwrap();
    let program = module("a", &with_ranges)
        + &module("b", &plain)
        + "fn main() { assert_eq!(a::model(), b::model()); println!(\"{:?}\", b::model()); }";
    let folder = Folder::new();
    let expected = format!("Ok({:?})\n", file.model_in::<f32, 0>().unwrap());
    assert_eq!(compiled_and_run(&program, folder.root()), expected);
}

#[test]
fn the_written_model_with_its_rates_and_ranges_makes_a_feed_forward() {
    let folder = Folder::new();
    let path = folder.root().join("model.rs");
    said(&[
        "identify",
        "--invertible",
        "--model-out",
        &path.display().to_string(),
    ]);
    let text = std::fs::read_to_string(&path).unwrap();
    let program = module("model", &text)
        + r#"
use bowden::control::{Compensator, CompensatorInput, CompensatorState};
use bowden::signal::{Rates, RatesState};

fn main() -> Result<(), bowden::Error> {
    let compensator = Compensator::try_new(&model::model()?)?.with_ranges(&model::ranges())?;
    let rates = Rates::try_new(model::RATES_TIME_CONSTANT)?;
    let mut past = RatesState::new();
    let mut state = CompensatorState::new();
    let mut command = 0.0;
    for k in 0..1000 {
        let phi_p = rates.step(&mut past, 0.001 * k as f32, 0.001).motion;
        let at = CompensatorInput {
            channels: &[phi_p],
            ..CompensatorInput::new(0.001, 5.0)
        };
        command = compensator.step(&mut state, &at).command;
    }
    println!("{}", (5.0..12.0).contains(&command));
    Ok(())
}
"#;
    assert_eq!(compiled_and_run(&program, folder.root()), "true\n");
}

#[test]
fn model_rs_says_what_its_numbers_mean_and_holds_no_path() {
    let folder = Folder::new();
    let path = |name: &str| folder.path(name);
    let csv = path("bench.csv");
    said(&args(&format!(
        "generate --mode torque --effect coulomb:20 --seed 4 --out {csv}"
    )));
    for name in ["model.rs", "model.toml"] {
        said(&[
            "identify",
            &csv,
            "--baseline",
            "bouc-wen,coulomb@phi_p",
            "--model-out",
            &path(name),
        ]);
        let text = std::fs::read_to_string(path(name)).unwrap();
        let place = folder.root().display().to_string();
        assert!(!text.contains(&place), "{text}");
        assert!(text.contains("bench.csv"), "{text}");
    }
    let text = std::fs::read_to_string(path("model.rs")).unwrap();
    for words in [
        "Input [N·m], output [N·m], torque mode.",
        "Channels, in the order of `Sample::channels`: 0 phi_p [rad], 1 phi_d [rad].",
        "Fitted to a record sampled at ",
        " Hz and low-pass filtered at ",
        "Error as a share of the output's standard deviation: fit ",
        "Held-out error sample by sample",
        "Feed-forward: ",
        "rho [1/(N·m)]",
        "B [1], kappa_eta [N·m], T0 [N·m]",
        "coulomb@phi_p: tanh(v/v_e); v_e [rad/s]",
        "pub fn fixed_model() -> Result<FixedModel<f32, 1, Terms>, bowden::Error> {",
        "effect: Coulomb::try_new(",
        "// [N·m]",
        "phi_p: position [rad], velocity [rad/s], acceleration [rad/s²]",
        "RATES_TIME_CONSTANT: f32 = ",
    ] {
        assert!(text.contains(words), "{words} is not in\n{text}");
    }
    // What the record does not show is named, as in the report.
    let json: serde_json::Value = serde_json::from_str(&said(&[
        "identify",
        &csv,
        "--baseline",
        "bouc-wen,coulomb@phi_p",
        "--json",
    ]))
    .unwrap();
    let parameters = json["final"]["parameters"].as_array().unwrap();
    for parameter in parameters {
        let name = parameter["name"].as_str().unwrap();
        let refused = parameter["identified"] == false && !name.starts_with("eta0");
        assert_eq!(
            text.contains(&format!("Not identified: {name} (")),
            refused,
            "{name}"
        );
    }
}

#[test]
fn the_ranges_are_those_that_the_fit_has_seen() {
    use crate::hand_over::rig::{record, Told};
    use bowden::effect::Motion;
    use bowden_synth::{Mode, Recipe};
    let recipe = Recipe {
        seed: 4,
        ..Recipe::new(Mode::Torque)
    };
    let told = Told::new(record(&recipe), &["bouc-wen", "viscous@phi_d"], None);
    let about = told.hand_over(false).files[0].about.clone().unwrap();
    let names: Vec<&str> = about.ranges.keys().map(String::as_str).collect();
    // phi_p is read by no term: `with_ranges` would refuse it.
    assert_eq!(names, ["input", "phi_d"]);
    let phi_d = told
        .data
        .channels
        .iter()
        .find(|c| c.name == "phi_d")
        .unwrap();
    let (first, last) = (
        told.data.split.fit[0],
        told.data.split.selection[told.data.split.selection.len() - 1],
    );
    let stride = told.data.stride;
    let seen = &phi_d.motion[first * stride..(last + 1) * stride];
    let ends = |motion: &[Motion<f64>], of: fn(&Motion<f64>) -> f64| {
        let values = || motion.iter().map(of);
        [
            values().fold(f64::INFINITY, f64::min),
            values().fold(f64::NEG_INFINITY, f64::max),
        ]
    };
    let told = &about.ranges["phi_d"];
    assert_eq!(told.position, ends(seen, |m| m.position));
    assert_eq!(told.velocity, ends(seen, |m| m.velocity));
    assert_eq!(told.acceleration, ends(seen, |m| m.acceleration));
    // The rest of the record goes further: ranges over all of it would be others.
    let whole = &phi_d.motion;
    assert!(
        ends(whole, |m| m.position) != told.position
            || ends(whole, |m| m.velocity) != told.velocity
            || ends(whole, |m| m.acceleration) != told.acceleration
    );
}
