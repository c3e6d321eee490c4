//! One record in many forms, made of sums, products and rounding alone, so that it is the same
//! to the bit wherever it is computed; `files/make.py` writes it by other people's writers.

use std::io::Write as _;

/// Input, output and load, at 256 Hz.
pub const NAMES: [&str; 4] = ["t", "x_mm", "f_N", "load_N"];

fn rounded(value: f64) -> f64 {
    (value * 1024.0 + 0.5).floor() / 1024.0
}

fn triangle(i: u32, period: u32) -> f64 {
    4.0 * (f64::from(i % period) / f64::from(period) - 0.5).abs() - 1.0
}

pub fn rows() -> Vec<[f64; 4]> {
    let (mut seed, mut play) = (1_u64, 0.0);
    let row = |i: u32| {
        let x = rounded(6.0 * triangle(i, 640) + 3.0 * triangle(i + 40, 275));
        play = (x + 1.5_f64).min((x - 1.5_f64).max(play));
        let load = rounded(5.0 * triangle(i, 900));
        seed = (seed * 1_103_515_245 + 12_345) % (1 << 31);
        let noise = 0.1 * (seed as f64 / f64::from(1_u32 << 31) - 0.5);
        let f = rounded(2.0 * x + 3.0 * (x - play) + 0.25 * load + noise);
        [f64::from(i) / 256.0, x, f, load]
    };
    (0..2560).map(row).collect()
}

/// The rows as text.
pub fn values(rows: &[[f64; 4]], separator: &str) -> String {
    let row = |row: &[f64; 4]| row.map(|v| v.to_string()).join(separator) + "\n";
    rows.iter().map(row).collect()
}

pub fn csv() -> String {
    format!("{}\n{}", NAMES.join(","), values(&rows(), ","))
}

/// As loggers write JSON: one record a line.
pub fn ndjson() -> String {
    let field = |(name, value): (&str, f64)| format!("{name:?}:{value}");
    let record = |row: [f64; 4]| {
        NAMES
            .into_iter()
            .zip(row)
            .map(field)
            .collect::<Vec<_>>()
            .join(",")
    };
    let rows = rows().into_iter();
    rows.map(|row| format!("{{{}}}\n", record(row))).collect()
}

/// As a spreadsheet in German exports it: a preamble, units below the names, decimal commas.
pub fn german() -> String {
    let values = values(&rows(), ";").replace('.', ",");
    let values = values.replace('\n', ";21,5;ü\r\n");
    let preamble = "Prüfstand;Süd;3\r\nDatum;23.11.2026\r\nAbtastrate;256,0\r\n\r\n";
    let names = NAMES.join(";");
    format!("{preamble}{names};Öltemperatur;Prüfer\r\ns;mm;N;N;°C;\r\n{values};;;;;\r\n\r\nEnde der Messung\r\n;;;;;\r\n")
}

pub fn latin_1(text: &str) -> Vec<u8> {
    text.chars().map(|c| u8::try_from(c).unwrap()).collect()
}

pub fn utf_16(text: &str) -> Vec<u8> {
    let units = "\u{feff}".encode_utf16().chain(text.encode_utf16());
    units.flat_map(u16::to_le_bytes).collect()
}

pub fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packed.write_all(bytes).unwrap();
    packed.finish().unwrap()
}

/// A file that SciPy or PyArrow has written.
pub fn foreign(name: &str) -> String {
    format!(
        "{}/tests/cli/reading/files/{name}",
        env!("CARGO_MANIFEST_DIR")
    )
}
