//! Variable projection: gains by QR, shapes by Levenberg-Marquardt.
//!
//! The output is linear in the gains once the shapes are known, so the gains are
//! eliminated (Golub and Pereyra, 1973; Kaufman's derivative, 1975) and the search
//! runs over rho, sigma, n, eta(0) and the effects' own shapes only. The hysteresis
//! column comes with its exact sensitivities in the same pass.

use crate::channels::Prepared;
use crate::columns::{raw_columns, RawColumns};
pub use crate::solution::{Segments, Solution};
use crate::structure::{Free, Range, Role, Structure};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};
use std::sync::Arc;

/// Gains, and the basis that they leave.
struct Linear {
    gains: Vec<f64>,
    basis: DMatrix<f64>,
}

/// Least squares on the fit segment with some gains kept from going negative.
fn solve_linear(
    rows: &[usize],
    columns: &[Arc<Vec<f64>>],
    target: &[f64],
    kept: &[bool],
) -> Linear {
    let mut active: Vec<usize> = (0..columns.len()).collect();
    let y = DVector::from_iterator(rows.len(), rows.iter().map(|&i| target[i]));
    loop {
        let (basis, gains, used) = orthonormal(rows, columns, &active, &y);
        let worst = used
            .iter()
            .zip(&gains)
            .filter(|(&k, g)| kept[k] && **g < 0.0)
            .map(|(&k, _)| k)
            .next();
        match worst {
            Some(k) => active.retain(|&a| a != k),
            None => {
                let mut all = vec![0.0; columns.len()];
                for (&k, &g) in used.iter().zip(&gains) {
                    all[k] = g;
                }
                return Linear { gains: all, basis };
            }
        }
    }
}

/// Orthonormal basis of the chosen columns (twice-repeated Gram-Schmidt, which is as
/// good as Householder) and the least-squares gains; dependent columns are left out.
fn orthonormal(
    rows: &[usize],
    columns: &[Arc<Vec<f64>>],
    chosen: &[usize],
    y: &DVector<f64>,
) -> (DMatrix<f64>, Vec<f64>, Vec<usize>) {
    let n = rows.len();
    let mut basis: Vec<DVector<f64>> = Vec::with_capacity(chosen.len());
    let mut used = Vec::with_capacity(chosen.len());
    let mut upper: Vec<Vec<f64>> = Vec::with_capacity(chosen.len());
    for &k in chosen {
        let mut v = DVector::from_iterator(n, rows.iter().map(|&i| columns[k][i]));
        let norm = v.norm();
        if !(norm.is_finite() && norm > 0.0) {
            continue;
        }
        let mut coefficients = vec![0.0; basis.len()];
        for _ in 0..2 {
            for (c, q) in coefficients.iter_mut().zip(&basis) {
                let dot = q.dot(&v);
                v.axpy(-dot, q, 1.0);
                *c += dot;
            }
        }
        let left = v.norm();
        // Below this a column is a sum of the others within rounding.
        if left < 1e-9 * norm {
            continue;
        }
        v /= left;
        coefficients.push(left);
        upper.push(coefficients);
        basis.push(v);
        used.push(k);
    }
    let m = basis.len();
    let mut gains: Vec<f64> = basis.iter().map(|q| q.dot(y)).collect();
    for i in (0..m).rev() {
        gains[i] /= upper[i][i];
        let g = gains[i];
        for (j, slot) in gains.iter_mut().enumerate().take(i) {
            *slot -= upper[i][j] * g;
        }
    }
    let basis = if m == 0 {
        DMatrix::zeros(n, 0)
    } else {
        DMatrix::from_columns(&basis)
    };
    (basis, gains, used)
}

/// Everything about one set of shapes.
struct Evaluation {
    raw: RawColumns,
    columns: Vec<Arc<Vec<f64>>>,
    linear: Linear,
    residual: DVector<f64>,
}

fn evaluate(
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
            free.iter().zip(start).map(|(f, &v)| f.range.encode(v)),
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
        let moves = now.raw.moves(self.data, self.free, &self.values())?;
        let mut jacobian = DMatrix::zeros(rows.len(), self.free.len());
        for (j, free) in self.free.iter().enumerate() {
            let tangent = self
                .data
                .filtered(&now.raw.tangent(&moves, j, &now.linear.gains));
            let mut column = DVector::from_iterator(rows.len(), rows.iter().map(|&i| tangent[i]));
            let projected = now.linear.basis.tr_mul(&column);
            column.gemv(-1.0, &now.linear.basis, &projected, 1.0);
            column *= -free.range.slope(self.line[j]);
            jacobian.set_column(j, &column);
        }
        jacobian.iter().all(|v| v.is_finite()).then_some(jacobian)
    }
}

