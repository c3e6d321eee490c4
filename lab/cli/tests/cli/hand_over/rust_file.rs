//! `model.rs`: what a firmware engineer opens.
// Numbers near constants are what the lints of a firmware's build must not stumble over.
#![allow(clippy::approx_constant)]

use crate::compiler::{compiled_and_run, module};
use crate::hand_over::{recipe, Told};
use crate::sentences::files::Rows;
use crate::shell::{has, json, refuses, said, Folder};
use bowden::effect::{Effect, Motion, Range, Viscous, CATALOGUE};
use bowden_lab::export::{About, ModelFile, ShapeFile, Span, TermFile, TransmissionFile};
use bowden_synth::Mode;

/// A model of one effect, with all that can stand in its file.
fn of_effect(effect: &Effect<f64>, transmission: bool) -> ModelFile {
    let shape = |(index, info): (usize, &bowden::effect::ShapeInfo)| ShapeFile {
        name: info.name.to_owned(),
        value: effect.shape(index).unwrap(),
    };
    let span = Span {
        position: [-1.5, 1.5],
        velocity: [-3.0, 3.0],
        acceleration: [-20.0, 20.0],
    };
    let about = About {
        rates_time_constant_s: 0.01,
        ranges: ["input", "phi_p"]
            .map(|name| (name.to_owned(), span))
            .into(),
        ..About::default()
    };
    ModelFile {
        schema: "bowden.model/1".to_owned(),
        mode: "torque".to_owned(),
        channels: vec!["phi_p".to_owned()],
        transmission: transmission.then_some(TransmissionFile {
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
            shapes: effect.info().shapes.iter().enumerate().map(shape).collect(),
        }],
        about: Some(about),
    }
}

/// The effect of that name; its shapes have four digits each.
fn effect(name: &str) -> Effect<f64> {
    let mut tried = (0..3).map(|n| Effect::try_from_name(name, &vec![0.3183; n]));
    let effect = tried.find_map(Result::ok).unwrap();
    let mut ranges = effect.info().shapes.iter().map(|s| s.range);
    assert!(ranges.all(|r| matches!(r, Range::Finite | Range::Positive)));
    effect
}

#[test]
fn model_rs_compiles_without_warnings_for_every_effect_and_is_that_model() {
    let mut files: Vec<ModelFile> = CATALOGUE
        .iter()
        .enumerate()
        // With and without a transmission: the imports differ.
        .map(|(index, info)| of_effect(&effect(info.name), index % 2 == 0))
        .collect();
    assert_eq!(files.len(), 50);
    let mut none = of_effect(&Viscous.into(), true);
    none.terms.clear();
    files.push(none.clone());
    none.about = None;
    files.push(none);
    // One term more than a fixed model holds is a model of any effect.
    for terms in [16, 17] {
        let mut file = of_effect(&Viscous.into(), true);
        let coulomb = of_effect(&effect("coulomb"), true).terms[0].clone();
        file.terms.extend(vec![coulomb; terms - 1]);
        files.push(file);
    }
    let (mut program, mut calls) = (String::from("#![deny(warnings)]\n"), String::new());
    let mut expected = String::new();
    for (index, file) in files.iter().enumerate() {
        let text = file.rust().unwrap();
        let is_fixed = (1..=16).contains(&file.terms.len());
        assert_eq!(text.contains("FixedModel"), is_fixed, "{text}");
        assert!(!is_fixed || !text.contains("try_from_name"), "{text}");
        program += &module(&format!("model_{index}"), &text);
        let (printed, model) = match file.terms.len() {
            0 => ("m", format!("{:?}", file.model_in::<f32, 0>().unwrap())),
            1 => ("m", format!("{:?}", file.model_in::<f32, 1>().unwrap())),
            _ => {
                let model = file.model_in::<f32, 17>().unwrap();
                ("m.terms()", format!("{:?}", model.terms()))
            }
        };
        calls += &format!("let m = model_{index}::model().unwrap();\n");
        calls += &format!("println!(\"{{:?}}\", {printed});\n");
        expected += &format!("{model}\n");
    }
    program += &format!("fn main() {{\n{calls}}}\n");
    let folder = Folder::new();
    assert_eq!(compiled_and_run(&program, folder.root()), expected);
}

