//! Files that no single model can describe, because the output of one file has another sign, unit
//! or calibration.

use super::by_file::nrmse_by_file;
use super::final_fit::FinalFit;
use super::finding::Finding;
use crate::algebra::line;
use crate::fit::{fit, Segments, Solution};
use crate::ledger::{FileApart, Ledger, RigsApart};
use crate::model::structure::Structure;
use crate::problem::{Piece, Prepared};
use crate::scale::{HALF, PART, QUARTER, TRACE, TWENTIETH};

/// The baseline model with separate gains for each file; `None` without hysteresis.
pub(crate) fn with_own_gains(data: &Prepared, declared: &Solution) -> Option<Solution> {
    if !declared.structure.hysteresis {
        return None;
    }
    let structure = Structure {
        own_gains: data.pieces.len(),
        ..declared.structure.clone()
    };
    fit(data, &structure, None, 0.0)
}

/// How a file relates to the gains of another file.
enum Beside {
    /// The gains describe the file, except for an offset.
    Same,
    /// A different gain describes the file.
    Apart(FileApart),
    /// Neither describes the file.
    Other,
}

/// If separate gains for each file, those of `own`, improve the baseline model more than all added
/// terms: the files that have another gain, or the finding that the files are not from one rig.
pub(crate) fn judge_files(
    data: &Prepared,
    own: Option<&Solution>,
    done: &FinalFit,
    ledger: &mut Ledger,
) {
    // A search that was cut short has not tried what else might describe all files.
    let Some(own) = own.filter(|_| !ledger.is_stopped()) else {
        return;
    };
    if own.rmse.fit >= HALF * done.rmse.fit {
        ledger.apart = far_apart(data, own, done);
        return;
    }
    ledger.apart = files_apart(data, own);
    let share = |rmse: Segments| rmse.normalised(data, &data.target).fit;
    let rigs = RigsApart {
        together: share(done.rmse),
        own: share(own.rmse),
    };
    ledger.rigs_apart = ledger.apart.is_empty().then_some(rigs);
}

/// Whether a gain is so far from one that the unit must differ, not the rig: beyond a factor of
/// two. A choice.
pub(crate) fn is_far(gain: f64) -> bool {
    !(0.5..=2.0).contains(&gain)
}

/// The files whose gain is far from that of the others, if separate gains halve the error as a
/// share of each file's output. The common squared error is not used: a file in a thousandth of the
/// unit would dominate it, and a term added for that file may describe no other file.
fn far_apart(data: &Prepared, own: &Solution, done: &FinalFit) -> Vec<FileApart> {
    let share = |solution: &Solution| {
        let files = nrmse_by_file(data, solution)?;
        let squares = files.iter().filter_map(|file| Some(file.fit?.powi(2)));
        Some(squares.sum::<f64>().sqrt())
    };
    let (Some(together), Some(alone)) = (share(&done.solution), share(own)) else {
        return Vec::new();
    };
    if alone >= HALF * together {
        return Vec::new();
    }
    let mut apart = files_apart(data, own);
    apart.retain(|file| is_far(file.gain));
    apart
}

/// Files that are not from one rig.
pub(super) fn several_rigs(ledger: &Ledger) -> Option<Finding> {
    let RigsApart { together, own } = ledger.rigs_apart?;
    Some(Finding::FilesOfSeveralRigs { together, own })
}

/// Files in which the output has another gain.
pub(super) fn files_scaled(data: &Prepared, ledger: &Ledger) -> Option<Finding> {
    (!ledger.apart.is_empty()).then(|| Finding::FilesScaled {
        files: ledger.apart.clone(),
        of: data.pieces.iter().filter(|p| p.fitted).count(),
        unit: data.output_unit.clone(),
    })
}

