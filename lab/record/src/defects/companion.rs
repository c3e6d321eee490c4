//! Whether another signal moves while one is constant.

use crate::scale::{CLEAR, FEW};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::Range;

/// The movement of another signal of the record, compared with its noise.
pub(super) struct Companion {
    sums: Vec<f64>,
    noise: f64,
    /// Usual distance between two neighbouring means, for each length of the means.
    usual: RefCell<BTreeMap<usize, f64>>,
}

impl Companion {
    pub(super) fn new(signal: &[f64]) -> Self {
        let mut sums = vec![0.0; signal.len() + 1];
        for (i, value) in signal.iter().enumerate() {
            sums[i + 1] = sums[i] + (value - signal[0]);
        }
        let bends = signal
            .windows(3)
            .map(|w| (w[2] - 2.0 * w[1] + w[0]).powi(2));
        let noise = (bends.sum::<f64>() / (6.0 * signal.len() as f64)).sqrt();
        Self {
            sums,
            noise,
            usual: RefCell::default(),
        }
    }

    /// The mean over `length` samples, minus the first sample.
    pub(super) fn mean(&self, from: usize, length: usize) -> f64 {
        (self.sums[from + length] - self.sums[from]) / length as f64
    }

    /// Mean distance between neighbouring means of `length` samples, over the record.
    fn usual(&self, length: usize) -> f64 {
        if let Some(known) = self.usual.borrow().get(&length) {
            return *known;
        }
        let count = (self.sums.len() - 1) / length;
        let moved =
            |k: usize| (self.mean(k * length, length) - self.mean((k - 1) * length, length)).abs();
        let usual = (1..count).map(moved).sum::<f64>() / count.saturating_sub(1).max(1) as f64;
        self.usual.borrow_mut().insert(length, usual);
        usual
    }

    /// The means over the fifths of an interval, and their noise.
    pub(super) fn parts(&self, stretch: &Range<usize>) -> ([f64; FEW], f64) {
        let border = |part: usize| stretch.start + part * stretch.len() / FEW;
        let mean = |part: usize| self.mean(border(part), border(part + 1) - border(part));
        let noise = self.noise / (stretch.len() as f64 / FEW as f64).sqrt();
        (std::array::from_fn(mean), noise)
    }

    /// Whether the signal moves in the middle of the interval, with at least this fraction of its
    /// usual speed. The first and last fifths are excluded, because the response to an earlier
    /// command may not have settled there.
    pub(super) fn moves(&self, stretch: &Range<usize>, share: f64) -> bool {
        let (means, noise) = self.parts(stretch);
        let [first, second] = [means[2] - means[1], means[3] - means[2]].map(f64::abs);
        let moved = first + second;
        let usual = self.usual(stretch.len() / FEW);
        first.min(second) > 0.0 && moved > CLEAR * noise && 0.5 * moved > share * usual
    }

    /// The travel in the first and in the last third of the interval.
    pub(super) fn ends(&self, stretch: &Range<usize>) -> (f64, f64) {
        let third = stretch.len() / 3;
        let half = third / 2;
        if half == 0 {
            return (0.0, 0.0);
        }
        let gone = |from: usize| (self.mean(from + half, half) - self.mean(from, half)).abs();
        (gone(stretch.start), gone(stretch.end - 2 * half))
    }
}
