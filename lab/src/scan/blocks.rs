//! The blocks, the exact test on their scores, and how long they have to be.

use crate::channels::Prepared;

/// Number of blocks.
pub const BLOCKS: usize = 16;

/// Sixteen blocks of equal path length over the rows of the fit segment.
///
/// Each is a range of positions in `data.split.fit`.
#[must_use]
pub fn blocks(data: &Prepared) -> Vec<std::ops::Range<usize>> {
    let rows = &data.split.fit;
    let path = |k: usize| data.path[rows[k]];
    let (first, total) = (path(0), path(rows.len() - 1) - path(0));
    let mut ranges = Vec::with_capacity(BLOCKS);
    let mut from = 0;
    for block in 1..=BLOCKS {
        let end = first + total * block as f64 / BLOCKS as f64;
        // Every block keeps a few rows, also where the input rests.
        let least = from + 2;
        let most = rows.len() - 2 * (BLOCKS - block);
        let mut to = if block == BLOCKS {
            rows.len()
        } else {
            (from..rows.len())
                .find(|&k| path(k) > end)
                .unwrap_or(rows.len())
        };
        to = to.clamp(least.min(most), most);
        ranges.push(from..to);
        from = to;
    }
    ranges
}

/// Share of all sign patterns whose sum is at least as far from zero as the real one.
///
/// Patterns are walked in Gray-code order: each differs from the last in one sign.
#[must_use]
pub fn sign_flip_p(scores: &[f64; BLOCKS]) -> f64 {
    let observed = scores.iter().sum::<f64>().abs();
    // Equal up to the rounding of a walk over 2^15 patterns.
    let threshold = observed - 1e-9 * scores.iter().map(|s| s.abs()).sum::<f64>();
    let mut sum: f64 = scores.iter().sum();
    let mut signs = [1.0; BLOCKS];
    let patterns = 1_u32 << (BLOCKS - 1);
    let mut as_far = 1_u32;
    for pattern in 1..patterns {
        // The last block keeps its sign: a pattern and its negative have the same sum.
        let flip = pattern.trailing_zeros() as usize;
        signs[flip] = -signs[flip];
        sum += 2.0 * signs[flip] * scores[flip];
        if sum.abs() >= threshold {
            as_far += 1;
        }
    }
    f64::from(as_far) / f64::from(patterns)
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
