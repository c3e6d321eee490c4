//! Least squares on Gram matrices, one for each block of the record.
//!
//! All columns and the target are multiplied with each other once. Any question about a
//! subset of columns on a subset of blocks is then dense algebra on a few hundred numbers: the
//! squared error of a set is a Schur complement, its reduction by one more column is a ratio
//! of entries of the swept matrix, and a sign-flip p-value needs the scores of the blocks only
//! (Lehmann and Romano, 2005, section 15.2).

use super::policy::EXCITED;
use crate::algebra::{add, directions, subtract, Stretch};
use crate::problem::filter::BLOCK;
use crate::score::blocks::flips;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;
use std::sync::Arc;

/// A column whose pivot is below this share of its squared norm depends on the others.
pub(super) const DEPENDENT: f64 = 1e-9;
/// The same threshold for a slope, which only refines the column of its effect.
const SLOPE: f64 = 1e-5;
/// Groups of at most this many columns are solved without a heap allocation.
const SMALL: usize = 6;

/// Products of all columns with each other: in total and for each block.
///
/// Columns are scaled to unit deviation on the fit rows; a constant column to unit norm.
#[derive(Debug, Clone, Default)]
pub struct Grams {
    size: usize,
    scale: Vec<f64>,
    whole: Vec<f64>,
    /// Of each block the lower triangle by rows: see [`place`].
    parts: Vec<Vec<f64>>,
}

/// Place of the product of columns `i` and `j <= i` in a lower triangle: row `i` has the
/// products with the columns up to `i`, so that more columns are more rows.
fn place(i: usize, j: usize) -> usize {
    i * (i + 1) / 2 + j
}

/// Appends to the products of one block the products of the columns from `old` on with all before, a
/// block of columns at a time: about half of a square of products is not needed.
fn multiply(
    part: &mut Vec<f64>,
    old: usize,
    (columns, scale): (&[Arc<Stretch>], &[f64]),
    rows: &[usize],
) {
    let size = columns.len();
    let mut all = Vec::with_capacity(rows.len() * size);
    for (column, scale) in columns.iter().zip(scale) {
        let factor = scale.recip();
        for run in rows.chunk_by(|a, b| *b == a + 1) {
            column.push_to(&mut all, run[0]..run[run.len() - 1] + 1, factor);
        }
    }
    let all = DMatrix::from_vec(rows.len(), size, all);
    // As a product of two matrices, which is faster than `tr_mul`.
    let transposed = all.transpose();
    part.reserve_exact(place(size, 0) - part.len());
    let mut first = old;
    while first < size {
        // No few columns alone: their products would be rounded in another way.
        let end = match size - first {
            rest if rest < BLOCK + BLOCK / 2 => size,
            _ => first + BLOCK,
        };
        let products = transposed.rows(0, end) * all.columns(first, end - first);
        for (i, own) in (first..end).zip(products.as_slice().chunks_exact(end)) {
            part.extend_from_slice(&own[..=i]);
        }
        first = end;
    }
}

/// Root of the squared norm about the mean; if the column is constant, of the squared norm.
fn scale_of(column: &Stretch, rows: &[usize]) -> f64 {
    let n = rows.len().max(1) as f64;
    let mean = rows.iter().map(|&i| column[i]).sum::<f64>() / n;
    let varying: f64 = rows.iter().map(|&i| (column[i] - mean).powi(2)).sum();
    let norm: f64 = rows.iter().map(|&i| column[i] * column[i]).sum();
    let measure = if varying > 1e-12 * norm {
        varying
    } else {
        norm
    };
    measure.sqrt().max(1e-300)
}

impl Grams {
    /// Multiplies columns on the given rows; a block is a range of positions in `rows`.
    #[must_use]
    pub fn new(columns: &[Arc<Stretch>], rows: &[usize], blocks: &[Range<usize>]) -> Self {
        let mut grams = Self::default();
        grams.extend(columns, rows, blocks);
        grams
    }

