//! Columns on the rows of the fit segment.

pub(crate) use crate::algebra::{Span, Stretch};
use crate::problem::Prepared;
use nalgebra::DVector;
use std::ops::Index;

impl Span {
    /// The span of columns on the estimation grid. Those of single files are added first: they
    /// stay short.
    pub(crate) fn of<'a>(data: &Prepared, columns: impl Iterator<Item = &'a Stretch>) -> Self {
        let own = columns.map(|column| column.at_rows(&data.split.fit));
        let mut own: Vec<Stretch> = own.collect();
        if data.pieces.len() > 1 {
            own.sort_by_key(|column| column.values().len());
        }
        let mut span = Self::default();
        for column in own {
            span.add(column);
        }
        span
    }
}

/// The rows of the fit segment of a column on the estimation grid.
pub(crate) fn rows<C>(data: &Prepared, column: &C) -> DVector<f64>
where
    C: Index<usize, Output = f64> + ?Sized,
{
    let rows = &data.split.fit;
    DVector::from_iterator(rows.len(), rows.iter().map(|&i| column[i]))
}
