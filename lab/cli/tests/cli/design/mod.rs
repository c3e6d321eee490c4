//! `bowden design`: from a record to gains, to the rig of one's own model, to firmware.

mod certified;
mod short;

use crate::compiler::{compiled_and_run, module};
use crate::shell::{args, example, refused, said, Folder};
use serde_json::Value;
use std::path::Path;

/// The model of the straight cable.
fn straight(folder: &Folder) -> String {
    let model = folder.path("model.toml");
    said(&["identify", &example("straight.csv"), "--model-out", &model]);
    model
}

fn text(path: &str) -> String {
    std::fs::read_to_string(path).unwrap()
}

/// A light joint against the same spring: it answers within some six milliseconds.
const LIGHT: [&str; 4] = ["--inertia", "0.002", "--damping", "0.5"];

/// The rows of a comparison on the rig of the model.
fn compared(model: &str, gains: &str) -> Value {
    let fixed = [
        "compare",
        "--model",
        model,
        "--gains",
        gains,
        "--seconds",
        "14",
        "--seeds",
        "1",
        "--json",
    ];
    serde_json::from_str(&said(&[&fixed, LIGHT.as_slice()].concat())).unwrap()
}

fn error(report: &Value, controller: &str) -> f64 {
    let rows = report["rows"].as_array().unwrap();
    let row = rows.iter().find(|row| row["controller"] == controller);
    let row = row.unwrap_or_else(|| panic!("no {controller} in {report}"));
    assert_eq!(row["diverged"], 0, "{row}");
    assert!(row["ran_away_at"].is_null(), "{row}");
    row["rmse_true"]["mean"].as_f64().unwrap()
}

