//! Columns on the rows of the fit segment.

pub(crate) use crate::algebra::Span;
use crate::problem::Prepared;
use nalgebra::DVector;

impl Span {
    /// The span of columns on the estimation grid.
    pub(crate) fn of<'a>(data: &Prepared, columns: impl Iterator<Item = &'a Vec<f64>>) -> Self {
        let mut span = Self::default();
        for column in columns {
            span.add(rows(data, column));
        }
        span
    }
}

/// The rows of the fit segment of a column on the estimation grid.
pub(crate) fn rows(data: &Prepared, column: &[f64]) -> DVector<f64> {
    let rows = &data.split.fit;
    DVector::from_iterator(rows.len(), rows.iter().map(|&i| column[i]))
}
