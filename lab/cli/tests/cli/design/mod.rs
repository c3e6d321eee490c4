//! `bowden design`: from a record to gains, to the rig of one's own model, to firmware.

mod certified;
mod short;

use crate::compare::row;
use crate::compiler::{compiled_and_run, module};
use crate::shell::{has, json, refuses, refuses_all, said, straight, Folder};
use serde_json::Value;

/// A design for a rate and a delay.
fn design(model: &str, rate: &str, delay: &str, more: &str) -> String {
    said(&format!(
        "design {model} --rate {rate} --delay {delay} {more}"
    ))
}

/// The straight cable's model, and gains for a drive of 1 N·m per command unit, which is its default.
fn designed(place: &Folder) -> (String, String) {
    let (model, gains) = (straight(place), place.path("gains.toml"));
    design(&model, "500", "0.006", &format!("--out {gains}"));
    (model, gains)
}

/// A light joint against the same spring: it answers within some six milliseconds.
const LIGHT: &str = "--inertia 0.002 --damping 0.5";

fn compared(model: &str, gains: &str, more: &str) -> Value {
    let files = format!("--model {model} --gains {gains}");
    json(&format!("compare {files} --seeds 1 --json {LIGHT} {more}"))
}

fn error(report: &Value, controller: &str) -> f64 {
    let row = row(report, controller);
    assert_eq!(row["diverged"], 0, "{row}");
    assert!(row["ran_away_at"].is_null(), "{row}");
    row["rmse_true"]["mean"].as_f64().unwrap()
}

#[test]
fn from_a_record_over_its_model_to_gains_that_settle_on_the_rig_of_that_model() {
    let place = Folder::new();
    let (model, gains) = (straight(&place), place.path("gains.toml"));
    let more = format!("--drive-gain 0.6 --noise 0.02 --out {gains} --json");
    let report: Value = serde_json::from_str(&design(&model, "1000", "0.006", &more)).unwrap();
    assert_eq!(report["schema"], "bowden.design/1");
    assert_eq!(report["designed_for"]["rate"], 1000.0);
    assert_eq!(report["delay_samples"], 7);
    assert!(report["pi"]["margins"]["gain"].as_f64().unwrap() >= 2.0);
    assert!(report["pi"]["margins"]["phase"].as_f64().unwrap() >= 45.0);

    // Twenty milliseconds for either: the law steps on one sample in seven.
    let mut told: toml::Table = place.read("gains.toml").parse().unwrap();
    let after = |law: &str| told[law]["fallback"]["after"].as_integer();
    assert_eq!((after("pi"), after("adaptive")), (Some(20), Some(3)));

    let own = compared(&model, &gains, "--seconds 14");
    let conditions = &own["conditions"];
    // That of the design, which is not given again.
    assert_eq!(conditions["noise"], 0.02);
    assert_eq!(conditions["model"], "model.toml");
    assert_eq!(conditions["gains"], "gains.toml");
    assert_eq!(conditions["rig"]["motor_inertia"], 0.002);
    let [low, high] = [0, 1].map(|k| conditions["reference"][k].as_f64().unwrap());
    // The reference stays within the outputs that the record has reached.
    let reached = &report["bounds"]["output"];
    assert!(reached[0].as_f64().unwrap() < low && high < reached[1].as_f64().unwrap());
    let names = own["rows"].as_array().unwrap().iter();
    let names: Vec<&str> = names.map(|r| r["controller"].as_str().unwrap()).collect();
    assert_eq!(names, ["pi", "adaptive", "pi-feed-forward"]);
    for name in names {
        // Settled: a fifth of the reference's amplitude at most.
        assert!(error(&own, name) < 0.1 * (high - low), "{name}");
    }

    let pi = told["pi"].as_table_mut().unwrap();
    for key in ["k_p", "k_i"] {
        let value = pi[key].as_float().unwrap();
        pi.insert(key.to_owned(), (0.1 * value).into());
    }
    let weak = place.file("weak.toml", toml::to_string(&told).unwrap());
    let weak = error(&compared(&model, &weak, "--seconds 14"), "pi");
    let designed = error(&own, "pi");
    assert!(designed < 0.5 * weak, "{designed} {weak}");
}

#[test]
fn gains_rs_compiles_without_warnings_and_is_the_gains() {
    let place = Folder::new();
    let model = straight(&place);
    let (mut program, mut calls) = (String::from("#![deny(warnings)]\n"), String::new());
    let mut expected = String::new();
    // One sample of delay, and several with the law on every so-many-th.
    for (name, delay, words) in [
        ("one", "0", "once per sample"),
        ("several", "0.0047", "one sample in 5"),
    ] {
        for out in ["gains.rs", "gains.toml"] {
            let more = format!("--noise 0.013 --out {}", place.path(out));
            design(&model, "1000", delay, &more);
        }
        let written = place.read("gains.rs");
        has(&written, &[words]);
        assert!(!written.contains(&place.path("")), "{written}");
        program += &module(name, &written);
        for law in ["PI", "ADAPTIVE"] {
            calls += &format!("println!(\"{{:?}}\", {name}::{law}.settings());\n");
        }
        // The same numbers as a firmware with serde reads from the TOML, to the bit.
        let table: toml::Table = place.read("gains.toml").parse().unwrap();
        let pi: bowden::control::PidSettings<f32> = table["pi"].clone().try_into().unwrap();
        let law: bowden::control::AdaptiveSettings<f32, 0> =
            table["adaptive"].clone().try_into().unwrap();
        expected += &format!("{pi:?}\n{law:?}\n");
    }
    program += &format!("fn main() {{ assert_eq!(one::RATE, 1000.0);\n{calls} }}\n");
    assert_eq!(compiled_and_run(&program, place.root()), expected);
}

