//! Steps that are so coarse that they determine the shape of the signal, for example from a
//! converter with few bits.
//!
//! The steps of a converter are usually finer than the signal's noise, which makes them harmless.
//! In a coarse signal, most neighbouring values are equal, all values are multiples of one step q,
//! and the quantisation error (q/√12) is a significant fraction of the signal. A commanded
//! staircase looks the same, but the other end responds to each step. With a coarse sensor, the
//! other end moves smoothly.

use super::companion::Companion;
use super::Found;
use crate::scale::{range, runs, spread, BETTER, FRACTION, GRAVE};

/// Number of levels above which the steps are fine enough for any signal.
const MOST_LEVELS: usize = 1000;

/// The steps of a sensor with few steps in its used range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// One step, in the column's unit.
    pub step: f64,
    /// The range of the signal, in steps.
    pub counts: f64,
}

impl Steps {
    /// The steps of a signal; `None` if they are fine, or commanded.
    pub(super) fn of(signal: &[f64], other: &Companion) -> Option<Self> {
        let (step, _) = comb(signal)?;
        let (low, high) = range(signal);
        shapes(signal, other).then(|| Self {
            step,
            counts: ((high - low) / step).round(),
        })
    }
}

pub(super) fn find(signal: &[f64], other: &Companion) -> Option<Found> {
    let (step, levels) = comb(signal)?;
    let share = step / 12.0_f64.sqrt() / spread(signal);
    if share.is_nan() || share < FRACTION || !shapes(signal, other) {
        return None;
    }
    Some(Found {
        message: format!(
            "coarse: steps of {step} over {levels} levels cause an error of {:.1} % of the signal's standard deviation; use a finer sensor or range",
            100.0 * share
        ),
        grave: share > GRAVE,
        samples: std::iter::once(0..signal.len()).collect(),
    })
}

/// Whether the steps determine the shape of the signal: most neighbouring values are equal, and the
/// other end does not respond to the steps.
fn shapes(signal: &[f64], other: &Companion) -> bool {
    let same = signal.windows(2).filter(|pair| pair[0] == pair[1]).count();
    2 * same >= signal.len() && !is_commanded(signal, other)
}

/// A signal that is interpolated linearly between the edges of its steps. At a reversal, the line
/// reaches the level.
pub(super) fn through_edges(signal: &[f64]) -> Vec<f64> {
    let Some(last) = signal.len().checked_sub(1) else {
        return Vec::new();
    };
    let mut points = vec![(0.0, signal[0])];
    let (mut edge, mut rose) = (0, None);
    for i in 1..=last {
        if signal[i] == signal[i - 1] {
            continue;
        }
        let rises = signal[i] > signal[i - 1];
        if rose == Some(!rises) {
            points.push((0.5 * (edge + i - 1) as f64, signal[i - 1]));
        }
        points.push((i as f64 - 0.5, 0.5 * (signal[i] + signal[i - 1])));
        (edge, rose) = (i, Some(rises));
    }
    points.push((last as f64, signal[last]));
    let mut next = 1;
    (0..=last)
        .map(|i| {
            let at = i as f64;
            while next + 1 < points.len() && points[next].0 < at {
                next += 1;
            }
            let ((from, low), (to, high)) = (points[next - 1], points[next]);
            low + (high - low) * (at - from) / (to - from).max(f64::MIN_POSITIVE)
        })
        .collect()
}

/// The step of which all values are multiples, and the number of used levels.
fn comb(signal: &[f64]) -> Option<(f64, usize)> {
    let mut levels: Vec<f64> = Vec::new();
    for value in signal {
        // Minus zero is the same level as zero.
        let value = value + 0.0;
        if let Err(place) = levels.binary_search_by(|level| level.total_cmp(&value)) {
            levels.insert(place, value);
        }
        if levels.len() > MOST_LEVELS {
            return None;
        }
    }
    let gaps: Vec<f64> = levels.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let step = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    let whole = |gap: &f64| (gap / step - (gap / step).round()).abs() < 0.05;
    // A switch has two or three levels and is meant to.
    (levels.len() > 3 && step > 0.0 && gaps.iter().all(whole)).then_some((step, levels.len()))
}

/// Whether the other end responds to the steps.
fn is_commanded(signal: &[f64], other: &Companion) -> bool {
    let ends = runs(signal).map(|plateau| other.ends(&plateau));
    let (first, last) = ends.fold((0.0, 0.0), |(first, last), (a, b)| (first + a, last + b));
    first > BETTER * last
}
