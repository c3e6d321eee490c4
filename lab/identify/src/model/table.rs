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
        if self.is_hats() {
            return Some(self.hats(&values));
        }
        let empty = self.shapes.iter().map(|_| Vec::with_capacity(values.len()));
        let mut columns: Vec<Vec<f64>> = empty.collect();
        for value in values {
            let (left, share) = self.place(value);
            for (column, shape) in columns.iter_mut().zip(&self.shapes) {
                column.push(shape[left] + share * (shape[left + 1] - shape[left]));
            }
        }
        Some(columns)
    }

    /// Whether each shape is one at its own knot and zero at all others.
    fn is_hats(&self) -> bool {
        let is_own = |(k, shape): (usize, &Vec<f64>)| {
            let at = |(j, value): (usize, &f64)| *value == f64::from(u8::from(j == k));
            shape.len() == self.knots.len() && shape.iter().enumerate().all(at)
        };
        self.shapes.len() == self.knots.len() && self.shapes.iter().enumerate().all(is_own)
    }

    /// The columns of hat functions: at most two of them differ from zero.
    fn hats(&self, values: &[f64]) -> Vec<Vec<f64>> {
        let zeros = self.knots.iter().map(|_| vec![0.0; values.len()]);
        let mut columns: Vec<Vec<f64>> = zeros.collect();
        for (i, &value) in values.iter().enumerate() {
            let (left, share) = self.place(value);
            if share.is_nan() {
                columns.iter_mut().for_each(|column| column[i] = share);
                continue;
            }
            columns[left][i] = 1.0 - share;
            columns[left + 1][i] = share;
        }
        columns
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
