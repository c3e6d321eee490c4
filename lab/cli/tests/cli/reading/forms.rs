//! Every form of one record gives the same answer.

use crate::reading::record::{
    csv, foreign, german, gzip, latin_1, ndjson, rows, utf_16, values, NAMES,
};
use crate::shell::{args, refused, said, without_seconds, Folder};
use bowden_lab::facts::{Asked, Options, Record};
use std::path::Path;

/// The JSON of `identify` but for seconds, path and notes, and the notes.
fn closed(path: &str, options: &[&str]) -> (String, String) {
    let json = said(&[&["identify", path, "--json"], options].concat());
    let json = without_seconds(json.as_bytes()).replace(&format!("{path:?}"), "PATH");
    let (before, rest) = json.split_once("\"notes\":[").unwrap();
    let (notes, after) = rest.split_once(']').unwrap();
    (format!("{before}{after}"), notes.to_owned())
}

#[test]
fn every_form_gives_the_same_answer_to_the_byte() {
    let folder = Folder::new();
    let plain = closed(&folder.file("plain.csv", csv()), &[]);
    assert!(plain.0.contains("\"verdict\":") && plain.1.is_empty());
    let packed = gzip(csv().as_bytes());
    for (path, note) in [
        (folder.file("excel.csv", latin_1(&german())), "Windows-1252"),
        (folder.file("excel.txt", utf_16(&german())), "UTF-16LE"),
        (
            folder.file("utf_8.csv", format!("\u{feff}{}", german())),
            "decimal comma",
        ),
        (folder.file("utf_16.csv", utf_16(&csv())), "UTF-16LE"),
        (folder.file("packed.csv.gz", packed), "gzip file unpacked"),
        (foreign("vectors.mat").display().to_string(), ""),
        (foreign("vectors_7_3.mat").display().to_string(), ""),
        (foreign("snappy.parquet").display().to_string(), ""),
        (foreign("vectors.npz").display().to_string(), ""),
        (foreign("vectors.xlsx").display().to_string(), ""),
        (folder.file("log.ndjson", ndjson()), ""),
        (
            folder.file(
                "vectors.mat.gz",
                gzip(&std::fs::read(foreign("vectors.mat")).unwrap()),
            ),
            "gzip file unpacked",
        ),
    ] {
        let (answer, notes) = closed(&path, &[]);
        assert!(answer == plain.0, "{path}: {answer}\n{}", plain.0);
        assert!(notes.contains(note), "{path}: {notes}");
    }
}

#[test]
fn a_spreadsheet_says_what_was_done_to_it() {
    let folder = Folder::new();
    let path = folder.file("excel.csv", latin_1(&german()));
    let text = said(&["identify", &path, "--max-terms", "0"]);
    for note in [
        "text encoding: Windows-1252 (Latin-1)",
        "lines 1–4 above the names ignored",
        "units from line 6",
        "decimal commas were read",
        "columns not read: `Öltemperatur`, `Prüfer`",
        "lines 2567–2569 below the table ignored",
    ] {
        assert!(text.contains(note), "{note} is not in\n{text}");
    }
}

#[test]
fn an_option_gives_a_unit_and_a_segment() {
    let folder = Folder::new();
    let rows = rows();
    let slow: Vec<[f64; 4]> = rows
        .iter()
        .map(|[t, x, f, load]| [1e3 * t, *x, *f, *load])
        .collect();
    let segment = format!("tick,x,f,load\n{}", values(&slow, ","));
    let path = folder.file("twice.csv", [segment.as_str(), &segment].concat());
    let line = refused(&["identify", &path, "--time", "tick [ms]"]);
    let place = format!("{path}:2562: column `tick`: ");
    assert_eq!(
        line,
        format!("bowden: {place}the file contains two records: the column names are repeated, and the time jumps back from 9.99609375 to 0 s; --segment N reads one of 2 segments (segment 2 begins here)")
    );
    let text = said(&[
        "identify",
        &path,
        "--time",
        "tick [ms]",
        "--segment",
        "2",
        "--max-terms",
        "0",
        "--json",
    ]);
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["record"]["samples"], 2560);
    let notes = json["notes"].to_string();
    for note in [
        "segment 2 of 2, with its names in line 2562",
        "unit of `tick` from --time: ms",
        "time converted from ms to s",
    ] {
        assert!(notes.contains(note), "{notes}");
    }
}

