//! Ways in and out: limited rounds, traces, models on the next record.

use crate::sentences::files::Rows;
use crate::shell::{has, json, refused, refuses, refuses_all, said, Folder};
use bowden_lab::check::Given;
use bowden_lab::export::ModelFile;
use bowden_synth::{Mode, Planted, Recipe};
use serde_json::Value;

fn viscous(seed: u64) -> Recipe {
    Recipe {
        effects: vec![Planted::with_gain("viscous", 0.02)],
        ..Recipe::of_one_rig(Mode::Displacement, seed)
    }
}

fn short(mode: Mode, seed: u64) -> Recipe {
    Recipe {
        seconds: 10.0,
        ..Recipe::of_one_rig(mode, seed)
    }
}

#[test]
fn a_check_has_the_models_errors_its_answer_first_and_a_trace_of_the_models_parts() {
    let folder = Folder::new();
    let own = folder.planted("own.csv", &viscous(76_000));
    let next = folder.planted("next.csv", &viscous(76_001));
    let (model, trace) = (folder.path("model.toml"), folder.path("trace.csv"));
    let report = json(&format!(
        "identify {own} --max-terms 1 --json --model-out {model}"
    ));
    let validate = format!("validate {model} {next}");
    let check = json(&format!("{validate} --json"));
    assert_eq!(check, json(&format!("{validate} --json")));
    assert_eq!(check["schema"], "bowden.validate/1");
    assert_eq!(check["verdict"], "holds");
    for segment in ["fit", "held_out"] {
        let [from, own] = [&check["trained_on"], &report["final"]]
            .map(|of| of["nrmse"][segment].as_f64().unwrap());
        // TOML prints the same bits; one reader may miss the last of them.
        assert!((from / own - 1.0).abs() < 1e-14, "{from} {own}");
    }
    assert_eq!(check["record"]["unit"], "N");
    let cutoff = |part: &str| &check[part]["cutoff_hz"];
    assert_eq!(cutoff("trained_on"), cutoff("record"));
    let [nrmse, moved] = ["nrmse", "nrmse_gain_offset"].map(|key| check[key].as_f64().unwrap());
    assert!(moved <= nrmse && nrmse <= check["threshold_nrmse"].as_f64().unwrap());
    assert!(check["gain"]["ci95"].is_array() && check["offset"]["value"].is_number());

    let text = said(&format!("{validate} --trace {trace}"));
    let answer: Vec<&str> = text.lines().skip(2).take(2).collect();
    assert_eq!(answer[0], "  THE MODEL HOLDS");
    has(answer[1], &["  The model holds: its error is "]);
    assert!(text.lines().count() <= 25, "{text}");
    assert!(!text.contains('\u{1b}'), "escape codes without a terminal");
    let trace = folder.read("trace.csv");
    let columns = "measured model residual model-gain-offset residual-gain-offset \
                   transmission.gain transmission.hysteresis transmission.offset viscous";
    let columns = columns
        .split_whitespace()
        .map(|name| format!(",{name} [N]"));
    let columns: String = columns.collect();
    let header = format!("t [s],segment,input [mm]{columns}\n");
    assert!(trace.starts_with(&header), "{header}");
    has(&trace, &[",checked,", ",dropped,"]);
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn the_json_of_close_has_the_model_after_each_round_and_rounds_writes_the_same() {
    let folder = Folder::new();
    let mut recipe = viscous(76_004);
    recipe
        .effects
        .push(Planted::with_gain("stiffness-cubic", 0.01));
    let record = folder.planted("r.csv", &recipe);
    let all = json(&format!("identify {record} --json"));
    let rounds = all["terms"].as_array().unwrap();
    assert!(rounds.len() >= 2 && all["stopped_by_max_terms"].is_null());
    let model =
        |round: &Value| -> ModelFile { serde_json::from_value(round["model"].clone()).unwrap() };
    for (index, round) in rounds.iter().enumerate() {
        let model = model(round);
        assert_eq!(model.terms.len(), index + 1);
        // As a file it is a model like any other.
        let given = Given::parse(&toml::to_string(&model).unwrap()).unwrap();
        assert_eq!(given.file, model);
    }
    let last = &rounds[rounds.len() - 1];
    assert_eq!(last["nrmse"], all["final"]["nrmse"]);
    assert_eq!(last["refitted"], all["final"]["refitted"]);

    let path = folder.path("one.toml");
    let one = json(&format!(
        "identify {record} --max-terms 1 --json --model-out {path}"
    ));
    assert_eq!(one["stopped_by_max_terms"], 1);
    assert_eq!(one["terms"].as_array().unwrap().len(), 1);
    let written: ModelFile = toml::from_str(&folder.read("one.toml")).unwrap();
    let reported = model(&one["terms"][0]);
    assert_eq!(written.mode, reported.mode);
    assert_eq!(written.channels, reported.channels);
    for (a, b) in written.terms.iter().zip(&reported.terms) {
        assert_eq!((&a.effect, &a.source), (&b.effect, &b.source));
        // JSON and TOML print the same bits; one reader may miss the last of them.
        assert!((a.gain / b.gain - 1.0).abs() < 1e-14);
    }
    assert_eq!(written.terms[0].effect, rounds[0]["effect"]);
}

#[test]
fn a_trace_of_several_records_says_of_which_each_line_is_and_is_the_same_each_time() {
    let folder = Folder::new();
    let [a, b] = [("a.csv", 76_005), ("b.csv", 76_006)]
        .map(|(name, seed)| folder.planted(name, &viscous(seed)));
    let asked = format!("identify {a} {b} --max-terms 0 --per-file gains --trace");
    for name in ["one.csv", "two.csv"] {
        said(&format!("{asked} {}", folder.path(name)));
    }
    let trace = folder.read("one.csv");
    assert_eq!(trace, folder.read("two.csv"));
    assert!(trace.starts_with("record,t [s],segment,input [mm],"));
    let of = |path: &str| trace.lines().filter(|l| l.starts_with(path)).count();
    assert_eq!(of(&a) + of(&b) + 1, trace.lines().count());
    // Each begins at zero.
    assert_eq!(of(&format!("{b},0,dropped,")), 1);
}

/// A model and its record.
fn model(folder: &Folder, mode: Mode, declare: &str) -> (String, String) {
    let recipe = Recipe {
        effects: vec![Planted::new("viscous")],
        ..short(mode, 75_000)
    };
    let (record, model) = (
        folder.planted("own.csv", &recipe),
        folder.path("model.toml"),
    );
    let baseline = format!("--max-terms 0 --baseline {declare}");
    said(&format!("identify {record} {baseline} --model-out {model}"));
    (model, record)
}

#[test]
fn what_is_no_model_is_refused_with_the_reason() {
    let folder = Folder::new();
    let (model, record) = model(&folder, Mode::Displacement, "bouc-wen,viscous");
    let text = folder.read("model.toml");
    let own_verdict = text.lines().find(|line| line.starts_with("verdict = "));
    for (from, to, word) in [
        (&*text, "this is no TOML", "TOML"),
        (&*text, "", "no schema"),
        ("bowden.model/1", "bowden.model/9", "bowden.model/9"),
        ("mode =", "mood =", "mood"),
        ("\"viscous\"", "\"sticky\"", "sticky"),
        ("\"displacement\"", "\"volts\"", "volts"),
        ("rho = ", "rho = -", "transmission"),
        ("cutoff_hz = ", "cutoff_hz = \"fast\" # ", "about"),
        // A model that describes nothing holds nowhere, on its own record neither.
        (
            own_verdict.unwrap(),
            "verdict = \"no-input-dependence\"",
            "the model does not describe its own records (verdict `no-input-dependence`)",
        ),
    ] {
        assert!(text.contains(from), "{from}");
        let other = folder.file("other.toml", text.replacen(from, to, 1));
        refuses(&format!("validate {other} {record}"), &["other.toml", word]);
    }
    let none = "schema = \"bowden.model/1\"\nmode = \"displacement\"\nchannels = []\n";
    let none = folder.file("none.toml", none);
    let binary = folder.file("binary.toml", [0, 159, 146, 150]);
    for (path, word) in [
        (none, "has no parts"),
        (binary, "is not text"),
        (folder.path("missing.toml"), "missing.toml"),
        (folder.path("."), ""),
    ] {
        refuses(&format!("validate {path} {record}"), &[word]);
    }
    // And the model itself is taken.
    said(&format!("validate {model} {record}"));
}

#[test]
fn a_record_that_does_not_fit_the_model_is_refused_with_the_reason() {
    let folder = Folder::new();
    let (model, record) = model(&folder, Mode::Torque, "bouc-wen,viscous@phi_p");
    let csv = folder.read("own.csv");
    folder.file("without.csv", csv.replace("phi_p", "angle"));
    folder.planted("other.csv", &short(Mode::Displacement, 1));
    // The cut-off is the model's: nobody has given an option, and the time is to blame.
    let mut rows = Rows::parsed(&csv);
    rows.set(0, |_, row| 1000.0 * row[0]);
    rows.write(&folder, "slow.csv");
    folder.file(
        "short.csv",
        csv.split_inclusive('\n').take(400).collect::<String>(),
    );
    folder.file("empty.csv", "");
    refuses_all(
        &folder,
        "validate model.toml without.csv => the model reads channel `phi_p`, but
        validate model.toml other.csv => the model is in torque mode
        validate model.toml own.csv --mode displacement => --mode must be torque
        validate model.toml slow.csv => the model's cut-off of | is the time in seconds?
        validate model.toml short.csv => too short",
    );
    let without = folder.path("without.csv");
    said(&format!("validate {model} {without} --channel phi_p=angle"));
    // What has nothing to do with the mode or an option is not put down to it.
    for (bad, word) in [
        ("empty.csv", "mode"),
        ("missing.csv", "mode"),
        ("short.csv", "--cutoff,"),
    ] {
        let line = refused(&format!("validate {model} {}", folder.path(bad)));
        assert!(!line.contains(word), "{line}");
    }
    // The most that is said to be allowed is.
    let line = refused(&format!("identify {record} --cutoff 1e6"));
    let (_, most) = line.split_once("at most ").unwrap();
    let most = most.split(' ').next().unwrap();
    said(&format!("identify {record} --max-terms 0 --cutoff {most}"));
}

#[test]
fn units_are_converted_or_refused() {
    let folder = Folder::new();
    let (model, record) = model(&folder, Mode::Displacement, "bouc-wen,viscous");
    let check = |path: &str| json(&format!("validate {model} {path} --json --cutoff 8"));
    let own = check(&record);
    let csv = folder.read("own.csv");
    // The same motion in metres.
    let mut rows = Rows::parsed(&csv);
    rows.rows.iter_mut().for_each(|row| row.truncate(3));
    rows.header = "t [s],x [m],f [N]".to_owned();
    rows.set(1, |_, row| row[1] / 1000.0);
    let converted = check(&rows.write(&folder, "metres.csv"));
    let [a, b] = [&own, &converted].map(|check| check["nrmse"].as_f64().unwrap());
    // A division and a multiplication by a thousand.
    assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
    has(
        &converted["notes"].to_string(),
        &["converted from unit m to unit mm"],
    );

    // Without any unit, as in a .mat file, it is in those of the model; with some, all are needed.
    let headed = |header: &str| {
        let text = csv.replacen("t [s],x [mm],f [N]", header, 1);
        folder.file("headed.csv", text)
    };
    let without = check(&headed("t,x,f"));
    assert_eq!(own["nrmse"], without["nrmse"]);
    has(&without["notes"].to_string(), &["has no units"]);
    for (header, word) in [
        ("t [s],x [V],f [N]", "unit V"),
        ("t [s],x,f [N]", "no unit"),
        ("t [s],x [mm],f [Pa]", "unit Pa"),
    ] {
        let validate = format!("validate {model} {}", headed(header));
        let must = ", but it must have unit ";
        refuses(&validate, &["headed.csv", word, must, ", as in the model"]);
    }
}
