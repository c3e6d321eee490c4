//! A curve over one variable as a term of the model.

use super::variable::Variable;
use crate::problem::Prepared;
use bowden::effect::Quantity;
use nalgebra::{DMatrix, DVector};

/// A curve between knots, linear in its gains: one column for each of its shapes.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// The variable of the curve.
    pub variable: Variable,
    /// The knots, in ascending order.
    pub knots: Vec<f64>,
    /// Values at the knots, for a gain of one each.
    pub shapes: Vec<Vec<f64>>,
}

impl Table {
    /// Its name among the effects of a model.
    pub(crate) fn name(&self, data: &Prepared) -> String {
        format!("curve over {}", self.variable.words(data))
    }

    /// The variable of the core's [curve](bowden::effect::CurvePosition) for it; `None` if the core
    /// has no such curve.
    pub(crate) fn over(&self) -> Option<Quantity> {
        match self.variable {
            Variable::Position(_) => Some(Quantity::Position),
            Variable::Velocity(_) => Some(Quantity::Velocity),
            _ => None,
        }
    }

    /// The points of the curve with these gains.
    pub(crate) fn points(&self, gains: &[f64]) -> Vec<(f64, f64)> {
        let at = |k: usize| self.shapes.iter().zip(gains).map(|(s, g)| g * s[k]).sum();
        let knots = self.knots.iter().enumerate();
        knots.map(|(k, &knot)| (knot, at(k))).collect()
    }

    /// The curve with these gains and at most `count` of its knots, with one gain: its two ends, and
    /// then always the knot that gives the smallest error at all knots, which the motion passes
    /// equally often.
    pub(crate) fn with_fewer_knots(&self, gains: &[f64], count: usize) -> Self {
        let points = self.points(gains);
        let mut kept = vec![0, points.len() - 1];
        while kept.len() < count.min(points.len()) {
            let with = |k: usize| {
                let mut more = kept.clone();
                more.insert(more.partition_point(|&own| own < k), k);
                Some((self.through(&points, &more)?.1, more))
            };
            let others = (0..points.len()).filter(|k| !kept.contains(k));
            match others.filter_map(with).min_by(|a, b| a.0.total_cmp(&b.0)) {
                Some((_, more)) => kept = more,
                None => break,
            }
        }
        let fewer = self.through(&points, &kept);
        fewer.map_or_else(|| self.clone(), |(fewer, _)| fewer)
    }

    /// The curve over some of the points with the smallest error at all points, and its squared
    /// error.
    fn through(&self, points: &[(f64, f64)], kept: &[usize]) -> Option<(Self, f64)> {
        let (all, values): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
        let mut curve = Self {
            variable: self.variable,
            knots: kept.iter().map(|&k| all[k]).collect(),
            shapes: Vec::new(),
        };
        let hats: Vec<DVector<f64>> = curve.hats(&all).into_iter().map(DVector::from).collect();
        let (hats, values) = (DMatrix::from_columns(&hats), DVector::from(values));
        let own = hats.tr_mul(&hats).cholesky()?.solve(&hats.tr_mul(&values));
        curve.shapes.push(own.iter().copied().collect());
        Some((curve, (hats * own - values).norm_squared()))
    }

    /// One column per shape, on the work grid.
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
