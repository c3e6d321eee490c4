//! Single samples that jump away from a signal and back: electromagnetic interference, a dropped
//! frame, or a marker such as −999 instead of a value.
//!
//! A spike jumps further than the signal ever moves in one sample, and returns a few samples later.
//! A step does not return, and a burst of oscillation jumps several times in a row. A jump at both
//! ends of the transmission is an event, unless both are corrupted in the same samples.

use super::{share, times, Found};
use std::ops::Range;

/// Longest spike [samples]; and the longest one that rests on one value.
const LONGEST: usize = 5;
const LONGEST_AT_REST: usize = 19;
/// A jump is at least this multiple of the 90 % quantile of the steps, and of the smallest step:
/// noise of Laplace's distribution reaches 6 times that quantile in a million samples.
const LEAP: f64 = 8.0;
const USUAL: f64 = 0.9;
/// A leap is also this share of the signal's spread from its 1 % to its 99 % quantile: smaller
/// ones do no harm behind the filter.
const NOTICEABLE: f64 = 0.03;
/// A spike ends within this share of its height from where it began.
const BACK: f64 = 0.25;
/// Samples on either side that must be calm, and the number of other spikes allowed in them.
const CALM: usize = 10;
const NEIGHBOURS: usize = 4;
/// Samples around a spike in which a jump of the other end makes the spike an event.
const EVENT: usize = 2;
/// Share of samples above which jumps are normal for the signal.
const NATURE: f64 = 0.05;

/// A signal and its leaps.
pub(super) struct Leaps<'a> {
    signal: &'a [f64],
    /// The step from which a leap begins.
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
        let mut steps: Vec<f64> = (1..signal.len()).map(|i| leaps.step(i)).collect();
        let count = steps.iter().copied().filter(|step| *step > 0.0);
        let count = count.fold(f64::INFINITY, f64::min);
        let (Some(usual), true) = (quantile(&mut steps, USUAL), count.is_finite()) else {
            return leaps;
        };
        let mut values = signal.to_vec();
        let (low, high) = (quantile(&mut values, 0.01), quantile(&mut values, 0.99));
        let spread = high.zip(low).map_or(0.0, |(high, low)| high - low);
        leaps.leap = (LEAP * usual.max(count)).max(NOTICEABLE * spread);
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

    /// The sample at which the signal is back from a leap.
    fn back_from(&self, start: usize, usual: f64) -> Option<usize> {
        let origin = self.signal[start - 1];
        let mut height = f64::INFINITY;
        for end in start + 1..self.signal.len().min(start + LONGEST_AT_REST + 1) {
            let last = self.signal[end - 1];
            let length = end - start;
            height = height.min((last - origin).abs());
            let rests = last == self.signal[start];
            if height < self.leap || (length > LONGEST && !rests) {
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
        let (from, to) = (spike.start.saturating_sub(CALM), spike.end + CALM);
        let first = self.candidates.partition_point(|other| other.end < from);
        let near = self.candidates[first..].iter();
        let near: Vec<_> = near.take_while(|other| other.start <= to).collect();
        let of_spike = |i: usize| near.iter().any(|other| other.start <= i && i <= other.end);
        let mut around = from.max(1)..=to.min(self.signal.len() - 1);
        near.len() <= 1 + NEIGHBOURS
            && around.all(|i| of_spike(i) || self.step(i) < 0.5 * self.leap)
    }

    /// Whether this end of the transmission responds to a candidate spike of the other end.
    fn answers(&self, spike: &Range<usize>) -> bool {
        if self.candidates.contains(spike) {
            return false;
        }
        let last = (spike.end + EVENT).min(self.signal.len() - 1);
        (spike.start.saturating_sub(EVENT).max(1)..=last).any(|i| self.step(i) > self.leap)
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
        (share <= NATURE).then(|| Found {
            message: format!(
                "spikes: up to {} for at most {within}, {}; replaced by a straight line, {:.2} % of the samples",
                three_digits(highest),
                times(samples.len()),
                100.0 * share
            ),
            grave: share > few,
            most: 1.0,
            samples,
        })
    }
}

/// A quantile of some values; reorders them.
fn quantile(values: &mut [f64], share: f64) -> Option<f64> {
    let place = (share * values.len() as f64) as usize;
    let place = place.min(values.len().checked_sub(1)?);
    Some(*values.select_nth_unstable_by(place, f64::total_cmp).1)
}

/// A positive number to three significant digits.
fn three_digits(value: f64) -> f64 {
    let unit = 10.0_f64.powi(2 - value.log10().floor() as i32);
    (value * unit).round() / unit
}
