//! The common basis of all detectors: thresholds, one false-alarm rate, and the statistics of a
//! signal.
//!
//! A detector is a statistic whose size without the defect is known. One threshold decides whether
//! a defect is reported, and a larger threshold decides whether it is grave.

use std::ops::Range;

/// Fraction of the samples, or of the standard deviation of a signal, from which a defect is
/// reported.
pub(super) const TOLD: f64 = 0.003;
/// Fraction from which a movement counts, and from which coarse steps are reported. For defects of
/// the input and of the time, conclusions are invalid from this fraction, because such a defect
/// acts on all later samples.
pub(super) const FRACTION: f64 = 0.02;
/// Fraction from which conclusions are invalid for other defects, and fraction of exceptions from
/// which they are the rule.
pub(super) const GRAVE: f64 = 0.05;
/// Fraction of a record that may be missing.
pub(super) const MISSING: f64 = 0.1;

/// Probability below which a run is not attributed to noise.
pub(super) const CHANCE: f64 = 1e-9;
/// Size that clearly exceeds the noise, in multiples of the noise rms.
pub(super) const CLEAR: f64 = 5.0;
/// Factor by which the measure of one explanation must exceed that of another to be better.
pub(super) const BETTER: f64 = 2.0;
/// Quantile up to which sizes are usual.
const USUAL: f64 = 0.9;
/// Size of a jump in multiples of the usual size. In a million samples, noise with a Laplace
/// distribution reaches 6 times this quantile.
pub(super) const LEAP: f64 = 8.0;
/// Fraction of reversals among the steps from which a signal contains noise.
const TURNS: f64 = 0.1;

/// A few samples: the shortest plateau, the longest spike, and the surroundings of an event.
pub(super) const FEW: usize = 5;
/// Number of samples for which a signal rarely rests.
pub(super) const MANY: usize = 20;
/// Minimum number of steps from which their usual size or their period is determined.
pub(super) const ENOUGH: usize = 60;

/// Smallest and largest value.
pub(super) fn range(values: &[f64]) -> (f64, f64) {
    let wider = |(low, high): (f64, f64), value: &f64| (low.min(*value), high.max(*value));
    values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), wider)
}

/// The change to each sample except the first.
pub(super) fn steps(signal: &[f64]) -> impl Iterator<Item = f64> + '_ {
    signal.windows(2).map(|pair| pair[1] - pair[0])
}

/// The intervals of equal values.
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

/// Whether noise moves a signal back and forth, according to the fraction of reversals among its
/// nonzero steps.
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