    /// Multiplies the new columns of `columns` with each other and with the known columns.
    pub fn extend(&mut self, columns: &[Arc<Stretch>], rows: &[usize], blocks: &[Range<usize>]) {
        use rayon::prelude::*;
        let (old, size) = (self.size, columns.len());
        self.parts.resize(blocks.len(), Vec::new());
        let new = columns[old..].iter().map(|c| scale_of(c, rows));
        self.scale.extend(new.collect::<Vec<f64>>());
        let scale = &self.scale;
        self.parts
            .par_iter_mut()
            .zip(blocks)
            .for_each(|(part, block)| multiply(part, old, (columns, scale), &rows[block.clone()]));
        let mut whole = Vec::with_capacity(size * size);
        for i in 0..old {
            whole.extend_from_slice(&self.whole[i * old..(i + 1) * old]);
            whole.resize((i + 1) * size, 0.0);
        }
        whole.resize(size * size, 0.0);
        for i in old..size {
            let row = &mut whole[i * size..=i * size + i];
            for part in &self.parts {
                add(row, &part[place(i, 0)..]);
            }
            for j in 0..i {
                whole[j * size + i] = whole[i * size + j];
            }
        }
        self.whole = whole;
        self.size = size;
    }

    /// The products of some of the columns, whose indices ascend.
    #[must_use]
    pub fn only(&self, columns: &[usize]) -> Self {
        let mut runs: Vec<Range<usize>> = Vec::new();
        // The next linearisation has about as many columns as this one.
        let room = place(self.size + BLOCK, 0);
        let empty = self.parts.iter().map(|_| Vec::with_capacity(room));
        let mut parts: Vec<Vec<f64>> = empty.collect();
        let mut whole = Vec::with_capacity(columns.len() * columns.len());
        for &i in columns {
            match runs.last_mut() {
                Some(run) if run.end == i => run.end += 1,
                _ => runs.push(i..i + 1),
            }
            for (some, part) in parts.iter_mut().zip(&self.parts) {
                for run in &runs {
                    some.extend_from_slice(&part[place(i, run.start)..place(i, run.end)]);
                }
            }
            whole.extend(columns.iter().map(|&j| self.whole[i * self.size + j]));
        }
        Self {
            size: columns.len(),
            scale: columns.iter().map(|&i| self.scale[i]).collect(),
            whole,
            parts,
        }
    }

    /// Number of columns.
    #[must_use]
    pub fn size(&self) -> usize {
        self.size
    }

    /// Number of blocks.
    #[must_use]
    pub fn blocks(&self) -> usize {
        self.parts.len()
    }

    /// Product of two columns on one block.
    #[must_use]
    pub fn on_block(&self, block: usize, i: usize, j: usize) -> f64 {
        self.parts[block][place(i.max(j), i.min(j))]
    }

    /// The squared scale of a column: squared errors of a target are in units of it.
    #[must_use]
    pub fn unit(&self, column: usize) -> f64 {
        self.scale[column].powi(2)
    }

    /// The Gram matrix swept by some columns, on the whole fit segment.
    #[must_use]
    pub fn without(&self, columns: &[usize]) -> Swept {
        let mut swept = Swept {
            size: self.size,
            entries: self.whole.clone(),
        };
        swept.sweep(columns);
        swept
    }

    fn compact(&self, index: &[usize]) -> Vec<f64> {
        let mut small = Vec::with_capacity(index.len() * index.len());
        for &i in index {
            small.extend(index.iter().map(|&j| self.whole[i * self.size + j]));
        }
        small
    }

    /// Squared error of the least-squares fit of a set, in units of the target's squared scale.
    #[must_use]
    pub fn squared_error(&self, columns: &[usize], target: usize) -> f64 {
        let index: Vec<usize> = columns.iter().copied().chain([target]).collect();
        let (mut small, m) = (self.compact(&index), index.len());
        eliminate(&mut small, m, m - 1);
        small[m * m - 1]
    }

