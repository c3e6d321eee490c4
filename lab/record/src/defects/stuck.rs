//! A sensor that is constant while the measured quantity moves.
//!
//! A run of bit-identical values alone proves nothing: references rest, encoders wait for the next
//! count, dry friction without noise is flat. The sensor is stuck if the other signals move during
//! the run, and if either the sensor's noise disappears with it or the signal jumps at its end,
//! further than it ever moves in one sample. If most of the record consists of such runs, the
//! signal is flat by nature.

use super::companion::Companion;
use super::{share, times, Found};
use std::ops::Range;

/// Shortest run that is considered [samples].
const SHORTEST: usize = 20;
/// Share of their usual speed at which other signals must move, both if the noise is gone and if
/// only a jump shows the defect: a reference may rest while its rig settles.
const CREEPING: f64 = 0.02;
const MOVING: f64 = 0.3;
/// A jump is at least this multiple of the largest usual step.
const LEAP: f64 = 3.0;
/// Steps are usual up to this quantile.
const USUAL: f64 = 0.995;
/// Minimum number of steps that determine the usual step.
const FEW_STEPS: usize = 40;
/// Share of turns among the steps from which a signal carries noise.
const TURNS: f64 = 0.1;
/// Chance of a run by noise alone, below which it is none.
const CHANCE: f64 = 1e-9;
/// Share of the record above which flat runs are normal for the signal.
const NATURE: f64 = 0.5;
/// A run up to the end of the record is at least this multiple of any other run.
const DEAD_END: usize = 5;

pub(super) fn find(signal: &[f64], others: &[&Companion], few: f64) -> Option<Found> {
    let runs = runs(signal);
    let suspects: Vec<Range<usize>> = runs
        .iter()
        .filter(|run| run.len() >= SHORTEST && others.iter().any(|o| o.moves(run, CREEPING)))
        .cloned()
        .collect();
    if suspects.is_empty() || share(&suspects, signal.len()) > NATURE {
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
            "stuck {}: bit for bit the same for up to {longest} samples while the rest of the record moves; {:.2} % of the samples",
            times(samples.len()),
            100.0 * share
        ),
        grave: share > few,
        most: 1.0,
        samples,
    })
}

/// All stretches of equal values.
fn runs(signal: &[f64]) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let mut start = 0;
    for i in 1..=signal.len() {
        if i == signal.len() || signal[i] != signal[start] {
            runs.push(start..i);
            start = i;
        }
    }
    runs
}

struct Judge<'a> {
    signal: &'a [f64],
    others: &'a [&'a Companion],
    /// Largest usual step; `None` if there are too few steps.
    usual: Option<f64>,
    /// Longest run that noise could cause; `None` if the signal has no noise.
    by_noise: Option<f64>,
    /// Longest run that is not suspect.
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
        let mut moving: Vec<f64> = steps.iter().copied().filter(|step| *step != 0.0).collect();
        let turns = moving.windows(2).filter(|w| w[0] * w[1] < 0.0).count();
        let noisy = turns as f64 > TURNS * moving.len() as f64;
        // Thrice as often the same as seen: the noise may be smaller where the signal rests.
        let same = 1.0 - moving.len() as f64 / steps.len().max(1) as f64 / 3.0;
        let by_noise = (CHANCE / signal.len() as f64).ln() / same.ln();
        moving.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
        let usual = moving
            .get((USUAL * moving.len() as f64) as usize)
            .map(|s| s.abs());
        let is_suspect = |run: &&Range<usize>| {
            let found = suspects.binary_search_by_key(&run.start, |suspect| suspect.start);
            found.is_ok()
        };
        let innocent = runs.iter().filter(|run| !is_suspect(run));
        let innocent = innocent.map(ExactSizeIterator::len);
        let (low, high) = crate::clipping::range(signal);
        Self {
            signal,
            others,
            usual: usual.filter(|_| moving.len() >= FEW_STEPS),
            by_noise: noisy.then_some(by_noise),
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
        let dead =
            run.end == self.signal.len() && run.len() > DEAD_END * self.innocent.max(SHORTEST);
        let moving = || self.others.iter().any(|other| other.moves(run, MOVING));
        silent || ((self.leaps(run.end) || dead) && moving())
    }
}
