//! `bowden identify --glob`: one row a record, read back with another reader than the writer's.

use crate::shell::{refused, said, Folder};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Field, Row, RowAccessor};
use serde_json::Value;
use std::path::Path;

/// Four generated records, and two that cannot be closed: one is cut off within a row, one
/// has a NaN.
fn folder() -> Folder {
    let folder = Folder::new();
    for seed in 1..=4 {
        let path = file(folder.root(), &format!("r{seed}.csv"));
        let seed = seed.to_string();
        let asked = ["--effect", "viscous", "--seconds", "10", "--rate", "400"];
        said(&[&["generate", "--out", &path, "--seed", &seed], &asked[..]].concat());
    }
    let whole = std::fs::read_to_string(file(folder.root(), "r1.csv")).unwrap();
    std::fs::write(file(folder.root(), "r5.csv"), &whole[..5000]).unwrap();
    let mut rows: Vec<String> = whole.lines().map(str::to_owned).collect();
    let (start, _) = rows[99].rsplit_once(',').unwrap();
    rows[99] = format!("{start},NaN");
    std::fs::write(file(folder.root(), "r6.csv"), rows.join("\n")).unwrap();
    folder
}

fn file(folder: &Path, name: &str) -> String {
    folder.join(name).to_str().unwrap().to_owned()
}

fn rows_of(path: &str) -> Vec<Row> {
    let reader = SerializedFileReader::new(std::fs::File::open(path).unwrap()).unwrap();
    let rows = reader.get_row_iter(None).unwrap();
    rows.map(Result::unwrap).collect()
}

/// A cell as JSON.
fn cell(row: &Row, name: &str) -> Value {
    let mut columns = row.get_column_iter();
    let (_, field) = columns.find(|(own, _)| *own == name).unwrap();
    of(field)
}

fn of(field: &Field) -> Value {
    match field {
        Field::Null => Value::Null,
        Field::Str(text) => text.as_str().into(),
        Field::Long(number) => (*number).into(),
        Field::Double(number) => (*number).into(),
        Field::ListInternal(list) => list.elements().iter().map(of).collect(),
        other => panic!("{other:?}"),
    }
}

