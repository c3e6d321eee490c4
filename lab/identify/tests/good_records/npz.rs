//! NumPy's archives of arrays.

use super::{accepted, csv, rows};
use bowden_lab::record::{parse, Mode, Options, Record};
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
    let (mut all, mut directory) = (Vec::new(), Vec::new());
    for (name, file) in files {
        let mut check = Crc::new();
        check.update(file);
        let packed = match is_packed {
            true => {
                let mut packed = DeflateEncoder::new(Vec::new(), Compression::fast());
                packed.write_all(file).unwrap();
                packed.finish().unwrap()
            }
            false => file.clone(),
        };
        let method = if is_packed { 8_u16 } else { 0 };
        let four = |size: usize| u32::try_from(size).unwrap().to_le_bytes();
        let mut own = [20_u16, 0, method, 0, 0].map(u16::to_le_bytes).concat();
        own.extend(
            [
                check.sum().to_le_bytes(),
                four(packed.len()),
                four(file.len()),
            ]
            .concat(),
        );
        own.extend(u16::try_from(name.len()).unwrap().to_le_bytes());
        own.extend([0, 0]);
        directory.extend([b"PK\x01\x02\x14\0".as_slice(), &own, &[0; 10]].concat());
        directory.extend(four(all.len()));
        directory.extend(name.as_bytes());
        all.extend([b"PK\x03\x04".as_slice(), &own, name.as_bytes(), &packed].concat());
    }
    let count = u16::try_from(files.len()).unwrap().to_le_bytes();
    let four = |size: usize| u32::try_from(size).unwrap().to_le_bytes();
    let end = [four(directory.len()), four(all.len())].concat();
    [
        all,
        directory,
        [
            b"PK\x05\x06\0\0\0\0".as_slice(),
            &count,
            &count,
            &end,
            &[0, 0],
        ]
        .concat(),
    ]
    .concat()
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

