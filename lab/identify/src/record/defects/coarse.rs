//! Steps so coarse that they shape the signal: the comb of a converter with few bits.
//!
//! A converter's usual steps are finer than the signal's noise, which then makes them
//! harmless. Here most neighbours are the same, all values lie on a comb, and the steps'
//! own error (q/√12) is a share of the signal that matters. A commanded staircase looks
//! the same, but the other end answers each of its steps; behind a coarse sensor it goes
//! on evenly.

use super::companion::Companion;
use super::Found;
use std::ops::Range;

/// Share of the signal's spread from which the error of the steps is told.
const TOLD: f64 = 0.02;
/// Share from which it spoils the conclusion.
const GRAVE: f64 = 0.05;
/// A comb with more teeth than this is fine enough for any signal.
const MOST_LEVELS: usize = 1000;
/// A switch has two or three levels and is meant to.
const FEWEST_LEVELS: usize = 4;
/// Share of neighbours that are the same.
const SAME: f64 = 0.5;
/// How much further the other end may go at the start of a plateau than at its end.
const ANSWERS: f64 = 2.0;

pub(super) fn find(signal: &[f64], other: &Companion) -> Option<Found> {
    let (step, levels) = comb(signal)?;
    let count = signal.len() as f64;
    let mean = signal.iter().sum::<f64>() / count;
    let spread = (signal.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count).sqrt();
    let share = step / 12.0_f64.sqrt() / spread;
    let same = signal.windows(2).filter(|pair| pair[0] == pair[1]).count() as f64;
    if share.is_nan() || share < TOLD || same < SAME * count || is_commanded(signal, other) {
        return None;
    }
    Some(Found {
        message: format!(
            "coarse: steps of {step} over {levels} levels, an error of {:.1} % of the signal's spread; a finer sensor or range was expected",
            100.0 * share
        ),
        grave: share > GRAVE,
        most: 1.0,
        samples: std::iter::once(0..signal.len()).collect(),
    })
}

/// The step of the comb on which all values lie, and how many levels are used.
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
    (levels.len() >= FEWEST_LEVELS && step > 0.0 && gaps.iter().all(whole))
        .then_some((step, levels.len()))
}

/// Whether the other end answers the steps.
fn is_commanded(signal: &[f64], other: &Companion) -> bool {
    let (mut first, mut last) = (0.0, 0.0);
    let mut start = 0;
    let mut plateau = |stretch: Range<usize>| {
        let (a, b) = other.ends(&stretch);
        first += a;
        last += b;
    };
    for i in 1..signal.len() {
        if signal[i] != signal[i - 1] {
            plateau(start..i);
            start = i;
        }
    }
    first > ANSWERS * last
}
