//! Every form of one record gives the same answer.

use crate::reading::record::{
    csv, foreign, german, gzip, latin_1, ndjson, rows, utf_16, values, NAMES,
};
use crate::shell::{has, json, refused, refuses_all, said, without_seconds, Folder};
use bowden_lab::facts::{Asked, Mode, Options, Record};
use serde_json::Value;
use std::path::Path;

/// The JSON of `identify` but for seconds, path and notes, and the notes.
fn closed(path: &str) -> (String, String) {
    let json = said(&format!("identify {path} --json"));
    let json = without_seconds(json.as_bytes()).replace(&format!("{path:?}"), "PATH");
    let (before, rest) = json.split_once("\"notes\":[").unwrap();
    let (notes, after) = rest.split_once(']').unwrap();
    (format!("{before}{after}"), notes.to_owned())
}

#[test]
fn every_form_gives_the_same_answer_to_the_byte() {
    let folder = Folder::new();
    let (plain, no_notes) = closed(&folder.file("plain.csv", csv()));
    assert!(plain.contains("\"verdict\":") && no_notes.is_empty());
    let marked = format!("\u{feff}{}", german());
    let packed = gzip(&std::fs::read(foreign("vectors.mat")).unwrap());
    let written = [
        ("excel.csv", latin_1(&german()), "Windows-1252"),
        ("excel.txt", utf_16(&german()), "UTF-16LE"),
        ("utf_8.csv", marked.into_bytes(), "decimal comma"),
        ("utf_16.csv", utf_16(&csv()), "UTF-16LE"),
        (
            "packed.csv.gz",
            gzip(csv().as_bytes()),
            "gzip file unpacked",
        ),
        ("log.ndjson", ndjson().into_bytes(), ""),
        ("vectors.mat.gz", packed, "gzip file unpacked"),
    ];
    let written = written.map(|(name, bytes, note)| (folder.file(name, bytes), note));
    let foreign = "vectors.mat vectors_7_3.mat snappy.parquet vectors.npz vectors.xlsx";
    let foreign = foreign
        .split(' ')
        .map(|name| (super::record::foreign(name), ""));
    for (path, note) in written.into_iter().chain(foreign) {
        let (answer, notes) = closed(&path);
        assert!(answer == plain, "{path}: {answer}\n{plain}");
        assert!(notes.contains(note), "{path}: {notes}");
    }
}

#[test]
fn a_spreadsheet_says_what_was_done_to_it() {
    let folder = Folder::new();
    let path = folder.file("excel.csv", latin_1(&german()));
    let text = said(&format!("identify {path} --max-terms 0"));
    for note in [
        "text encoding: Windows-1252 (Latin-1)",
        "lines 1–4 above the names ignored",
        "units from line 6",
        "decimal commas were read",
        "columns not read: `Öltemperatur`, `Prüfer`",
        "lines 2567–2569 below the table ignored",
    ] {
        has(&text, &[note]);
    }
}

#[test]
fn an_option_gives_a_unit_and_a_segment() {
    let folder = Folder::new();
    let slow: Vec<[f64; 4]> = rows()
        .into_iter()
        .map(|[t, x, f, l]| [1e3 * t, x, f, l])
        .collect();
    let segment = format!("tick,x,f,load\n{}", values(&slow, ","));
    let path = folder.file("twice.csv", segment.repeat(2));
    let asked = ["identify", &path, "--time", "tick [ms]"];
    let place = format!("bowden: {path}:2562: column `tick`: the file contains two records: ");
    let why = "the column names are repeated, and the time jumps back from 9.99609375 to 0 s; ";
    let what = "--segment N reads one of 2 segments (segment 2 begins here)";
    assert_eq!(refused(&asked), format!("{place}{why}{what}"));
    let rest = ["--segment", "2", "--max-terms", "0", "--json"];
    let json = json(&[&asked[..], &rest].concat());
    assert_eq!(json["record"]["samples"], 2560);
    let unit = "unit of `tick` from --time: ms";
    let segment = "segment 2 of 2, with its names in line 2562";
    has(
        &json["notes"].to_string(),
        &[segment, unit, "time converted from ms to s"],
    );
}

