//! Requests as the page makes them.
#![allow(clippy::unwrap_used, clippy::panic)]

use bowden_cli::view;
use bowden_trials::facts as trials;
use bowden_web::{Answer, Engine, EXAMPLE};
use serde_json::{json, Value};

fn ask(engine: &mut Engine, request: &Value, bytes: &[u8]) -> Answer {
    let mut line = serde_json::to_vec(request).unwrap();
    line.push(b'\n');
    line.extend(bytes);
    engine.answer(&line, &|_| {})
}

fn record(head: &str, bad: Option<u32>) -> Vec<u8> {
    let mut text = format!("{head}\n");
    for i in 0..2000_u32 {
        let t = 0.01 * f64::from(i);
        let torque = match bad == Some(i) {
            true => "oops".to_owned(),
            false => format!("{:.4}", 16.0 * (2.0 * t).sin()),
        };
        text += &format!("{t:.2},{torque},{:.4}\n", 15.0 * (2.0 * t - 0.1).sin());
    }
    text.into_bytes()
}

#[test]
fn the_example_has_columns_with_units_and_parts() {
    let mut engine = Engine::default();
    let _ = ask(&mut engine, &json!({"ask": "example"}), &[]);
    let look = json!({"ask": "look", "file": EXAMPLE});
    let answer = ask(&mut engine, &look, &[]);
    let columns = answer.get("columns").unwrap();
    let parts: Vec<&Value> = columns
        .as_array()
        .unwrap()
        .iter()
        .map(|c| &c["part"])
        .collect();
    assert_eq!(parts, ["time", "input", "output", "channel", "channel"]);
    assert_eq!(columns[1]["unit"], "N·m");
    assert_eq!(answer.get("samples").unwrap(), 20_000);
    assert!(answer.get("refusal").is_none());
}

#[test]
fn a_refusal_has_its_line_and_its_cell() {
    let mut engine = Engine::default();
    let add = json!({"ask": "add", "name": "bench.csv"});
    let _ = ask(&mut engine, &add, &record("t,tau_i,tau_o", Some(49)));
    let look = json!({"ask": "look", "file": "bench.csv"});
    let answer = ask(&mut engine, &look, &[]);
    let refusal = answer.get("refusal").unwrap();
    assert_eq!(
        (&refusal["line"], &refusal["column"]),
        (&json!(51), &json!("tau_i"))
    );
    assert!(refusal["text"]
        .as_str()
        .unwrap()
        .starts_with("bench.csv:51: column `tau_i`: "));
    let marked = refusal["lines"].as_array().unwrap();
    let marked = marked.iter().find(|line| line["number"] == 51).unwrap();
    assert_eq!(marked["cells"][1], "oops");
    let identify = json!({"ask": "identify", "files": ["bench.csv"]});
    let answer = ask(&mut engine, &identify, &[]);
    assert_eq!(answer.get("refused"), Some(&refusal["text"]));
}

#[test]
fn the_command_line_has_what_was_chosen() {
    let mut engine = Engine::default();
    let add = json!({"ask": "add", "name": "my bench.csv"});
    let _ = ask(&mut engine, &add, &record("time,motor,joint", None));
    let choices = json!({
        "mode": "torque", "input": "motor", "output": "joint", "cutoff": 5.0, "max_terms": 0
    });
    let identify = json!({"ask": "identify", "files": ["my bench.csv"], "choices": choices});
    let answer = ask(&mut engine, &identify, &[]);
    let expected = "bowden identify 'my bench.csv' --mode torque --input motor --output joint --cutoff 5 --max-terms 0 --report report.html";
    assert_eq!(
        answer.get("command").unwrap(),
        expected,
        "{:?}",
        answer.get("refused")
    );
    for name in ["report.html", "result.json", "result.txt", "trace.csv"] {
        assert!(
            answer.file(name).is_some_and(|bytes| !bytes.is_empty()),
            "{name}"
        );
    }
    let shown = std::str::from_utf8(answer.file("result.txt").unwrap()).unwrap();
    assert!(!shown.contains('\u{1b}'));
}