#[test]
fn from_a_record_over_its_model_to_gains_that_settle_on_the_rig_of_that_model() {
    let place = Folder::new();
    let (model, gains) = (straight(&place), place.path("gains.toml"));
    let asked = [
        "design",
        &model,
        "--rate",
        "1000",
        "--delay",
        "0.006",
        "--drive-gain",
        "0.6",
        "--noise",
        "0.02",
    ];
    let report: Value = serde_json::from_str(&said(
        &[&asked, ["--out", &gains, "--json"].as_slice()].concat(),
    ))
    .unwrap();
    assert_eq!(report["schema"], "bowden.design/1");
    assert_eq!(report["designed_for"]["rate"], 1000.0);
    assert_eq!(report["delay_samples"], 7);
    assert!(report["pi"]["margins"]["gain"].as_f64().unwrap() >= 2.0);
    assert!(report["pi"]["margins"]["phase"].as_f64().unwrap() >= 45.0);

    // Twenty milliseconds for either: the law steps on one sample in seven.
    let told: toml::Table = toml::from_str(&text(&gains)).unwrap();
    let after = |law: &str| told[law]["fallback"]["after"].as_integer();
    assert_eq!((after("pi"), after("adaptive")), (Some(20), Some(3)));

    let own = compared(&model, &gains);
    let conditions = &own["conditions"];
    // That of the design, which is not given again.
    assert_eq!(conditions["noise"], 0.02);
    assert_eq!(
        (&conditions["model"], &conditions["gains"]),
        (&"model.toml".into(), &"gains.toml".into())
    );
    assert_eq!(conditions["rig"]["motor_inertia"], 0.002);
    let [low, high] = [0, 1].map(|k| conditions["reference"][k].as_f64().unwrap());
    // The reference stays within the outputs that the record has reached.
    let reached = &report["bounds"]["output"];
    assert!(reached[0].as_f64().unwrap() < low && high < reached[1].as_f64().unwrap());
    let names: Vec<&str> = own["rows"]
        .as_array()
        .unwrap()
        .iter()
        .map(|r| r["controller"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["pi", "adaptive", "pi-feed-forward"]);
    for name in names {
        // Settled: a fifth of the reference's amplitude at most.
        assert!(error(&own, name) < 0.1 * (high - low), "{name}");
    }

    let mut table: toml::Table = toml::from_str(&text(&gains)).unwrap();
    let pi = table["pi"].as_table_mut().unwrap();
    for key in ["k_p", "k_i"] {
        let value = pi[key].as_float().unwrap();
        pi.insert(key.to_owned(), (0.1 * value).into());
    }
    let weak = place.file("weak.toml", toml::to_string(&table).unwrap());
    let weak = error(&compared(&model, &weak), "pi");
    let designed = error(&own, "pi");
    assert!(designed < 0.5 * weak, "{designed} {weak}");
}

#[test]
fn gains_rs_compiles_without_warnings_and_is_the_gains() {
    let place = Folder::new();
    let model = straight(&place);
    let mut program = String::from("#![deny(warnings)]\n");
    let mut calls = String::new();
    // One sample of delay, and several with the law on every so-many-th.
    for (index, delay) in ["0", "0.0047"].iter().enumerate() {
        let (rust, toml) = (place.path("gains.rs"), place.path(&format!("{index}.toml")));
        for out in [&rust, &toml] {
            said(&args(&format!(
                "design {model} --rate 1000 --delay {delay} --noise 0.013 --out {out}"
            )));
        }
        let written = text(&rust);
        assert!(written.contains(if index == 0 {
            "once per sample"
        } else {
            "one sample in 5"
        }));
        assert!(
            !written.contains(&place.root().display().to_string()),
            "{written}"
        );
        program += &module(&format!("gains_{index}"), &written);
        calls += &format!(
            "println!(\"{{:?}}\\n{{:?}}\", gains_{index}::PI.settings(), gains_{index}::ADAPTIVE.settings());\n"
        );
    }
    program += &format!("fn main() {{ assert_eq!(gains_0::RATE, 1000.0);\n{calls} }}\n");
    let printed = compiled_and_run(&program, place.root());
    let mut lines = printed.lines();
    for index in 0..2 {
        // The same numbers as a firmware with serde reads from the TOML, to the bit.
        let table: toml::Table =
            toml::from_str(&text(&place.path(&format!("{index}.toml")))).unwrap();
        let pi: bowden::control::PidSettings<f32> = table["pi"].clone().try_into().unwrap();
        assert_eq!(lines.next().unwrap(), format!("{pi:?}"));
        let law: bowden::control::AdaptiveSettings<f32, 0> =
            table["adaptive"].clone().try_into().unwrap();
        assert_eq!(lines.next().unwrap(), format!("{law:?}"));
    }
}

#[test]
fn bad_use_is_one_line_and_nothing_is_written() {
    let place = Folder::new();
    let model = place.file(
        "m.toml",
        "schema = \"bowden.model/1\"\nmode = \"displacement\"\nchannels = []\n[transmission]\ngain = 1.0\nkappa_eta = 0.5\noffset = 0.0\nrho = 1.0\nsigma = 0.6\nn = 1.5\n",
    );
    let out = place.path("gains.toml");
    let with = |more: &[&str]| -> String {
        let line = refused(&[&["design", &model, "--out", &out], more].concat());
        assert!(!Path::new(&out).exists());
        line
    };
    let good = ["--rate", "1000", "--delay", "0.001"];
    let line = with(&good);
    assert!(
        line.contains("m.toml: mode \"displacement\" must be torque"),
        "{line}"
    );
    for (rate, delay, part) in [
        ("-5", "0.001", "--rate -5"),
        ("nan", "0", "--rate NaN"),
        ("1000", "-0.1", "--delay -0.1"),
        ("1000", "inf", "--delay inf"),
    ] {
        let line = with(&["--rate", rate, "--delay", delay]);
        assert!(line.contains(part), "{line}");
    }
    let line = with(&[&good, ["--noise", "-1"].as_slice()].concat());
    assert!(line.contains("--noise -1"), "{line}");
    place.file(
        "m.toml",
        "schema = \"bowden.model/1\"\nmode = \"torque\"\ncolour = 1\n",
    );
    assert!(with(&good).contains("m.toml:3:1: `colour`"));
    place.file("m.toml", "");
    assert!(with(&good).contains("is empty"));

    // What cannot be written is told before the model is looked at.
    for (out, part) in [
        ("gains.csv", ".toml or .rs"),
        ("nowhere/gains.toml", "nowhere"),
        ("m.toml", "would overwrite"),
    ] {
        let out = place.path(out);
        let line = refused(&[&["design", &model, "--out", &out], good.as_slice()].concat());
        assert!(line.contains("--out") && line.contains(part), "{line}");
    }
    assert_eq!(text(&model), "");
}

#[test]
fn gains_and_rigs_that_make_no_sense_are_one_line() {
    let place = Folder::new();
    let model = straight(&place);
    let gains = place.path("gains.toml");
    said(&args(&format!(
        "design {model} --rate 1000 --delay 0.006 --out {gains}"
    )));
    let compare = |gains: &str, more: &[&str]| -> String {
        refused(
            &[
                &args(&format!(
                    "compare --model {model} --gains {gains} --seeds 1"
                )),
                more,
            ]
            .concat(),
        )
    };
    let broken = place.file("broken.toml", text(&gains).replace("k_p = ", "kp = "));
    let line = compare(&broken, &[]);
    assert!(line.contains("broken.toml:13:1: `kp`"), "{line}");
    assert!(compare(&model, &[]).contains("is a model"));
    assert!(compare(&gains, &["--inertia", "-1"]).contains("--inertia -1 is out of range"));
    assert!(compare(&gains, &["--spring", "nan"]).contains("--spring NaN is out of range"));
    assert!(compare(&gains, &["--drive-gain", "0"]).contains("--drive-gain 0 is out of range"));
    assert!(compare(&gains, &["--delay", "9"]).contains("delay"));
    assert!(compare(&gains, &["--effect", "viscous"]).contains("--effect"));
    let other = text(&model)
        .replace("source = \"phi_p\"", "source = \"oil\"")
        .replace("\"phi_p\", ", "\"oil\", ");
    let other = place.file("oil.toml", &other);
    let line = refused(&args(&format!(
        "compare --model {other} --spring 160 --seeds 1"
    )));
    assert!(line.contains("oil.toml: the term viscous@oil"), "{line}");
}

/// Gains of `bowden design` for a drive of 1 N·m per command unit, which is its default.
fn designed(place: &Folder) -> (String, String) {
    let (model, gains) = (straight(place), place.path("gains.toml"));
    let asked = ["--rate", "500", "--delay", "0.006", "--out", &gains];
    said(&[&["design", &model], asked.as_slice()].concat());
    (model, gains)
}

#[test]
fn designed_gains_run_on_no_rig_but_that_of_a_model() {
    let place = Folder::new();
    let (_, gains) = designed(&place);
    let line = refused(&["compare", "--gains", &gains, "--seeds", "1"]);
    assert!(
        line.contains("gains.toml: gains from `bowden design` need their model")
            && line.contains("--model MODEL.toml"),
        "{line}"
    );
    // A file of gains and rig has no model of its own.
    let setup = place.file("setup.toml", "[rig]\nnoise = 0.02\n");
    let line = refused(&args(&format!(
        "compare --model {setup} --gains {gains} --seeds 1"
    )));
    assert!(
        line.contains("setup.toml: with --gains, pass a model written by `bowden identify"),
        "{line}"
    );
}

#[test]
fn the_rig_has_the_drive_gain_that_the_gains_were_designed_for() {
    let place = Folder::new();
    let (model, gains) = designed(&place);
    let fixed = [
        "compare",
        "--model",
        &model,
        "--gains",
        &gains,
        "--seconds",
        "8",
        "--seeds",
        "1",
    ];
    let fixed = [&fixed, LIGHT.as_slice()].concat();
    let with = |more: &[&str]| said(&[fixed.as_slice(), more].concat());
    let json = |text: &str| serde_json::from_str::<Value>(text).unwrap();
    let own = json(&with(&["--json"]));
    let same = json(&with(&["--json", "--drive-gain", "1"]));
    assert_eq!(own["conditions"]["drive_gain"], 1.0);
    assert_eq!(own["rows"], same["rows"]);
    let own = with(&[]);
    assert!(
        own.contains("Drive gain: 1 N·m/unit, as in the design of the gains."),
        "{own}"
    );
    let other = with(&["--drive-gain", "0.6"]);
    assert!(
        other.contains("Drive gain: 0.6 N·m/unit, but the gains were designed for 1 N·m/unit."),
        "{other}"
    );
}

/// In mN·m the limits would be a thousand times too wide, and nothing would look wrong.
#[test]
fn a_model_in_another_unit_of_torque_is_refused() {
    let place = Folder::new();
    let model = text(&straight(&place));
    let options = ["--rate", "500", "--delay", "0.006"];
    for end in ["input", "output"] {
        let mut table: toml::Table = toml::from_str(&model).unwrap();
        let units = table["about"]["units"].as_table_mut().unwrap();
        assert_eq!(units[end].as_str(), Some("N·m"));
        // The same unit in other letters.
        units.insert(end.to_owned(), "Nm".into());
        let same = place.file("same.toml", toml::to_string(&table).unwrap());
        said(&[["design", &same].as_slice(), &options].concat());
        let units = table["about"]["units"].as_table_mut().unwrap();
        units.insert(end.to_owned(), "mN·m".into());
        let other = place.file("milli.toml", toml::to_string(&table).unwrap());
        for arguments in [
            [["design", &other].as_slice(), &options].concat(),
            vec!["compare", "--model", &other, "--inertia", "0.002"],
        ] {
            let line = refused(&arguments);
            let wanted = format!("its {end} is in mN·m, but it must be in N·m");
            assert!(
                line.contains("milli.toml") && line.contains(&wanted),
                "{line}"
            );
        }
    }
}
