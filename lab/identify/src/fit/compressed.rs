//! A Jacobian of as few rows as it has parameters.
//!
//! Levenberg-Marquardt asks only for products of the residual and of the Jacobian's columns with
//! each other. They are the same in an orthonormal basis of those columns, which has one row for
//! each: the residual is the first vector of it, so that there only its first entry is not zero.
//! The basis is found by modified Gram-Schmidt, whose triangle is as good as Householder's
//! (Björck, 1967).

use crate::algebra::{dot, norm, subtract};
use nalgebra::{DMatrix, DVector};

/// The residual in that basis, for so many parameters.
pub(super) fn residual(size: f64, parameters: usize) -> DVector<f64> {
    let mut small = DVector::zeros(parameters + 1);
    small[0] = size;
    small
}

/// The Jacobian in that basis.
pub(super) fn jacobian(residual: &[f64], mut columns: DMatrix<f64>) -> DMatrix<f64> {
    let (rows, count) = columns.shape();
    let mut small = DMatrix::zeros(count + 1, count);
    if rows == 0 {
        return small;
    }
    let mut split: Vec<&mut [f64]> = columns.as_mut_slice().chunks_exact_mut(rows).collect();
    let size = norm(residual);
    if size > 0.0 {
        for (j, column) in split.iter_mut().enumerate() {
            let part = dot(residual, column) / size;
            small[(0, j)] = part;
            subtract(column, part / size, residual);
        }
    }
    for k in 0..count {
        let (done, others) = split.split_at_mut(k + 1);
        let Some(own) = done.last_mut() else { continue };
        let size = norm(own);
        small[(k + 1, k)] = size;
        if size > 0.0 {
            own.iter_mut().for_each(|v| *v /= size);
            for (j, other) in others.iter_mut().enumerate() {
                let part = dot(own, other);
                small[(k + 1, k + 1 + j)] = part;
                subtract(other, part, own);
            }
        }
    }
    small
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn all_products_stay_as_they_were() {
        let at = |i: usize, j: usize| (0.3 * (i * (j + 2)) as f64).sin() + 0.1 * j as f64;
        let columns = DMatrix::from_fn(50, 4, at);
        let whole = DVector::from_fn(50, |i, _| at(i, 7));
        for whole in [whole, DVector::zeros(50)] {
            let small = jacobian(whole.as_slice(), columns.clone());
            let short = residual(whole.norm(), 4);
            assert_eq!(small.shape(), (5, 4));
            // Rounding of fifty products of numbers near one.
            let (a, b) = (small.tr_mul(&small), columns.tr_mul(&columns));
            assert_relative_eq!(a, b, epsilon = 1e-12);
            let (a, b) = (small.tr_mul(&short), columns.tr_mul(&whole));
            assert_relative_eq!(a, b, epsilon = 1e-12);
        }
    }

    #[test]
    fn columns_that_vanish_or_repeat_are_borne() {
        let column = DVector::from_fn(20, |i, _| (0.3 * i as f64).cos());
        let columns = DMatrix::from_columns(&[column.clone(), column.clone(), 0.0 * column]);
        let small = jacobian(DVector::zeros(20).as_slice(), columns);
        assert!(small.iter().all(|v| v.is_finite()));
        assert_eq!(jacobian(&[], DMatrix::zeros(0, 2)), DMatrix::zeros(3, 2));
    }
}