/// As `friction@x`, of what `identify --json` prints.
fn mechanisms(report: &Value) -> Value {
    let of = |lack: &Value, key: &str| lack[key].as_str().unwrap().to_owned();
    let lacks = report["lacks"].as_array().unwrap().iter();
    let names = lacks.map(|lack| format!("{}@{}", of(lack, "mechanism"), of(lack, "channel")));
    names.collect()
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn each_record_is_a_row_with_what_close_says_of_it_alone_or_with_its_error() {
    let folder = folder();
    let out = file(folder.root(), "rows.parquet");
    let pattern = file(folder.root(), "r*.csv");
    let asked = ["--baseline", "bouc-wen", "--cutoff", "6"];
    let glob = [
        "identify",
        "--glob",
        &pattern,
        "--out",
        &out,
        "--workers",
        "1",
    ];
    let words = said(&[&glob, &asked[..]].concat());
    assert_eq!(
        words,
        format!("{out}: 6 rows, one per record; 2 records could not be identified\n")
    );
    let rows = rows_of(&out);
    assert_eq!(rows.len(), 6);
    for (index, row) in rows.iter().enumerate().take(4) {
        let path = file(folder.root(), &format!("r{}.csv", index + 1));
        let alone = said(&[&["identify", &path, "--json"], &asked[..]].concat());
        let alone: Value = serde_json::from_str(&alone).unwrap();
        let each = |list: &Value, name: &str| -> Value {
            let list = list.as_array().unwrap();
            list.iter().map(|own| own[name].clone()).collect()
        };
        assert_eq!(cell(row, "file"), path.as_str());
        assert_eq!(cell(row, "status"), "ok");
        let verdict = cell(row, "verdict");
        assert!(!verdict.is_null() && verdict == alone["verdict"]);
        assert_eq!(cell(row, "mechanisms"), mechanisms(&alone));
        assert_eq!(cell(row, "names"), each(&alone["terms"], "effect"));
        let confidences = each(&alone["terms"], "confidence");
        assert_eq!(cell(row, "confidences"), confidences);
        let fitted = &alone["final"]["parameters"];
        assert!(fitted.as_array().unwrap().len() > 5);
        for (column, name) in [
            ("parameters", "name"),
            ("values", "value"),
            ("units", "unit"),
        ] {
            assert_eq!(cell(row, column), each(fitted, name), "{column}");
        }
        let error = &alone["baseline"]["rmse"]["held_out"];
        assert_eq!(cell(row, "baseline_held_out"), *error);
        assert_eq!(
            cell(row, "final_held_out"),
            alone["final"]["rmse"]["held_out"]
        );
        assert!(cell(row, "floor").as_f64().unwrap() > 0.0);
        for name in ["evaluations", "jacobians", "columns_filtered", "searches"] {
            assert_eq!(cell(row, name), alone["cost"][name], "{name}");
        }
    }
    // What `identify` says of them, in its words.
    for (index, line) in [(4, Value::Null), (5, 100.into())] {
        let path = file(folder.root(), &format!("r{}.csv", index + 1));
        let alone = refused(&["identify", &path]);
        let row = &rows[index];
        assert_eq!(cell(row, "status"), "error");
        let error = cell(row, "error");
        assert_eq!(format!("bowden: {}", error.as_str().unwrap()), alone);
        assert!(cell(row, "line").is_number());
        assert!(line.is_null() || cell(row, "line") == line);
        assert_eq!(cell(row, "column").is_null(), line.is_null());
        assert!(cell(row, "verdict").is_null() && cell(row, "names").is_null());
    }
    // Side by side the bytes are the same.
    let before = std::fs::read(&out).unwrap();
    let glob = [
        "identify",
        "--glob",
        &pattern,
        "--out",
        &out,
        "--workers",
        "3",
    ];
    said(&[&glob, &asked[..]].concat());
    assert_eq!(std::fs::read(&out).unwrap(), before);
}

#[test]
fn a_process_that_dies_is_the_row_of_its_record() {
    let folder = folder();
    let out = file(folder.root(), "rows.parquet");
    // Without memory for more than the program itself a process is ended by the system.
    let mut limited = std::process::Command::new("sh");
    let script = "ulimit -v 40000; exec \"$0\" \"$@\"";
    limited.args([
        "-c",
        script,
        env!("CARGO_BIN_EXE_bowden"),
        "identify",
        "--glob",
    ]);
    limited.args([
        &file(folder.root(), "r[12].csv"),
        "--out",
        &out,
        "--workers",
        "1",
    ]);
    let Ok(ended) = limited.output() else {
        println!("skipped: no sh");
        return;
    };
    if !ended.status.success() {
        println!("skipped: no such limit here, or it ends the first process too: {ended:?}");
        return;
    }
    let rows = rows_of(&out);
    assert_eq!(rows.len(), 2);
    for row in rows {
        assert_eq!(row.get_string(1).unwrap(), "error", "{row}");
        assert!(row.get_string(2).unwrap().contains("signal"), "{row}");
    }
}

#[test]
fn bad_use_of_glob_leaves_the_rows_of_before() {
    let folder = folder();
    let out = file(folder.root(), "rows.parquet");
    std::fs::write(&out, "rows of before").unwrap();
    let none = file(folder.root(), "q*.csv");
    assert_eq!(
        refused(&["identify", "--glob", &none, "--out", &out]),
        format!("bowden: {none}: no file matches this pattern")
    );
    let pattern = file(folder.root(), "r*.csv");
    let record = file(folder.root(), "r1.csv");
    let line = refused(&["identify", "--glob", &pattern, "--out", &record]);
    assert!(
        line.ends_with(&format!("this would overwrite {record}, which is an input")),
        "{line}"
    );
    let line = refused(&["identify", "--glob", &pattern, "--out", &out, "--cutoff=-1"]);
    assert!(line.contains("`--cutoff -1` is out of range"), "{line}");
    for more in [["--json", "--invertible"], ["--max-terms", "1"]] {
        let ended = crate::shell::bowden(&[&["identify", "--glob", &pattern], &more[..]].concat());
        assert_eq!(ended.status.code(), Some(2));
    }
    assert_eq!(std::fs::read_to_string(&out).unwrap(), "rows of before");
}

#[test]
fn an_option_of_glob_without_it_is_refused_and_not_passed_over() {
    let folder = Folder::new();
    let out = file(folder.root(), "model.toml");
    // A record that is not there would be complained of first if it were read first.
    let record = file(folder.root(), "later.csv");
    for asked in [
        &["identify"][..],
        &["identify", &record],
        &["identify", "--json"],
    ] {
        let line = refused(&[asked, &["--out", &out]].concat());
        assert_eq!(
            line,
            format!(
                "bowden: --out {out} needs --glob; to write the model, use --model-out FILE.toml"
            )
        );
        let line = refused(&[asked, &["--workers", "3"]].concat());
        assert!(line.contains("--workers 3 needs --glob"), "{line}");
        refused(&[asked, &["--out", &out, "--workers", "3"]].concat());
    }
    assert!(!Path::new(&out).exists());
}
