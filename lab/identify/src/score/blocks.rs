//! The blocks, the exact test on their scores, and how long they have to be.

use crate::problem::Prepared;
use std::ops::Range;

/// Number of blocks.
pub const BLOCKS: usize = 16;

/// Whether the record has blocks enough for a test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// Sixteen blocks, each at least three correlation times long: p-values.
    Blocks,
    /// Fewer: effects are accepted by size and repetition, the verdict is under-excited.
    Effect,
}

/// Sixteen blocks of equal path length over the rows of the fit segment.
///
/// Each is a range of positions in `data.split.fit`. Of several records each gets as many
/// blocks as are nearest to its share of the path, so that none straddles two of them;
/// only a record with less than half a block's path shares one with its neighbour.
#[must_use]
pub fn blocks(data: &Prepared) -> Vec<Range<usize>> {
    let path = path(data);
    let mut ranges = Vec::with_capacity(BLOCKS);
    for (part, count) in parts(data, &path) {
        divide(&path, part, count, &mut ranges);
    }
    ranges
}

/// Path length at each row of the fit segment; what was gone where rows are left out does
/// not count, or the block around it would be left with hardly any.
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

/// The fit rows in parts with a number of blocks each: a part a record where they allow.
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
        // Every block keeps a few rows, also where the input rests.
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
    /// Of a residual on the fit rows, with its correlation time in samples.
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

/// Share of all sign patterns that count, the real one always among them.
///
/// Patterns are walked in Gray-code order: each differs from the last in one sign.
/// `counts(block, sign)` is told which block's sign has changed, and to what.
pub(crate) fn share_of_patterns(mut counts: impl FnMut(usize, f64) -> bool) -> f64 {
    let mut signs = [1.0; BLOCKS];
    let patterns = 1_u32 << (BLOCKS - 1);
    let mut counted = 1_u32;
    for pattern in 1..patterns {
        // The last block keeps its sign: a pattern and its negative have the same sum.
        let flip = pattern.trailing_zeros() as usize;
        signs[flip] = -signs[flip];
        counted += u32::from(counts(flip, signs[flip]));
    }
    f64::from(counted) / f64::from(patterns)
}

/// Share of all sign patterns whose sum is at least as far from zero as the real one.
#[must_use]
pub fn sign_flip_p(scores: &[f64; BLOCKS]) -> f64 {
    let observed = scores.iter().sum::<f64>().abs();
    // Equal up to the rounding of a walk over 2^15 patterns.
    let threshold = observed - 1e-9 * scores.iter().map(|s| s.abs()).sum::<f64>();
    let mut sum: f64 = scores.iter().sum();
    share_of_patterns(|block, sign| {
        sum += 2.0 * sign * scores[block];
        sum.abs() >= threshold
    })
}

/// Time after which the autocorrelation has fallen to 1/e, in samples.
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
