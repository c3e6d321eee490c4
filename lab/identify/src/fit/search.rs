//! The search of the shapes from one start: Levenberg-Marquardt on the reduced problem.

use super::compressed;
use super::linear::{solve_linear, Linear};
use super::tie::{slope, ties};
use crate::model::columns::{raw_columns_knowing, Beforehand, RawColumns};
use crate::model::structure::{Free, Range, Role, Structure};
use crate::problem::cost::{EVALUATIONS, JACOBIANS, SEARCHES};
use crate::problem::{Prepared, Stretch};
use crate::scale::TRACE;
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};
use std::cell::Cell;
use std::sync::Arc;

/// Prediction and derivatives at one set of shapes.
pub(super) struct Evaluation {
    pub(super) raw: RawColumns,
    pub(super) columns: Vec<Arc<Stretch>>,
    pub(super) linear: Linear,
    residual: Stretch,
}

pub(super) fn evaluate(
    data: &Prepared,
    structure: &Structure,
    free: &[Free],
    values: &[f64],
    last: Option<&Evaluation>,
) -> Option<Evaluation> {
    EVALUATIONS.add(1);
    let known = Beforehand {
        last: last.map(|l| &l.raw),
        slopes: true,
        ..Beforehand::default()
    };
    let raw = raw_columns_knowing(data, structure, free, values, known)?;
    let columns = filtered(data, &raw, last);
    let linear = solve_linear(
        &data.split.fit,
        &columns,
        &data.target,
        &structure.signs(data),
        &ties(structure, free, values),
    );
    let rows = &data.split.fit;
    let mut residual = vec![0.0; rows.len()];
    for (column, gain) in columns.iter().zip(&linear.gains) {
        column.add_at_rows(&mut residual, rows, *gain);
    }
    for (sum, &i) in residual.iter_mut().zip(rows) {
        *sum = data.target[i] - *sum;
    }
    let residual = Stretch::from(residual);
    residual.is_finite().then_some(Evaluation {
        raw,
        columns,
        linear,
        residual,
    })
}

/// The filtered columns; those that do not depend on the shapes are reused.
fn filtered(data: &Prepared, raw: &RawColumns, last: Option<&Evaluation>) -> Vec<Arc<Stretch>> {
    let kept = |k: usize| last.filter(|_| raw.fixed[k]).map(|l| &l.columns[k]);
    let moved = (0..raw.columns.len()).filter(|&k| kept(k).is_none());
    let moved: Vec<&Stretch> = moved.map(|k| &*raw.columns[k]).collect();
    let mut anew = data.filtered_stretches(&moved).into_iter();
    (0..raw.columns.len())
        .filter_map(|k| kept(k).cloned().or_else(|| anew.next().map(Arc::new)))
        .collect()
}

impl Evaluation {
    /// d prediction / d value for each free parameter, through the filter.
    pub(super) fn tangents(
        &self,
        data: &Prepared,
        structure: &Structure,
        free: &[Free],
        values: &[f64],
    ) -> Option<Vec<Stretch>> {
        JACOBIANS.add(1);
        let (raw, gains) = (&self.raw, &self.linear.gains);
        let moves = raw.moves(data, structure, free, values)?;
        let slopes = raw.tangents(&moves, gains);
        let slopes: Vec<&Stretch> = slopes.iter().collect();
        let mut tangents = data.filtered_stretches(&slopes);
        for (tangent, one) in tangents.iter_mut().zip(free) {
            self.add_tied(tangent, free, values, one.role);
        }
        Some(tangents)
    }

    /// Adds to a tangent the change of a gain that is tied to kappa_eta.
    fn add_tied(&self, tangent: &mut Stretch, free: &[Free], values: &[f64], role: Role) {
        if !matches!(role, Role::Rho | Role::Sigma) {
            return;
        }
        for tie in &self.linear.tied {
            let slope = -self.linear.gains[tie.hysteresis] * slope(free, values, role);
            tangent.add(&self.columns[tie.gain], slope);
        }
    }

