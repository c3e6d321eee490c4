//! The part of a column that no combination of a set of columns can reproduce.

use super::Stretch;
use nalgebra::{DMatrix, DVector};

/// Below this share of its norm a column is a sum of others within rounding and the errors of
/// difference quotients, from which most slopes come.
const DEPENDENT: f64 = 1e-6;

/// Orthonormal basis of columns, by Gram-Schmidt that is repeated once, which is as good as
/// Householder (Giraud, Langou and Rozložník, 2005).
///
/// A column that is zero outside of one file stays so if only columns of files were added
/// before it: who adds these first pays for each on its own file alone.
#[derive(Debug, Clone)]
pub(crate) struct Span {
    /// Below this share of its norm a column lies in the span already.
    dependent: f64,
    basis: Vec<Stretch>,
    /// Each column that widened the span, in terms of the basis up to its own vector.
    upper: Vec<Vec<f64>>,
}

impl Default for Span {
    fn default() -> Self {
        Self::with_tolerance(DEPENDENT)
    }
}

impl Span {
    /// An empty span. A column with at most this share of its norm outside the span counts as
    /// dependent.
    pub(crate) fn with_tolerance(dependent: f64) -> Self {
        Self {
            dependent,
            basis: Vec::new(),
            upper: Vec::new(),
        }
    }

    /// Widens the span, unless the column lies in it already or is not finite; whether it did.
    pub(crate) fn add(&mut self, column: impl Into<Stretch>) -> bool {
        self.add_with_parts(column.into()).0
    }

    /// The same, and the column in terms of the basis, its own vector included.
    pub(crate) fn add_with_parts(&mut self, column: Stretch) -> (bool, Vec<f64>) {
        let norm = column.norm();
        if !(norm.is_finite() && norm > 0.0) {
            return (false, Vec::new());
        }
        let (left, mut parts) = self.split(column);
        let rest = left.norm();
        let widens = rest > self.dependent * norm;
        if widens {
            parts.push(rest);
            self.upper.push(parts.clone());
            self.basis.push(left.divided(rest));
        }
        (widens, parts)
    }

    /// The orthonormal vectors.
    pub(crate) fn basis(&self) -> &[Stretch] {
        &self.basis
    }

    /// The column without its part in the span.
    pub(crate) fn off(&self, column: DVector<f64>) -> DVector<f64> {
        let (left, _) = self.split(column.into());
        DVector::from_column_slice(left.values())
    }

    /// The column without its part in the span, projected once, which is sufficient if enough of
    /// the column remains.
    pub(crate) fn once_off(&self, mut column: Stretch) -> Stretch {
        let parts: Vec<f64> = self.basis.iter().map(|q| q.dot(&column)).collect();
        for (part, q) in parts.into_iter().zip(&self.basis) {
            column.take_off(q, part);
        }
        column
    }

    /// The column without its part in the span, and that part in terms of the basis.
    fn split(&self, mut column: Stretch) -> (Stretch, Vec<f64>) {
        let mut parts = vec![0.0; self.basis.len()];
        // Twice, against rounding.
        for _ in 0..2 {
            for (part, q) in parts.iter_mut().zip(&self.basis) {
                let dot = q.dot(&column);
                column.take_off(q, dot);
                *part += dot;
            }
        }
        (column, parts)
    }

    /// Least-squares gains of the columns that widened the span.
    pub(crate) fn gains(&self, target: &Stretch) -> Vec<f64> {
        let mut gains: Vec<f64> = self.basis.iter().map(|q| q.dot(target)).collect();
        for i in (0..gains.len()).rev() {
            gains[i] /= self.upper[i][i];
            let gain = gains[i];
            for (j, slot) in gains.iter_mut().enumerate().take(i) {
                *slot -= self.upper[i][j] * gain;
            }
        }
        gains
    }
}

/// Removes from a column its part in the columns of an orthonormal matrix. One projection is
/// sufficient if enough of the column remains.
pub(crate) fn take_off(basis: &DMatrix<f64>, column: &mut DVector<f64>) {
    let parts = basis.tr_mul(column);
    column.gemv(-1.0, basis, &parts, 1.0);
}

/// Correlation of a column with its best imitation by a span, from the norms of the column and of
/// its part outside the span.
pub(crate) fn imitated(whole: f64, rest: f64) -> f64 {
    (1.0 - (rest / whole).powi(2)).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn column(values: [f64; 3]) -> DVector<f64> {
        DVector::from_vec(values.to_vec())
    }

    /// (1, 1, 0) and (1, 0, 1), with two columns that add nothing between them.
    fn plane() -> Span {
        let mut span = Span::default();
        assert!(span.add(column([1.0, 1.0, 0.0])));
        assert!(!span.add(column([2.0, 2.0, 0.0])), "a multiple");
        assert!(!span.add(column([0.0; 3])), "no column");
        assert!(!span.add(column([f64::NAN; 3])), "not finite");
        assert!(span.add(column([1.0, 0.0, 1.0])));
        span
    }

    #[test]
    fn what_is_in_the_span_vanishes_and_what_is_not_stays() {
        let span = plane();
        assert_eq!(span.basis().len(), 2);
        // The plane's normal is (1, −1, −1).
        let normal = column([1.0, -1.0, -1.0]);
        let left = span.off(&normal + column([5.0, 2.0, 3.0]));
        // Rounding of a few operations on numbers near one.
        assert_relative_eq!(left, normal, epsilon = 1e-12);
    }

    #[test]
    fn gains_are_those_of_the_least_squares_fit() {
        // 2·(1, 1, 0) − 3·(1, 0, 1), and something along the normal, which no gain can reach.
        let target = column([-1.0, 2.0, -3.0]) + 7.0 * column([1.0, -1.0, -1.0]);
        let gains = plane().gains(&target.into());
        // Rounding of a few operations on numbers of order ten.
        assert_relative_eq!(gains[0], 2.0, epsilon = 1e-11);
        assert_relative_eq!(gains[1], -3.0, epsilon = 1e-11);
    }

    #[test]
    fn the_tolerance_says_what_counts_as_a_sum_of_others() {
        let nearly = || column([1.0, 1.0, 1e-7]);
        for (tolerance, expected) in [(1e-6, 1), (1e-9, 2)] {
            let mut span = Span::with_tolerance(tolerance);
            span.add(column([1.0, 1.0, 0.0]));
            span.add(nearly());
            assert_eq!(span.basis().len(), expected, "{tolerance}");
        }
    }

    #[test]
    fn once_is_enough_for_a_column_of_which_much_is_left() {
        // Along the normal (1, −1, −1): (3 − 1 − 5)/3 = −1.
        let left = column([-1.0, 1.0, 1.0]);
        let once = plane().once_off(column([3.0, 1.0, 5.0]).into());
        assert_relative_eq!(column([once[0], once[1], once[2]]), left, epsilon = 1e-12);
        let basis: Vec<_> = plane()
            .basis
            .into_iter()
            .map(Stretch::into_values)
            .map(DVector::from)
            .collect();
        let plane = DMatrix::from_columns(&basis);
        let mut one = column([3.0, 1.0, 5.0]);
        take_off(&plane, &mut one);
        assert_relative_eq!(one, left, epsilon = 1e-12);
    }

    #[test]
    fn of_a_column_at_sixty_degrees_half_is_imitated() {
        let rest = 0.75_f64.sqrt();
        // Rounding of two roots.
        assert_relative_eq!(imitated(1.0, rest), 0.5, epsilon = 1e-12);
        assert!(
            imitated(1.0, 1.0 + 1e-15).abs() < 1e-12,
            "never the root of less than nothing"
        );
    }
}
