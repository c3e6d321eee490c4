//! What a column has that nothing in a model can imitate.

use crate::problem::Prepared;
use nalgebra::DVector;

/// Below this share of its norm a column is a sum of others within rounding.
const DEPENDENT: f64 = 1e-6;

/// An orthonormal basis on the rows of the fit segment.
#[derive(Debug, Clone, Default)]
pub(crate) struct Span(Vec<DVector<f64>>);

impl Span {
    /// The span of columns on the estimation grid.
    pub(crate) fn of<'a>(data: &Prepared, columns: impl Iterator<Item = &'a Vec<f64>>) -> Self {
        let mut span = Self::default();
        for column in columns {
            span.add(rows(data, column));
        }
        span
    }

    /// Widens the span, unless the column lies in it already.
    pub(crate) fn add(&mut self, column: DVector<f64>) {
        let norm = column.norm();
        if !(norm.is_finite() && norm > 0.0) {
            return;
        }
        let left = self.off(column);
        let rest = left.norm();
        if rest > DEPENDENT * norm {
            self.0.push(left / rest);
        }
    }

    /// The orthonormal vectors.
    pub(crate) fn basis(&self) -> &[DVector<f64>] {
        &self.0
    }

    /// The column without its part in the span; twice, against rounding.
    pub(crate) fn off(&self, mut column: DVector<f64>) -> DVector<f64> {
        for _ in 0..2 {
            for q in &self.0 {
                let dot = q.dot(&column);
                column.axpy(-dot, q, 1.0);
            }
        }
        column
    }
}

/// The rows of the fit segment of a column on the estimation grid.
pub(crate) fn rows(data: &Prepared, column: &[f64]) -> DVector<f64> {
    let rows = &data.split.fit;
    DVector::from_iterator(rows.len(), rows.iter().map(|&i| column[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_in_the_span_vanishes_and_what_is_not_stays() {
        let mut span = Span::default();
        span.add(DVector::from_vec(vec![1.0, 1.0, 0.0]));
        span.add(DVector::from_vec(vec![2.0, 2.0, 0.0]));
        span.add(DVector::from_vec(vec![0.0, 0.0, 0.0]));
        assert_eq!(span.0.len(), 1, "dependent and empty columns add nothing");
        let left = span.off(DVector::from_vec(vec![3.0, 1.0, 5.0]));
        let expected = DVector::from_vec(vec![1.0, -1.0, 5.0]);
        // Rounding of a few operations on numbers near one.
        assert!((left - expected).norm() < 1e-12);
    }
}
