//! The search of the shapes from one start: Levenberg-Marquardt on the reduced problem.

use super::linear::{solve_linear, Linear};
use super::tie::{slope, ties};
use crate::model::columns::{raw_columns, RawColumns};
use crate::model::structure::{Free, Range, Role, Structure};
use crate::problem::Prepared;
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};
use std::sync::Arc;

/// Everything about one set of shapes.
pub(super) struct Evaluation {
    pub(super) raw: RawColumns,
    pub(super) columns: Vec<Arc<Vec<f64>>>,
    pub(super) linear: Linear,
    residual: DVector<f64>,
}

pub(super) fn evaluate(
    data: &Prepared,
    structure: &Structure,
    free: &[Free],
    values: &[f64],
    last: Option<&Evaluation>,
) -> Option<Evaluation> {
    let raw = raw_columns(data, structure, free, values)?;
    let columns: Vec<Arc<Vec<f64>>> = raw
        .columns
        .iter()
        .enumerate()
        .map(|(k, c)| match last {
            Some(last) if raw.fixed[k] => Arc::clone(&last.columns[k]),
            _ => Arc::new(data.filtered(c)),
        })
        .collect();
    let linear = solve_linear(
        &data.split.fit,
        &columns,
        &data.target,
        &structure.sign_kept(data.mode),
        &ties(structure, free, values),
    );
    let rows = &data.split.fit;
    let residual = DVector::from_iterator(
        rows.len(),
        rows.iter().map(|&i| {
            data.target[i]
                - columns
                    .iter()
                    .zip(&linear.gains)
                    .map(|(c, g)| g * c[i])
                    .sum::<f64>()
        }),
    );
    if !residual.iter().all(|r| r.is_finite()) {
        return None;
    }
    Some(Evaluation {
        raw,
        columns,
        linear,
        residual,
    })
}

impl Evaluation {
    /// Adds to a tangent how a gain that is tied to kappa_eta moves with the shape.
    pub(super) fn add_tied(&self, tangent: &mut [f64], free: &[Free], values: &[f64], role: Role) {
        for tie in &self.linear.tied {
            let slope = -self.linear.gains[tie.hysteresis] * slope(free, values, role);
            for (t, x) in tangent.iter_mut().zip(self.columns[tie.gain].iter()) {
                *t += slope * x;
            }
        }
    }
}

/// The reduced problem that Levenberg-Marquardt sees.
struct Reduced<'a> {
    data: &'a Prepared,
    structure: &'a Structure,
    free: &'a [Free],
    line: DVector<f64>,
    now: Option<Evaluation>,
}

impl<'a> Reduced<'a> {
    fn new(data: &'a Prepared, structure: &'a Structure, free: &'a [Free], start: &[f64]) -> Self {
        let line = DVector::from_iterator(
            free.len(),
            free.iter().zip(start).map(|(f, &v)| match f.range {
                Range::Free => v,
                range => range.encode(v).clamp(-START, START),
            }),
        );
        let mut problem = Self {
            data,
            structure,
            free,
            line: line.clone(),
            now: None,
        };
        problem.set_params(&line);
        problem
    }

    fn values(&self) -> Vec<f64> {
        self.free
            .iter()
            .zip(self.line.iter())
            .map(|(f, &u)| f.range.decode(u))
            .collect()
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Reduced<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, line: &DVector<f64>) {
        // Beyond this the logistic map is flat in f64 anyway.
        self.line = line.map(|u| if u.is_finite() { u } else { 0.0 });
        for (u, free) in self.line.iter_mut().zip(self.free) {
            if free.range != Range::Free {
                *u = u.clamp(-12.0, 12.0);
            }
        }
        let values = self.values();
        self.now = evaluate(
            self.data,
            self.structure,
            self.free,
            &values,
            self.now.as_ref(),
        );
    }

    fn params(&self) -> DVector<f64> {
        self.line.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        self.now.as_ref().map(|e| e.residual.clone())
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let now = self.now.as_ref()?;
        let rows = &self.data.split.fit;
        let values = self.values();
        let moves = now
            .raw
            .moves(self.data, self.structure, self.free, &values)?;
        let mut jacobian = DMatrix::zeros(rows.len(), self.free.len());
        for (j, free) in self.free.iter().enumerate() {
            let mut tangent = self
                .data
                .filtered(&now.raw.tangent(&moves, j, &now.linear.gains));
            now.add_tied(&mut tangent, self.free, &values, free.role);
            let mut column = DVector::from_iterator(rows.len(), rows.iter().map(|&i| tangent[i]));
            let projected = now.linear.basis.tr_mul(&column);
            column.gemv(-1.0, &now.linear.basis, &projected, 1.0);
            column *= -free.range.slope(self.line[j]);
            jacobian.set_column(j, &column);
        }
        jacobian.iter().all(|v| v.is_finite()).then_some(jacobian)
    }
}

/// A search that gains less than this share of the squared error was the last.
const GAINED: f64 = 0.01;
/// At most so many searches after the first.
const AGAIN: usize = 6;
/// How far out on the line a bounded parameter may start: beyond this the map is so flat
/// that a search would take the parameter for one without influence.
const START: f64 = 5.0;

/// Searches from one start with about `most` evaluations; the sum of squares and the
/// values reached.
pub(super) fn descend(
    data: &Prepared,
    structure: &Structure,
    free: &[Free],
    start: &[f64],
    most: usize,
    tolerance: f64,
) -> Option<(f64, Vec<f64>)> {
    let problem = Reduced::new(data, structure, free, start);
    let sse = problem.now.as_ref()?.residual.norm_squared();
    if free.is_empty() {
        return Some((sse, Vec::new()));
    }
    let patience = most.div_ceil(free.len() + 1);
    let solver = LevenbergMarquardt::new()
        .with_ftol(tolerance)
        .with_xtol(tolerance)
        .with_gtol(0.0)
        .with_patience(patience)
        .with_stepbound(10.0);
    let (problem, _) = solver.minimize(problem);
    let sse = problem.now.as_ref()?.residual.norm_squared();
    Some((sse, problem.values()))
}

/// Searches again from where the last search stopped until that gains nothing more: a
/// search may stop because its trust region has shrunk, and not at an optimum.
pub(super) fn descend_fully(
    data: &Prepared,
    structure: &Structure,
    free: &[Free],
    start: &[f64],
) -> Option<Vec<f64>> {
    let (mut sse, mut values) = descend(data, structure, free, start, 30, 1e-7)?;
    for _ in 0..AGAIN {
        let (less, better) = descend(data, structure, free, &values, 30, 1e-7)?;
        let gained = 1.0 - less / sse;
        if less < sse {
            (sse, values) = (less, better);
        }
        if gained.is_nan() || gained < GAINED {
            break;
        }
    }
    Some(values)
}
