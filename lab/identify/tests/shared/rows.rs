//! A record that is fine, as text; what is changed in it, and how it is read.

use bowden_lab::record::{parse, Mode, Options, Record};

/// A record that is fine: 400 samples at 100 Hz in three columns.
pub fn rows() -> Vec<String> {
    let row = |i: i32| {
        let t = f64::from(i) * 0.01;
        let (x, f) = (10.0 * (3.0 * t).sin(), 25.0 * (3.0 * t + 0.2).sin());
        format!("{t:.2},{x:.6},{f:.6}")
    };
    (0..400).map(row).collect()
}

pub fn csv(header: &str, rows: &[String]) -> String {
    format!("{header}\n{}\n", rows.join("\n"))
}

pub fn plain() -> String {
    csv("t,x,f", &rows())
}

/// The record with one line (numbered as an editor does) replaced.
pub fn with_line(line: usize, text: &str) -> String {
    let mut rows = rows();
    rows[line - 2] = text.to_owned();
    csv("t,x,f", &rows)
}

/// The record with each row changed.
pub fn changed(header: &str, row: impl Fn(usize, &str) -> String) -> String {
    let rows: Vec<String> = (0..).zip(rows()).map(|(i, own)| row(i, &own)).collect();
    csv(header, &rows)
}

/// The record with the same cells behind each row.
pub fn wider(header: &str, cells: &str) -> String {
    changed(header, |_, row| format!("{row}{cells}"))
}

/// The record with another first column.
pub fn stamped(header: &str, time: impl Fn(usize) -> String) -> String {
    changed(header, |i, row| time(i) + &row[row.find(',').unwrap()..])
}

/// The record with two columns computed from the time.
pub fn of(input: impl Fn(f64) -> f64, output: impl Fn(f64) -> f64) -> String {
    let time = (0..2000).map(|i| f64::from(i) * 0.01);
    let rows: Vec<String> = time
        .map(|t| format!("{t},{},{}", input(t), output(t)))
        .collect();
    csv("t,x,f", &rows)
}

pub fn with(set: impl FnOnce(&mut Options)) -> Options {
    let mut options = Options::default();
    set(&mut options);
    options
}

pub fn drop_bad() -> Options {
    with(|o| o.drop_bad = true)
}

/// Displacement mode between two columns.
pub fn ends(input: &str, output: &str) -> Options {
    with(|o| {
        o.mode = Some(Mode::Displacement);
        (o.input, o.output) = (Some(input.to_owned()), Some(output.to_owned()));
    })
}

pub fn named(names: &[&str]) -> Options {
    with(|o| o.names = names.iter().map(|name| (*name).to_owned()).collect())
}

pub fn timed(column: &str) -> Options {
    with(|o| o.time = Some(column.to_owned()))
}

pub fn channels(pairs: &[(&str, &str)]) -> Options {
    let own = |(name, column): &(&str, &str)| ((*name).to_owned(), (*column).to_owned());
    with(|o| o.channels = pairs.iter().map(own).collect())
}

pub fn read(bytes: impl AsRef<[u8]>, options: &Options) -> Record {
    parse(bytes.as_ref(), "r.csv", options).unwrap_or_else(|error| panic!("{error}"))
}

pub fn accepted(bytes: impl AsRef<[u8]>) -> Record {
    read(bytes, &Options::default())
}

/// Reads what has the numbers of the plain record; `notes` are all that is said of it.
pub fn same(bytes: impl AsRef<[u8]>, options: &Options, notes: &[&str]) -> Record {
    let record = same_numbers(bytes, options);
    assert_eq!(record.notes, notes);
    record
}

pub fn same_numbers(bytes: impl AsRef<[u8]>, options: &Options) -> Record {
    let bytes = bytes.as_ref();
    let begin = String::from_utf8_lossy(&bytes[..bytes.len().min(80)]);
    let (plain, record) = (accepted(plain()), read(bytes, options));
    assert_eq!(record.time, plain.time, "{begin}");
    assert_eq!(record.input.values, plain.input.values, "{begin}");
    assert_eq!(record.output.values, plain.output.values, "{begin}");
    record
}

/// Units of input and output.
pub fn units(record: &Record) -> [Option<&str>; 2] {
    [&record.input, &record.output].map(|column| column.unit.as_deref())
}

pub fn refusal(bytes: impl AsRef<[u8]>, options: &Options) -> String {
    let error = parse(bytes.as_ref(), "r.csv", options).expect_err("a refusal");
    error.to_string()
}

/// `line` is the refusal behind `r.csv:`.
pub fn refused_with(bytes: impl AsRef<[u8]>, options: &Options, line: &str) {
    assert_eq!(refusal(bytes, options), format!("r.csv:{line}"));
}

pub fn refused(bytes: impl AsRef<[u8]>, line: &str) {
    refused_with(bytes, &Options::default(), line);
}
