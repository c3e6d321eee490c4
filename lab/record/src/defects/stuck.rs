//! A sensor that is constant while the measured quantity moves.
//!
//! A run of bit-identical values by itself proves nothing. References rest, encoders wait for the
//! next count, and dry friction without noise is flat. Two conditions identify a stuck sensor. The
//! other signals move during the run. In addition, the sensor noise disappears during the run, or
//! the signal jumps at its end further than it ever moves in one sample. If most of the record
//! consists of such runs, the signal is flat by nature.

use super::companion::Companion;
use super::{share, Found};
use crate::scale::{
    is_noisy, range, runs, times, usual, CHANCE, ENOUGH, FEW, FRACTION, LEAP, MANY,
};
use std::ops::Range;

/// Fraction of their usual speed with which the other signals must move if a jump is the only sign.
/// A reference may rest while its rig settles.
const MOVING: f64 = 0.3;

pub(super) fn find(signal: &[f64], others: &[&Companion], few: f64) -> Option<Found> {
    let runs: Vec<Range<usize>> = runs(signal).collect();
    let suspects: Vec<Range<usize>> = runs
        .iter()
        .filter(|run| run.len() >= MANY && others.iter().any(|o| o.moves(run, FRACTION)))
        .cloned()
        .collect();
    // A signal that is mostly flat is flat by nature.
    if suspects.is_empty() || share(&suspects, signal.len()) > 0.5 {
        return None;
    }
    let judge = Judge::new(signal, others, &runs, &suspects);
    let samples: Vec<Range<usize>> = suspects
        .into_iter()
        .filter(|run| judge.is_stuck(run))
        .collect();
    let share = share(&samples, signal.len());
    let longest = samples.iter().map(ExactSizeIterator::len).max()?;
    Some(Found {
        message: format!(
            "stuck {}: bit-identical for up to {longest} samples while other signals move; {:.2} % of the samples",
            times(samples.len()),
            100.0 * share
        ),
        grave: share > few,
        samples,
    })
}

struct Judge<'a> {
    signal: &'a [f64],
    others: &'a [&'a Companion],
    /// Largest usual step; `None` if there are too few steps.
    usual: Option<f64>,
    /// Longest run that noise could cause; `None` if the signal has no noise.
    by_noise: Option<f64>,
    /// Longest run that is not suspicious.
    innocent: usize,
    low: f64,
    high: f64,
}

impl<'a> Judge<'a> {
    fn new(
        signal: &'a [f64],
        others: &'a [&'a Companion],
        runs: &[Range<usize>],
        suspects: &[Range<usize>],
    ) -> Self {
        let suspect = |i: usize| {
            let after = suspects.partition_point(|run| run.end < i);
            suspects
                .get(after)
                .is_some_and(|run| run.start <= i && i <= run.end)
        };
        let inside: Vec<usize> = (1..signal.len()).filter(|&i| !suspect(i)).collect();
        let steps: Vec<f64> = inside.iter().map(|&i| signal[i] - signal[i - 1]).collect();
        let moving: Vec<f64> = steps.iter().copied().filter(|step| *step != 0.0).collect();
        // Thrice as often the same as seen: the noise may be smaller where the signal rests.
        let same = 1.0 - moving.len() as f64 / steps.len().max(1) as f64 / 3.0;
        let by_noise = (CHANCE / signal.len() as f64).ln() / same.ln();
        let is_suspect = |run: &&Range<usize>| {
            let found = suspects.binary_search_by_key(&run.start, |suspect| suspect.start);
            found.is_ok()
        };
        let innocent = runs.iter().filter(|run| !is_suspect(run));
        let innocent = innocent.map(ExactSizeIterator::len);
        let (low, high) = range(signal);
        Self {
            signal,
            others,
            usual: usual(moving.iter().map(|step| step.abs())).filter(|_| moving.len() >= ENOUGH),
            by_noise: is_noisy(&moving).then_some(by_noise),
            innocent: innocent.max().unwrap_or(0),
            low,
            high,
        }
    }

    fn leaps(&self, at: usize) -> bool {
        let step = |i: usize| (self.signal[i] - self.signal[i - 1]).abs();
        (1..self.signal.len()).contains(&at)
            && self.usual.is_some_and(|usual| step(at) > LEAP * usual)
    }

    fn is_stuck(&self, run: &Range<usize>) -> bool {
        let level = self.signal[run.start];
        // The end of the sensor's range is clipping, unless the signal leaps there.
        if (level == self.low || level == self.high) && !self.leaps(run.start) {
            return false;
        }
        let silent = self
            .by_noise
            .is_some_and(|longest| run.len() as f64 > longest);
        let dead = run.end == self.signal.len() && run.len() > FEW * self.innocent.max(MANY);
        let moving = || self.others.iter().any(|other| other.moves(run, MOVING));
        silent || ((self.leaps(run.end) || dead) && moving())
    }
}