    /// Least-squares coefficients of a set, in the columns' own units; 0 for a column that
    /// depends on those before it.
    #[must_use]
    pub fn coefficients(&self, columns: &[usize], target: usize) -> Vec<f64> {
        let index: Vec<usize> = columns.iter().copied().chain([target]).collect();
        let (mut small, m) = (self.compact(&index), index.len());
        let used = eliminate(&mut small, m, m - 1);
        let of = |(i, &column): (usize, &usize)| match used[i] {
            true => small[i * m + m - 1] * self.scale[target] / self.scale[column],
            false => 0.0,
        };
        columns.iter().enumerate().map(of).collect()
    }

    /// Exact sign-flip p-value of some columns together, given others.
    ///
    /// Under the null hypothesis the score vector of each block is as likely of either sign.
    /// The statistic is the squared length of the whitened sum of scores, over all `2^15`
    /// patterns. The p-value is 1 if the columns depend on the others.
    #[must_use]
    pub fn p_value(&self, own: &[usize], others: &[usize], target: usize) -> f64 {
        let index: Vec<usize> = [others, own, &[target]].concat();
        let (m, o, d) = (index.len(), others.len(), own.len());
        let mut small = self.compact(&index);
        let used = eliminate(&mut small, m, o);
        // Residuals of the columns and of the target after regression on the others.
        let mut residual = DMatrix::zeros(m, d + 1);
        for c in 0..=d {
            for i in (0..o).filter(|&i| used[i]) {
                residual[(i, c)] = -small[i * m + o + c];
            }
            residual[(o + c, c)] = 1.0;
        }
        let mut inner = DMatrix::zeros(d, d);
        let mut scores: Vec<Vec<f64>> = Vec::with_capacity(self.parts.len());
        for part in &self.parts {
            let gram = DMatrix::from_fn(m, m, |i, j| {
                part[place(index[i].max(index[j]), index[i].min(index[j]))]
            });
            let products = residual.transpose() * gram * &residual;
            scores.push((0..d).map(|i| products[(i, d)]).collect());
            inner += products.view((0, 0), (d, d));
        }
        flips(&whitened(&scores, inner))
    }
}

/// Scores along the independent directions, each of unit variance.
fn whitened(scores: &[Vec<f64>], inner: DMatrix<f64>) -> Vec<Vec<f64>> {
    let directions = directions(inner, EXCITED);
    let along = |s: &Vec<f64>, (size, direction): &(f64, DVector<f64>)| -> f64 {
        let dot: f64 = direction.iter().zip(s).map(|(a, b)| a * b).sum();
        dot / size.sqrt()
    };
    scores
        .iter()
        .map(|s| directions.iter().map(|own| along(s, own)).collect())
        .collect()
}

/// Gauss-Jordan elimination of the first `pivots` rows and columns of a symmetric matrix of
/// `m` rows: leaves the regression coefficients and the Schur complement in place. Returns
/// which pivots were used.
fn eliminate(a: &mut [f64], m: usize, pivots: usize) -> Vec<bool> {
    let mut used = vec![false; pivots];
    let mut row = vec![0.0; m];
    for s in 0..pivots {
        let pivot = a[s * m + s];
        if pivot < DEPENDENT {
            continue;
        }
        used[s] = true;
        for (r, v) in row.iter_mut().zip(&a[s * m..(s + 1) * m]) {
            *r = v / pivot;
        }
        for i in (0..m).filter(|&i| i != s) {
            let factor = a[i * m + s];
            if factor != 0.0 {
                for (v, r) in a[i * m..(i + 1) * m].iter_mut().zip(&row) {
                    *v -= factor * r;
                }
            }
        }
        a[s * m..(s + 1) * m].copy_from_slice(&row);
    }
    used
}

/// Gram matrix of the residuals of all columns after regression on some: a Schur complement.
#[derive(Debug, Clone, Default)]
pub struct Swept {
    size: usize,
    /// Rows; only the upper triangle is kept up to date.
    entries: Vec<f64>,
}

impl Swept {
    /// Number of columns.
    #[must_use]
    pub fn size(&self) -> usize {
        self.size
    }

