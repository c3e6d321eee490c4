//! Several records: errors by file, and the gains that each has of its own.

use super::terminal::{estimate, number, table};
use crate::channels::{Piece, Prepared};
use crate::closing::Ledger;
use crate::final_fit::FinalFit;
use crate::fit::Solution;
use crate::intervals::{gain_names, numbered, parameters};
use serde::Serialize;

/// Errors on one file; a segment that the file has no part in is left open.
#[derive(Debug, Clone, Serialize)]
pub(super) struct FileErrors {
    path: String,
    fit: Option<f64>,
    stop: Option<f64>,
    held_out: Option<f64>,
}

impl FileErrors {
    fn segments(&self) -> [Option<f64>; 3] {
        [self.fit, self.stop, self.held_out]
    }
}

/// Rms of a signal about a value of each segment's own, by file.
fn by_file(data: &Prepared, of: impl Fn(&[usize]) -> f64) -> Option<Vec<FileErrors>> {
    if data.pieces.len() < 2 {
        return None;
    }
    let own = |piece: &Piece, rows: &[usize]| {
        let begin = rows.partition_point(|&row| row < piece.rows.start);
        let end = rows.partition_point(|&row| row < piece.rows.end);
        (begin < end).then(|| of(&rows[begin..end]))
    };
    let all = data.pieces.iter().map(|piece| FileErrors {
        path: piece.path.clone(),
        fit: own(piece, &data.split.fit),
        stop: own(piece, &data.split.stop),
        held_out: own(piece, &data.split.held_out),
    });
    Some(all.collect())
}

fn rms(signal: &[f64], rows: &[usize], about: f64) -> f64 {
    let squares = rows.iter().map(|&i| (signal[i] - about).powi(2));
    (squares.sum::<f64>() / rows.len().max(1) as f64).sqrt()
}

/// Rms errors by file, in the output's unit; `None` for a single record.
pub(super) fn rmse_by_file(data: &Prepared, solution: &Solution) -> Option<Vec<FileErrors>> {
    by_file(data, |rows| rms(&solution.residual, rows, 0.0))
}

/// The same as shares of the filtered output's standard deviation there.
pub(super) fn nrmse_by_file(data: &Prepared, solution: &Solution) -> Option<Vec<FileErrors>> {
    by_file(data, |rows| {
        let mean = rows.iter().map(|&i| data.target[i]).sum::<f64>() / rows.len() as f64;
        rms(&solution.residual, rows, 0.0) / rms(&data.target, rows, mean)
    })
}

/// The file that is held out as a whole, where there is one.
fn held_out(data: &Prepared) -> Option<&Piece> {
    data.pieces.iter().find(|piece| !piece.fitted)
}

/// How long the records are, in words.
pub(super) fn size(data: &Prepared) -> String {
    let hertz = |rate: f64| number(rate, Some(1e-3 * rate));
    let own = data.pieces.iter().map(|p| p.samples as f64 / p.rate);
    match &data.pieces[..] {
        pieces @ [_, _, ..] => format!(
            "{} samples in {} files, {:.1} s together, brought to {} Hz",
            data.samples,
            pieces.len(),
            own.sum::<f64>(),
            hertz(data.rate)
        ),
        _ => format!(
            "{} samples, {} Hz, {:.1} s",
            data.samples,
            hertz(data.rate),
            data.samples as f64 / data.rate
        ),
    }
}

/// How the records are split, in words.
pub(super) fn split(data: &Prepared) -> String {
    let trailing = "60 % to fit, 15 % to stop, 25 % held out";
    match (data.pieces.len(), held_out(data)) {
        (1, _) => trailing.to_owned(),
        (_, None) => format!("of each file {trailing}"),
        (_, Some(piece)) => {
            format!("80 % to fit, 20 % to stop; held out: {}", piece.path)
        }
    }
}

/// Errors by file before and after, as a table; empty for a single record.
pub(super) fn errors(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> String {
    let (Some(before), Some(after)) = (
        nrmse_by_file(data, &ledger.declared),
        nrmse_by_file(data, &done.solution),
    ) else {
        return String::new();
    };
    let mut files = table(
        &[
            "error by file [%]",
            "fit",
            "stop",
            "held out",
            "samples",
            "Hz",
        ],
        1..6,
    );
    let cell = |before: Option<f64>, after: Option<f64>| match (before, after) {
        (Some(before), Some(after)) => {
            let percent = |v: f64| number(100.0 * v, Some(5.0 * v));
            format!("{} → {}", percent(before), percent(after))
        }
        _ => "–".to_owned(),
    };
    for ((before, after), piece) in before.iter().zip(&after).zip(&data.pieces) {
        let pairs = before.segments().into_iter().zip(after.segments());
        let mut row = vec![piece.path.clone()];
        row.extend(pairs.map(|(b, a)| cell(b, a)));
        row.push(piece.samples.to_string());
        row.push(number(piece.rate, Some(1e-3 * piece.rate)));
        files.add_row(row);
    }
    format!("{files}\n\n")
}

/// The gains that each file has of its own, as a table; empty where they are common.
pub(super) fn gains(data: &Prepared, solution: &Solution) -> String {
    if solution.structure.own_gains == 0 {
        return String::new();
    }
    let (names, _) = gain_names(data.mode);
    let all = parameters(data, solution);
    let mut files = table(
        &["gains by file (95 %)", names[0], names[1], names[2]],
        0..0,
    );
    for (record, piece) in data.pieces.iter().enumerate() {
        let own = names.map(|name| {
            let name = numbered(name, record);
            let found = all.iter().find(|p| p.name == name);
            found.map_or_else(String::new, estimate)
        });
        files.add_row([vec![piece.path.clone()], own.to_vec()].concat());
    }
    format!("{files}\n\n")
}
