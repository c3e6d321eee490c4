//! A curve over one variable as a term of the model.

use super::variable::Variable;
use crate::problem::Prepared;

/// A curve between knots, linear in its gains: one column for each of its shapes.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// What it is a function of.
    pub variable: Variable,
    /// Where, in rising order.
    pub knots: Vec<f64>,
    /// Values at the knots, for a gain of one each.
    pub shapes: Vec<Vec<f64>>,
}

impl Table {
    /// One column a shape, on the work grid.
    #[must_use]
    pub fn columns(&self, data: &Prepared, eta: &[f64]) -> Option<Vec<Vec<f64>>> {
        let values = self.variable.values(data, eta)?;
        let mut columns = vec![Vec::with_capacity(values.len()); self.shapes.len()];
        for value in values {
            let (left, share) = self.place(value);
            for (column, shape) in columns.iter_mut().zip(&self.shapes) {
                column.push(shape[left] + share * (shape[left + 1] - shape[left]));
            }
        }
        Some(columns)
    }

    /// The knot on the left, and how far on to the next one; constant beyond the ends.
    fn place(&self, value: f64) -> (usize, f64) {
        let last = self.knots.len() - 2;
        let left = self.knots.partition_point(|k| *k <= value);
        let left = left.saturating_sub(1).min(last);
        let (a, b) = (self.knots[left], self.knots[left + 1]);
        (left, ((value - a) / (b - a)).clamp(0.0, 1.0))
    }
}
