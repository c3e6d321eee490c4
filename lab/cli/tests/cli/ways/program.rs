//! The program from outside.

use crate::shell::{args, refused, said, Folder};
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

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&said(arguments)).unwrap()
}

#[test]
fn the_json_of_a_check_has_the_models_errors_and_is_the_same_each_time() {
    let folder = Folder::new();
    let own = folder.planted("own.csv", &viscous(76_000));
    let next = folder.planted("next.csv", &viscous(76_001));
    let model = folder.path("model.toml");
    let report = json(&args(&format!(
        "identify {own} --max-terms 1 --json --model-out {model}"
    )));

    let first = said(&["validate", &model, &next, "--json"]);
    assert_eq!(first, said(&["validate", &model, &next, "--json"]));
    let check: Value = serde_json::from_str(&first).unwrap();
    assert_eq!(check["schema"], "bowden.validate/1");
    assert_eq!(check["verdict"], "holds");
    for segment in ["fit", "held_out"] {
        let of = |nrmse: &Value| nrmse[segment].as_f64().unwrap();
        let (from, own) = (
            of(&check["trained_on"]["nrmse"]),
            of(&report["final"]["nrmse"]),
        );
        // TOML prints the same bits; one reader may miss the last of them.
        assert!((from / own - 1.0).abs() < 1e-14, "{from} {own}");
    }
    assert_eq!(check["record"]["unit"], "N");
    assert_eq!(
        check["trained_on"]["cutoff_hz"],
        check["record"]["cutoff_hz"]
    );
    let [nrmse, moved] = ["nrmse", "nrmse_gain_offset"].map(|key| check[key].as_f64().unwrap());
    assert!(moved <= nrmse && nrmse <= check["threshold_nrmse"].as_f64().unwrap());
    assert!(check["gain"]["ci95"].is_array() && check["offset"]["value"].is_number());
}

#[test]
fn the_text_of_a_validation_begins_with_the_answer_and_its_trace_has_the_models_parts() {
    let folder = Folder::new();
    let own = folder.planted("own.csv", &viscous(76_002));
    let next = folder.planted("next.csv", &viscous(76_003));
    let (model, trace) = (folder.path("model.toml"), folder.path("trace.csv"));
    said(&["identify", &own, "--max-terms", "1", "--model-out", &model]);
    let text = said(&["validate", &model, &next, "--trace", &trace]);
    let answer: Vec<&str> = text.lines().skip(2).take(2).collect();
    assert_eq!(answer[0], "  THE MODEL HOLDS");
    assert!(
        answer[1].starts_with("  The model holds: its error is "),
        "{text}"
    );
    assert!(text.lines().count() <= 25, "{text}");
    assert!(!text.contains('\u{1b}'), "escape codes without a terminal");
    let trace = folder.read("trace.csv");
    let header = trace.lines().next().unwrap();
    assert_eq!(
        header,
        "t [s],segment,input [mm],measured [N],model [N],residual [N],model-gain-offset [N],residual-gain-offset [N],transmission.gain [N],transmission.hysteresis [N],transmission.offset [N],viscous [N]"
    );
    assert!(trace.contains(",checked,") && trace.contains(",dropped,"));
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn the_json_of_close_has_the_model_after_each_round_and_rounds_writes_the_same() {
    let folder = Folder::new();
    let recipe = Recipe {
        effects: vec![
            Planted::with_gain("viscous", 0.02),
            Planted::with_gain("stiffness-cubic", 0.01),
        ],
        ..Recipe::of_one_rig(Mode::Displacement, 76_004)
    };
    let record = folder.planted("r.csv", &recipe);
    let all = json(&["identify", &record, "--json"]);
    let rounds = all["terms"].as_array().unwrap();
    assert!(rounds.len() >= 2 && all["stopped_by_max_terms"].is_null());
    for (index, round) in rounds.iter().enumerate() {
        let model: ModelFile = serde_json::from_value(round["model"].clone()).unwrap();
        assert_eq!(model.terms.len(), index + 1);
        // As a file it is a model like any other.
        let given = Given::parse(&toml::to_string(&model).unwrap()).unwrap();
        assert_eq!(given.file, model);
    }
    let last = &rounds[rounds.len() - 1];
    assert_eq!(last["nrmse"], all["final"]["nrmse"]);
    assert_eq!(last["refitted"], all["final"]["refitted"]);

    let path = folder.path("one.toml");
    let one = json(&args(&format!(
        "identify {record} --max-terms 1 --json --model-out {path}"
    )));
    assert_eq!(one["stopped_by_max_terms"], 1);
    assert_eq!(one["terms"].as_array().unwrap().len(), 1);
    let written: ModelFile = toml::from_str(&folder.read("one.toml")).unwrap();
    let reported: ModelFile = serde_json::from_value(one["terms"][0]["model"].clone()).unwrap();
    assert_eq!(
        (written.mode, written.channels),
        (reported.mode, reported.channels)
    );
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
    let a = folder.planted("a.csv", &viscous(76_005));
    let b = folder.planted("b.csv", &viscous(76_006));
    let (one, two) = (folder.path("one.csv"), folder.path("two.csv"));
    for trace in [&one, &two] {
        said(&args(&format!(
            "identify {a} {b} --max-terms 0 --per-file gains --trace {trace}"
        )));
    }
    let trace = folder.read("one.csv");
    assert_eq!(trace, folder.read("two.csv"));
    assert!(trace.starts_with("record,t [s],segment,input [mm],"));
    let of = |path: &str| trace.lines().filter(|l| l.starts_with(path)).count();
    assert_eq!(of(&a) + of(&b) + 1, trace.lines().count());
    // Each begins at zero.
    assert!(trace
        .lines()
        .any(|l| l.starts_with(&format!("{b},0,dropped,"))));
}

#[test]
fn rounds_beyond_the_loops_own_are_refused() {
    let line = refused(&["identify", "--max-terms", "9"]);
    assert!(
        line.contains("`--max-terms 9` is out of range (0 to 8)"),
        "{line}"
    );
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn plan_and_power_take_the_rounds_too() {
    let folder = Folder::new();
    let record = folder.planted(
        "r.csv",
        &Recipe {
            seconds: 10.0,
            ..viscous(76_007)
        },
    );
    said(&["plan", &record, "--max-terms", "0"]);
    let power = json(&args(&format!(
        "power {record} --max-terms 0 --effects drag-cubic --trials 5 --json"
    )));
    assert_eq!(power["schema"], "bowden.power/1");
}
