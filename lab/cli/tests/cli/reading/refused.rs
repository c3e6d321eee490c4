//! Each kind of file that cannot be read gets one line and exit status 2. Each kind by itself is
//! tested where records are read, in `lab/record` and `lab/identify/tests/bad_records`.

use crate::reading::record::{csv, foreign, gzip};
use crate::shell::{refused, Folder};
use bowden_lab::facts::Asked;

/// The line behind the file's name.
fn line(path: &str, options: &str) -> String {
    let line = refused(&format!("identify {path} {options}"));
    let own = line.strip_prefix(&format!("bowden: {path}"));
    own.unwrap_or_else(|| panic!("{line}")).to_owned()
}

#[test]
fn a_form_that_is_not_read_or_is_damaged_is_named_with_what_to_do_instead() {
    let folder = Folder::new();
    let (text, packed) = (csv(), gzip(csv().as_bytes()));
    let v7_3 = [b"MATLAB 7.3 MAT-file".as_slice(), &[b' '; 493]].concat();
    for (name, bytes, begin, end) in [
        (
            "r.zip",
            [b"PK\x03\x04", text.as_bytes()].concat(),
            ": the file is ",
            "",
        ),
        ("r.pdf", b"%PDF-1.7".to_vec(), ": the file is a PDF", ""),
        // A header with nothing behind it; what the rest says is the crate's that reads HDF5.
        (
            "r.mat",
            v7_3,
            ": the file is damaged or has unsupported content: ",
            "; save it in MATLAB with `save -v7`",
        ),
        (
            "short.gz",
            packed[..packed.len() / 2].to_vec(),
            ": the gzip file is damaged: ",
            "",
        ),
        (
            "twice.gz",
            gzip(&packed),
            ": the file is compressed with gzip twice; unpack it once",
            "",
        ),
    ] {
        let line = line(&folder.file(name, bytes), "");
        assert!(line.starts_with(begin) && line.ends_with(end), "{line}");
    }
    let mat = "vectors.mat structure.mat vectors_7_3.mat structure_7_3.mat";
    let others = "snappy.parquet vectors.xlsx structured.npy";
    for name in mat.split(' ').chain(others.split(' ')) {
        let bytes = std::fs::read(foreign(name)).unwrap();
        let line = line(&folder.file(name, &bytes[..bytes.len() / 2]), "");
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
    let mat = "structure.mat cells.mat trace.mat vectors_7_3.mat structure_7_3.mat cells_7_3.mat trace_7_3.mat";
    let others = "gzip.parquet null.parquet tiny.xlsx structured.npy";
    for name in mat.split(' ').chain(others.split(' ')) {
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
    let table = "
        version_4.mat : the file is a MATLAB file of version 4, which bowden does not read; save it in MATLAB with `save -v7`
        words.mat : no vector of real numbers among the variables `who`, `rate`; each column must be one vector, on its own or as a field of a structure
        lengths.mat : column `f`: the column has 239 values, but it must have 240, as `t` does
        complex.mat : column `x`: no such column; the columns are
        complex_7_3.mat : column `x`: no such column; the columns are
        words.parquet : the file has no numeric column; each quantity must have one
        zstd.parquet : column `t`: the column is compressed with zstd, which bowden does not read; write the file with snappy or gzip
        brotli.parquet : column `t`: the column is compressed with brotli, which bowden does not read; write the file with snappy or gzip
        null.parquet :100: column `x`: the cell is empty, but it must be a number; --drop-bad drops such rows";
    for row in table.lines().skip(1) {
        let (name, expected) = row.trim().split_once(' ').unwrap();
        let line = line(&foreign(name), "");
        assert!(line.starts_with(expected), "{name}: {line}");
    }
    let line = line(&foreign("vectors.mat"), "--header-line 2");
    let names = ": --header-line 2: the file has no lines, and its columns already have names";
    assert_eq!(line, names);
}

#[test]
fn text_that_could_be_read_in_two_ways_is_refused_with_line_and_column() {
    let comma = csv().replace(',', ";").replace('.', ",");
    let folder = Folder::new();
    let path = folder.file("r.csv", comma.replacen("\n1,5;", "\n1.5;", 1));
    let point = ":386: column `t`: `1.5` has a decimal point; write a decimal comma, as in line 2";
    assert_eq!(line(&path, ""), point);
}
