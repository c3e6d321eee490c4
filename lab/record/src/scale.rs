//! What all detectors share: one scale of consequences, one false-alarm rate, and the statistics of
//! a signal from which they judge.
//!
//! A detector is a statistic whose size without the defect is known. One share decides whether a defect
//! is told, and a larger one whether it is grave.

use std::ops::Range;

/// Share of the samples, or of a signal's spread, from which a defect is told.
pub(super) const TOLD: f64 = 0.003;
/// Share from which a movement counts, and coarse steps are told; and from which conclusions are
/// invalid where the defect acts on all samples behind it: at the input, whose motion acts through
/// the hysteresis, and in time.
pub(super) const FRACTION: f64 = 0.02;
/// Share from which other conclusions are invalid; and the share of exceptions from which they are
/// the rule.
pub(super) const GRAVE: f64 = 0.05;
/// Share of a record that may be missing.
pub(super) const MISSING: f64 = 0.1;

/// Chance of a run by noise alone, below which it is none.
pub(super) const CHANCE: f64 = 1e-9;
/// What is clear of noise, in multiples of its rms.
pub(super) const CLEAR: f64 = 5.0;
/// One explanation is better than another if its measure is so many times larger.
pub(super) const BETTER: f64 = 2.0;
/// Sizes are usual up to this quantile.
const USUAL: f64 = 0.9;
/// A leap is so many times the usual size: noise of Laplace's distribution reaches 6 times that
/// quantile in a million samples.
pub(super) const LEAP: f64 = 8.0;
/// Share of turns among the steps from which a signal carries noise.
const TURNS: f64 = 0.1;

/// A few samples: the shortest plateau, the longest spike, what surrounds an event.
pub(super) const FEW: usize = 5;
/// Samples that a signal rarely rests for.
pub(super) const MANY: usize = 20;
/// Minimum number of steps that determine their usual size or their period.
pub(super) const ENOUGH: usize = 60;

/// Smallest and largest value.
pub(super) fn range(values: &[f64]) -> (f64, f64) {
    let wider = |(low, high): (f64, f64), value: &f64| (low.min(*value), high.max(*value));
    values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), wider)
}

/// The change to each sample but the first.
pub(super) fn steps(signal: &[f64]) -> impl Iterator<Item = f64> + '_ {
    signal.windows(2).map(|pair| pair[1] - pair[0])
}

/// The stretches of equal values.
pub(super) fn runs(signal: &[f64]) -> impl Iterator<Item = Range<usize>> + '_ {
    let mut end = 0;
    signal.chunk_by(|a, b| a == b).map(move |run| {
        end += run.len();
        end - run.len()..end
    })
}

/// A quantile of some values.
pub(super) fn quantile(values: impl IntoIterator<Item = f64>, share: f64) -> Option<f64> {
    let mut values: Vec<f64> = values.into_iter().collect();
    let place = (share * values.len() as f64) as usize;
    let place = place.min(values.len().checked_sub(1)?);
    Some(*values.select_nth_unstable_by(place, f64::total_cmp).1)
}

/// The largest usual value.
pub(super) fn usual(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    quantile(values, USUAL)
}

/// Standard deviation.
pub(super) fn spread(signal: &[f64]) -> f64 {
    let count = signal.len() as f64;
    let mean = signal.iter().sum::<f64>() / count;
    (signal.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count).sqrt()
}

/// Whether noise moves a signal back and forth: the share of turns among its steps other than zero.
pub(super) fn is_noisy(moving: &[f64]) -> bool {
    let turns = moving.windows(2).filter(|pair| pair[0] * pair[1] < 0.0);
    turns.count() as f64 > TURNS * moving.len() as f64
}

/// "1 cell", "3 cells".
pub(super) fn counted(count: usize, noun: &str) -> String {
    match count {
        1 => format!("1 {noun}"),
        _ => format!("{count} {noun}s"),
    }
}

/// "once", "3 times".
pub(super) fn times(count: usize) -> String {
    match count {
        1 => "once".to_owned(),
        _ => format!("{count} times"),
    }
}