#[test]
fn a_sheet_of_a_workbook_is_chosen_as_in_the_program() {
    let mut engine = Engine::default();
    let add = json!({"ask": "add", "name": "r.xlsx"});
    let bytes = include_bytes!("../../../lab/cli/tests/cli/reading/files/vectors.xlsx");
    let _ = ask(&mut engine, &add, bytes);
    let look = |sheet: &str| json!({"ask": "look", "file": "r.xlsx", "choices": {"sheet": sheet}});
    let answer = ask(&mut engine, &look("Run"), &[]);
    assert!(
        answer.get("refusal").is_none(),
        "{:?}",
        answer.get("refusal")
    );
    let answer = ask(&mut engine, &look("run"), &[]);
    assert_eq!(
        answer.get("refusal").unwrap()["text"],
        "r.xlsx: --sheet run: the workbook has no such sheet (nearest: `Run`)"
    );
    let choices = json!({"sheet": "Run", "max_terms": 0});
    let identify = json!({"ask": "identify", "files": ["r.xlsx"], "choices": choices});
    let answer = ask(&mut engine, &identify, &[]);
    let expected = "bowden identify r.xlsx --sheet Run --max-terms 0 --report report.html";
    assert_eq!(answer.get("command").unwrap(), expected);
}

#[test]
fn what_is_no_request_gets_one_line() {
    let mut engine = Engine::default();
    for request in [
        "",
        "{}",
        "\n",
        "{\"ask\":\"look\",\"file\":\"none\"}",
        "\u{0}",
        "{\"ask\":\"identify\",\"files\":[]}",
    ] {
        let answer = engine.answer(request.as_bytes(), &|_| {});
        let line = answer.get("refused").and_then(Value::as_str).unwrap();
        assert!(
            !line.is_empty() && !line.contains('\n'),
            "{request:?}: {line:?}"
        );
    }
    let unknown = json!({"ask": "look", "file": "none", "choices": {"colour": "red"}});
    let answer = ask(&mut engine, &unknown, &[]);
    assert!(answer
        .get("refused")
        .unwrap()
        .as_str()
        .unwrap()
        .contains("colour"));
    let bytes = answer.bytes();
    assert!(bytes.ends_with(b"\n") && bytes.iter().filter(|b| **b == b'\n').count() == 1);
}

/// A cable whose output never falls while its input rises.
const MODEL: &str = include_str!("../../../lab/cli/tests/cli/shell/soft.toml");

fn json_of(answer: &Answer) -> Value {
    let bytes = answer.file("result.json");
    serde_json::from_slice(bytes.unwrap_or_else(|| panic!("{:?}", answer.get("refused")))).unwrap()
}

