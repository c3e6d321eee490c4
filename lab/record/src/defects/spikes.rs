//! Single samples that jump away from a signal and back: electromagnetic interference, a dropped
//! frame, or a marker such as −999 instead of a value.
//!
//! A spike jumps further than the signal ever moves in one sample, and returns a few samples later.
//! A step does not return, and a burst of oscillation jumps several times in a row. A jump at both
//! ends of the transmission is an event, unless both are corrupted in the same samples.

use super::{share, Found};
use crate::scale::{quantile, steps, times, usual, FEW, FRACTION, GRAVE, LEAP, MANY};
use std::ops::Range;

/// At its end, a spike is within this fraction of its height of its initial value.
const BACK: f64 = 0.25;

/// A signal and its jumps.
pub(super) struct Leaps<'a> {
    signal: &'a [f64],
    /// Size of a step from which it is a jump.
    leap: f64,
    /// The candidates for a spike.
    candidates: Vec<Range<usize>>,
}

impl<'a> Leaps<'a> {
    pub(super) fn of(signal: &'a [f64]) -> Self {
        let mut leaps = Self {
            signal,
            leap: f64::INFINITY,
            candidates: Vec::new(),
        };
        let sizes = || steps(signal).map(f64::abs);
        let count = sizes().filter(|step| *step > 0.0);
        let count = count.fold(f64::INFINITY, f64::min);
        let [low, high] = [FRACTION, 1.0 - FRACTION].map(|q| quantile(signal.iter().copied(), q));
        let (Some(usual), Some(low), Some(high), true) =
            (usual(sizes()), low, high, count.is_finite())
        else {
            return leaps;
        };
        // Of the smallest step too, and smaller ones do no harm behind the filter.
        leaps.leap = (LEAP * usual.max(count)).max(FRACTION * (high - low));
        leaps.candidates = leaps.candidates(usual);
        leaps
    }

    /// Size of the step to a sample from the one before it.
    fn step(&self, i: usize) -> f64 {
        (self.signal[i] - self.signal[i - 1]).abs()
    }

    fn candidates(&self, usual: f64) -> Vec<Range<usize>> {
        let mut found = Vec::new();
        let mut i = 1;
        while i < self.signal.len() {
            let spike = (self.step(i) > self.leap).then(|| self.back_from(i, usual));
            i = match spike.flatten() {
                Some(end) => {
                    found.push(i..end);
                    end
                }
                None => i,
            } + 1;
        }
        found
    }

    /// The sample at which the signal has returned from a jump.
    fn back_from(&self, start: usize, usual: f64) -> Option<usize> {
        let origin = self.signal[start - 1];
        let mut height = f64::INFINITY;
        for end in start + 1..self.signal.len().min(start + MANY) {
            let last = self.signal[end - 1];
            let length = end - start;
            height = height.min((last - origin).abs());
            let rests = last == self.signal[start];
            if height < self.leap || (length > FEW && !rests) {
                return None;
            }
            let away = (self.signal[end] - origin).abs();
            if away <= BACK * height + usual * length as f64 && self.step(end) > 0.5 * self.leap {
                return Some(end);
            }
        }
        None
    }

    /// Whether nothing happens around a spike, except a few other spikes.
    fn is_alone(&self, spike: &Range<usize>) -> bool {
        let (from, to) = (spike.start.saturating_sub(2 * FEW), spike.end + 2 * FEW);
        let first = self.candidates.partition_point(|other| other.end < from);
        let near = self.candidates[first..].iter();
        let near: Vec<_> = near.take_while(|other| other.start <= to).collect();
        let of_spike = |i: usize| near.iter().any(|other| other.start <= i && i <= other.end);
        let mut around = from.max(1)..=to.min(self.signal.len() - 1);
        near.len() <= FEW && around.all(|i| of_spike(i) || self.step(i) < 0.5 * self.leap)
    }

    /// Whether this end of the transmission responds to a candidate spike of the other end.
    fn answers(&self, spike: &Range<usize>) -> bool {
        if self.candidates.contains(spike) {
            return false;
        }
        let last = (spike.end + FEW).min(self.signal.len() - 1);
        (spike.start.saturating_sub(FEW).max(1)..=last).any(|i| self.step(i) > self.leap)
    }

    /// The spikes to which no other signal responds.
    pub(super) fn spikes(&self, others: &[&Leaps], few: f64) -> Option<Found> {
        let is_spike = |spike: &&Range<usize>| {
            self.is_alone(spike) && !others.iter().any(|other| other.answers(spike))
        };
        let samples: Vec<_> = self.candidates.iter().filter(is_spike).cloned().collect();
        let longest = samples.iter().map(ExactSizeIterator::len).max()?;
        let share = share(&samples, self.signal.len());
        let height = |spike: &Range<usize>| self.step(spike.start);
        let highest = samples.iter().map(height).fold(0.0, f64::max);
        let within = match longest {
            1 => "one sample".to_owned(),
            _ => format!("{longest} samples"),
        };
        (share <= GRAVE).then(|| Found {
            message: format!(
                "spikes: up to {} for at most {within}, {}; a straight line replaces {:.2} % of the samples",
                three_digits(highest),
                times(samples.len()),
                100.0 * share
            ),
            grave: share > few,
            samples,
        })
    }
}

/// A positive number to three significant digits.
fn three_digits(value: f64) -> f64 {
    let unit = 10.0_f64.powi(2 - value.log10().floor() as i32);
    (value * unit).round() / unit
}
