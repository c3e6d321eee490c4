//! The program from outside: one line and status 2, or a report by file.

use crate::shell::{
    args, bowden, bowden_on, example, refused, said, text, without_seconds, Folder,
};

fn record(folder: &Folder, name: &str, more: &[&str]) -> String {
    folder.record(
        name,
        &[&["--seconds", "15", "--rate", "500"], more].concat(),
    )
}

/// A copy of a record with its header changed.
fn renamed(folder: &Folder, from: &str, name: &str, change: impl Fn(&str) -> String) -> String {
    let csv = std::fs::read_to_string(from).unwrap();
    let (header, rows) = csv.split_once('\n').unwrap();
    folder.file(name, format!("{}\n{rows}", change(header)))
}

#[test]
fn files_that_do_not_go_together_give_one_line_with_file_and_column() {
    let folder = Folder::new();
    let a = record(&folder, "a.csv", &["--seed", "1"]);
    let x = record(&folder, "x.csv", &["--mode", "displacement"]);
    let line = refused(&["identify", &a, &x]);
    assert!(
        line.contains("x.csv: column `x`: ") && line.contains("but the mode must be torque"),
        "{line}"
    );
    let fewer = renamed(&folder, &a, "fewer.csv", |h| h.replace("phi_d", "other"));
    let line = refused(&["identify", &a, &fewer]);
    assert!(
        line.contains("fewer.csv: column `phi_d`: the file has no such channel"),
        "{line}"
    );
    let line = refused(&["identify", &fewer, &a]);
    assert!(
        line.contains("a.csv: column `phi_d`: ") && line.contains("fewer.csv has no such channel"),
        "{line}"
    );
    let other = renamed(&folder, &a, "unit.csv", |h| h.replacen("N·m", "V", 1));
    let line = refused(&["identify", &a, &other]);
    assert!(
        line.contains("unit.csv: column `tau_i`: the column has unit V, but it must have unit N·m"),
        "{line}"
    );
    let line = refused(&["identify", &a, &folder.path("none.csv")]);
    assert!(line.contains("none.csv"), "{line}");
    assert!(refused(&["identify", &a, &a]).contains("given twice"));
    let copy = renamed(&folder, &a, "copy.csv", str::to_owned);
    let line = refused(&["identify", &a, &copy]);
    assert!(
        line.contains("copy.csv: the samples are the same as in"),
        "{line}"
    );
    let line = refused(&["identify", &a, "--per-file", "gains"]);
    assert!(line.contains("more than one file"), "{line}");
    let b = record(&folder, "b.csv", &["--seed", "2"]);
    let line = refused(&args(&format!(
        "identify {a} {b} --per-file gains --baseline viscous"
    )));
    assert!(line.contains("bouc-wen"), "{line}");
}