    /// Product of two residual columns.
    #[must_use]
    pub fn at(&self, i: usize, j: usize) -> f64 {
        let (i, j) = (i.min(j), i.max(j));
        self.entries[i * self.size + j]
    }

    /// Adds columns to the set.
    pub fn sweep(&mut self, columns: &[usize]) {
        let k = self.size;
        let mut row = vec![0.0; k];
        for &s in columns {
            let pivot = self.at(s, s);
            if pivot < DEPENDENT {
                continue;
            }
            for (j, r) in row.iter_mut().enumerate() {
                *r = self.at(s, j);
            }
            for i in 0..k {
                let factor = row[i] / pivot;
                if factor != 0.0 {
                    subtract(&mut self.entries[i * k + i..(i + 1) * k], factor, &row[i..]);
                }
            }
        }
    }

    /// Whether the residual of a column is large enough to determine its coefficient.
    #[must_use]
    pub fn is_excited(&self, column: usize) -> bool {
        self.at(column, column) > EXCITED
    }

    /// Reduction of the target's squared error by a group of columns jointly; 0 if the first
    /// one, the effect's own, is not excited, since the others are only its slopes.
    #[must_use]
    pub fn gain(&self, group: &[usize], target: usize) -> f64 {
        match group.first() {
            Some(&first) if self.is_excited(first) => self.gain_of_any(group, target),
            _ => 0.0,
        }
    }

    /// The same for a group of columns of equal rank, such as those of a curve.
    #[must_use]
    pub fn gain_of_any(&self, group: &[usize], target: usize) -> f64 {
        let upper = |i: usize, j: usize| self.at(group[i], group[j]);
        gain(upper, |i| self.at(group[i], target), group.len())
    }

    /// Reduction of the target's squared error by two columns jointly; `None` if they are
    /// nearly collinear.
    #[must_use]
    pub fn gain_of_pair(&self, i: usize, j: usize, target: usize) -> Option<f64> {
        let (a, b, ab) = (self.at(i, i), self.at(j, j), self.at(i, j));
        let determinant = a * b - ab * ab;
        let (p, q) = (self.at(i, target), self.at(j, target));
        (determinant > EXCITED * a * b)
            .then(|| (p * p * b - 2.0 * p * q * ab + q * q * a) / determinant)
    }
}

/// Reduction of the target's squared error by some columns, from the products of residuals:
/// `upper(i, j)` with `i <= j` among the columns, `right(i)` with the target.
pub(super) fn gain(
    upper: impl Fn(usize, usize) -> f64,
    right: impl Fn(usize) -> f64,
    d: usize,
) -> f64 {
    match d {
        0 => 0.0,
        1 => match upper(0, 0) {
            pivot if pivot < SLOPE => 0.0,
            pivot => right(0) * right(0) / pivot,
        },
        2 => gain_in(&mut [0.0; 6], upper, right, d),
        3 => gain_in(&mut [0.0; 12], upper, right, d),
        4..=SMALL => gain_in(&mut [0.0; SMALL * (SMALL + 1)], upper, right, d),
        _ => gain_in(&mut vec![0.0; d * (d + 1)], upper, right, d),
    }
}

/// The same, with room for a matrix of `d` rows and one more column.
fn gain_in(
    a: &mut [f64],
    upper: impl Fn(usize, usize) -> f64,
    right: impl Fn(usize) -> f64,
    d: usize,
) -> f64 {
    let m = d + 1;
    for i in 0..d {
        for j in i..d {
            a[i * m + j] = upper(i, j);
        }
        a[i * m + d] = right(i);
    }
    let mut gain = 0.0;
    for s in 0..d {
        let pivot = a[s * m + s];
        if pivot < SLOPE {
            continue;
        }
        gain += a[s * m + d] * a[s * m + d] / pivot;
        for i in s + 1..d {
            let factor = a[s * m + i] / pivot;
            for j in i..m {
                a[i * m + j] -= factor * a[s * m + j];
            }
        }
    }
    gain
}

#[cfg(test)]
mod tests;
