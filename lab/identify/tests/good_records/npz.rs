//! NumPy's archives of arrays.

use super::*;
use flate2::write::DeflateEncoder;
use flate2::{Compression, Crc};
use std::io::Write as _;

/// A file of an array.
fn npy(descr: &str, shape: &str, by_column: bool, data: &[u8]) -> Vec<u8> {
    let order = if by_column { "True" } else { "False" };
    let header = format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}\n");
    let length = u16::try_from(header.len()).unwrap().to_le_bytes();
    [
        b"\x93NUMPY\x01\0".as_slice(),
        &length,
        header.as_bytes(),
        data,
    ]
    .concat()
}

/// A zip archive of these files, compressed or not.
pub fn zip(files: &[(&str, Vec<u8>)], is_packed: bool) -> Vec<u8> {
    let four = |size: usize| u32::try_from(size).unwrap().to_le_bytes();
    let two = |size: usize| u16::try_from(size).unwrap().to_le_bytes();
    let (mut all, mut directory) = (Vec::new(), Vec::new());
    for (name, file) in files {
        let mut check = Crc::new();
        check.update(file);
        let mut packed = file.clone();
        if is_packed {
            let mut encoder = DeflateEncoder::new(Vec::new(), Compression::fast());
            encoder.write_all(file).unwrap();
            packed = encoder.finish().unwrap();
        }
        let method = if is_packed { 8 } else { 0 };
        let mut own = [20, 0, method, 0, 0].map(two).concat();
        own.extend(check.sum().to_le_bytes());
        own.extend([four(packed.len()), four(file.len())].concat());
        own.extend([two(name.len()), two(0)].concat());
        directory.extend([b"PK\x01\x02\x14\0".as_slice(), &own, &[0; 10]].concat());
        directory.extend(four(all.len()));
        directory.extend(name.as_bytes());
        all.extend([b"PK\x03\x04".as_slice(), &own, name.as_bytes(), &packed].concat());
    }
    let count = two(files.len());
    let end = [four(directory.len()), four(all.len())].concat();
    let last = [
        b"PK\x05\x06\0\0\0\0".as_slice(),
        &count,
        &count,
        &end,
        &[0, 0],
    ]
    .concat();
    [all, directory, last].concat()
}

fn column(index: usize) -> Vec<f64> {
    let cell = |row: &String| row.split(',').nth(index).unwrap().parse().unwrap();
    rows().iter().map(cell).collect()
}

fn doubles(values: &[f64]) -> Vec<u8> {
    values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}

/// The column of the plain record as an array of its own.
fn array(index: usize) -> Vec<u8> {
    npy("'<f8'", "(400,)", false, &doubles(&column(index)))
}

/// The three columns row by row.
fn by_row() -> Vec<f64> {
    let columns = [0, 1, 2].map(column);
    (0..400)
        .flat_map(|i| [0, 1, 2].map(|k| columns[k][i]))
        .collect()
}

fn structured() -> Vec<u8> {
    let descr = "[('t', '<f8'), ('x', '<f8'), ('f', '<f8')]";
    npy(descr, "(400,)", false, &doubles(&by_row()))
}

fn is_plain(bytes: &[u8]) -> Record {
    same_numbers(bytes, &Options::default())
}

#[test]
fn arrays_are_columns_by_their_names() {
    let files = [
        ("t.npy", array(0)),
        ("x_mm.npy", array(1)),
        ("f.npy", array(2)),
    ];
    for is_packed in [false, true] {
        let record = is_plain(&zip(&files, is_packed));
        assert_eq!(units(&record)[0], Some("mm"));
    }
    // Big-endian, whole numbers, and what is no column.
    let big: Vec<u8> = column(1)
        .iter()
        .flat_map(|value| value.to_be_bytes())
        .collect();
    let stamps: Vec<u8> = (0..400_i16).flat_map(|i| (10 * i).to_le_bytes()).collect();
    let files = [
        ("ms.npy", npy("'<i2'", "(400,)", false, &stamps)),
        ("x.npy", npy("'>f8'", "(400,)", true, &big)),
        ("f.npy", array(2)),
        ("rate.npy", npy("'<f8'", "()", false, &doubles(&[100.0]))),
        ("note.npy", npy("'<U2'", "(1,)", false, &[0; 8])),
    ];
    let record = accepted(zip(&files, true));
    assert!((record.time[399] - 3.99).abs() < 1e-12);
    assert_eq!(record.input.values, column(1));
}