fn same(bytes: &[u8]) -> Record {
    let plain = accepted(csv("t,x,f", &rows()));
    let record = parse(bytes, "r.npz", &Options::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(record.time, plain.time);
    assert_eq!(record.input.values, plain.input.values);
    assert_eq!(record.output.values, plain.output.values);
    record
}

#[test]
fn arrays_are_columns_by_their_names() {
    let own = |index: usize| npy("'<f8'", "(400,)", false, &doubles(&column(index)));
    let files = [("t.npy", own(0)), ("x_mm.npy", own(1)), ("f.npy", own(2))];
    for is_packed in [false, true] {
        let record = same(&zip(&files, is_packed));
        assert_eq!(record.input.unit.as_deref(), Some("mm"));
    }
    // Big-endian, whole numbers, and what is no column.
    let big: Vec<u8> = column(1)
        .iter()
        .flat_map(|value| value.to_be_bytes())
        .collect();
    let stamps: Vec<u8> = (0..400_i16).flat_map(|i| (10 * i).to_le_bytes()).collect();
    let record = parse(
        &zip(
            &[
                ("ms.npy", npy("'<i2'", "(400,)", false, &stamps)),
                ("x.npy", npy("'>f8'", "(400,)", true, &big)),
                ("f.npy", own(2)),
                ("rate.npy", npy("'<f8'", "()", false, &doubles(&[100.0]))),
                ("note.npy", npy("'<U2'", "(1,)", false, &[0; 8])),
            ],
            true,
        ),
        "r.npz",
        &Options::default(),
    )
    .unwrap();
    assert!((record.time[399] - 3.99).abs() < 1e-12);
    assert_eq!(record.input.values, column(1));
}

#[test]
fn a_matrix_with_names_and_a_structured_array_are_columns() {
    let by_row: Vec<f64> = (0..400)
        .flat_map(|i| [0, 1, 2].map(|k| column(k)[i]))
        .collect();
    let by_column = [column(0), column(1), column(2)].concat();
    let names: Vec<u8> = "txf"
        .chars()
        .flat_map(|c| u32::from(c).to_le_bytes())
        .collect();
    let names = npy("'<U1'", "(3,)", false, &names);
    for (values, is_by_column) in [(by_row.clone(), false), (by_column, true)] {
        let data = npy("'<f8'", "(400, 3)", is_by_column, &doubles(&values));
        same(&zip(
            &[("data.npy", data), ("columns.npy", names.clone())],
            false,
        ));
    }
    let descr = "[('t', '<f8'), ('x', '<f8'), ('f', '<f8')]";
    let record = npy(descr, "(400,)", false, &doubles(&by_row));
    same(&zip(&[("log.npy", record)], true));
}

#[test]
fn a_lone_array_has_columns_by_names_or_by_fields() {
    let by_row: Vec<f64> = (0..400)
        .flat_map(|i| [0, 1, 2].map(|k| column(k)[i]))
        .collect();
    let matrix = npy("'<f8'", "(400, 3)", false, &doubles(&by_row));
    let descr = "[('t', '<f8'), ('x', '<f8'), ('f', '<f8')]";
    let structured = npy(descr, "(400,)", false, &doubles(&by_row));
    same(&structured);
    let read = |bytes: &[u8], options: &Options| parse(bytes, "r.npy", options);
    let names = |list: &str| Options {
        names: list.split(',').map(str::to_owned).collect(),
        ..Options::default()
    };
    let record = read(&matrix, &names("t,x [mm],f")).unwrap();
    assert_eq!(record.input.values, column(1));
    assert_eq!(record.input.unit.as_deref(), Some("mm"));
    let by_number = Options {
        time: Some("data(:,1)".to_owned()),
        input: Some("data(:,2)".to_owned()),
        output: Some("data(:,3)".to_owned()),
        mode: Some(Mode::Displacement),
        ..Options::default()
    };
    assert_eq!(read(&matrix, &by_number).unwrap().output.values, column(2));
    let plain = |shape: &str| npy("'<f8'", shape, false, &doubles(&by_row));
    for (bytes, options, says) in [
        (plain("(1200,)"), Options::default(), "the array is one column of 1200 numbers; save a two-dimensional array, or name the columns with `np.savez`"),
        (plain("(20, 20, 3)"), Options::default(), "the array has 3 dimensions, but it must have two, with one column per quantity"),
        (plain("()"), Options::default(), "the array has 0 dimensions, but it must have two, with one column per quantity"),
        (npy("'|O'", "(400, 3)", false, &[]), Options::default(), "the array does not contain real numbers"),
        (matrix.clone(), names("t,x"), "the array has 3 columns, but --names lists 2"),
        (structured, names("t,x,f"), "--names: the fields of the array already have names"),
        (matrix[..2000].to_vec(), Options::default(), "the file is damaged: an array is truncated"),
    ] {
        let line = read(&bytes, &options).unwrap_err().to_string();
        assert_eq!(line, format!("r.npy: {says}"));
    }
}

#[test]
fn damage_to_an_archive_is_refused() {
    let own = |index: usize| npy("'<f8'", "(400,)", false, &doubles(&column(index)));
    let whole = zip(
        &[("t.npy", own(0)), ("x.npy", own(1)), ("f.npy", own(2))],
        false,
    );
    let refusal = |bytes: &[u8]| {
        let error = parse(bytes, "r.npz", &Options::default()).unwrap_err();
        error.to_string()
    };
    let line = refusal(&whole[..whole.len() / 2]);
    assert_eq!(
        line,
        "r.npz: the file is damaged: the zip archive is truncated"
    );
    let mut spoilt = whole.clone();
    spoilt[2000] ^= 1;
    assert_eq!(
        refusal(&spoilt),
        "r.npz: the file is damaged: a checksum is wrong"
    );
    let short = zip(
        &[("t.npy", npy("'<f8'", "(500,)", false, &doubles(&column(0))))],
        true,
    );
    assert_eq!(
        refusal(&short),
        "r.npz: the file is damaged: an array is truncated"
    );
    // Any byte of any value: a refusal or a record, and no panic.
    for at in (0..whole.len()).step_by(7) {
        for byte in [0, 1, 0x7f, 0xff] {
            let mut spoilt = whole.clone();
            spoilt[at] = byte;
            let _ = parse(&spoilt, "r.npz", &Options::default());
        }
    }
}
