//! A Jacobian with only as many rows as parameters.
//!
//! Levenberg-Marquardt asks only for products of the residual and of the Jacobian's columns with
//! each other. These products are the same in any orthonormal basis of the columns; the solver
//! gets them in a basis whose first vector is the residual. In this basis only the first entry of
//! the residual is not zero, whatever the Jacobian, so it is known before the Jacobian is needed.
//!
//! The slopes are first projected off the columns of the model (Kaufman, 1975). For one file this
//! is done on all rows. For several files, the slopes, the columns of the model and the residual
//! are first written in the basis of their [`Span`]: columns of a single file are added first and
//! stay on its own rows, so the cost is proportional to the number of rows.

use crate::algebra::{take_off, Span, Stretch};
use nalgebra::{DMatrix, DVector};

/// A column whose remainder after the others is below this share of its norm gets no basis vector:
/// the remainder is rounding.
const ROUNDING: f64 = 1e-14;

/// The residual in the solver's basis, for this number of parameters.
pub(super) fn residual(norm: f64, parameters: usize) -> DVector<f64> {
    let mut small = DVector::zeros(parameters + 1);
    small[0] = norm;
    small
}

/// The Jacobian in the solver's basis: the slopes without their part in the orthonormal columns
/// of the model, each times its factor.
pub(super) fn jacobian(
    model: &Span,
    residual: &Stretch,
    slopes: impl Iterator<Item = Stretch>,
    factors: &[f64],
) -> DMatrix<f64> {
    let slopes = slopes.map(|slope| model.once_off(slope));
    triangle(residual.clone(), slopes.zip(factors))
}

/// The same, at a cost in proportion to the rows where many slopes belong to one of several
/// files.
pub(super) fn jacobian_of_files(
    model: &Span,
    residual: &Stretch,
    slopes: impl Iterator<Item = Stretch>,
    factors: &[f64],
) -> DMatrix<f64> {
    let (slopes, residual) = (slopes.collect::<Vec<_>>(), residual.clone());
    let (count, own) = (slopes.len(), model.basis().len());
    let mut all: Vec<(usize, Stretch)> = slopes.into_iter().enumerate().collect();
    all.extend(
        model
            .basis()
            .iter()
            .cloned()
            .zip(count..)
            .map(|(q, k)| (k, q)),
    );
    all.push((count + own, residual));
    all.sort_by_key(|(_, column)| column.values().len());
    let mut span = Span::with_tolerance(ROUNDING);
    let mut parts = vec![Vec::new(); all.len()];
    for (place, column) in all {
        (_, parts[place]) = span.add_with_parts(column);
    }
    let size = span.basis().len();
    let at = |i: usize, place: usize| parts[place].get(i).copied().unwrap_or(0.0);
    let basis = DMatrix::from_fn(size, own, |i, k| at(i, count + k));
    let residual = DVector::from_fn(size, |i, _| at(i, count + own));
    let slopes = (0..count).map(|j| {
        let mut slope = DVector::from_fn(size, |i, _| at(i, j));
        take_off(&basis, &mut slope);
        Stretch::from(slope)
    });
    triangle(residual.into(), slopes.zip(factors))
}

/// Columns, each times its factor, in a basis whose first vector is the residual.
fn triangle<'a>(
    residual: Stretch,
    columns: impl Iterator<Item = (Stretch, &'a f64)>,
) -> DMatrix<f64> {
    let mut span = Span::with_tolerance(ROUNDING);
    span.add(residual);
    let parts: Vec<(Vec<f64>, f64)> = columns
        .map(|(column, factor)| (span.add_with_parts(column).1, *factor))
        .collect();
    let at = |i: usize, j: usize| parts[j].0.get(i).copied().unwrap_or(0.0) * parts[j].1;
    DMatrix::from_fn(parts.len() + 1, parts.len(), at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const ROWS: usize = 60;

    fn column(rows: std::ops::Range<usize>, seed: usize) -> Stretch {
        let at = |i: usize| (0.3 * (i * (seed + 2)) as f64).sin() + 0.1 * seed as f64;
        Stretch::at(rows.start, rows.map(at).collect())
    }

    fn matrix(columns: &[Stretch]) -> DMatrix<f64> {
        let columns: Vec<_> = columns
            .iter()
            .map(|c| DVector::from_vec(c.whole(ROWS).to_vec()))
            .collect();
        DMatrix::from_columns(&columns)
    }

    /// Two files, each with a separate state, and their common columns.
    fn slopes() -> Vec<Stretch> {
        vec![
            column(0..ROWS, 1),
            column(0..25, 2),
            column(25..ROWS, 3),
            column(0..ROWS, 4),
        ]
    }

    #[test]
    fn all_products_are_those_of_the_projected_jacobian_on_all_rows() {
        let mut model = Span::default();
        assert!(model.add(column(0..ROWS, 5)) && model.add(column(0..ROWS, 6)));
        let factors = [1.0, -2.0, 3.0, 0.5];
        let projected: Vec<_> = (slopes().iter().zip(factors))
            .map(|(slope, factor)| model.off(matrix(&[slope.map(|v| factor * v)]).column(0).into()))
            .collect();
        let projected = DMatrix::from_columns(&projected);
        // The residual of a fit has no part in the columns of the model.
        let rest = model.off(matrix(&[column(0..ROWS, 7)]).column(0).into());
        for rest in [rest, DVector::zeros(ROWS)] {
            let (left, short) = (Stretch::from(rest.clone()), residual(rest.norm(), 4));
            for small in [
                jacobian(&model, &left, slopes().into_iter(), &factors),
                jacobian_of_files(&model, &left, slopes().into_iter(), &factors),
            ] {
                assert_eq!(small.shape(), (5, 4));
                // Rounding of sixty products of numbers of order ten.
                let (a, b) = (small.tr_mul(&small), projected.tr_mul(&projected));
                assert_relative_eq!(a, b, epsilon = 1e-10);
                let (a, b) = (small.tr_mul(&short), projected.tr_mul(&rest));
                assert_relative_eq!(a, b, epsilon = 1e-10);
            }
        }
    }

    #[test]
    fn slopes_that_vanish_or_repeat_are_borne() {
        let all = || vec![column(0..20, 1), column(0..20, 1), Stretch::default()].into_iter();
        let (model, none) = (Span::default(), Stretch::default());
        for small in [
            jacobian(&model, &none, all(), &[1.0; 3]),
            jacobian_of_files(&model, &none, all(), &[1.0; 3]),
        ] {
            assert!(small.iter().all(|v| v.is_finite()));
            assert_eq!(small.shape(), (4, 3));
        }
    }
}
