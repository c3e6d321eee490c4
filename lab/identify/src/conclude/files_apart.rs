//! Files that no one model can describe, because in one of them the output is a multiple of what
//! it is in the others: another sign, unit or calibration.

use super::final_fit::FinalFit;
use crate::algebra::line;
use crate::fit::{fit, Solution};
use crate::ledger::FileApart;
use crate::model::structure::Structure;
use crate::problem::{Piece, Prepared};

/// Files are of several configurations if gains of their own reduce the error of the declared
/// model below this share.
pub(crate) const OTHER_CONFIGURATION: f64 = 0.5;
/// A gain and an offset are said of a file if they leave at most this share of its error ...
const LINE_LEAVES: f64 = 0.25;
/// ... which itself is at least this share of its output's standard deviation. A choice, as the
/// one before.
const LEAST_ERROR: f64 = 0.1;
/// Gains that differ by less than this are one gain. A choice: sensors are calibrated to that.
const SAME_GAIN: f64 = 0.05;

/// The declared model with gains of its own for each file; `None` without a hysteresis.
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

/// The files with another gain, where gains of their own make the declared model better than all
/// that was added to it; most files have the gain that the others are compared with.
pub(crate) fn files_apart(data: &Prepared, own: &Solution, done: &FinalFit) -> Vec<FileApart> {
    if own.rmse.fit >= OTHER_CONFIGURATION * done.rmse.fit {
        return Vec::new();
    }
    let fitted = || (0..data.pieces.len()).filter(|&k| !rows_of(data, k).is_empty());
    let with_gain_of = |one: usize| -> Vec<FileApart> {
        let others = fitted().filter(|&k| k != one);
        let apart = others.filter_map(|k| compared(data, own, k, one));
        apart.collect()
    };
    let all = fitted().map(with_gain_of);
    all.min_by_key(Vec::len).unwrap_or_default()
}

/// The rows of a file that the fit sees.
fn rows_of(data: &Prepared, record: usize) -> &[usize] {
    let Piece { rows, .. } = &data.pieces[record];
    let fit = &data.split.fit;
    let begin = fit.partition_point(|&row| row < rows.start);
    let end = fit.partition_point(|&row| row < rows.end);
    &fit[begin..end]
}

/// A file beside the gains of another one, if its output is a multiple of what they say.
fn compared(data: &Prepared, own: &Solution, file: usize, than: usize) -> Option<FileApart> {
    let rows = rows_of(data, file);
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
    let is = (gain - 1.0).abs() > SAME_GAIN && before > LEAST_ERROR && after < LINE_LEAVES * before;
    is.then(|| FileApart {
        path: data.pieces[file].path.clone(),
        than: data.pieces[than].path.clone(),
        gain,
        offset,
        before,
        after,
    })
}

/// A step of the pretension this near to the beginning of a file is its beginning, as a share of
/// the file's length. A choice.
const AT_THE_BEGINNING: f64 = 0.01;

/// What is to be said of a pretension that steps where a file begins.
pub(super) fn another_zero(data: &Prepared, done: &Solution) -> Option<String> {
    let steps = done.structure.terms.iter().filter(|t| t.has_moment());
    let moments: Vec<f64> = steps.filter_map(|t| t.effect.shape(0)).collect();
    let length = |piece: &Piece| piece.work.len() as f64 * data.dt;
    let begins = |piece: &&Piece| {
        let near = AT_THE_BEGINNING * length(piece);
        moments.iter().any(|t_s| (t_s - piece.since).abs() <= near)
    };
    let piece = data.pieces.iter().skip(1).find(begins)?;
    Some(format!(
        "The pretension steps where `{}` begins: is the zero of a sensor another one there? `--per-file gains` fits one for each file.",
        piece.path
    ))
}

/// What is to be said of such files; `None` where there are none.
pub(super) fn apart_words(data: &Prepared, apart: &[FileApart]) -> Option<String> {
    let (first, others) = apart.split_first()?;
    let unit = data.output_unit.as_ref().map(|unit| format!(" {unit}"));
    let asked = match first.gain < 0.0 {
        true => "Has a sensor another sign there?",
        false => "Has a sensor another unit or calibration there, or is the rig another one?",
    };
    let also = match others.len() {
        0 => String::new(),
        1 => format!(
            " So it is in `{}`, with a gain of {:.4}.",
            others[0].path, others[0].gain
        ),
        more => format!(" So it is in {more} more files."),
    };
    Some(format!(
        "No one model describes these files: in `{}` the output is {:.4} times what the gains of `{}` say, and {:.4}{} more, which leaves {:.1} % of its standard deviation in place of {:.0} %.{also} {asked} Mend the file, or give each one its gains with `--per-file gains`.",
        first.path,
        first.gain,
        first.than,
        first.offset,
        unit.unwrap_or_default(),
        100.0 * first.after,
        100.0 * first.before
    ))
}
