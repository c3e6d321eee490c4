//! `bowden identify --glob`: one row a record, read back with another reader than the writer's.

use crate::shell::{bowden_in, has, json, refused, refuses_all, said, Folder};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Field, Row};
use serde_json::Value;

/// Four generated records, and two that cannot be closed: one is cut off within a row, one
/// has a NaN.
fn folder() -> Folder {
    let folder = Folder::new();
    for seed in 1..=4 {
        let options = format!("--seed {seed} --effect viscous --seconds 10 --rate 400");
        folder.record(&format!("r{seed}.csv"), &options);
    }
    let whole = folder.read("r1.csv");
    folder.file("r5.csv", &whole[..5000]);
    let mut rows: Vec<String> = whole.lines().map(str::to_owned).collect();
    let (start, _) = rows[99].rsplit_once(',').unwrap();
    rows[99] = format!("{start},NaN");
    folder.file("r6.csv", rows.join("\n"));
    folder
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

/// The row of a record has what `identify --json` prints of it.
fn assert_row(row: &Row, path: &str, alone: &Value) {
    let each = |list: &Value, of: &dyn Fn(&Value) -> Value| -> Value {
        list.as_array().unwrap().iter().map(of).collect()
    };
    let named = |list: &Value, name: &str| each(list, &|own| own[name].clone());
    let mechanism = |lack: &Value| -> Value {
        let [name, channel] = ["mechanism", "channel"].map(|key| lack[key].as_str().unwrap());
        format!("{name}@{channel}").into()
    };
    let (terms, fitted) = (&alone["terms"], &alone["final"]["parameters"]);
    assert!(fitted.as_array().unwrap().len() > 5);
    assert!(!alone["verdict"].is_null());
    for (column, expected) in [
        ("file", path.into()),
        ("status", "ok".into()),
        ("verdict", alone["verdict"].clone()),
        ("mechanisms", each(&alone["lacks"], &mechanism)),
        ("names", named(terms, "effect")),
        ("confidences", named(terms, "confidence")),
        ("parameters", named(fitted, "name")),
        ("values", named(fitted, "value")),
        ("units", named(fitted, "unit")),
        (
            "baseline_held_out",
            alone["baseline"]["rmse"]["held_out"].clone(),
        ),
        ("final_held_out", alone["final"]["rmse"]["held_out"].clone()),
    ] {
        assert_eq!(cell(row, column), expected, "{column}");
    }
    assert!(cell(row, "floor").as_f64().unwrap() > 0.0);
    for name in ["evaluations", "jacobians", "columns_filtered", "searches"] {
        assert_eq!(cell(row, name), alone["cost"][name], "{name}");
    }
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn each_record_is_a_row_with_what_close_says_of_it_alone_or_with_its_error() {
    let folder = folder();
    let (out, pattern) = (folder.path("rows.parquet"), folder.path("r*.csv"));
    let asked = "--baseline bouc-wen --cutoff 6";
    let glob = format!("identify --glob {pattern} --out {out} {asked}");
    let words = said(&format!("{glob} --workers 1"));
    let counts = "6 rows, one per record; 2 records could not be identified";
    assert_eq!(words, format!("{out}: {counts}\n"));
    let rows = rows_of(&out);
    assert_eq!(rows.len(), 6);
    let path = |index: usize| folder.path(&format!("r{}.csv", index + 1));
    for (index, row) in rows.iter().enumerate().take(4) {
        let alone = json(&format!("identify {} --json {asked}", path(index)));
        assert_row(row, &path(index), &alone);
    }
    // What `identify` says of them, in its words.
    for (index, line) in [(4, Value::Null), (5, 100.into())] {
        let (row, alone) = (&rows[index], refused(&format!("identify {}", path(index))));
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
    said(&format!("{glob} --workers 3"));
    assert_eq!(std::fs::read(&out).unwrap(), before);
}

#[test]
fn a_process_that_dies_is_the_row_of_its_record() {
    let folder = folder();
    let (out, pattern) = (folder.path("rows.parquet"), folder.path("r[12].csv"));
    // Without memory for more than the program itself a process is ended by the system.
    let mut limited = std::process::Command::new("sh");
    let script = "ulimit -v 40000; exec \"$0\" \"$@\"";
    limited.args(["-c", script, env!("CARGO_BIN_EXE_bowden")]);
    limited.args([
        "identify",
        "--glob",
        &pattern,
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
        assert_eq!(cell(&row, "status"), "error", "{row}");
        has(cell(&row, "error").as_str().unwrap(), &["signal"]);
    }
}

#[test]
fn bad_use_of_glob_leaves_the_rows_of_before() {
    let folder = folder();
    folder.file("rows.parquet", "rows of before");
    // An option of glob without it is no option. A record that is not there, later.csv, would be
    // complained of first if it were read first.
    let to_write = "needs --glob; to write the model, use --model-out FILE.toml";
    refuses_all(
        &folder,
        &format!(
            "identify --glob q*.csv --out rows.parquet => bowden: q*.csv: no file matches this pattern
            identify --glob r*.csv --out r1.csv => this would overwrite r1.csv, which is an input
            identify --glob r*.csv --out rows.parquet --cutoff=-1 => `--cutoff -1` is out of range
            identify --out rows.parquet => {to_write}
            identify later.csv --out rows.parquet => {to_write}
            identify --json --out rows.parquet => {to_write}
            identify later.csv --workers 3 => --workers 3 needs --glob
            identify --out rows.parquet --workers 3 => --glob"
        ),
    );
    for more in ["--json --invertible", "--max-terms 1"] {
        let ended = bowden_in(&folder, &format!("identify --glob r*.csv {more}"));
        assert_eq!(ended.status.code(), Some(2));
    }
    assert_eq!(folder.read("rows.parquet"), "rows of before");
}
