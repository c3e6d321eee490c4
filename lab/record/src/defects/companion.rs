//! Whether another signal moves while one is constant.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::Range;

/// Number of parts of a stretch; the outer parts are left out, because the response to an earlier
/// command may still settle there.
const PARTS: usize = 5;
/// Least movement, in multiples of the noise.
const CLEAR: f64 = 5.0;

/// Another signal of the record: the size of its movement, compared with its noise.
pub(super) struct Companion {
    sums: Vec<f64>,
    noise: f64,
    /// Usual distance between two neighbouring means, by the length of the means.
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

    fn mean(&self, from: usize, length: usize) -> f64 {
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

    /// Whether it moves in the middle of the stretch, at this share of its usual speed.
    pub(super) fn moves(&self, stretch: &Range<usize>, share: f64) -> bool {
        let length = stretch.len() / PARTS;
        if length == 0 {
            return false;
        }
        let mean = |part: usize| self.mean(stretch.start + part * length, length);
        let first = (mean(2) - mean(1)).abs();
        let second = (mean(3) - mean(2)).abs();
        let moved = first + second;
        let noise = self.noise / (length as f64).sqrt();
        first.min(second) > 0.0 && moved > CLEAR * noise && 0.5 * moved > share * self.usual(length)
    }

    /// Its travel in the first and in the last third of the stretch.
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