/// Searches from one start with about `most` evaluations; the sum of squares and the
/// values reached.
fn descend(
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

/// Assembles the solution at given values.
fn settle(
    data: &Prepared,
    structure: &Structure,
    free: &[Free],
    values: Vec<f64>,
) -> Option<Solution> {
    let Evaluation {
        raw,
        columns,
        linear,
        ..
    } = evaluate(data, structure, free, &values, None)?;
    let gains = linear.gains;
    let moves = raw.moves(data, free, &values)?;
    let tangents: Vec<Vec<f64>> = (0..free.len())
        .map(|j| data.filtered(&raw.tangent(&moves, j, &gains)))
        .collect();
    let columns: Vec<Vec<f64>> = columns.iter().map(|c| c.to_vec()).collect();
    let sum = |columns: &[Vec<f64>]| -> Vec<f64> {
        let n = columns.first().map_or(0, Vec::len);
        (0..n)
            .map(|i| columns.iter().zip(&gains).map(|(c, g)| g * c[i]).sum())
            .collect()
    };
    let (prediction, unfiltered) = if columns.is_empty() {
        (vec![0.0; data.target.len()], vec![0.0; data.work_len()])
    } else {
        (sum(&columns), sum(&raw.columns))
    };
    let residual: Vec<f64> = data
        .target
        .iter()
        .zip(&prediction)
        .map(|(y, p)| y - p)
        .collect();
    let rmse = Segments::of(data, &residual);
    let on_bound = free
        .iter()
        .zip(&values)
        .map(|(f, &v)| f.range.at_bound(f.range.encode(v)))
        .collect();
    let mut fitted = structure.clone();
    for (f, &v) in free.iter().zip(&values) {
        match f.role {
            Role::Shape { term, index } => {
                fitted.terms[term].effect = fitted.terms[term].effect.with_shape(index, v).ok()?
            }
            Role::Origin { term } => fitted.terms[term].origin = v,
            Role::Start { term } => fitted.terms[term].start = v,
            _ => {}
        }
    }
    Some(Solution {
        structure: fitted,
        free: free.to_vec(),
        values,
        gains,
        columns,
        tangents,
        prediction,
        unfiltered,
        eta: raw.eta,
        residual,
        rmse,
        on_bound,
    })
}

/// Eight deterministic starts, and the present optimum where there is one.
fn starts(
    data: &Prepared,
    structure: &Structure,
    free: &[Free],
    from: Option<&Solution>,
    stage_gain: f64,
) -> Vec<Vec<f64>> {
    let x = data.input.reach;
    // rho·X from nearly linear to nearly a relay, each with a soft and a sharp knee.
    const GRID: [(f64, f64, f64); 8] = [
        (1.0, 0.8, 1.2),
        (3.0, 0.6, 2.0),
        (3.0, 3.0, 1.3),
        (8.0, 0.7, 1.2),
        (8.0, 2.0, 2.5),
        (25.0, 0.8, 1.5),
        (60.0, 1.5, 1.2),
        (1.5, 30.0, 3.0),
    ];
    let present = |role: Role| from.and_then(|s| s.value(role));
    let at = |hysteresis: Option<(f64, f64, f64)>| -> Vec<f64> {
        free.iter()
            .map(|f| match (f.role, hysteresis) {
                (Role::Rho, Some((rho, ..))) => rho / x,
                (Role::Sigma, Some((_, sigma, _))) => sigma,
                (Role::N, Some((.., n))) => n,
                (Role::Eta0, Some(_)) => present(Role::Eta0).unwrap_or(0.0),
                (Role::Stage { term }, _) => {
                    let known = from
                        .filter(|s| term < s.structure.terms.len())
                        .and_then(|s| s.value(f.role));
                    known.unwrap_or(stage_gain)
                }
                (Role::Shape { term, index }, _) => {
                    structure.terms[term].effect.shape(index).unwrap_or(0.0)
                }
                (Role::Origin { term }, _) => structure.terms[term].origin,
                (Role::Start { term }, _) => structure.terms[term].start,
                (role, None) => present(role).unwrap_or(0.5),
            })
            .collect()
    };
    let mut all = Vec::new();
    if from.is_some() || !structure.hysteresis {
        all.push(at(None));
    }
    if structure.hysteresis {
        all.extend(GRID.iter().map(|&start| at(Some(start))));
    } else {
        // Without hysteresis only the effects' own shapes are searched: wider and narrower.
        for scale in [0.3, 3.0] {
            all.push(
                free.iter()
                    .zip(at(None))
                    .map(|(f, v)| match f.range {
                        Range::Log(lo, hi) => (v * scale).clamp(lo, hi),
                        _ => v,
                    })
                    .collect(),
            );
        }
    }
    all
}

/// Fits a structure: all starts for a while on a coarse grid, the best three to the end.
///
/// `from` is the optimum of the round before (its structure is a prefix of this one).
/// `stage_gain` starts the gain of an output stage that is new.
#[must_use]
pub fn fit(
    data: &Prepared,
    structure: &Structure,
    from: Option<&Solution>,
    stage_gain: f64,
) -> Option<Solution> {
    use rayon::prelude::*;
    let free = structure.free(data);
    let starts = starts(data, structure, &free, from, stage_gain);
    let (coarse, fine) = (data.for_search(true), data.for_search(false));
    let run = |data: &Prepared,
               from: &[Vec<f64>],
               most: usize,
               tolerance: f64,
               keep: usize|
     -> Vec<Vec<f64>> {
        let mut reached: Vec<(f64, Vec<f64>)> = from
            .par_iter()
            .map(|start| descend(data, structure, &free, start, most, tolerance))
            .collect::<Vec<_>>()
            .into_iter()
            .flatten()
            .collect();
        reached.sort_by(|a, b| a.0.total_cmp(&b.0));
        reached.truncate(keep);
        reached.into_iter().map(|(_, values)| values).collect()
    };
    let rough = run(&coarse, &starts, 12, 1e-3, 3);
    let better = run(&coarse, &rough, 70, 1e-6, 3);
    let best = run(&fine, &better, 30, 1e-7, 3);
    let settled: Vec<Option<Solution>> = best
        .into_par_iter()
        .map(|values| settle(data, structure, &free, values))
        .collect();
    let mut settled: Vec<Solution> = settled.into_iter().flatten().collect();
    settled.sort_by(|a, b| a.rmse.fit.total_cmp(&b.rmse.fit));
    choose(settled)
}

/// One short search from the present optimum, on the coarse grid: the sum of squares
/// there and the structure with its shapes refined.
#[must_use]
pub fn glance(
    data: &Prepared,
    structure: &Structure,
    from: &Solution,
    stage_gain: f64,
) -> Option<(f64, Structure, f64)> {
    let free = structure.free(data);
    let starts = starts(data, structure, &free, Some(from), stage_gain);
    // The present optimum may have bent the loop to stand in for what is missing.
    let rough = starts
        .iter()
        .enumerate()
        .filter(|(index, _)| [0, 2, 6].contains(index))
        .filter_map(|(_, start)| descend(data, structure, &free, start, 10, 1e-3));
    let (_, start) = rough.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let (sse, values) = descend(data, structure, &free, &start, 30, 1e-4)?;
    let mut refined = structure.clone();
    let mut gain = stage_gain;
    for (f, &v) in free.iter().zip(&values) {
        match f.role {
            Role::Shape { term, index } => {
                refined.terms[term].effect = refined.terms[term].effect.with_shape(index, v).ok()?
            }
            Role::Origin { term } => refined.terms[term].origin = v,
            Role::Start { term } => refined.terms[term].start = v,
            Role::Stage { term } if term + 1 == structure.terms.len() => gain = v,
            _ => {}
        }
    }
    Some((sse, refined, gain))
}

/// Among optima within 5 % the best on the stop-check; two shapes on bounds are refused
/// while anything else is left.
fn choose(mut settled: Vec<Solution>) -> Option<Solution> {
    if settled.iter().any(|s| s.shapes_on_bound() < 2) {
        settled.retain(|s| s.shapes_on_bound() < 2);
    }
    let best = settled.first()?.rmse.fit;
    settled
        .into_iter()
        .filter(|s| s.rmse.fit <= 1.05 * best)
        .min_by(|a, b| a.rmse.stop.total_cmp(&b.rmse.stop))
}