#[test]
fn rows_that_are_left_out_are_counted_in_the_ledger_and_in_the_json() {
    let folder = Folder::new();
    let mut lines: Vec<String> = csv().lines().map(str::to_owned).collect();
    lines[700] = format!("{},NaN,1,1", 699.0 / 256.0);
    lines[800] = format!("{},,1,1", 799.0 / 256.0);
    lines[900] = lines[899].clone();
    let path = folder.file("bad.csv", lines.join("\n"));
    let asked = format!("identify {path} --drop-bad --max-terms 0");
    let kinds = "1 with an empty cell, 1 with NaN, 1 with a repeated time stamp";
    let note = format!("--drop-bad dropped 3 rows: {kinds}");
    has(&said(&asked), &[&note]);
    let json = json(&format!("{asked} --json"));
    assert_eq!(json["record"]["dropped"], 3);
    assert_eq!(json["record"]["samples"], 2557);
    assert_eq!(json["notes"][0], note);
    assert_eq!(json["defects"][0]["kind"], "gap");
}

fn read(name: &str, options: Options) -> Record {
    let asked = Asked {
        options,
        ..Asked::default()
    };
    asked.read(Path::new(&foreign(name))).unwrap()
}

/// A column of what the foreign files hold.
fn column(index: usize) -> Vec<f64> {
    rows()[..240].iter().map(|row| row[index]).collect()
}

#[test]
fn each_shape_of_a_mat_file_and_each_compression_of_parquet_holds_the_same_columns() {
    let mat = "structure.mat cells.mat letters.mat trace.mat structure_7_3.mat cells_7_3.mat trace_7_3.mat";
    let others =
        "matrix.npz structured.npz structured.npy matrix.npy none.parquet gzip.parquet lz4.parquet";
    for name in mat.split(' ').chain(others.split(' ')) {
        let names = match name {
            "matrix.npy" => NAMES.map(str::to_owned).to_vec(),
            _ => Vec::new(),
        };
        let options = Options {
            names,
            ..Options::default()
        };
        let record = read(name, options);
        assert_eq!(record.time, column(0), "{name}");
        assert_eq!(record.input.values, column(1), "{name}");
        assert_eq!(record.output.values, column(2), "{name}");
        assert_eq!(record.channel("load").unwrap().values, column(3), "{name}");
        assert_eq!(record.output.unit.as_deref(), Some("N"), "{name}");
    }
}

#[test]
fn columns_without_names_fields_types_stamps_and_nulls_are_read_as_they_were_written() {
    let in_mode = || Options {
        mode: Some(Mode::Displacement),
        ..Options::default()
    };
    let values = |record: &Record, name: &str| record.channel(name).unwrap().values.clone();
    // Columns of a matrix without names, as MATLAB writes them.
    let [time, input, output] = [1, 2, 3].map(|index| Some(format!("data(:,{index})")));
    let options = Options {
        time,
        input,
        output,
        ..in_mode()
    };
    assert_eq!(read("nameless.mat", options).output.values, column(2));
    // A field by its whole name.
    let own = |name: &str| (name.to_owned(), name.to_owned());
    let options = Options {
        input: Some("x_mm".into()),
        output: Some("run.f_N".into()),
        channels: vec![own("count")],
        ..in_mode()
    };
    for name in ["structure.mat", "structure_7_3.mat"] {
        let record = read(name, options.clone());
        assert_eq!(record.output.values, column(2));
        assert_eq!(values(&record, "count")[239], 239.0);
    }
    // Single precision in chunks with a checksum, and truths, of version 7.3.
    let options = Options {
        channels: vec![own("single"), own("moves")],
        ..Options::default()
    };
    let record = read("structure_7_3.mat", options);
    let singles = column(1).into_iter().map(|v| f64::from(v as f32));
    assert_eq!(values(&record, "single"), singles.collect::<Vec<_>>());
    let moves = column(2).into_iter().map(|f| f64::from(u8::from(f > 0.0)));
    assert_eq!(values(&record, "moves"), moves.collect::<Vec<_>>());
    // Points in time in µs, single precision, unsigned integers.
    let record = read("stamps.parquet", Options::default());
    let mut times = record.time.iter().zip(column(0));
    // The file rounds to whole microseconds.
    assert!(times.all(|(a, b)| (a - b).abs() <= 1e-6));
    assert_eq!(record.input.values, column(1));
    assert_eq!(values(&record, "load")[239], 239.0);
    // Nulls are empty cells.
    let options = Options {
        drop_bad: true,
        ..Options::default()
    };
    let record = read("null.parquet", options);
    assert_eq!((record.samples(), record.dropped), (239, 1));
}