/// What is wrong in a model and in the options is tested where designs are made, in
/// `lab/trials/tests/design/file.rs`.
#[test]
fn bad_use_is_one_line_and_nothing_is_written() {
    let place = Folder::new();
    let schema = "schema = \"bowden.model/1\"\nmode = \"torque\"\ncolour = 1\n";
    place.file("m.toml", schema);
    // What cannot be written is told before the model is looked at.
    refuses_all(
        &place,
        "design m.toml --out gains.toml --rate 1000 --delay 0.001 => m.toml:3:1: `colour`
        design m.toml --out gains.toml --rate -5 --delay 0.001 => --rate -5
        design m.toml --out gains.csv --rate 1000 --delay 0.001 => --out | .toml or .rs
        design m.toml --out no/gains.toml --rate 1000 --delay 0.001 => --out | no/gains.toml
        design m.toml --out m.toml --rate 1000 --delay 0.001 => --out | would overwrite",
    );
    assert_eq!(place.names(), ["m.toml"]);
    assert_eq!(place.read("m.toml"), schema);
}

#[test]
fn gains_and_rigs_that_make_no_sense_are_one_line() {
    let place = Folder::new();
    designed(&place);
    let gains = place.read("gains.toml");
    place.file("broken.toml", gains.replace("k_p = ", "kp = "));
    let model = place.read("model.toml");
    let oil = model.replace("source = \"phi_p\"", "source = \"oil\"");
    place.file("oil.toml", oil.replace("\"phi_p\", ", "\"oil\", "));
    // A file of gains and rig has no model of its own.
    place.file("setup.toml", "[rig]\nnoise = 0.02\n");
    let both = "compare --model model.toml --gains gains.toml";
    refuses_all(
        &place,
        &format!(
            "compare --model model.toml --gains broken.toml => broken.toml:13:1: `kp`
            compare --model model.toml --gains model.toml => is a model
            {both} --inertia -1 => --inertia -1 is out of range
            {both} --spring nan => --spring NaN is out of range
            {both} --drive-gain 0 => --drive-gain 0 is out of range
            {both} --delay 9 => delay
            {both} --effect viscous => --effect
            compare --model oil.toml --spring 160 => oil.toml: the term viscous@oil
            compare --gains gains.toml => gains.toml: gains from `bowden design` need their model | --model MODEL.toml
            compare --model setup.toml --gains gains.toml => setup.toml: with --gains, pass a model written by `bowden identify
            certify --gains model.toml => model.toml: this file is a model | `bowden design MODEL.toml
            certify --gains gains.toml => certify this file with `bowden certify FILE`"
        ),
    );
}

#[test]
fn the_rig_has_the_drive_gain_that_the_gains_were_designed_for() {
    let place = Folder::new();
    let (model, gains) = designed(&place);
    let own = compared(&model, &gains, "--seconds 8");
    let same = compared(&model, &gains, "--seconds 8 --drive-gain 1");
    assert_eq!(own["conditions"]["drive_gain"], 1.0);
    assert_eq!(own["rows"], same["rows"]);
    let table = format!("compare --model {model} --gains {gains} --seeds 1 --seconds 8 {LIGHT}");
    for (more, words) in [
        ("", "1 N·m/unit, as in the design of the gains."),
        (
            "--drive-gain 0.6",
            "0.6 N·m/unit, but the gains were designed for 1 N·m/unit.",
        ),
    ] {
        has(
            &said(&format!("{table} {more}")),
            &[&format!("Drive gain: {words}")],
        );
    }
}

/// In mN·m the limits would be a thousand times too wide, and nothing would look wrong.
#[test]
fn a_model_in_another_unit_of_torque_is_refused() {
    let place = Folder::new();
    straight(&place);
    let table: toml::Table = place.read("model.toml").parse().unwrap();
    for end in ["input", "output"] {
        let in_unit = |unit: &str| {
            let mut table = table.clone();
            let units = table["about"]["units"].as_table_mut().unwrap();
            assert_eq!(units[end].as_str(), Some("N·m"));
            units.insert(end.to_owned(), unit.into());
            place.file("unit.toml", toml::to_string(&table).unwrap())
        };
        // The same unit in other letters.
        design(&in_unit("Nm"), "500", "0.006", "");
        let other = in_unit("mN·m");
        let wanted = format!("its {end} is in mN·m, but it must be in N·m");
        for asked in [
            format!("design {other} --rate 500 --delay 0.006"),
            format!("compare --model {other} --inertia 0.002"),
        ] {
            refuses(&asked, &["unit.toml", &wanted]);
        }
    }
}
