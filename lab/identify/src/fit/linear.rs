//! Gains by least squares once the shapes are known.

use super::tie::Tie;
use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

/// Gains, and the basis that they leave.
pub(super) struct Linear {
    pub(super) gains: Vec<f64>,
    pub(super) basis: DMatrix<f64>,
    /// The bounds that the gains lie on.
    pub(super) tied: Vec<Tie>,
}

/// Least squares on the fit segment with some gains kept from going negative, and others
/// within their ties.
///
/// A bound that the gains violate becomes an equation, and the two columns of its gains
/// one column. A bound that has become an equation stays one: with one record there is
/// only one, so that this is the exact optimum.
pub(super) fn solve_linear(
    rows: &[usize],
    columns: &[Arc<Vec<f64>>],
    target: &[f64],
    kept: &[bool],
    ties: &[Tie],
) -> Linear {
    let mut tied: Vec<Tie> = Vec::new();
    loop {
        let mut columns = columns.to_vec();
        for tie in &tied {
            columns[tie.hysteresis] = Arc::new(tie.merged(&columns));
        }
        let free = |k: &usize| tied.iter().all(|tie| tie.gain != *k);
        let active = (0..columns.len()).filter(free).collect();
        let mut linear = non_negative(rows, &columns, target, kept, active);
        for tie in &tied {
            linear.gains[tie.gain] = -tie.ratio * linear.gains[tie.hysteresis];
        }
        match ties.iter().find(|tie| tie.is_violated(&linear.gains)) {
            Some(next) if !tied.contains(next) => tied.push(*next),
            _ => return Linear { tied, ..linear },
        }
    }
}

/// Least squares with some gains kept from going negative.
fn non_negative(
    rows: &[usize],
    columns: &[Arc<Vec<f64>>],
    target: &[f64],
    kept: &[bool],
    mut active: Vec<usize>,
) -> Linear {
    let y = DVector::from_iterator(rows.len(), rows.iter().map(|&i| target[i]));
    loop {
        let (basis, gains, used) = orthonormal(rows, columns, &active, &y);
        let worst = used
            .iter()
            .zip(&gains)
            .filter(|(&k, g)| kept[k] && **g < 0.0)
            .map(|(&k, _)| k)
            .next();
        match worst {
            Some(k) => active.retain(|&a| a != k),
            None => {
                let mut all = vec![0.0; columns.len()];
                for (&k, &g) in used.iter().zip(&gains) {
                    all[k] = g;
                }
                return Linear {
                    gains: all,
                    basis,
                    tied: Vec::new(),
                };
            }
        }
    }
}

/// Orthonormal basis of the chosen columns (twice-repeated Gram-Schmidt, which is as
/// good as Householder) and the least-squares gains; dependent columns are left out.
fn orthonormal(
    rows: &[usize],
    columns: &[Arc<Vec<f64>>],
    chosen: &[usize],
    y: &DVector<f64>,
) -> (DMatrix<f64>, Vec<f64>, Vec<usize>) {
    let n = rows.len();
    let mut basis: Vec<DVector<f64>> = Vec::with_capacity(chosen.len());
    let mut used = Vec::with_capacity(chosen.len());
    let mut upper: Vec<Vec<f64>> = Vec::with_capacity(chosen.len());
    for &k in chosen {
        let mut v = DVector::from_iterator(n, rows.iter().map(|&i| columns[k][i]));
        let norm = v.norm();
        if !(norm.is_finite() && norm > 0.0) {
            continue;
        }
        let mut coefficients = vec![0.0; basis.len()];
        for _ in 0..2 {
            for (c, q) in coefficients.iter_mut().zip(&basis) {
                let dot = q.dot(&v);
                v.axpy(-dot, q, 1.0);
                *c += dot;
            }
        }
        let left = v.norm();
        // Below this a column is a sum of the others within rounding.
        if left < 1e-9 * norm {
            continue;
        }
        v /= left;
        coefficients.push(left);
        upper.push(coefficients);
        basis.push(v);
        used.push(k);
    }
    let m = basis.len();
    let mut gains: Vec<f64> = basis.iter().map(|q| q.dot(y)).collect();
    for i in (0..m).rev() {
        gains[i] /= upper[i][i];
        let g = gains[i];
        for (j, slot) in gains.iter_mut().enumerate().take(i) {
            *slot -= upper[i][j] * g;
        }
    }
    let basis = if m == 0 {
        DMatrix::zeros(n, 0)
    } else {
        DMatrix::from_columns(&basis)
    };
    (basis, gains, used)
}
