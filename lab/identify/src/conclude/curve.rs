//! The curve of a table, with its interval.

use super::intervals::{jackknife, quantile};
use crate::fit::Solution;
use crate::problem::{Prepared, Stretch};

/// One point of the curve.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Knot {
    /// Value of the variable.
    pub at: f64,
    /// The contribution of the curve to the output at this value.
    pub value: f64,
    /// 95 % interval, by blocks; `None` if the record does not determine it.
    pub ci95: Option<[f64; 2]>,
}

/// The table of a model as a curve; empty if it has none.
///
/// The curve excludes everything that the rest of the model can represent, above all a constant.
#[must_use]
pub fn curve(data: &Prepared, solution: &Solution) -> Vec<Knot> {
    let Some(table) = &solution.structure.table else {
        return Vec::new();
    };
    let first = solution.gains.len() - table.shapes.len();
    let gains = &solution.gains[first..];
    let moving = solution
        .tangents
        .iter()
        .zip(&solution.on_bound)
        .filter(|(_, bound)| !**bound);
    let columns: Vec<&Stretch> = solution.columns[first..]
        .iter()
        .chain(&solution.columns[..first])
        .chain(moving.map(|(tangent, _)| tangent))
        .collect();
    let steps = jackknife(data, solution, &columns);
    table
        .knots
        .iter()
        .enumerate()
        .map(|(knot, &at)| {
            let sum =
                |by: &[f64]| -> f64 { table.shapes.iter().zip(by).map(|(s, g)| s[knot] * g).sum() };
            let value = sum(gains);
            let half = steps.as_ref().and_then(|steps| {
                let variance: f64 = steps.iter().map(|step| sum(step).powi(2)).sum();
                Some(quantile()? * variance.sqrt())
            });
            Knot {
                at,
                value,
                ci95: half
                    .filter(|h| h.is_finite())
                    .map(|h| [value - h, value + h]),
            }
        })
        .collect()
}
