//! The reader of records.

use bowden_lab::record::{parse, Mode, Options, MIN_SAMPLES};
use std::fmt::Write as _;

const FILE: &str = "record.csv";

/// Whatever the bytes: a record of finite numbers, or one line that names the file.
///
/// The first byte chooses the options; with its highest bit, good rows follow the bytes, so
/// that a mutated header meets a record that is long enough to be read to its end.
pub fn check(data: &[u8]) {
    let Some((choice, bytes)) = data.split_first() else {
        return;
    };
    let mut bytes = bytes.to_vec();
    if choice & 0x80 != 0 {
        bytes.extend_from_slice(good_rows().as_bytes());
    }
    let options = Options {
        mode: match choice & 3 {
            1 => Some(Mode::Torque),
            2 => Some(Mode::Displacement),
            _ => None,
        },
        time: (choice & 4 != 0).then(|| "t".to_owned()),
        input: (choice & 8 != 0).then(|| "x".to_owned()),
        output: (choice & 8 != 0).then(|| "f".to_owned()),
        channels: match choice & 19 {
            19 => vec![("stretch".to_owned(), "load-x".to_owned())],
            own if own & 16 != 0 => vec![("load".to_owned(), "load".to_owned())],
            _ => Vec::new(),
        },
        rate: (choice & 32 != 0).then_some(1000.0),
        until: (choice & 64 != 0).then_some(0.25),
        skip: 0.0,
        header_line: (choice & 7 == 7).then_some(2),
        segment: (choice & 70 == 70).then_some(1),
        names: match choice & 11 {
            11 => ["t", "x", "f"].map(str::to_owned).to_vec(),
            _ => Vec::new(),
        },
        sheet: (choice & 37 == 37).then(|| "Sheet1".to_owned()),
        drop_bad: choice & 3 == 3,
    };
    match parse(&bytes, FILE, &options) {
        Ok(record) => {
            let columns = [&record.input, &record.output];
            for column in columns.into_iter().chain(&record.channels) {
                assert_eq!(column.values.len(), record.samples());
                assert!(column.values.iter().all(|value| value.is_finite()));
            }
            assert!(record.samples() >= MIN_SAMPLES);
            assert!(record.time.iter().all(|time| time.is_finite()));
            assert!(record.time.windows(2).all(|pair| pair[0] < pair[1]));
            assert!(record.step() > 0.0);
            assert_eq!(record.path, FILE);
        }
        Err(error) => one_line(&error.to_string()),
    }
}

/// Every refusal is one line without control characters, and begins with the file.
fn one_line(message: &str) {
    assert!(message.starts_with(FILE), "{message:?}");
    assert!(message.len() > FILE.len() + 2, "{message:?}");
    assert!(!message.contains(char::is_control), "{message:?}");
}

fn good_rows() -> String {
    let mut rows = String::new();
    for k in 0..300 {
        let phase = f64::from(k) * 0.05;
        let _ = writeln!(
            rows,
            "{:.3},{:.4},{:.4}",
            f64::from(k) * 1e-3,
            phase.sin(),
            phase.cos()
        );
    }
    rows
}
