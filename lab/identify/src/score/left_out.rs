//! Comparison of two models on each block, with the gains fitted on the other blocks.

use super::blocks::{blocks, Regime, BLOCKS};
use crate::algebra::least_norm;
use crate::fit::Solution;
use crate::problem::Prepared;
use nalgebra::{DMatrix, DVector};

/// Number of left-out blocks on which the new model is better, and whether this number suffices.
pub(crate) fn on_blocks(
    data: &Prepared,
    old: &Solution,
    new: &Solution,
    regime: Regime,
) -> (usize, bool) {
    let ratios = ratios(data, old, new);
    let better = ratios.iter().filter(|r| **r > 0.0).count();
    let enough = match regime {
        Regime::Blocks => {
            let n = ratios.len() as f64;
            let mean = ratios.iter().sum::<f64>() / n;
            let variance = ratios.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / (n - 1.0);
            mean > (variance / n).sqrt() && better >= 10
        }
        Regime::Effect => better >= 9,
    };
    (better, enough)
}

/// ln of the old model's loss divided by the new model's, on each left-out block.
pub(crate) fn ratios(data: &Prepared, old: &Solution, new: &Solution) -> Vec<f64> {
    let (before, after) = (left_out(data, old), left_out(data, new));
    let both = before.iter().zip(&after);
    both.map(|(b, a)| (b / a).ln()).collect()
}

/// Loss on each block with the gains fitted on the others, shapes frozen.
fn left_out(data: &Prepared, solution: &Solution) -> Vec<f64> {
    let rows = &data.split.fit;
    let blocks = blocks(data);
    let m = solution.columns.len();
    let scale: Vec<f64> = solution
        .columns
        .iter()
        .map(|c| {
            rows.iter()
                .map(|&i| c[i] * c[i])
                .sum::<f64>()
                .sqrt()
                .max(1e-300)
        })
        .collect();
    let parts: Vec<(DMatrix<f64>, DVector<f64>)> = blocks
        .iter()
        .map(|block| {
            let rows = &rows[block.clone()];
            let x = DMatrix::from_fn(rows.len(), m, |k, j| {
                solution.columns[j][rows[k]] / scale[j]
            });
            let y = DVector::from_iterator(rows.len(), rows.iter().map(|&i| solution.residual[i]));
            (x.tr_mul(&x), x.tr_mul(&y))
        })
        .collect();
    // The change of the gains is the regression of the residual on the columns.
    let mut losses = Vec::with_capacity(BLOCKS);
    for (out, block) in blocks.iter().enumerate() {
        let mut gram = DMatrix::zeros(m, m);
        let mut score = DVector::zeros(m);
        for (_, (g, s)) in parts.iter().enumerate().filter(|(b, _)| *b != out) {
            gram += g;
            score += s;
        }
        let change = least_norm(gram, &score, 1e-10).unwrap_or_else(|| DVector::zeros(m));
        let loss: f64 = rows[block.clone()]
            .iter()
            .map(|&i| {
                let moved: f64 = (0..m)
                    .map(|j| change[j] * solution.columns[j][i] / scale[j])
                    .sum();
                (solution.residual[i] - moved).powi(2)
            })
            .sum();
        losses.push(loss.max(1e-300));
    }
    losses
}