#[test]
fn gains_and_trials_are_those_of_the_program() {
    let mut engine = Engine::default();
    let options = json!({"rate": 1000.0, "delay": 0.004, "drive_gain": 0.5});
    let design = json!({"ask": "design", "model": "model.toml", "options": options});
    let answer = ask(&mut engine, &design, MODEL.as_bytes());
    let question = trials::DesignQuestion {
        rate: 1000.0,
        delay: 0.004,
        noise: 0.0,
        drive_gain: 0.5,
    };
    let designed = trials::design(MODEL, "model.toml", &question).unwrap();
    let expected: Value = serde_json::from_str(&view::design::json(&designed).unwrap()).unwrap();
    assert_eq!(json_of(&answer), expected);
    assert_eq!(
        answer.get("command").unwrap(),
        "bowden design model.toml --rate 1000 --delay 0.004 --drive-gain 0.5 --out gains.toml"
    );
    let gains = answer.file("gains.toml").unwrap();
    assert_eq!(gains, designed.gains.toml().unwrap().as_bytes());
    assert_eq!(
        answer.file("gains.rs").unwrap(),
        trials::design_rust(&designed).as_bytes()
    );

    for (name, bytes) in [("model.toml", MODEL.as_bytes()), ("gains.toml", gains)] {
        let _ = ask(&mut engine, &json!({"ask": "add", "name": name}), bytes);
    }
    let options = json!({"seconds": 8.0, "seeds": 2, "rig": {"load_stiffness": 120.0}});
    let compare = json!({
        "ask": "compare", "model": "model.toml", "gains": "gains.toml", "options": options
    });
    let answer = ask(&mut engine, &compare, &[]);
    let folder = std::env::temp_dir().join(format!("bowden-requests-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (model, of_disk) = (folder.join("model.toml"), folder.join("gains.toml"));
    std::fs::write(&model, MODEL).unwrap();
    std::fs::write(&of_disk, gains).unwrap();
    let compared = trials::compare(&trials::Question {
        setup: Some(&model),
        gains: Some(&of_disk),
        seconds: 8.0,
        seeds: 2,
        rig: trials::RigChanges {
            load_stiffness: Some(120.0),
            ..trials::RigChanges::default()
        },
        ..trials::Question::default()
    });
    std::fs::remove_dir_all(&folder).unwrap();
    let expected: Value = serde_json::from_str(&view::compare::json(&compared.unwrap())).unwrap();
    assert_eq!(json_of(&answer), expected);
    assert_eq!(
        answer.get("command").unwrap(),
        "bowden compare --model model.toml --gains gains.toml --seeds 2 --seconds 8 --spring 120 --report report.html"
    );
    let report = std::str::from_utf8(answer.file("report.html").unwrap()).unwrap();
    assert!(report.contains("<h2 id=\"tracking-head\">"));
    assert!(report.contains("Configuration varying"));
}

#[test]
fn what_cannot_be_designed_or_compared_gets_one_line() {
    let mut engine = Engine::default();
    let model = json!({"ask": "add", "name": "model.toml"});
    let _ = ask(&mut engine, &model, MODEL.as_bytes());
    let design =
        |options: Value| json!({"ask": "design", "model": "model.toml", "options": options});
    let compare =
        |options: Value| json!({"ask": "compare", "model": "model.toml", "options": options});
    let displacement = MODEL.replace("\"torque\"", "\"displacement\"");
    for (request, bytes, word) in [
        (
            design(json!({"rate": 0.0, "delay": 0.004})),
            MODEL,
            "--rate 0",
        ),
        (design(json!({"rate": 1000.0})), MODEL, "delay"),
        (
            design(json!({"rate": 1000.0, "delay": 0.004})),
            "",
            "model.toml",
        ),
        (
            design(json!({"rate": 1000.0, "delay": 0.004})),
            &displacement,
            "torque",
        ),
        (compare(json!({"seconds": 1.0})), "", "--seconds 1 "),
        (compare(json!({"seeds": 0})), "", "--seeds 0 "),
        (compare(json!({"rig": {"delay": 9}})), "", "--delay 9 "),
        (
            compare(json!({"rig": {"motor_inertia": -1.0}})),
            "",
            "--inertia -1 ",
        ),
        (compare(json!({"noise": -1.0})), "", "--noise -1"),
        (
            json!({"ask": "compare", "model": "model.toml", "gains": "none"}),
            "",
            "none",
        ),
    ] {
        let answer = ask(&mut engine, &request, bytes.as_bytes());
        let line = answer.get("refused").and_then(Value::as_str).unwrap_or("");
        assert!(
            line.contains(word) && !line.contains('\n'),
            "{request}: {line:?}"
        );
    }
}

#[test]
fn separate_gains_give_a_model_for_each_file() {
    let mut engine = Engine::default();
    let names = ["a.csv", "b.csv"];
    for (name, bad) in names.iter().zip([None, Some(1999)]) {
        // The second file is one sample shorter: the same samples twice are refused.
        let text = String::from_utf8(record("t,tau_i,tau_o", bad)).unwrap();
        let bytes = text.split("19.99,oops").next().unwrap();
        let add = json!({"ask": "add", "name": name});
        let _ = ask(&mut engine, &add, bytes.as_bytes());
    }
    let choices = json!({"max_terms": 0, "per_file": true});
    let identify = json!({"ask": "identify", "files": names, "choices": choices});
    let answer = ask(&mut engine, &identify, &[]);
    assert_eq!(
        answer.get("command").unwrap(),
        "bowden identify a.csv b.csv --max-terms 0 --per-file gains --report report.html",
        "{:?}",
        answer.get("refused")
    );
    assert_eq!(
        answer.get("models").unwrap(),
        &json!(["model-1.toml", "model-2.toml"])
    );
    for name in [
        "model-1.toml",
        "model-2.rs",
        "model-2.h",
        "model-2.vector.csv",
    ] {
        assert!(answer.file(name).is_some(), "{name}");
    }
    let one = json!({"ask": "identify", "files": ["a.csv"], "choices": choices});
    let line = ask(&mut engine, &one, &[]);
    let line = line.get("refused").unwrap();
    assert_eq!(line, "--per-file gains needs more than one file");
}
