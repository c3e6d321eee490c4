//! Channels of a coarse sensor: the effect of its steps on the model, and the terms that they
//! explain.
//!
//! The edges of the steps are accurate to a fraction of a sample. With a line through the edges
//! instead of the steps, the model gives a different output: the difference is the effect of the
//! steps.

use super::final_fit::FinalFit;
use super::finding::Finding;
use super::words::{four_digits, spaced};
use crate::fit::Solution;
use crate::ledger::{CoarseChannel, Grade, Ledger, Round};
use crate::model::columns::{raw_columns, weighted};
use crate::problem::{Channel, Prepared, Stretch};
use crate::record::{Defect, DefectKind, Record, Steps};
use crate::scale::HALF;
use bowden::effect::Quantity;
use bowden::model::Source;

/// The channels whose steps matter to the final model: their effect on it is more than half of its
/// residual, and more than the noise floor. `prepare` puts records on the same grids.
pub(crate) fn coarse_channels(
    records: &[Record],
    done: &FinalFit,
    prepare: impl FnOnce(&[Record]) -> Option<Prepared>,
) -> Vec<CoarseChannel> {
    let steps: Vec<Vec<(usize, Steps)>> = records.iter().map(Record::steps).collect();
    if steps.iter().all(Vec::is_empty) {
        return Vec::new();
    }
    let finer: Vec<Record> = records.iter().map(Record::without_steps).collect();
    let data = &done.data;
    let Some(finer) = prepare(&finer).filter(|finer| finer.work_len() == data.work_len()) else {
        return Vec::new();
    };
    let residual = rms(data, &done.solution.residual);
    let all = 0..=data.channels.len();
    let of = |channel: usize| {
        let own =
            |list: &Vec<(usize, Steps)>| list.iter().find(|(c, _)| *c == channel).map(|s| s.1);
        let steps = steps.iter().filter_map(own);
        let steps = steps.max_by(|a, b| a.step.total_cmp(&b.step))?;
        let error = moved(data, &finer, channel, &done.solution)?;
        let matters = error > data.noise_floor && error > HALF * residual;
        matters.then(|| CoarseChannel {
            channel: match channel.checked_sub(1) {
                None => data.input.name.clone(),
                Some(index) => data.channels[index].name.clone(),
            },
            step: steps.step,
            counts: steps.counts,
            error,
            names: Vec::new(),
        })
    };
    all.filter_map(of).collect()
}

/// Root mean square on the fit segment.
fn rms(data: &Prepared, signal: &[f64]) -> f64 {
    let rows = &data.split.fit;
    let squares: f64 = rows.iter().map(|&row| signal[row].powi(2)).sum();
    (squares / rows.len().max(1) as f64).sqrt()
}

/// The change of the prediction with a line through the steps of one channel, 0 for the input.
fn moved(data: &Prepared, finer: &Prepared, channel: usize, model: &Solution) -> Option<f64> {
    let mut mended = data.clone();
    let put = |to: &mut Channel, from: &Channel| to.motion.clone_from(&from.motion);
    match channel.checked_sub(1) {
        None => put(&mut mended.input, &finer.input),
        Some(index) => put(&mut mended.channels[index], &finer.channels[index]),
    }
    let raw = raw_columns(&mended, &model.structure, &model.free, &model.values)?;
    let columns: Vec<&Stretch> = raw.columns.iter().map(|c| &**c).collect();
    let columns = mended.filtered_stretches(&columns);
    let prediction = weighted(&columns, &model.gains, data.target.len());
    let pairs = prediction.iter().zip(&model.prediction);
    let difference: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
    Some(rms(data, &difference)).filter(|error| error.is_finite())
}

/// Withdraws high confidence from the names that the steps of a channel explain, and adds a note on
/// the effect of the steps.
pub(crate) fn told(data: &mut Prepared, ledger: &mut Ledger, coarse: Vec<CoarseChannel>) {
    for mut one in coarse {
        let source = match data.channels.iter().position(|c| c.name == one.channel) {
            Some(index) => Source::Channel(index as u8),
            None => Source::Input,
        };
        let is_weak = |r: &&mut Round| r.term().source == source && is_explained(r, one.error);
        for round in ledger.beyond.iter_mut().filter(is_weak) {
            round.grade = Grade::Low;
        }
        for round in ledger.rounds.iter_mut().filter(is_weak) {
            round.grade = Grade::Low;
            one.names.push(round.term().effect.name().to_owned());
        }
        let is_known = |d: &Defect| d.kind == DefectKind::Quantisation && d.channel == one.channel;
        if !data.defects.iter().any(is_known) {
            data.notes.push(note(data, &one));
        }
        ledger.coarse.push(one);
    }
}

/// Whether the steps explain half or more of the reduction by a name, as RMS values. The name reads a
/// velocity or has reversals.
fn is_explained(round: &Round, error: f64) -> bool {
    let effect = &round.term().effect;
    let reads = |what: &Quantity| matches!(what, Quantity::Velocity | Quantity::Acceleration);
    let is_of_motion = effect.info().reads.iter().any(reads)
        || effect.info().memory
        || effect.reads_eta()
        || effect.is_input_stage();
    let removed = (round.before.fit.powi(2) - round.after.fit.powi(2))
        .max(0.0)
        .sqrt();
    is_of_motion && HALF * removed <= error
}

fn note(data: &Prepared, coarse: &CoarseChannel) -> String {
    let error = match data.noise_floor > 0.0 {
        true => format!(
            "{:.1} times the noise floor",
            coarse.error / data.noise_floor
        ),
        false => format!("{:.2e} of the output's unit", coarse.error),
    };
    format!(
        "`{}` has a resolution of {}{}, 1/{} of its range, which causes an error of {error} in the model's output",
        coarse.channel,
        four_digits(coarse.step),
        spaced(unit(data, &coarse.channel).as_deref()),
        coarse.counts
    )
}

/// The unit of a channel.
fn unit(data: &Prepared, channel: &str) -> Option<String> {
    let mut all = std::iter::once(&data.input).chain(&data.channels);
    all.find(|c| c.name == channel).and_then(|c| c.unit.clone())
}

/// The channels of a coarse sensor.
pub(super) fn coarse<'a>(
    data: &'a Prepared,
    ledger: &'a Ledger,
) -> impl Iterator<Item = Finding> + 'a {
    ledger.coarse.iter().map(|one| Finding::CoarseSensor {
        channel: one.clone(),
        unit: unit(data, &one.channel),
    })
}
