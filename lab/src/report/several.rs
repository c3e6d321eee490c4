//! Several records: errors by file, and the gains that each has of its own.

use super::words::{estimate, number, table};
use crate::conclude::by_file::{nrmse_by_file, worse};
use crate::conclude::final_fit::FinalFit;
use crate::conclude::intervals::{gain_names, numbered, parameters};
use crate::fit::Solution;
use crate::ledger::Ledger;
use crate::problem::{Piece, Prepared};

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
    let mut out = format!("{files}\n");
    for file in worse(data, &ledger.declared, &done.solution) {
        out += &format!(
            "worse for {}: held out {} % → {} %\n",
            file.path,
            number(100.0 * file.before, Some(5.0 * file.before)),
            number(100.0 * file.after, Some(5.0 * file.after))
        );
    }
    out + "\n"
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
