//! Findings that only the held-out segment shows: a changed rig, or clocks that differ.

use super::final_fit::FinalFit;
use super::finding::Finding;
use crate::algebra::line;
use crate::fit::{Segments, Solution};
use crate::model::structure::{FitTerm, Role};
use crate::problem::Prepared;
use crate::record::{is_velocity, DefectKind, Mode};
use crate::scale::{is_raised, NOISE, PART, QUARTER, TRACE, TWENTIETH};
use crate::score::ranges::{beyond, range, POSITION};
use bowden::model::Source;

/// The positions of the held-out segment beyond those of the fit segment, if the model's error is
/// larger there.
pub(super) fn extrapolates(data: &Prepared, done: &FinalFit) -> Vec<Finding> {
    let (fit, held_out) = (done.rmse.fit, done.rmse.held_out);
    if !is_raised(held_out, fit) || held_out <= NOISE * data.noise_floor {
        return Vec::new();
    }
    let split = &data.split;
    let channels = 0..data.channels.len();
    let channels = channels.map(|index| Source::Channel(index as u8));
    let sources = std::iter::once(Source::Input).chain(channels);
    let outside = |source: Source| {
        let channel = data.channel(source)?;
        if !done.solution.structure.reads(source) {
            return None;
        }
        let seen = range(data, channel, &split.fit, POSITION);
        beyond(data, channel, &split.held_out, POSITION, seen)
    };
    sources
        .filter_map(outside)
        .map(Finding::Extrapolation)
        .collect()
}

/// The terms of a channel replace the output if their sum has the first share of its standard
/// deviation, although the error of the baseline model is below the second. Both are choices: a
/// term for a missing effect is only about as large as the error of the baseline model.
const STANDS_FOR: (f64, f64) = (0.9, 0.3);

/// The errors on the fit and on the held-out segment, as shares of the output's standard deviation
/// on each, if the held-out error means another rig: it is a part of the output, and the fit error is
/// less than a quarter of it. A choice: of the ten measured rows none has more than 8 % or 2.2 times.
pub(super) fn other_rig(data: &Prepared, done: &FinalFit) -> Option<(f64, f64)> {
    let error = done.rmse.normalised(data, &data.target);
    (error.held_out > PART && QUARTER * error.held_out > error.fit)
        .then_some((error.fit, error.held_out))
}

/// The time \[s\] after which the held-out error is large, if it is within the held-out segment: only a
/// trace of the squared error lies before it.
pub(super) fn begins(data: &Prepared, done: &FinalFit) -> Option<f64> {
    let rows = &data.split.held_out;
    let square = |row: &usize| done.solution.residual[*row].powi(2);
    let all: f64 = rows.iter().map(square).sum();
    let mut sum = 0.0;
    let first = rows.iter().position(|row| {
        sum += square(row);
        sum >= TRACE * all
    })?;
    (first as f64 > TWENTIETH * rows.len() as f64).then(|| data.moment(rows[first]))
}

/// A creep whose initial state lies on a bound of its range: the relaxation does not come from a
/// motion of the input, and may come from the sensor itself.
pub(super) fn starts_apart(data: &Prepared, solution: &Solution) -> Option<Finding> {
    let terms = &solution.structure.terms;
    let ends = solution.free.iter().zip(&solution.on_bound);
    let mut starts = ends
        .filter(|(_, on_bound)| **on_bound)
        .filter_map(|(f, _)| match f.role {
            Role::Start { term, .. } => terms.find(term),
            _ => None,
        });
    let creeps = starts.any(|term| term.effect.info().family == "creep");
    creeps.then(|| Finding::CreepStartsOutside {
        output: data.output_name.clone(),
    })
}

/// Whether the model of the other files fails to describe a file that was held out as a whole.
pub(super) fn is_other_file(data: &Prepared, done: &FinalFit) -> bool {
    data.pieces.last().is_some_and(|piece| !piece.fitted) && other_rig(data, done).is_some()
}

