//! The blocks of a record, their minimum length, and the exact sign-flip test on their scores.

use crate::problem::Prepared;
use std::ops::Range;

/// Number of blocks.
pub const BLOCKS: usize = 16;

/// Whether the blocks of a record are long enough for a test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// Sixteen blocks, each at least three correlation times long: p-values.
    Blocks,
    /// Shorter blocks: effects are accepted by size and repetition, the verdict is under-excited.
    Effect,
}

/// Sixteen blocks of equal path length over the rows of the fit segment.
///
/// Each block is a range of positions in `data.split.fit`. With several records the number of
/// blocks of each is its share of the path, rounded, so that no block straddles two records;
/// only a record with less than half a block's path shares a block with its neighbour.
#[must_use]
pub fn blocks(data: &Prepared) -> Vec<Range<usize>> {
    let path = path(data);
    let mut ranges = Vec::with_capacity(BLOCKS);
    for (part, count) in parts(data, &path) {
        divide(&path, part, count, &mut ranges);
    }
    ranges
}

/// Path length at each row of the fit segment. The path across rows that are left out does not
/// count, since the block around them would have hardly any rows.
fn path(data: &Prepared) -> Vec<f64> {
    let rows = &data.split.fit;
    let mut path = vec![0.0; rows.len()];
    for k in 1..rows.len() {
        let next = rows[k] == rows[k - 1] + 1;
        let gone = data.path[rows[k]] - data.path[rows[k - 1]];
        path[k] = path[k - 1] + if next { gone } else { 0.0 };
    }
    path
}

/// Divides the fit rows into parts with a number of blocks each: one part per record if possible.
fn parts(data: &Prepared, path: &[f64]) -> Vec<(Range<usize>, usize)> {
    let rows = &data.split.fit;
    let (Some(first), Some(last)) = (path.first(), path.last()) else {
        return Vec::new();
    };
    let mut parts = Vec::new();
    let (mut from, mut used) = (0, 0);
    for piece in &data.pieces {
        let to = rows.partition_point(|&row| row < piece.rows.end);
        if to == rows.len() || to < from + 2 {
            continue;
        }
        let share = (path[to - 1] - first) / (last - first);
        let until = (share * BLOCKS as f64).round() as usize;
        let rows_left = to >= from + 2 * (until - used) && rows.len() >= to + 2 * (BLOCKS - until);
        if until > used && until < BLOCKS && rows_left {
            parts.push((from..to, until - used));
            (from, used) = (to, until);
        }
    }
    parts.push((from..rows.len(), BLOCKS - used));
    parts
}

/// Blocks of equal path length over some of the rows.
fn divide(path: &[f64], rows: Range<usize>, count: usize, ranges: &mut Vec<Range<usize>>) {
    let (first, total) = (path[rows.start], path[rows.end - 1] - path[rows.start]);
    let mut from = rows.start;
    for block in 1..=count {
        let end = first + total * block as f64 / count as f64;
        // Every block keeps a few rows, even while the input rests.
        let least = from + 2;
        let most = rows.end - 2 * (count - block);
        let mut to = if block == count {
            rows.end
        } else {
            (from..rows.end)
                .find(|&k| path[k] > end)
                .unwrap_or(rows.end)
        };
        to = to.clamp(least.min(most), most);
        ranges.push(from..to);
        from = to;
    }
}

impl Regime {
    /// The regime of a residual on the fit rows, and its correlation time in samples.
    pub(crate) fn of(data: &Prepared, residual: &[f64]) -> (Self, f64) {
        let samples = correlation_samples(residual);
        let shortest = blocks(data).iter().map(ExactSizeIterator::len).min();
        let regime = match shortest.unwrap_or(0) as f64 >= 3.0 * samples {
            true => Self::Blocks,
            false => Self::Effect,
        };
        (regime, samples)
    }
}