/// The files with another gain. They are compared with the gains that describe the most files.
fn files_apart(data: &Prepared, own: &Solution) -> Vec<FileApart> {
    // Of each file the error of its own gains; none where the fit sees nothing of it.
    let errors = nrmse_by_file(data, own).unwrap_or_default();
    let errors = errors.iter().map(|file| file.fit).enumerate();
    let fitted: Vec<(usize, f64)> = errors.filter_map(|(k, e)| Some((k, e?))).collect();
    let with_gains_of = |one: usize| {
        let (mut same, mut apart) = (0, Vec::new());
        for &(file, _) in fitted.iter().filter(|(k, _)| *k != one) {
            match beside(data, own, file, one) {
                Beside::Same => same += 1,
                Beside::Apart(file) => apart.push(file),
                Beside::Other => {}
            }
        }
        (same, apart)
    };
    // The gains of a dead sensor do not even describe its own file.
    let known = fitted.iter().filter(|(_, error)| *error <= HALF);
    let all = known.map(|(one, _)| with_gains_of(*one));
    // Of equals the first one: the earlier file is the one that others are compared with.
    let best = all.reduce(|best, next| {
        let rank = |(same, apart): &(usize, Vec<FileApart>)| (*same, apart.len());
        match rank(&next) > rank(&best) {
            true => next,
            false => best,
        }
    });
    best.map_or_else(Vec::new, |(_, apart)| apart)
}

/// How the output of a file relates to the prediction with the gains of another file. A file that the
/// model does not describe at all has no gain.
fn beside(data: &Prepared, own: &Solution, file: usize, than: usize) -> Beside {
    let rows = data.pieces[file].rows_of(&data.split.fit);
    let shared = own.structure.base()..own.gains.len();
    let with_gains_of_the_other = |row: usize| -> f64 {
        let cable = (0..3).map(|j| own.gains[3 * than + j] * own.columns[3 * file + j][row]);
        let rest = shared.clone().map(|k| own.gains[k] * own.columns[k][row]);
        cable.chain(rest).sum()
    };
    let pairs: Vec<(f64, f64)> = rows
        .iter()
        .map(|&row| (with_gains_of_the_other(row), data.target[row]))
        .collect();
    let (gain, offset) = line(pairs.iter().copied());
    let n = pairs.len() as f64;
    let rms = |of: &dyn Fn(f64, f64) -> f64| {
        let squares = pairs.iter().map(|&(x, y)| of(x, y).powi(2));
        (squares.sum::<f64>() / n).sqrt()
    };
    let mean = pairs.iter().map(|(_, y)| y).sum::<f64>() / n;
    let deviation = rms(&|_, y| y - mean);
    let (before, after) = (
        rms(&|x, y| y - x) / deviation,
        rms(&|x, y| y - gain * x - offset) / deviation,
    );
    if before <= PART {
        return Beside::Same;
    }
    let is_line = after <= QUARTER * before && after <= HALF;
    match (is_line, (gain - 1.0).abs() <= TWENTIETH) {
        (true, true) => Beside::Same,
        (true, false) => Beside::Apart(FileApart {
            path: data.pieces[file].path.clone(),
            than: data.pieces[than].path.clone(),
            gain,
            offset,
            before,
            after,
        }),
        (false, _) => Beside::Other,
    }
}

/// A preload step at the beginning of a file.
pub(super) fn another_zero(data: &Prepared, done: &Solution) -> Option<Finding> {
    let steps = done.structure.terms.iter().filter(|t| t.has_moment());
    let moments: Vec<f64> = steps.filter_map(|t| t.effect.shape(0)).collect();
    let length = |piece: &Piece| piece.work.len() as f64 * data.dt;
    let begins = |piece: &&Piece| {
        let near = TRACE * length(piece);
        moments.iter().any(|t_s| (t_s - piece.since).abs() <= near)
    };
    let piece = data.pieces.iter().skip(1).find(begins)?;
    Some(Finding::ZeroDiffers {
        path: piece.path.clone(),
        may_fit_gains: done.structure.hysteresis && done.structure.own_gains == 0,
    })
}