/// A file that was held out as a whole and differs from the others, by gain and offset alone or
/// more.
pub(super) fn other_line(data: &Prepared, done: &FinalFit) -> Option<Finding> {
    let file = data.pieces.last().filter(|_| is_other_file(data, done))?;
    let (prediction, target) = (&done.solution.prediction, &data.target);
    let rows = data.split.held_out.iter();
    let (gain, offset) = line(rows.map(|&row| (prediction[row], target[row])));
    let pairs = target.iter().zip(prediction);
    let left: Vec<f64> = pairs.map(|(y, x)| y - gain * x - offset).collect();
    let share = |rmse: Segments| rmse.normalised(data, target).held_out;
    let (error, now) = (share(Segments::of(data, &left)), share(done.rmse));
    if error > QUARTER * now {
        let structure = &done.solution.structure;
        let may_help = structure.hysteresis && structure.own_gains == 0;
        return may_help.then_some(Finding::HeldOutFileDiffers);
    }
    Some(Finding::HeldOutFileScaled {
        path: file.path.clone(),
        gain,
        offset,
        unit: data.output_unit.clone(),
        error,
    })
}

/// The channel that replaces the output in the delivered model: its terms make up nearly all of the
/// output, although the baseline model explains nearly all of the output by the input.
pub(super) fn stands_for_output<'a>(
    data: &'a Prepared,
    declared: &Solution,
    done: &Solution,
) -> Option<&'a str> {
    let (most, nearly_all) = STANDS_FOR;
    let error = declared.rmse.normalised(data, &data.target).held_out;
    let (share, channel) = made_of_channel(data, done)?;
    (error < nearly_all && share > most).then(|| data.channels[channel].name.as_str())
}

/// The channel that gives nearly all of the output in a model that does not read its input.
pub(super) fn made_without_input<'a>(data: &'a Prepared, done: &Solution) -> Option<&'a str> {
    if !done.structure.hysteresis || done.structure.own_gains > 0 {
        return None;
    }
    let (columns, gains) = (&done.columns, &done.gains);
    let part = |row: usize| gains[0] * columns[0][row] + gains[1] * columns[1][row];
    let part: Vec<f64> = (0..data.target.len()).map(part).collect();
    let spread = |signal: &[f64]| Segments::deviation(data, signal).held_out;
    let transmits = spread(&part) >= TWENTIETH * spread(&data.target);
    let (share, channel) = made_of_channel(data, done)?;
    (!transmits && share > STANDS_FOR.0).then(|| data.channels[channel].name.as_str())
}

/// The channel whose terms make up most of the held-out output, and the ratio of their standard
/// deviation to the output's.
fn made_of_channel(data: &Prepared, done: &Solution) -> Option<(f64, usize)> {
    let terms = done.structure.terms.iter().filter(|t| t.is_linear());
    let gains = done.columns.iter().zip(&done.gains);
    let gains = terms.zip(gains.skip(done.structure.base()));
    let rows = &data.split.held_out;
    let spread = |signal: &[f64]| Segments::deviation(data, signal).held_out;
    let of = |channel: usize| {
        let mut made = vec![0.0; data.target.len()];
        let reads = |term: &FitTerm| term.source == Source::Channel(channel as u8);
        for (_, (column, gain)) in gains.clone().filter(|(term, _)| reads(term)) {
            for &row in rows {
                made[row] += gain * column[row];
            }
        }
        (spread(&made) / spread(&data.target), channel)
    };
    let all = (0..data.channels.len()).map(of);
    all.max_by(|a, b| a.0.total_cmp(&b.0))
}

/// A displacement that appears to be a velocity.
pub(super) fn velocity(data: &Prepared) -> Option<Finding> {
    let input = &data.input;
    let is = data.mode == Mode::Displacement && is_velocity(&input.name, input.unit.as_deref());
    is.then(|| Finding::InputIsVelocity {
        input: input.name.clone(),
    })
}

/// Motion of the input that was not measured, if the residual exceeds the noise.
pub(super) fn unseen_motion(data: &Prepared, done: &FinalFit) -> Option<Finding> {
    let is_left = data.noise_floor > 0.0 && done.rmse.fit > NOISE * data.noise_floor;
    let is = is_left && done.solution.structure.hysteresis && has_unseen_motion(data);
    is.then(|| Finding::MotionUnseen {
        input: data.input.name.clone(),
    })
}

fn has_unseen_motion(data: &Prepared) -> bool {
    let split = &data.split;
    let rows = || {
        [&split.fit, &split.selection, &split.held_out]
            .into_iter()
            .flatten()
    };
    let span = rows()
        .max()
        .zip(rows().min())
        .map_or(0, |(last, first)| last + 1 - first);
    // Short gaps are bridged, and nothing is left out for them.
    let is_left_out = data.pieces.len() > 1 || span > rows().count();
    is_left_out
        && data.defects.iter().any(|defect| match defect.kind {
            DefectKind::Gap => true,
            DefectKind::Stuck | DefectKind::Clipping => defect.channel == data.input.name,
            _ => false,
        })
}
