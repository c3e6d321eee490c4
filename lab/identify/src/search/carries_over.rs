//! The choice of the terms that transfer to data that the fit has not used.
//!
//! On measured records the residual is systematic: every part of a record repeats the same misfit,
//! so no test within one record predicts whether a second record gives the same term. One rule
//! helps: the delivered model is the simplest one whose error on blocks that were left out of its
//! linear fit is not worse than the smallest of all ([`delivered`]).

use super::policy;
use crate::algebra::least_norm;
use crate::fit::Solution;
use crate::problem::{Prepared, Stretch};
use crate::scale::LEVEL_OF_ONE;
use crate::score::blocks::{blocks, sign_flip_p_above};
use nalgebra::{DMatrix, DVector};
use rand::seq::SliceRandom;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// A slope is excluded if its squared norm is below this share of the residual's.
const MOVES: f64 = 1e-6;

/// Random half-sets of the blocks, in complementary pairs.
pub(super) fn halves(blocks: usize, count: usize) -> Vec<Vec<usize>> {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut all = Vec::with_capacity(count);
    let mut order: Vec<usize> = (0..blocks).collect();
    while all.len() < count {
        order.shuffle(&mut rng);
        let (one, other) = order.split_at(blocks / 2);
        all.extend([one.to_vec(), other.to_vec()]);
    }
    all.truncate(count);
    all
}

/// Products of a model's columns, slopes and residual on each block.
struct Parts {
    /// The last column is the residual.
    grams: Vec<DMatrix<f64>>,
    rows: Vec<f64>,
    /// Precision of the prior of each column's change, in units of the residual's variance.
    precision: Vec<f64>,
}

impl Parts {
    fn new(data: &Prepared, solution: &Solution) -> Self {
        let rows = &data.split.fit;
        let mut columns: Vec<Stretch> = Vec::new();
        let mut precision = Vec::new();
        let squares = |c: &Stretch| rows.iter().map(|&i| c[i] * c[i]).sum::<f64>();
        let target = Stretch::from(solution.residual.clone());
        let residual = squares(&target);
        let of_curve = of_curve(solution, &squares);
        for (index, column) in solution.columns.iter().enumerate() {
            let size = squares(column).sqrt();
            if size > 0.0 {
                columns.push(column.map(|v| v / size));
                precision.push(if index < of_curve.first {
                    0.0
                } else {
                    of_curve.precision
                });
            }
        }
        let free = solution.free.iter().zip(&solution.values);
        for ((f, &value), tangent) in free.zip(&solution.tangents) {
            let slope = f.range.slope(f.range.on_line(value));
            let column = tangent.map(|t| t * slope);
            if squares(&column) > MOVES * residual {
                columns.push(column);
                // A normal prior of unit variance on each step.
                precision.push(1.0);
            }
        }
        columns.push(target);
        let blocks = blocks(data);
        let gram = |block: &std::ops::Range<usize>| {
            let own = &rows[block.clone()];
            let x = DMatrix::from_fn(own.len(), columns.len(), |k, j| columns[j][own[k]]);
            x.tr_mul(&x)
        };
        Self {
            grams: blocks.iter().map(gram).collect(),
            rows: blocks.iter().map(|b| b.len() as f64).collect(),
            precision,
        }
    }

    /// Squared error on each block that is not in `fitted`, after a linear fit on `fitted`.
    fn left_out(&self, fitted: &[usize]) -> Option<Vec<(usize, f64)>> {
        let m = self.precision.len();
        let mut sum = DMatrix::zeros(m + 1, m + 1);
        let mut count = 0.0;
        for &block in fitted {
            sum += &self.grams[block];
            count += self.rows[block];
        }
        let mut normal = sum.view((0, 0), (m, m)).into_owned();
        let variance = sum[(m, m)] / f64::max(count, 1.0);
        for (j, precision) in self.precision.iter().enumerate() {
            normal[(j, j)] += precision * variance;
        }
        let right = sum.column(m).rows(0, m).into_owned();
        let change = least_norm(normal, &right, 1e-10)?;
        let weights = DVector::from_fn(m + 1, |j, _| if j < m { -change[j] } else { 1.0 });
        let others = (0..self.grams.len()).filter(|b| !fitted.contains(b));
        Some(
            others
                .map(|b| (b, weights.dot(&(&self.grams[b] * &weights))))
                .collect(),
        )
    }
}

/// The columns of a curve: the first of them, and the precision of its changes.
///
/// Half a record may hardly cover some of the hat functions. A normal prior therefore limits the
/// changes of their gains to the size of the curve's gains.
struct OfCurve {
    first: usize,
    precision: f64,
}