#[test]
fn rows_that_are_left_out_are_counted_in_the_ledger_and_in_the_json() {
    let folder = Folder::new();
    let mut lines: Vec<String> = csv().lines().map(str::to_owned).collect();
    lines[700] = format!("{},NaN,1,1", 699.0 / 256.0);
    lines[800] = format!("{},,1,1", 799.0 / 256.0);
    lines[900] = lines[899].clone();
    let path = folder.file("bad.csv", lines.join("\n"));
    let text = said(&["identify", &path, "--drop-bad", "--max-terms", "0"]);
    let note =
        "--drop-bad dropped 3 rows: 1 with an empty cell, 1 with NaN, 1 with a repeated time stamp";
    assert!(text.contains(note), "{text}");
    let json = said(&args(&format!(
        "identify {path} --drop-bad --max-terms 0 --json"
    )));
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["record"]["dropped"], 3);
    assert_eq!(json["record"]["samples"], 2557);
    assert_eq!(json["notes"][0], note);
    assert_eq!(json["defects"][0]["kind"], "gap");
}

fn read(path: &Path, options: Options) -> Record {
    let asked = Asked {
        options,
        ..Asked::default()
    };
    asked.read(path).unwrap()
}

#[test]
fn each_shape_of_a_mat_file_and_each_compression_of_parquet_holds_the_same_columns() {
    let own = &rows()[..240];
    let column = |index: usize| own.iter().map(|row| row[index]).collect::<Vec<_>>();
    for name in [
        "structure.mat",
        "cells.mat",
        "letters.mat",
        "trace.mat",
        "structure_7_3.mat",
        "cells_7_3.mat",
        "trace_7_3.mat",
        "matrix.npz",
        "structured.npz",
        "structured.npy",
        "matrix.npy",
        "none.parquet",
        "gzip.parquet",
        "lz4.parquet",
    ] {
        let names = match name {
            "matrix.npy" => NAMES.map(str::to_owned).to_vec(),
            _ => Vec::new(),
        };
        let options = Options {
            names,
            ..Options::default()
        };
        let record = read(&foreign(name), options);
        assert_eq!(record.time, column(0), "{name}");
        assert_eq!(record.input.values, column(1), "{name}");
        assert_eq!(record.output.values, column(2), "{name}");
        assert_eq!(record.channel("load").unwrap().values, column(3), "{name}");
        assert_eq!(record.output.unit.as_deref(), Some("N"), "{name}");
    }
}

#[test]
fn columns_without_names_fields_types_stamps_and_nulls_are_read_as_they_were_written() {
    let own = &rows()[..240];
    let column = |index: usize| own.iter().map(|row| row[index]).collect::<Vec<_>>();
    // Columns of a matrix without names, as MATLAB writes them.
    let at = |index: usize| Some(format!("data(:,{index})"));
    let options = Options {
        mode: Some(bowden_lab::facts::Mode::Displacement),
        time: at(1),
        input: at(2),
        output: at(3),
        ..Options::default()
    };
    let record = read(&foreign("nameless.mat"), options);
    assert_eq!(record.output.values, column(2));
    // A field by its whole name.
    let options = Options {
        output: Some("run.f_N".into()),
        channels: vec![("count".into(), "count".into())],
        mode: Some(bowden_lab::facts::Mode::Displacement),
        input: Some("x_mm".into()),
        ..Options::default()
    };
    for name in ["structure.mat", "structure_7_3.mat"] {
        let record = read(&foreign(name), options.clone());
        assert_eq!(record.output.values, column(2));
        assert_eq!(record.channel("count").unwrap().values[239], 239.0);
    }
    // Single precision in chunks with a checksum, and truths, of version 7.3.
    let own = |name: &str| (name.to_owned(), name.to_owned());
    let options = Options {
        channels: vec![own("single"), own("moves")],
        ..Options::default()
    };
    let record = read(&foreign("structure_7_3.mat"), options);
    let single = |v: &f64| f64::from(*v as f32);
    let singles: Vec<f64> = column(1).iter().map(single).collect();
    assert_eq!(record.channel("single").unwrap().values, singles);
    let moves = column(2).into_iter().map(|f| f64::from(u8::from(f > 0.0)));
    let moves: Vec<f64> = moves.collect();
    assert_eq!(record.channel("moves").unwrap().values, moves);
    // Points in time in µs, single precision, unsigned integers.
    let record = read(&foreign("stamps.parquet"), Options::default());
    let apart = record
        .time
        .iter()
        .zip(column(0))
        .map(|(a, b)| (a - b).abs());
    // The file rounds to whole microseconds.
    assert!(apart.fold(0.0, f64::max) <= 1e-6);
    assert_eq!(record.input.values, column(1));
    assert_eq!(record.channel("load").unwrap().values[239], 239.0);
    // Nulls are empty cells.
    let options = Options {
        drop_bad: true,
        ..Options::default()
    };
    let record = read(&foreign("null.parquet"), options);
    assert_eq!((record.samples(), record.dropped), (239, 1));
}

