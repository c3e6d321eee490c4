//! Gain and offset of a prediction, the only two numbers that a validation fits.

use super::intervals::quantile;
use crate::algebra::line;
use crate::problem::Prepared;
use crate::scale::TWENTIETH;
use crate::score::blocks::{blocks, BLOCKS};
use std::ops::Range;

/// A fitted number with its interval.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Fitted {
    /// Estimate.
    pub value: f64,
    /// 95 % interval, from leaving out each block in turn; `None` if it cannot be computed.
    pub ci95: Option<[f64; 2]>,
}

/// y ≈ gain · prediction + offset.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Line {
    /// Factor of the prediction.
    pub gain: Fitted,
    /// Offset, in the output's unit.
    pub offset: Fitted,
}

impl Fitted {
    /// Whether the number differs from a value by more than a twentieth of a scale, and by more than the
    /// width of its interval. A choice: if the model describes the rig, neither gain nor offset changes
    /// as much from one record to the next (`--test ways calibration`).
    fn is_apart(&self, from: f64, scale: f64) -> bool {
        let by = (self.value - from).abs();
        by > TWENTIETH * scale && self.ci95.is_some_and(|[low, high]| by > high - low)
    }
}

impl Line {
    /// Whether the gain has changed.
    #[must_use]
    pub fn gain_moved(&self) -> bool {
        self.gain.is_apart(1.0, 1.0)
    }

    /// Whether the offset has changed, for an output of this standard deviation.
    #[must_use]
    pub fn offset_moved(&self, deviation: f64) -> bool {
        self.offset.is_apart(0.0, deviation)
    }

    /// Least squares over the rows that count; intervals by the delete-one-block jackknife
    /// (Efron, 1982) on the sixteen blocks, with Student's t of fifteen degrees.
    pub(crate) fn fit(data: &Prepared, prediction: &[f64]) -> Self {
        let rows = &data.split.fit;
        let whole = solve(data, prediction, rows, 0..0);
        let without = blocks(data).into_iter();
        let without: Vec<_> = without
            .map(|block| solve(data, prediction, rows, block))
            .collect();
        let fitted = |of: fn(&(f64, f64)) -> f64| {
            let value = of(&whole);
            let mean = without.iter().map(of).sum::<f64>() / BLOCKS as f64;
            let squares: f64 = without.iter().map(|one| (of(one) - mean).powi(2)).sum();
            let deviation = (squares * (BLOCKS as f64 - 1.0) / BLOCKS as f64).sqrt();
            let half = quantile().map(|t| t * deviation).filter(|h| h.is_finite());
            Fitted {
                value,
                ci95: half.map(|h| [value - h, value + h]),
            }
        };
        Self {
            gain: fitted(|one| one.0),
            offset: fitted(|one| one.1),
        }
    }

    /// A prediction with this gain and offset.
    pub(crate) fn of(&self, prediction: &[f64]) -> Vec<f64> {
        let line = |p: &f64| self.gain.value * p + self.offset.value;
        prediction.iter().map(line).collect()
    }
}

/// Gain and offset without the rows at these positions. A constant prediction keeps its gain.
fn solve(data: &Prepared, prediction: &[f64], rows: &[usize], out: Range<usize>) -> (f64, f64) {
    let kept = rows[..out.start].iter().chain(&rows[out.end..]);
    line(kept.map(|&i| (prediction[i], data.target[i])))
}
