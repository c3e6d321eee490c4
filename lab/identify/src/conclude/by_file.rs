//! Errors of a joint model by file.

use crate::fit::Solution;
use crate::problem::{Piece, Prepared};
use crate::scale::is_raised;
use serde::Serialize;

/// Errors on one file; `None` for a segment that contains no part of the file.
#[derive(Debug, Clone, Serialize)]
pub struct FileErrors {
    /// The file.
    pub path: String,
    /// Error on its part of the fit segment.
    pub fit: Option<f64>,
    /// Error on its part of the selection segment.
    pub selection: Option<f64>,
    /// Error on its part of the held-out segment.
    pub held_out: Option<f64>,
}

impl FileErrors {
    /// The three errors in the order of the segments.
    #[must_use]
    pub fn segments(&self) -> [Option<f64>; 3] {
        [self.fit, self.selection, self.held_out]
    }
}

fn by_file(data: &Prepared, of: impl Fn(&[usize]) -> f64) -> Option<Vec<FileErrors>> {
    if data.pieces.len() < 2 {
        return None;
    }
    let own = |piece: &Piece, rows: &[usize]| {
        let rows = piece.rows_of(rows);
        (!rows.is_empty()).then(|| of(rows))
    };
    let all = data.pieces.iter().map(|piece| FileErrors {
        path: piece.path.clone(),
        fit: own(piece, &data.split.fit),
        selection: own(piece, &data.split.selection),
        held_out: own(piece, &data.split.held_out),
    });
    Some(all.collect())
}

fn rms(signal: &[f64], rows: &[usize], about: f64) -> f64 {
    let squares = rows.iter().map(|&i| (signal[i] - about).powi(2));
    (squares.sum::<f64>() / rows.len().max(1) as f64).sqrt()
}

/// Rms errors by file, in the output's unit; `None` for a single record.
#[must_use]
pub fn rmse_by_file(data: &Prepared, solution: &Solution) -> Option<Vec<FileErrors>> {
    by_file(data, |rows| rms(&solution.residual, rows, 0.0))
}

/// These errors as shares of the standard deviation of the filtered output there.
#[must_use]
pub fn nrmse_by_file(data: &Prepared, solution: &Solution) -> Option<Vec<FileErrors>> {
    by_file(data, |rows| {
        let mean = rows.iter().map(|&i| data.target[i]).sum::<f64>() / rows.len() as f64;
        rms(&solution.residual, rows, 0.0) / rms(&data.target, rows, mean)
    })
}

/// The reduction of the squared error by a term in a file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FileShare {
    /// The file.
    pub path: String,
    /// Share of the squared error on its part of the fit segment that the term removes; negative if
    /// the term increases the error.
    pub share: f64,
}

/// The reduction of one model's squared error by another model, in each file that is part of the
/// fit segment; empty for a single record.
#[must_use]
pub fn removed(data: &Prepared, before: &Solution, after: &Solution) -> Vec<FileShare> {
    let of = |solution| rmse_by_file(data, solution).unwrap_or_default();
    let pairs = of(before).into_iter().zip(of(after));
    let share = |(before, after): (FileErrors, FileErrors)| {
        let share = 1.0 - (after.fit? / before.fit?).powi(2);
        let path = after.path;
        Some(FileShare { path, share })
    };
    pairs.filter_map(share).collect()
}

/// A file whose held-out error the final model raises.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Worse {
    /// The file.
    pub path: String,
    /// Held-out error of the baseline model, as a share of the output's standard deviation.
    pub before: f64,
    /// Held-out error of the final model, likewise.
    pub after: f64,
}

/// The files on which the final model is worse than the baseline model; for a file without a
/// held-out part the fit segment is compared.
#[must_use]
pub fn worse(data: &Prepared, declared: &Solution, last: &Solution) -> Vec<Worse> {
    let (Some(before), Some(after)) = (nrmse_by_file(data, declared), nrmse_by_file(data, last))
    else {
        return Vec::new();
    };
    let judged = |errors: &FileErrors| errors.held_out.or(errors.fit);
    before
        .iter()
        .zip(&after)
        .filter_map(|(b, a)| Some((b, judged(b)?, judged(a)?)))
        .filter(|(_, before, after)| is_raised(*after, *before))
        .map(|(file, before, after)| Worse {
            path: file.path.clone(),
            before,
            after,
        })
        .collect()
}