    /// The Jacobian of the residual in the unbounded parameters, in the solver's basis.
    fn jacobian(&self, data: &Prepared, tangents: &[Stretch], slopes: &[f64]) -> DMatrix<f64> {
        let tangents = tangents.iter().map(|t| t.at_rows(&data.split.fit));
        let basis = &self.linear.basis;
        match data.pieces.len() {
            1 => compressed::jacobian(basis, &self.residual, tangents, slopes),
            _ => compressed::jacobian_of_files(basis, &self.residual, tangents, slopes),
        }
    }
}

/// The reduced problem for Levenberg-Marquardt.
struct Reduced<'a> {
    data: &'a Prepared,
    structure: &'a Structure,
    free: &'a [Free],
    line: DVector<f64>,
    now: Option<Evaluation>,
    /// Whether this point was accepted by the search, not only tried.
    stands: Cell<bool>,
    /// The previous accepted point, to which the search returns if the trial is worse.
    back: Option<(DVector<f64>, Evaluation)>,
}

impl<'a> Reduced<'a> {
    fn new(data: &'a Prepared, structure: &'a Structure, free: &'a [Free], start: &[f64]) -> Self {
        let line = DVector::from_iterator(
            free.len(),
            free.iter().zip(start).map(|(f, &v)| f.range.on_line(v)),
        );
        let mut problem = Self {
            data,
            structure,
            free,
            line: line.clone(),
            now: None,
            stands: Cell::new(false),
            back: None,
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
        let mut line = line.map(|u| if u.is_finite() { u } else { 0.0 });
        for (u, free) in line.iter_mut().zip(self.free) {
            if free.range != Range::Free {
                *u = u.clamp(-12.0, 12.0);
            }
        }
        let left = std::mem::replace(&mut self.line, line);
        let tried = self.now.take();
        if self.stands.replace(false) {
            self.back = tried.map(|evaluation| (left, evaluation));
        }
        if let Some((_, known)) = self.back.take_if(|(place, _)| *place == self.line) {
            self.now = Some(known);
            return;
        }
        let last = self.back.as_ref().map(|(_, evaluation)| evaluation);
        let values = self.values();
        self.now = evaluate(self.data, self.structure, self.free, &values, last);
    }

    fn params(&self) -> DVector<f64> {
        self.line.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let now = self.now.as_ref()?;
        Some(compressed::residual(now.residual.norm(), self.free.len()))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let now = self.now.as_ref()?;
        self.stands.set(true);
        let tangents = now.tangents(self.data, self.structure, self.free, &self.values())?;
        if !tangents.iter().all(Stretch::is_finite) {
            return None;
        }
        let slopes = self.free.iter().zip(self.line.iter());
        let slopes: Vec<f64> = slopes.map(|(f, &u)| -f.range.slope(u)).collect();
        let jacobian = now.jacobian(self.data, &tangents, &slopes);
        let is_finite = jacobian.as_slice().iter().all(|v| v.is_finite());
        is_finite.then_some(jacobian)
    }
}

/// Maximum number of repetitions of a search.
const AGAIN: usize = 6;

/// Searches from one start with about `most` evaluations; returns the sum of squares and the
/// values reached.
pub(crate) fn descend(
    data: &Prepared,
    structure: &Structure,
    free: &[Free],
    start: &[f64],
    most: usize,
    tolerance: f64,
) -> Option<(f64, Vec<f64>)> {
    SEARCHES.add(1);
    let problem = Reduced::new(data, structure, free, start);
    let sse = problem.now.as_ref()?.residual.norm().powi(2);
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
    let sse = problem.now.as_ref()?.residual.norm().powi(2);
    Some((sse, problem.values()))
}

/// Repeats the search from its last point until nothing more is gained: a search may also stop
/// because its trust region has shrunk.
pub(crate) fn descend_fully(
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
        if gained.is_nan() || gained < TRACE {
            break;
        }
    }
    Some(values)
}
