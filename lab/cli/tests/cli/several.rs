//! Several records at once: a report by file, a row by file, or one line and status 2.

use crate::sentences::files::Rows;
use crate::shell::{
    bowden_on, example, has, json, refused, refuses, refuses_all, said, text, without_seconds,
    Folder,
};

fn record(folder: &Folder, name: &str, more: &str) -> String {
    folder.record(name, &format!("--seconds 15 --rate 500 {more}"))
}

#[test]
fn files_that_do_not_go_together_give_one_line_with_file_and_column() {
    let folder = Folder::new();
    record(&folder, "a.csv", "--seed 1");
    record(&folder, "b.csv", "--seed 2");
    record(&folder, "x.csv", "--mode displacement");
    let csv = folder.read("a.csv");
    folder.file("fewer.csv", csv.replacen("phi_d", "other", 1));
    folder.file("unit.csv", csv.replacen("N·m", "V", 1));
    folder.file("copy.csv", &csv);
    let names: Vec<String> = (1..=65).map(|k| format!("{k}.csv")).collect();
    let (many, fewer) = (names.join(" "), names[..64].join(" "));
    // Of 64 files the first is read, and is none.
    refuses_all(
        &folder,
        &format!(
            "identify a.csv x.csv => x.csv: column `x`: | but the mode must be torque
            identify a.csv fewer.csv => fewer.csv: column `phi_d`: the file has no such channel
            identify fewer.csv a.csv => a.csv: column `phi_d`: | fewer.csv has no such channel
            identify a.csv unit.csv => unit.csv: column `tau_i`: the column has unit V, but it must have unit N·m
            identify a.csv none.csv => none.csv
            identify a.csv a.csv => given twice
            identify a.csv copy.csv => copy.csv: the samples are the same as in
            identify a.csv --per-file gains => more than one file
            identify a.csv b.csv --per-file gains --baseline viscous => bouc-wen
            identify {many} => 65 records are too many for one model (at most 64)
            identify {fewer} => 1.csv"
        ),
    );
}

/// What `--model-out` writes beside a model lies where the records are.
#[test]
fn a_pattern_leaves_out_the_test_vectors_that_the_program_has_written_and_says_so() {
    let folder = Folder::new();
    let a = record(&folder, "a.csv", "--seed 1");
    let (model, vector) = (folder.path("a.toml"), folder.path("a.vector.csv"));
    said(&format!("identify {a} --max-terms 0 --model-out {model}"));
    assert!(folder.names().contains(&"a.vector.csv".to_owned()));
    let pattern = folder.path("*.csv");
    let of = |asked: &str| json(&format!("identify {asked} --max-terms 0 --json"));
    let (alone, of_pattern) = (of(&a), of(&pattern));
    assert_eq!(of_pattern["record"]["path"], a.as_str());
    assert_eq!(of_pattern["final"], alone["final"]);
    let note = "1 test vector of --model-out excluded from the pattern";
    for (json, number) in [(&alone, 0), (&of_pattern, 1)] {
        let notes = json["notes"].as_array().unwrap().iter();
        assert_eq!(notes.filter(|own| *own == note).count(), number);
    }
    let ledger = said(&format!("identify {pattern} --max-terms 0"));
    has(&ledger, &[&format!("Note    {note}")]);
    // Named in full it is read; where a pattern has nothing else, that is said.
    refuses(
        &format!("identify {vector}"),
        &["a.vector.csv:1: ", "neither `tau_i`"],
    );
    let nothing = "no file matches this pattern except 1 test vector of --model-out";
    refuses(
        &format!("identify {}", folder.path("*.vector.csv")),
        &[nothing],
    );
    // A record of such a name stays one.
    let same = folder.file("b.vector.csv", folder.read("a.csv"));
    let line = refused(&format!("identify {pattern}"));
    has(&line, &[&format!("{same}: the samples are the same as in")]);
    let rows = folder.path("rows.parquet");
    let glob = format!("identify --glob {pattern} --out {rows} --workers 1 --max-terms 0");
    let counts = "2 rows, one per record; 0 records could not be identified";
    assert_eq!(said(&glob), format!("{rows}: {counts}; {note}\n"));
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn a_file_in_other_units_of_the_same_kind_is_converted() {
    let folder = Folder::new();
    let a = record(&folder, "a.csv", "--seed 1");
    let b = record(&folder, "b.csv", "--seed 2");
    let mut rows = Rows::parsed(&folder.read("b.csv"));
    rows.header = rows.header.replacen("N·m", "mN·m", 1);
    rows.set(1, |_, row| 1000.0 * row[1]);
    let c = rows.write(&folder, "c.csv");
    let error = |other: &str| {
        let json = json(&format!("identify {a} {other} --json"));
        json["baseline"]["rmse"]["fit"].as_f64().unwrap()
    };
    // A multiplication and a division by a thousand.
    assert!((error(&b) / error(&c) - 1.0).abs() < 1e-6);
}

#[test]
fn the_report_says_what_each_file_supports_alone() {
    let [a, b] = ["straight.csv", "straight_later.csv"].map(example);
    let report = said(&format!("identify {a} {b}"));
    let found = "found in each individual file, with high confidence\n";
    has(
        &report,
        &[&format!(
            "Files   friction over the velocity of phi_p: {found}"
        )],
    );
    assert!(!report.contains("not the joint fit"), "{report}");
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn three_files_are_reported_one_by_one_and_the_same_on_any_number_of_threads() {
    let folder = Folder::new();
    let files = [1, 2, 3].map(|seed| {
        let name = format!("{seed}.csv");
        record(&folder, &name, &format!("--seed {seed}"))
    });
    let asked = format!("identify {}", files.join(" "));
    let on = |threads: &str| bowden_on(threads, &format!("{asked} --json")).stdout;
    let first = on("1");
    assert_eq!(without_seconds(&first), without_seconds(&on("3")));
    let json: serde_json::Value = serde_json::from_str(text(&first)).unwrap();
    assert!(json.get("record").is_none());
    let records = json["records"].as_array().unwrap();
    for (index, held_out) in ["nothing", "nothing", "whole"].into_iter().enumerate() {
        assert_eq!(records[index]["held_out"], held_out);
        assert_eq!(records[index]["path"], files[index].as_str());
    }
    for model in ["baseline", "final"] {
        let files = json[model]["rmse_by_file"].as_array().unwrap();
        assert_eq!(files.len(), 3);
        assert!(files[0]["fit"].is_f64() && files[0]["held_out"].is_null());
        assert!(files[2]["fit"].is_null());
        // One file is held out, so its error is that of the whole.
        assert_eq!(files[2]["held_out"], json[model]["rmse"]["held_out"]);
    }
    let held_out = format!("held-out: {}", files[2]);
    has(&said(&asked), &[&held_out, "error by file"]);
}