/// The paths of the records that a pattern stands for.
fn matched(pattern: &str) -> Vec<String> {
    let json = json(&format!("identify {pattern} --max-terms 0 --json"));
    let path = |part: &Value| part["path"].as_str().unwrap().to_owned();
    match json["records"].as_array() {
        Some(all) if !all.is_empty() => all.iter().map(path).collect(),
        _ => vec![path(&json["record"])],
    }
}

#[test]
fn a_pattern_reads_as_in_a_shell() {
    let folder = Folder::new();
    for below in ["a/b", "a/.c", ".d"] {
        std::fs::create_dir_all(folder.path(below)).unwrap();
    }
    let text = csv();
    let lines: Vec<&str> = text.lines().collect();
    for (index, name) in ["a/2.csv", "1.csv", "a/b/3.csv"].iter().enumerate() {
        // Each of its own: the same samples twice are refused.
        folder.file(name, lines[..lines.len() - index].join("\n"));
    }
    for hidden in [".0.csv", "a/.c/0.csv", ".d/0.csv", "a/1.txt"] {
        folder.file(hidden, "not a record");
    }
    for (pattern, names) in [
        ("?.csv", "1.csv"),
        ("*/[2-3].csv", "a/2.csv"),
        ("*/../[!a].csv", "a/../1.csv"),
        ("**/*.csv", "1.csv a/2.csv a/b/3.csv"),
    ] {
        let names: Vec<String> = names.split(' ').map(|name| folder.path(name)).collect();
        assert_eq!(matched(&folder.path(pattern)), names, "{pattern}");
    }
    let none = "no file matches this pattern";
    refuses_all(
        &folder,
        &format!(
            "identify */ => bowden: */: {none}
            identify 1.csv/* => bowden: 1.csv/*: {none}
            identify *.dat => bowden: *.dat: {none}
            identify [ => bowden: [: invalid pattern: invalid range pattern
            power **/*.csv => 3 files match this pattern; exactly one must match"
        ),
    );
    // A file that has the very name is no pattern.
    let own = folder.file("run[1].csv", csv());
    assert_eq!(matched(&own), [own]);
}

/// What a stranger's program has left beside the records.
#[cfg(unix)]
#[test]
fn a_name_that_is_not_utf8_is_matched_as_any_other() {
    use std::os::unix::ffi::OsStrExt as _;
    let folder = Folder::new();
    let foreign = |name: &[u8]| folder.root().join(std::ffi::OsStr::from_bytes(name));
    std::fs::write(foreign(b"caf\xe9.txt"), "").unwrap();
    std::fs::create_dir(foreign(b"\xe9")).unwrap();
    std::fs::write(foreign(b"\xe9/lat\xe9.csv"), csv()).unwrap();
    folder.file("ok.csv", csv());
    for pattern in ["*.csv", "?/*.csv"] {
        matched(&folder.path(pattern));
    }
}

#[test]
fn every_command_that_reads_a_record_reads_every_form_with_the_same_options() {
    let folder = Folder::new();
    let model = folder.path("model.toml");
    let text = format!("a,b,c,d\n{}\n{}", NAMES.join(","), values(&rows(), ","));
    let text = text.replace("load_N", "load_in_mm");
    let mut bad: Vec<&str> = text.lines().collect();
    bad[898] = "3.5,,1,1";
    let path = folder.file("r.csv.gz", gzip(bad.join("\n").as_bytes()));
    let options = "--header-line 2 --drop-bad --channel stretch=x_mm-load_in_mm";
    let close = format!("identify {path} --max-terms 0 --model-out {model} {options}");
    has(&said(&close), &["channels stretch"]);
    said(&format!("validate {model} {path} {options}"));
    said(&format!("plan {path} --max-terms 0 {options}"));
    let power = format!("power {path} --max-terms 0 --trials 5 --effects offset");
    said(&format!("{power} {options}"));
}