fn of_curve(solution: &Solution, squares: &dyn Fn(&Stretch) -> f64) -> OfCurve {
    let hats = solution
        .structure
        .table
        .as_ref()
        .map_or(0, |t| t.shapes.len());
    let first = solution.columns.len() - hats;
    let own = solution.columns[first..]
        .iter()
        .zip(&solution.gains[first..]);
    let sizes: f64 = own
        .map(|(column, gain)| gain * gain * squares(column))
        .sum();
    OfCurve {
        first,
        precision: hats as f64 / sizes.max(f64::MIN_POSITIVE),
    }
}

/// Errors of a model on blocks that were left out of its linear fit, over [`policy::HALVES`]
/// half-sets.
struct LeftOut {
    /// Mean ln RMSE over all left-out blocks of a half-set.
    error: f64,
    /// Mean ln of the squared error on each block, over the half-sets that leave it out. Unlike the
    /// mean of the error itself, it is robust against a half-set that determines a gain badly.
    on_blocks: Vec<f64>,
}

impl LeftOut {
    fn of(data: &Prepared, solution: &Solution) -> Self {
        let parts = Parts::new(data, solution);
        let mut on_blocks = vec![0.0; parts.grams.len()];
        let mut times = vec![0.0; parts.grams.len()];
        let (mut error, mut count) = (0.0, 0.0);
        for half in halves(parts.grams.len(), policy::HALVES) {
            let Some(errors) = parts.left_out(&half) else {
                continue;
            };
            let (mut squares, mut rows) = (0.0, 0.0);
            for (block, square) in errors {
                on_blocks[block] += square.max(1e-300).ln();
                times[block] += 1.0;
                squares += square;
                rows += parts.rows[block];
            }
            error += 0.5 * (squares / f64::max(rows, 1.0)).max(1e-300).ln();
            count += 1.0;
        }
        for (sum, times) in on_blocks.iter_mut().zip(&times) {
            *sum /= f64::max(*times, 1.0);
        }
        Self {
            error: if count > 0.0 {
                error / count
            } else {
                f64::INFINITY
            },
            on_blocks,
        }
    }

    /// Whether the errors on blocks are not larger than those of `other`, or by no more than
    /// chance: the exact one-sided sign-flip test of their ratios.
    fn is_as_good_as(&self, other: &Self) -> bool {
        let pairs = self.on_blocks.iter().zip(&other.on_blocks);
        let ratios: Vec<f64> = pairs.map(|(own, other)| own - other).collect();
        sign_flip_p_above(&ratios) > LEVEL_OF_ONE
    }
}

/// Index of the model to deliver, from models in order of preference: the first one whose error on
/// left-out blocks is that of the best model, or exceeds it by no more than chance.
///
/// The baseline model, which is the first, is delivered only if its error is the smallest, because
/// the first addition has passed the test of the search against it.
#[must_use]
pub fn delivered(data: &Prepared, models: &[&Solution]) -> usize {
    use rayon::prelude::*;
    let errors: Vec<LeftOut> = models.par_iter().map(|s| LeftOut::of(data, s)).collect();
    let best = errors.iter().min_by(|a, b| a.error.total_cmp(&b.error));
    best.map_or(0, |best| {
        let does = |(index, one): (usize, &LeftOut)| {
            std::ptr::eq(one, best)
                || (index > 0 && one.error.is_finite() && one.is_as_good_as(best))
        };
        errors.iter().enumerate().position(does).unwrap_or(0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on_blocks(error: impl Fn(usize) -> f64) -> LeftOut {
        let on_blocks = (0..16).map(|block| error(block).ln()).collect();
        let error = 0.0;
        LeftOut { error, on_blocks }
    }

    #[test]
    fn a_model_is_worse_only_where_chance_does_not_explain_its_blocks() {
        let best = on_blocks(|_| 1.0);
        // A little worse on every block: not by chance.
        assert!(!on_blocks(|_| 1.01).is_as_good_as(&best));
        // Ten times worse on one block, equal on the others: half of all patterns.
        let one = on_blocks(|block| if block == 3 { 10.0 } else { 1.0 });
        assert!(one.is_as_good_as(&best));
        // Worse on 11 blocks of 16 and better on 5 by as much: 10.5 % of all patterns.
        let of = |worse: usize| on_blocks(move |block| if block < worse { 1.5 } else { 1.0 / 1.5 });
        assert!(of(11).is_as_good_as(&best));
        // On 12 of 16: 3.8 %.
        assert!(!of(12).is_as_good_as(&best));
    }
}