#[test]
fn the_written_model_with_its_rates_and_ranges_makes_a_feed_forward() {
    let folder = Folder::new();
    let path = folder.path("model.rs");
    said(&format!("identify --invertible --model-out {path}"));
    let program = module("model", &folder.read("model.rs"))
        + r#"
use bowden::control::{Compensator, CompensatorInput, CompensatorState};
use bowden::signal::{Rates, RatesState};

fn main() -> Result<(), bowden::Error> {
    let compensator = Compensator::try_new(&model::model()?)?.with_ranges(&model::ranges())?;
    let rates = Rates::try_new(model::RATES_TIME_CONSTANT)?;
    let (mut past, mut state) = (RatesState::new(), CompensatorState::new());
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
    let recipe = "--mode torque --effect coulomb:20 --seed 4";
    let csv = folder.record("bench.csv", recipe);
    let asked = format!("identify {csv} --baseline bouc-wen,coulomb@phi_p");
    for name in ["model.toml", "model.rs"] {
        said(&format!("{asked} --model-out {}", folder.path(name)));
        let text = folder.read(name);
        assert!(!text.contains(&folder.path("")), "{text}");
        has(&text, &["bench.csv"]);
    }
    let text = folder.read("model.rs");
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
        has(&text, &[words]);
    }
    // What the record does not show is named, as in the report.
    let json = json(&format!("{asked} --json"));
    for parameter in json["final"]["parameters"].as_array().unwrap() {
        let name = parameter["name"].as_str().unwrap();
        let refused = parameter["identified"] == false && !name.starts_with("eta0");
        let words = format!("Not identified: {name} (");
        assert_eq!(text.contains(&words), refused, "{name}");
    }
}

#[test]
fn the_ranges_are_those_that_the_fit_has_seen() {
    let told = Told::new(
        &recipe(Mode::Torque, 4, &[]),
        &["bouc-wen", "viscous@phi_d"],
    );
    let about = told.hand_over(false).files[0].about.clone().unwrap();
    let names: Vec<&str> = about.ranges.keys().map(String::as_str).collect();
    // phi_p is read by no term: `with_ranges` would refuse it.
    assert_eq!(names, ["input", "phi_d"]);
    let data = &told.data;
    let phi_d = data.channels.iter().find(|c| c.name == "phi_d").unwrap();
    let (first, last) = (data.split.fit[0], *data.split.selection.last().unwrap());
    let seen = &phi_d.motion[first * data.stride..(last + 1) * data.stride];
    let ends = |motion: &[Motion<f64>]| {
        let of = |of: fn(&Motion<f64>) -> f64| {
            let values = || motion.iter().map(of);
            [
                values().fold(f64::INFINITY, f64::min),
                values().fold(f64::NEG_INFINITY, f64::max),
            ]
        };
        [
            of(|m| m.position),
            of(|m| m.velocity),
            of(|m| m.acceleration),
        ]
    };
    let told = &about.ranges["phi_d"];
    let told = [told.position, told.velocity, told.acceleration];
    assert_eq!(told, ends(seen));
    // The rest of the record goes further: ranges over all of it would be others.
    assert_ne!(told, ends(&phi_d.motion));
}

/// A spring across the sum of two angles, on three tones: whoever runs the model has to know how to
/// compute the sum.
#[test]
fn a_channel_that_is_a_sum_is_defined_in_every_file_that_is_handed_over() {
    let row = |k: i32| {
        let t = 1e-3 * f64::from(k);
        let (proximal, slip) = (
            (3.1 * t).sin(),
            0.2 * (1.3 * t).sin() + 0.1 * (7.7 * t).sin(),
        );
        let input = 4.0 * (5.3 * t).sin();
        let output = 0.8 * input + 6.0 * slip + 0.01 * (f64::from(k) * 12.9898).sin();
        vec![t, input, output, proximal, slip - proximal]
    };
    let header = "t [s],tau_i [N*m],tau_o [N*m],proximal [rad],distal [rad]";
    let folder = Folder::new();
    let record = Rows::new(header, (0..12_000).map(row)).write(&folder, "rig.csv");
    let stretch = "--channel stretch=proximal+distal";
    let baseline = "--max-terms 0 --baseline gain,stiffness-linear@stretch";
    for name in ["rig.toml", "rig.rs"] {
        let out = folder.path(name);
        said(&format!(
            "identify {record} {baseline} --model-out {out} {stretch}"
        ));
    }
    let defined = "[about.definitions]\nstretch = \"proximal + distal\"\n";
    has(&folder.read("rig.toml"), &[defined]);
    let listed = "`Sample::channels`: 0 stretch = proximal + distal [rad].";
    has(&folder.read("rig.rs"), &[listed]);
    let model = folder.path("rig.toml");
    let listed = "#define RIG_CHANNEL_STRETCH 0 /* stretch = proximal + distal [rad] */";
    has(&said(&format!("export --c {model}")), &[listed]);
    // A record without the channel is told how to get it.
    let validate = format!("validate {model} {record}");
    refuses(
        &validate,
        &[
            "channel `stretch` (fitted as proximal + distal), but the record has no such channel; ",
            "pass its column with --channel stretch=COL",
        ],
    );
    said(&format!("{validate} {stretch}"));
}
