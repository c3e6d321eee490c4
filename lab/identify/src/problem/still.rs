//! An input at rest: its noise must not drive the hysteresis.
//!
//! The state of a hysteresis moves with the travel of the input, and noise travels far during a
//! rest of seconds: its effect on the state then looks like play or presliding. If the smoothed
//! input stays within its own noise for long, it is replaced by a straight line.

use super::ZeroPhase;
use crate::algebra::line;
use crate::scale::SWING;

/// A rest stays within the swing of the smoothed noise for at least this many periods of the cut-off
/// (in fewer the travel of the noise is small) ...
const LONG: f64 = 10.0;
/// ... and has a standard deviation of at most this many of the noise's: three standard deviations
/// of an estimate from at least fifty independent values.
const ALONE: f64 = 1.3;
/// With less noise than this share of it a rest needs no line.
const LEAST: f64 = 0.4;

/// The standard deviation of the noise of a column, per sample, from the median of its fourth
/// differences: they contain almost nothing of the smooth motion, and the median ignores spikes.
#[must_use]
pub fn noise(column: &[f64]) -> f64 {
    let bend = |w: &[f64]| (w[0] - 4.0 * w[1] + 6.0 * w[2] - 4.0 * w[3] + w[4]).abs();
    let mut bends: Vec<f64> = column.windows(5).map(bend).collect();
    if bends.is_empty() {
        return 0.0;
    }
    let middle = bends.len() / 2;
    let median = *bends.select_nth_unstable_by(middle, f64::total_cmp).1;
    // The median of |N(0, 1)| is 0.6745; a fourth difference has 70 times the variance.
    median / (0.6745 * 70.0_f64.sqrt())
}

fn spread(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt()
}

/// Whether a column is only noise.
pub(super) fn is_at_rest(column: &[f64]) -> bool {
    spread(column) <= ALONE * noise(column)
}

/// The note on a channel that is only noise in each of some records.
pub(super) fn note(channel: &str, records: usize) -> String {
    match records {
        1 => format!("`{channel}` shows only sensor noise, so no term reads it"),
        _ => format!(
            "within each file `{channel}` shows only sensor noise, so it has one value per file and no term reads it"
        ),
    }
}

/// Whether an output follows an input at rest row by row: half of its variance or more. Sensors do not
/// share their noise, so the rows are not in the order of time.
pub(super) fn follows(input: &[f64], output: &[f64]) -> bool {
    let pairs = || input.iter().copied().zip(output.iter().copied());
    let (gain, offset) = line(pairs());
    let left: Vec<f64> = pairs().map(|(x, y)| y - gain * x - offset).collect();
    2.0 * spread(&left).powi(2) <= spread(output).powi(2)
}

/// Whether a stretch, and each quarter of it, is noise of this standard deviation.
fn is_noise(stretch: &[f64], noise: f64) -> bool {
    let within = |values: &[f64], most: f64| (LEAST..most).contains(&(spread(values) / noise));
    let mut quarters = stretch.chunks(stretch.len().div_ceil(4));
    within(stretch, ALONE) && quarters.all(|own| within(own, ALONE * ALONE))
}

/// The smoothed input, with a line instead of each long rest, and the samples at rest.
pub(super) fn smoothed(smooth: &ZeroPhase, input: &[f64], period: f64) -> (Vec<f64>, usize) {
    let mut smoothed = smooth.apply(input);
    let rested = still(&mut smoothed, smooth.noise_gain() * noise(input), period);
    (smoothed, rested)
}

/// Replaces long rests of a smoothed signal with a line. The noise of the signal has the given
/// standard deviation; `period` is that of the cut-off \[samples\]. Returns the samples at rest.
fn still(smoothed: &mut [f64], noise: f64, period: f64) -> usize {
    let (most, long) = (SWING * noise, (LONG * period).ceil() as usize);
    let edge = period.ceil() as usize;
    let (mut start, mut rested) = (0, 0);
    while noise > 0.0 && start + long < smoothed.len() {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let within = |value: &&f64| {
            low = low.min(**value);
            high = high.max(**value);
            high - low <= most
        };
        let length = smoothed[start..].iter().take_while(within).count();
        // Motion as small as that has more spread than noise; a rest without noise needs no line.
        if length < long || !is_noise(&smoothed[start..start + length], noise) {
            start += (length / 2).max(1);
            continue;
        }
        let (from, to) = (start + edge, start + length - edge);
        let (first, last) = (smoothed[from], smoothed[to - 1]);
        let steps = (to - 1 - from).max(1) as f64;
        for (k, value) in smoothed[from..to].iter_mut().enumerate() {
            *value = first + (last - first) * k as f64 / steps;
        }
        rested += to - from;
        start += length;
    }
    rested
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hash(row: usize) -> f64 {
        let one = |k: usize| (((row + k) as f64 * 12.9898).sin() * 43758.5453).rem_euclid(1.0);
        // Of unit variance.
        (0..12).map(|k| one(7919 * k)).sum::<f64>() - 6.0
    }

    fn way(signal: &[f64]) -> f64 {
        signal.windows(2).map(|w| (w[1] - w[0]).abs()).sum()
    }

    #[test]
    fn noise_goes_no_way_at_rest_and_motion_stays_as_it_is() {
        let at = |row: usize| match row {
            0..1000 | 3000.. => (0.01 * row as f64).sin(),
            _ => (10.0_f64).sin() + 0.005 * hash(row),
        };
        let before: Vec<f64> = (0..4000).map(at).collect();
        let mut after = before.clone();
        let rested = still(&mut after, 0.005, 20.0);
        assert!((1900..2000).contains(&rested), "{rested}");
        assert!(way(&after[1100..2900]) < 0.05 && way(&before[1100..2900]) > 5.0);
        assert_eq!(after[..950], before[..950]);
        assert_eq!(after[3050..], before[3050..]);
        // Motion within the same band is none.
        let small = |row: usize| match row {
            0..1000 | 3000.. => (0.01 * row as f64).sin(),
            _ => (10.0_f64).sin() + 0.015 * (0.03 * row as f64).sin(),
        };
        let mut own: Vec<f64> = (0..4000).map(small).collect();
        assert_eq!(still(&mut own, 0.005, 20.0), 0);
        // Without noise nothing rests but what is still.
        let mut own = before.clone();
        assert_eq!(still(&mut own, 0.0, 20.0), 0);
        assert_eq!(own, before);
    }

    #[test]
    fn the_noise_is_that_of_the_samples_whatever_the_motion() {
        let column: Vec<f64> = (0..20_000)
            .map(|row| 5.0 * (0.01 * row as f64).sin() + 0.02 * hash(row))
            .collect();
        assert!(
            (noise(&column) / 0.02 - 1.0).abs() < 0.05,
            "{}",
            noise(&column)
        );
    }
}