/// Exact sign-flip p-value of the score vectors of the blocks: the share of all sign patterns
/// whose sum is at least as long as the observed one.
///
/// The p-value is 1 if a score is not finite. Each signed sum over all blocks is a sum over the
/// first half of them plus a sum over the other half, so two short tables of signed sums give
/// all patterns.
#[must_use]
pub fn flips(scores: &[Vec<f64>]) -> f64 {
    let directions = scores.first().map_or(0, Vec::len);
    let [first @ .., last] = scores else {
        return 1.0;
    };
    if directions == 0 || scores.len() != BLOCKS {
        return 1.0;
    }
    let (low, high) = first.split_at(BLOCKS / 2);
    let (mut lows, mut highs, mut real) = (Vec::new(), Vec::new(), 0.0);
    for direction in 0..directions {
        let sum: f64 = scores.iter().map(|own| own[direction]).sum();
        real += sum * sum;
        lows.push(signed_sums(0.0, low, direction));
        // The last block keeps its sign: a pattern and its negative have the same length.
        highs.push(signed_sums(last[direction], high, direction));
    }
    if !real.is_finite() {
        return 1.0;
    }
    // Equal up to the rounding of a sum of sixteen numbers.
    let threshold = real * (1.0 - 1e-9);
    let patterns = lows[0].len() * highs[0].len();
    let mut lengths = vec![0.0; lows[0].len()];
    let mut counted = 0;
    for pattern in 0..highs[0].len() {
        lengths.fill(0.0);
        for (low, high) in lows.iter().zip(&highs) {
            let of_others = high[pattern];
            for (length, own) in lengths.iter_mut().zip(low) {
                *length += (own + of_others) * (own + of_others);
            }
        }
        counted += lengths.iter().filter(|l| **l >= threshold).count();
    }
    counted as f64 / patterns as f64
}

/// `start` plus the scores of some blocks in one direction, for all patterns of signs.
fn signed_sums(start: f64, scores: &[Vec<f64>], direction: usize) -> Vec<f64> {
    let mut sums = vec![start];
    for own in scores {
        let score = own[direction];
        let minus: Vec<f64> = sums.iter().map(|sum| sum - score).collect();
        for sum in &mut sums {
            *sum += score;
        }
        sums.extend(minus);
    }
    sums
}

/// The same test for one score per block.
#[must_use]
pub fn sign_flip_p(scores: &[f64; BLOCKS]) -> f64 {
    flips(&scores.map(|score| vec![score]))
}

/// Exact one-sided sign-flip p-value of scores: the share of all sign patterns whose sum is at
/// least the observed one. 1 if a score is not finite.
#[must_use]
pub fn sign_flip_p_above(scores: &[f64]) -> f64 {
    let real: f64 = scores.iter().sum();
    let size: f64 = scores.iter().map(|score| score.abs()).sum();
    if !size.is_finite() || scores.len() > BLOCKS {
        return 1.0;
    }
    let scores: Vec<Vec<f64>> = scores.iter().map(|&score| vec![score]).collect();
    let sums = signed_sums(0.0, &scores, 0);
    // Equal up to the rounding of a sum of sixteen numbers.
    let threshold = real - 1e-9 * size;
    let counted = sums.iter().filter(|sum| **sum >= threshold).count();
    counted as f64 / sums.len() as f64
}

/// Lag at which the autocorrelation falls to 1/e, in samples.
#[must_use]
pub fn correlation_samples(residual: &[f64]) -> f64 {
    let n = residual.len();
    let mean = residual.iter().sum::<f64>() / n.max(1) as f64;
    let correlation = |lag: usize| -> f64 {
        (lag..n)
            .map(|i| (residual[i] - mean) * (residual[i - lag] - mean))
            .sum()
    };
    let zero = correlation(0);
    if zero.is_nan() || zero <= 0.0 {
        return 1.0;
    }
    let mut last = 1.0;
    for lag in 1..n / 2 {
        let now = correlation(lag) / zero;
        if now <= (-1.0_f64).exp() {
            return lag as f64 - 1.0 + (last - (-1.0_f64).exp()) / (last - now);
        }
        last = now;
    }
    n as f64 / 2.0
}
