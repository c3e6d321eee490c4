//! Which names carry over to data that the fit has not seen.
//!
//! On measured records the residual is systematic: every part of a record repeats the same
//! misfit, so that no test within one record predicts whether a second record shows the same
//! name. Two rules help. The delivered model is the round with the least error on blocks that
//! were left out of its linear fit ([`delivered`]). And each name carries the number of
//! half-records, out of a hundred, in which a search finds it again (`recurrences`).

use super::bank::{on_line, Identity};
use super::linear::Linear;
use super::policy;
use crate::algebra::least_norm;
use crate::fit::Solution;
use crate::problem::Prepared;
use crate::score::blocks::blocks;
use nalgebra::{DMatrix, DVector};
use rand::seq::SliceRandom;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// A slope is left out if its squared norm is below this share of the residual's.
const MOVES: f64 = 1e-6;
/// Fixed seed: every record is divided into the same half-sets.
const SEED: u64 = 1;

/// Random half-sets of the blocks, in complementary pairs.
fn halves(blocks: usize, count: usize) -> Vec<Vec<usize>> {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
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
    /// Which columns are slopes.
    slopes: Vec<bool>,
}

impl Parts {
    fn new(data: &Prepared, solution: &Solution) -> Self {
        let rows = &data.split.fit;
        let mut columns: Vec<Vec<f64>> = Vec::new();
        let mut slopes = Vec::new();
        let squares = |c: &[f64]| rows.iter().map(|&i| c[i] * c[i]).sum::<f64>();
        let residual = squares(&solution.residual);
        for column in &solution.columns {
            let size = squares(column).sqrt();
            if size > 0.0 {
                columns.push(column.iter().map(|v| v / size).collect());
                slopes.push(false);
            }
        }
        let free = solution.free.iter().zip(&solution.values);
        for ((f, &value), tangent) in free.zip(&solution.tangents) {
            let slope = f.range.slope(on_line(f.range, value));
            let column: Vec<f64> = tangent.iter().map(|t| t * slope).collect();
            if squares(&column) > MOVES * residual {
                columns.push(column);
                slopes.push(true);
            }
        }
        columns.push(solution.residual.clone());
        let blocks = blocks(data);
        let gram = |block: &std::ops::Range<usize>| {
            let own = &rows[block.clone()];
            let x = DMatrix::from_fn(own.len(), columns.len(), |k, j| columns[j][own[k]]);
            x.tr_mul(&x)
        };
        Self {
            grams: blocks.iter().map(gram).collect(),
            rows: blocks.iter().map(|b| b.len() as f64).collect(),
            slopes,
        }
    }

    /// Mean squared error on the remaining blocks after a linear fit on `fitted`.
    fn left_out(&self, fitted: &[usize]) -> Option<f64> {
        let m = self.slopes.len();
        let mut sum = DMatrix::zeros(m + 1, m + 1);
        let mut count = 0.0;
        for &block in fitted {
            sum += &self.grams[block];
            count += self.rows[block];
        }
        let mut normal = sum.view((0, 0), (m, m)).into_owned();
        // Ridge term of the slopes: a normal prior of unit variance on each step.
        let variance = sum[(m, m)] / f64::max(count, 1.0);
        for (j, _) in self.slopes.iter().enumerate().filter(|(_, is)| **is) {
            normal[(j, j)] += variance;
        }
        let right = sum.column(m).rows(0, m).into_owned();
        let change = least_norm(normal, &right, 1e-10)?;
        let weights = DVector::from_fn(m + 1, |j, _| if j < m { -change[j] } else { 1.0 });
        let (mut squares, mut rows) = (0.0, 0.0);
        for block in (0..self.grams.len()).filter(|b| !fitted.contains(b)) {
            squares += weights.dot(&(&self.grams[block] * &weights));
            rows += self.rows[block];
        }
        Some(squares / f64::max(rows, 1.0))
    }
}

/// Mean ln RMSE on the blocks left out, over [`policy::HALVES`] half-sets.
#[must_use]
pub fn left_out_error(data: &Prepared, solution: &Solution) -> f64 {
    let parts = Parts::new(data, solution);
    let errors: Vec<f64> = halves(parts.grams.len(), policy::HALVES)
        .iter()
        .filter_map(|half| parts.left_out(half))
        .map(|error| 0.5 * error.max(1e-300).ln())
        .collect();
    match errors.is_empty() {
        true => f64::INFINITY,
        false => errors.iter().sum::<f64>() / errors.len() as f64,
    }
}

/// Index of the model with the least left-out error on a path of models with more and more
/// names.
#[must_use]
pub fn delivered(data: &Prepared, path: &[&Solution]) -> usize {
    use rayon::prelude::*;
    let errors: Vec<f64> = path.par_iter().map(|s| left_out_error(data, s)).collect();
    let best = errors.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1));
    best.map_or(0, |(index, _)| index)
}

/// Number of half-records, of [`policy::RECURRENCES`], in which each name is found again: the
/// mean of two forward selections, one linearised at the declared and one at the final model.
pub(super) fn recurrences(
    names: impl Iterator<Item = Identity>,
    from_declared: &[Vec<Identity>],
    last: &Linear,
) -> Vec<usize> {
    let mut names = names.peekable();
    if names.peek().is_none() {
        return Vec::new();
    }
    let from_last = last.found_on_halves();
    let found = || from_declared.iter().chain(&from_last);
    names
        .map(|name| found().filter(|set| set.contains(&name)).count() / 2)
        .collect()
}

impl Linear<'_> {
    /// Result of a forward selection on each half-set of blocks.
    pub(super) fn found_on_halves(&self) -> Vec<Vec<Identity>> {
        use rayon::prelude::*;
        halves(self.grams.blocks(), policy::RECURRENCES)
            .into_par_iter()
            .map(|half| self.found_on(&half))
            .collect()
    }
}