/// What `--model-out` writes beside a model lies where the records are.
#[test]
fn a_pattern_leaves_out_the_test_vectors_that_the_program_has_written_and_says_so() {
    let folder = Folder::new();
    let a = record(&folder, "a.csv", &["--seed", "1"]);
    let (model, vector) = (folder.path("a.toml"), folder.path("a.vector.csv"));
    let quick = ["--max-terms", "0"];
    let written = bowden(&[&["identify", &a, "--model-out", &model], &quick[..]].concat());
    assert_eq!(written.status.code(), Some(0));
    assert!(std::path::Path::new(&vector).exists());
    let pattern = folder.path("*.csv");
    let json = |arguments: &[&str]| -> serde_json::Value {
        let output = bowden(&[&["identify", "--json"], arguments, &quick].concat());
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let (alone, of_pattern) = (json(&[&a]), json(&[&pattern]));
    assert_eq!(of_pattern["record"]["path"], a.as_str());
    assert_eq!(of_pattern["final"], alone["final"]);
    let note = "1 test vector of --model-out excluded from the pattern";
    let noted = |json: &serde_json::Value| {
        let notes = json["notes"].as_array().unwrap();
        notes.iter().filter(|own| *own == note).count()
    };
    assert_eq!((noted(&alone), noted(&of_pattern)), (0, 1));
    let ledger = bowden(&[&["identify", &pattern], &quick[..]].concat());
    assert!(text(&ledger.stdout).contains(&format!("Note    {note}")));
    // Named in full it is read; where a pattern has nothing else, that is said.
    let line = refused(&["identify", &vector]);
    assert!(
        line.contains("a.vector.csv:1: ") && line.contains("neither `tau_i`"),
        "{line}"
    );
    let line = refused(&["identify", &folder.path("*.vector.csv")]);
    assert!(
        line.ends_with("no file matches this pattern except 1 test vector of --model-out"),
        "{line}"
    );
    // A record of such a name stays one.
    std::fs::copy(&a, folder.path("b.vector.csv")).unwrap();
    let line = refused(&["identify", &pattern]);
    assert!(
        line.contains("b.vector.csv: the samples are the same as in"),
        "{line}"
    );
    let rows = folder.path("rows.parquet");
    let glob = [
        "identify",
        "--glob",
        &pattern,
        "--out",
        &rows,
        "--workers",
        "1",
    ];
    let output = bowden(&[&glob, &quick[..]].concat());
    assert_eq!(
        text(&output.stdout),
        format!("{rows}: 2 rows, one per record; 0 records could not be identified; {note}\n")
    );
}

#[test]
fn more_files_than_can_be_fitted_together_are_refused_before_any_is_read() {
    let names: Vec<String> = (1..=65).map(|k| format!("{k}.csv")).collect();
    let mut all = vec!["identify"];
    all.extend(names.iter().map(String::as_str));
    let line = refused(&all);
    assert!(
        line.contains("65 records are too many for one model (at most 64)"),
        "{line}"
    );
    // One less is read, and the first of these names is no file.
    all.pop();
    assert!(refused(&all).contains("1.csv"));
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn a_file_in_other_units_of_the_same_kind_is_converted() {
    let folder = Folder::new();
    let a = record(&folder, "a.csv", &["--seed", "1"]);
    let b = record(&folder, "b.csv", &["--seed", "2"]);
    let csv = std::fs::read_to_string(&b).unwrap();
    let (header, rows) = csv.split_once('\n').unwrap();
    let mut converted = header.replacen("N·m", "mN·m", 1) + "\n";
    for row in rows.lines() {
        let mut cells: Vec<String> = row.split(',').map(str::to_owned).collect();
        cells[1] = format!("{:.9}", 1000.0 * cells[1].parse::<f64>().unwrap());
        converted += &(cells.join(",") + "\n");
    }
    let c = folder.path("c.csv");
    std::fs::write(&c, converted).unwrap();
    let error = |other: &str| {
        let out = bowden(&["identify", &a, other, "--json"]);
        let json: serde_json::Value = serde_json::from_slice(&out.stdout).unwrap();
        json["baseline"]["rmse"]["fit"].as_f64().unwrap()
    };
    // Nine decimals of a thousandth were written.
    assert!((error(&b) / error(&c) - 1.0).abs() < 1e-6);
}

#[test]
fn the_report_says_what_each_file_supports_alone() {
    let [a, b] = ["straight.csv", "straight_later.csv"].map(example);
    let report = said(&["identify", &a, &b]);
    let line =
        "Files   friction over the velocity of phi_p: found in each individual file, with high confidence\n";
    assert!(report.contains(line), "{report}");
    assert!(!report.contains("not the joint fit"), "{report}");
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn three_files_are_reported_one_by_one_and_the_same_on_any_number_of_threads() {
    let folder = Folder::new();
    let name = |seed: &str| record(&folder, &format!("{seed}.csv"), &["--seed", seed]);
    let (a, b, c) = (name("1"), name("2"), name("3"));
    let arguments = ["identify", &a, &b, &c, "--json"];
    let first = bowden_on("1", &arguments);
    assert_eq!(first.status.code(), Some(0), "{}", text(&first.stderr));
    let again = bowden_on("3", &arguments);
    assert_eq!(
        without_seconds(&first.stdout),
        without_seconds(&again.stdout)
    );
    let json: serde_json::Value = serde_json::from_slice(&first.stdout).unwrap();
    assert!(json.get("record").is_none());
    let records = json["records"].as_array().unwrap();
    let held_out: Vec<_> = records.iter().map(|r| r["held_out"].as_str()).collect();
    assert_eq!(held_out, [Some("nothing"), Some("nothing"), Some("whole")]);
    assert_eq!(records[1]["path"], b.as_str());
    for model in ["baseline", "final"] {
        let files = json[model]["rmse_by_file"].as_array().unwrap();
        assert_eq!(files.len(), 3);
        assert!(files[0]["fit"].is_f64() && files[0]["held_out"].is_null());
        assert!(files[2]["fit"].is_null());
        // One file is held out, so its error is that of the whole.
        assert_eq!(files[2]["held_out"], json[model]["rmse"]["held_out"]);
    }
    let ledger = bowden(&["identify", &a, &b, &c]);
    let ledger = text(&ledger.stdout);
    assert!(ledger.contains(&format!("held-out: {c}")), "{ledger}");
    assert!(ledger.contains("error by file"), "{ledger}");
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn with_gains_of_their_own_each_file_gets_a_model_file() {
    let folder = Folder::new();
    let a = record(&folder, "a.csv", &["--seed", "1"]);
    let b = record(&folder, "b.csv", &["--seed", "2"]);
    let out = folder.path("model.toml");
    let ran = bowden(&args(&format!(
        "identify {a} {b} --per-file gains --model-out {out}"
    )));
    assert_eq!(ran.status.code(), Some(0), "{}", text(&ran.stderr));
    assert!(text(&ran.stdout).contains("gains by file"));
    assert!(!std::path::Path::new(&out).exists());
    let read = |name: &str| -> toml::Table {
        let text = std::fs::read_to_string(folder.path(name)).unwrap();
        text.parse().unwrap()
    };
    let (one, two) = (read("model-1.toml"), read("model-2.toml"));
    let part = |model: &toml::Table, key: &str| model["transmission"][key].as_float().unwrap();
    assert_eq!(part(&one, "rho"), part(&two, "rho"));
    assert_ne!(part(&one, "kappa_eta"), part(&two, "kappa_eta"));
}