#[test]
fn a_pattern_stands_for_its_files_by_name() {
    let folder = Folder::new();
    for name in ["b.csv", "a.csv", "c.txt"] {
        // Each of its own: the same samples twice are refused.
        let text = csv();
        let kept = text.lines().count() - usize::from(name.as_bytes()[0] - b'a');
        let lines: Vec<&str> = text.lines().take(kept).collect();
        folder.file(name, lines.join("\n"));
    }
    let json = said(&[
        "identify",
        &folder.path("*.csv"),
        "--max-terms",
        "0",
        "--json",
    ]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let path = |index: usize| json["records"][index]["path"].as_str().unwrap().to_owned();
    assert_eq!(path(0), folder.path("a.csv"));
    assert_eq!(path(1), folder.path("b.csv"));
    assert!(json["records"][2].is_null());
    // A file that has the very name is no pattern.
    let own = folder.file("run[1].csv", csv());
    said(&["identify", &own, "--max-terms", "0"]);
}

/// What a stranger's program has left beside the records.
#[cfg(unix)]
#[test]
fn a_name_that_is_not_utf8_is_matched_as_any_other() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt as _;
    let folder = Folder::new();
    folder.file("ok.csv", csv());
    let foreign = |name: &[u8]| Path::new(&folder.path("")).join(OsStr::from_bytes(name));
    std::fs::write(foreign(b"caf\xe9.txt"), "").unwrap();
    let close = ["identify", &folder.path("*.csv"), "--max-terms", "0"];
    said(&close);
    std::fs::create_dir(foreign(b"\xe9")).unwrap();
    std::fs::write(foreign(b"\xe9/lat\xe9.csv"), csv()).unwrap();
    let close = ["identify", &folder.path("?/*.csv"), "--max-terms", "0"];
    said(&close);
    let none = folder.path("*.dat");
    let line = refused(&["identify", &none]);
    assert_eq!(
        line,
        format!("bowden: {none}: no file matches this pattern")
    );
}

#[test]
fn a_pattern_reads_as_in_a_shell() {
    let folder = Folder::new();
    let root = Path::new(&folder.path("")).to_owned();
    for below in ["a/b", "a/.c", ".d"] {
        std::fs::create_dir_all(root.join(below)).unwrap();
    }
    for (index, name) in ["1.csv", "a/2.csv", "a/b/3.csv"].iter().enumerate() {
        let text = csv();
        let lines: Vec<&str> = text.lines().collect();
        folder.file(name, lines[..lines.len() - index].join("\n"));
    }
    for hidden in [".0.csv", "a/.c/0.csv", ".d/0.csv", "a/1.txt"] {
        folder.file(hidden, "not a record");
    }
    let read = |pattern: &str| -> Vec<String> {
        let json = said(&[
            "identify",
            &folder.path(pattern),
            "--max-terms",
            "0",
            "--json",
        ]);
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        let path = |part: &serde_json::Value| part["path"].as_str().unwrap().to_owned();
        match json["records"].as_array() {
            Some(all) if !all.is_empty() => all.iter().map(path).collect(),
            _ => vec![path(&json["record"])],
        }
    };
    let paths = |names: &[&str]| -> Vec<String> { names.iter().map(|n| folder.path(n)).collect() };
    assert_eq!(read("?.csv"), paths(&["1.csv"]));
    assert_eq!(read("*/[2-3].csv"), paths(&["a/2.csv"]));
    assert_eq!(read("*/../[!a].csv"), paths(&["a/../1.csv"]));
    assert_eq!(read("**/*.csv"), paths(&["1.csv", "a/2.csv", "a/b/3.csv"]));
    for (pattern, why) in [
        ("*/", "no file matches this pattern"),
        ("1.csv/*", "no file matches this pattern"),
        ("[", "invalid pattern: invalid range pattern"),
    ] {
        let path = folder.path(pattern);
        let line = refused(&["identify", &path]);
        assert!(
            line.starts_with(&format!("bowden: {path}: {why}")),
            "{line}"
        );
    }
}

#[test]
fn every_command_that_reads_a_record_reads_every_form_with_the_same_options() {
    let folder = Folder::new();
    let model = folder.path("model.toml");
    let preamble = format!("a,b,c,d\n{}\n{}", NAMES.join(","), values(&rows(), ","));
    let mut bad: Vec<String> = preamble
        .lines()
        .map(|line| line.replace("load_N", "load_in_mm"))
        .collect();
    bad[898] = "3.5,,1,1".to_owned();
    let path = folder.file("r.csv.gz", gzip(bad.join("\n").as_bytes()));
    let options = args("--header-line 2 --drop-bad --channel stretch=x_mm-load_in_mm");
    let close = ["identify", &path, "--max-terms", "0", "--model-out", &model];
    let text = said(&[&close[..], &options].concat());
    assert!(text.contains("channels stretch"), "{text}");
    for command in [
        &["validate", &model, &path][..],
        &["plan", &path, "--max-terms", "0"],
        &args(&format!(
            "power {path} --max-terms 0 --trials 5 --effects offset"
        )),
    ] {
        said(&[command, &options].concat());
    }
}
