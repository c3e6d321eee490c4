//! Systems of equations, and the directions of symmetric matrices.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Least-squares solution of `a·x = b`, with the smallest norm. Singular values up to `tolerance`
/// count as zero: `a` should have columns of about unit size. `None` if the tolerance is negative.
pub(crate) fn least_norm(
    a: DMatrix<f64>,
    b: &DVector<f64>,
    tolerance: f64,
) -> Option<DVector<f64>> {
    a.svd(true, true).solve(b, tolerance).ok()
}

/// Inverse of a symmetric positive definite matrix; `None` if it is not definite.
pub(crate) fn inverse(gram: DMatrix<f64>) -> Option<DMatrix<f64>> {
    gram.cholesky().map(|factor| factor.inverse())
}

/// A matrix `w` for which `w·gram·wᵀ` is the identity: it makes columns with these products
/// orthonormal. `None` if `gram` is not positive definite.
pub(crate) fn whitening(gram: DMatrix<f64>) -> Option<DMatrix<f64>> {
    gram.cholesky()?.l().try_inverse()
}

/// Eigenvalues above `least` of a symmetric matrix, each with its direction of unit norm.
pub(crate) fn directions(matrix: DMatrix<f64>, least: f64) -> Vec<(f64, DVector<f64>)> {
    let eigen = SymmetricEigen::new(matrix);
    let values = eigen.eigenvalues.iter().copied();
    let pairs = values.zip(eigen.eigenvectors.column_iter());
    pairs
        .filter(|(value, _)| *value > least)
        .map(|(value, direction)| (value, direction.into_owned()))
        .collect()
}

/// Slope and offset of the least-squares line through points `(x, y)`. Where `x` does not vary
/// the slope is 1.
pub(crate) fn line(points: impl Iterator<Item = (f64, f64)> + Clone) -> (f64, f64) {
    let count = points.clone().count().max(1) as f64;
    let x = points.clone().map(|point| point.0).sum::<f64>() / count;
    let y = points.clone().map(|point| point.1).sum::<f64>() / count;
    let (mut own, mut cross) = (0.0, 0.0);
    for point in points {
        own += (point.0 - x).powi(2);
        cross += (point.0 - x) * (point.1 - y);
    }
    let slope = if own > 0.0 { cross / own } else { 1.0 };
    (slope, y - slope * x)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_singular_system_has_the_solution_of_least_norm() {
        // x + y = 2, twice: the point of that line nearest to the origin is (1, 1).
        let a = DMatrix::from_element(2, 2, 1.0);
        let b = DVector::from_element(2, 2.0);
        let x = least_norm(a, &b, 1e-10).unwrap();
        // Rounding of a few operations on numbers near one.
        assert_relative_eq!(x, DVector::from_element(2, 1.0), epsilon = 1e-12);
    }

    #[test]
    fn a_singular_value_below_the_tolerance_counts_as_zero() {
        let a = || DMatrix::from_diagonal(&DVector::from_vec(vec![2.0, 1e-6]));
        let b = DVector::from_element(2, 1.0);
        // Rounding of a division.
        let below = least_norm(a(), &b, 1e-5).unwrap();
        assert_relative_eq!(below, DVector::from_vec(vec![0.5, 0.0]), epsilon = 1e-12);
        let above = least_norm(a(), &b, 1e-7).unwrap();
        assert_relative_eq!(above[1], 1e6, max_relative = 1e-12);
    }

    #[test]
    fn an_overdetermined_system_is_solved_in_the_least_squares_sense() {
        // The mean of 1, 2 and 6.
        let a = DMatrix::from_element(3, 1, 1.0);
        let b = DVector::from_vec(vec![1.0, 2.0, 6.0]);
        // Rounding of a few operations on numbers near one.
        assert_relative_eq!(least_norm(a, &b, 1e-10).unwrap()[0], 3.0, epsilon = 1e-12);
    }

    #[test]
    fn a_definite_matrix_has_its_inverse_and_an_indefinite_one_none() {
        let inverted = inverse(DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 1.0, 2.0])).unwrap();
        let expected = DMatrix::from_row_slice(2, 2, &[2.0, -1.0, -1.0, 2.0]) / 3.0;
        // Rounding of a few operations on numbers near one.
        assert_relative_eq!(inverted, expected, epsilon = 1e-12);
        assert!(inverse(DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 2.0, 1.0])).is_none());
    }

    #[test]
    fn whitening_makes_products_those_of_orthonormal_columns() {
        let gram = DMatrix::from_row_slice(2, 2, &[4.0, 2.0, 2.0, 5.0]);
        let w = whitening(gram.clone()).unwrap();
        // gram = l·lᵀ with l = [2 0; 1 2].
        let expected = DMatrix::from_row_slice(2, 2, &[0.5, 0.0, -0.25, 0.5]);
        // Rounding of a few operations on numbers near one.
        assert_relative_eq!(w, expected, epsilon = 1e-12);
        assert!(whitening(-gram).is_none());
    }

    #[test]
    fn directions_without_a_size_are_left_out() {
        // Eigenvalues 2 along (1, 1) and 0 along (1, −1).
        let found = directions(DMatrix::from_element(2, 2, 1.0), 1e-4);
        assert_eq!(found.len(), 1);
        // Rounding of a few operations on numbers near one.
        assert_relative_eq!(found[0].0, 2.0, epsilon = 1e-12);
        assert_relative_eq!(found[0].1[0], found[0].1[1], epsilon = 1e-12);
        assert_relative_eq!(found[0].1.norm(), 1.0, epsilon = 1e-12);
    }

    #[test]
    fn a_line_goes_through_points_on_it_and_through_the_mean_where_x_rests() {
        let on_it = [(0.0, 1.0), (1.0, 3.0), (2.0, 5.0)];
        assert_eq!(line(on_it.into_iter()), (2.0, 1.0));
        let at_rest = [(3.0, 1.0), (3.0, 2.0)];
        assert_eq!(line(at_rest.into_iter()), (1.0, -1.5));
    }
}
