//! Each kind of file that cannot be read gets one line and exit status 2.

use crate::reading::record::{csv, foreign, gzip};
use crate::shell::{refused, Folder};
use bowden_lab::facts::Asked;

/// The line behind the file's name.
fn line(path: &str, options: &[&str]) -> String {
    let line = refused(&[&["identify", path], options].concat());
    let own = line.strip_prefix(&format!("bowden: {path}"));
    own.unwrap_or_else(|| panic!("{line}")).to_owned()
}

#[test]
fn a_form_that_is_not_read_is_named_with_what_to_do_instead() {
    let folder = Folder::new();
    let text = csv();
    for (name, magic, says) in [
        (
            "r.zip",
            b"PK\x03\x04".as_slice(),
            "without an Excel workbook",
        ),
        (
            "r.xls",
            b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
            "save the sheet as CSV",
        ),
        ("r.pdf", b"%PDF-1.7", "is a PDF"),
        ("r.tdms", b"TDSm\0\0", "TDMS"),
        ("r.csv.zst", b"\x28\xb5\x2f\xfd", "zstd -d"),
        ("r.h5", b"\x89HDF\r\n\x1a\n", "HDF5"),
    ] {
        let path = folder.file(name, [magic, text.as_bytes()].concat());
        let line = line(&path, &[]);
        assert!(
            line.starts_with(": the file is ") && line.contains(says),
            "{line}"
        );
    }
    // A header with nothing behind it; what the rest says is the crate's that reads HDF5.
    let v7_3 = [b"MATLAB 7.3 MAT-file".as_slice(), &[b' '; 493]].concat();
    let line_of = line(&folder.file("r.mat", v7_3), &[]);
    assert!(
        line_of.starts_with(": the file is damaged or has unsupported content: ")
            && line_of.ends_with("; save it in MATLAB with `save -v7`"),
        "{line_of}"
    );
    let v4 = foreign("version_4.mat").display().to_string();
    assert_eq!(
        line(&v4, &[]),
        ": the file is a MATLAB file of version 4, which bowden does not read; save it in MATLAB with `save -v7`"
    );
}

#[test]
fn a_damaged_file_is_refused() {
    let folder = Folder::new();
    let packed = gzip(csv().as_bytes());
    let short = line(&folder.file("short.gz", &packed[..packed.len() / 2]), &[]);
    assert!(short.starts_with(": the gzip file is damaged: "), "{short}");
    let twice = line(&folder.file("twice.gz", gzip(&packed)), &[]);
    assert_eq!(
        twice,
        ": the file is compressed with gzip twice; unpack it once"
    );
    for name in [
        "vectors.mat",
        "structure.mat",
        "vectors_7_3.mat",
        "structure_7_3.mat",
        "snappy.parquet",
        "vectors.xlsx",
        "structured.npy",
    ] {
        let bytes = std::fs::read(foreign(name)).unwrap();
        let path = folder.file(name, &bytes[..bytes.len() / 2]);
        let line = line(&path, &[]);
        assert!(line.contains(" file is damaged"), "{name}: {line}");
    }
}

#[test]
fn no_damage_to_a_foreign_file_does_more_than_a_refusal() {
    let asked = Asked::default();
    let mut seed = 1_u64;
    let mut draw = |below: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 33) as usize % below
    };
    for name in [
        "structure.mat",
        "cells.mat",
        "trace.mat",
        "vectors_7_3.mat",
        "structure_7_3.mat",
        "cells_7_3.mat",
        "trace_7_3.mat",
        "gzip.parquet",
        "null.parquet",
        "tiny.xlsx",
        "structured.npy",
    ] {
        let whole = std::fs::read(foreign(name)).unwrap();
        for _ in 0..200 {
            let mut bytes = whole.clone();
            for _ in 0..=draw(3) {
                let at = draw(bytes.len());
                bytes[at] = draw(256) as u8;
            }
            if draw(4) == 0 {
                bytes.truncate(draw(bytes.len()));
            }
            if let Err(line) = asked.read_text(&bytes, name) {
                assert!(line.starts_with(&format!("{name}:")), "{line}");
                assert!(!line.contains(char::is_control), "{line}");
            }
        }
    }
}

#[test]
fn what_a_foreign_file_lacks_is_said_with_the_column() {
    let foreign =
        |name: &str, options: &[&str]| line(&foreign(name).display().to_string(), options);
    assert_eq!(
        foreign("words.mat", &[]),
        ": no vector of real numbers among the variables `who`, `rate`; each column must be one vector, on its own or as a field of a structure"
    );
    assert_eq!(
        foreign("lengths.mat", &[]),
        ": column `f`: the column has 239 values, but it must have 240, as `t` does"
    );
    for name in ["complex.mat", "complex_7_3.mat"] {
        let line = foreign(name, &[]);
        assert!(
            line.starts_with(": column `x`: no such column; the columns are "),
            "{name}: {line}"
        );
    }
    assert_eq!(
        foreign("vectors.mat", &["--header-line", "2"]),
        ": --header-line 2: the file has no lines, and its columns already have names"
    );
    assert_eq!(
        foreign("words.parquet", &[]),
        ": the file has no numeric column; each quantity must have one"
    );
    for codec in ["zstd", "brotli"] {
        assert_eq!(
            foreign(&format!("{codec}.parquet"), &[]),
            format!(
                ": column `t`: the column is compressed with {codec}, which bowden does not read; write the file with snappy or gzip"
            )
        );
    }
    assert_eq!(
        foreign("null.parquet", &[]),
        ":100: column `x`: the cell is empty, but it must be a number; --drop-bad drops such rows"
    );
}

#[test]
fn text_that_could_be_read_in_two_ways_is_refused_with_line_and_column() {
    let folder = Folder::new();
    let refuses = |text: String, options: &[&str], expected: &str| {
        assert_eq!(line(&folder.file("r.csv", text), options), expected);
    };
    let comma = csv().replace(',', ";").replace('.', ",");
    refuses(
        comma.replacen("\n1,5;", "\n1.5;", 1),
        &[],
        ":386: column `t`: `1.5` has a decimal point; write a decimal comma, as in line 2",
    );
    refuses(
        csv().replacen("\n1.5,", "\n1,5,", 1),
        &[],
        ":386: the row has 5 cells, but the header has 4",
    );
    refuses(
        csv(),
        &["--header-line", "9999"],
        ": --header-line 9999: the file has only 2561 lines",
    );
    refuses(
        csv(),
        &["--channel", "stretch=x_mm-load_N"],
        ":1: column `load_N`: the column has unit N, but it must have unit mm, as `x_mm` has, so that the two can be added or subtracted",
    );
    refuses(
        csv()
            .replacen("\n1.5,", "\n1.5,NaN,", 1)
            .replacen("t,", "t,extra,", 1),
        &[],
        ":2: the row has 4 cells, but the header has 5",
    );
}

#[test]
fn a_pattern_without_files_or_with_several_is_refused() {
    let folder = Folder::new();
    let none = folder.path("*.csv");
    assert_eq!(line(&none, &[]), ": no file matches this pattern");
    folder.file("a.csv", csv());
    folder.file("b.csv", csv());
    let line = refused(&["power", &none]);
    assert!(
        line.ends_with("2 files match this pattern; exactly one must match"),
        "{line}"
    );
}