#[test]
fn a_matrix_with_names_and_a_structured_array_are_columns() {
    let by_column = [column(0), column(1), column(2)].concat();
    let names: Vec<u8> = "txf".bytes().flat_map(|c| [c, 0, 0, 0]).collect();
    let names = npy("'<U1'", "(3,)", false, &names);
    for (values, is_by_column) in [(by_row(), false), (by_column, true)] {
        let data = npy("'<f8'", "(400, 3)", is_by_column, &doubles(&values));
        let files = [("data.npy", data), ("columns.npy", names.clone())];
        is_plain(&zip(&files, false));
    }
    is_plain(&zip(&[("log.npy", structured())], true));
    is_plain(&structured());
}

#[test]
fn a_lone_array_has_columns_by_names_or_by_numbers() {
    let plain = |shape: &str| npy("'<f8'", shape, false, &doubles(&by_row()));
    let matrix = plain("(400, 3)");
    let record = same_numbers(&matrix, &named(&["t", "x [mm]", "f"]));
    assert_eq!(units(&record)[0], Some("mm"));
    let mut by_number = ends("data(:,2)", "data(:,3)");
    by_number.time = Some("data(:,1)".to_owned());
    same_numbers(&matrix, &by_number);
    let none = Options::default();
    for (bytes, options, says) in [
        (plain("(1200,)"), &none, "the array is one column of 1200 numbers; save a two-dimensional array, or name the columns with `np.savez`"),
        (plain("(20, 20, 3)"), &none, "the array has 3 dimensions, but it must have two, with one column per quantity"),
        (plain("()"), &none, "the array has 0 dimensions, but it must have two, with one column per quantity"),
        (npy("'|O'", "(400, 3)", false, &[]), &none, "the array does not contain real numbers"),
        (matrix.clone(), &named(&["t", "x"]), "the array has 3 columns, but --names lists 2"),
        (structured(), &named(&["t", "x", "f"]), "--names: the fields of the array already have names"),
        (matrix[..2000].to_vec(), &none, "the file is damaged: an array is truncated"),
    ] {
        refused_with(bytes, options, &format!(" {says}"));
    }
}

/// Any byte of any value: a refusal or a record, and no panic.
pub fn no_byte_panics(whole: &[u8], step: usize) {
    for at in (0..whole.len()).step_by(step) {
        for byte in [0, 1, 0x7f, 0xff] {
            let mut spoilt = whole.to_vec();
            spoilt[at] = byte;
            let _ = bowden_lab::record::parse(&spoilt, "r", &Options::default());
        }
    }
}

#[test]
fn damage_to_an_archive_is_refused() {
    let files = [
        ("t.npy", array(0)),
        ("x.npy", array(1)),
        ("f.npy", array(2)),
    ];
    let whole = zip(&files, false);
    let mut spoilt = whole.clone();
    spoilt[2000] ^= 1;
    let longer = npy("'<f8'", "(500,)", false, &doubles(&column(0)));
    for (bytes, says) in [
        (
            whole[..whole.len() / 2].to_vec(),
            "the zip archive is truncated",
        ),
        (spoilt, "a checksum is wrong"),
        (zip(&[("t.npy", longer)], true), "an array is truncated"),
    ] {
        refused(bytes, &format!(" the file is damaged: {says}"));
    }
    no_byte_panics(&whole, 7);
}
