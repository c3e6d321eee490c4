//! A fitted model on a record, and its errors.

use crate::model::columns::{effect_column, series_column, stage_column};
use crate::model::structure::{FitTerm, Free, Role, Structure};
use crate::problem::{Prepared, Stretch};

/// Root mean square errors of the three segments, in the output's unit.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Segments {
    /// First 60 %.
    pub fit: f64,
    /// Next 15 %.
    pub selection: f64,
    /// Last 25 %.
    pub held_out: f64,
}

impl Segments {
    /// Rms of `residual` on each segment.
    #[must_use]
    pub fn of(data: &Prepared, residual: &[f64]) -> Self {
        let rms = |rows: &[usize]| {
            (rows.iter().map(|&i| residual[i] * residual[i]).sum::<f64>()
                / rows.len().max(1) as f64)
                .sqrt()
        };
        Self {
            fit: rms(&data.split.fit),
            selection: rms(&data.split.selection),
            held_out: rms(&data.split.held_out),
        }
    }

    /// Standard deviation of a signal on each segment.
    #[must_use]
    pub fn deviation(data: &Prepared, signal: &[f64]) -> Self {
        let deviation = |rows: &[usize]| {
            let n = rows.len().max(1) as f64;
            let mean = rows.iter().map(|&i| signal[i]).sum::<f64>() / n;
            (rows
                .iter()
                .map(|&i| (signal[i] - mean).powi(2))
                .sum::<f64>()
                / n)
                .sqrt()
        };
        Self {
            fit: deviation(&data.split.fit),
            selection: deviation(&data.split.selection),
            held_out: deviation(&data.split.held_out),
        }
    }

    /// The errors as shares of the standard deviation of `signal` on each segment.
    #[must_use]
    pub fn normalised(&self, data: &Prepared, signal: &[f64]) -> Self {
        let by = Self::deviation(data, signal);
        Self {
            fit: self.fit / by.fit,
            selection: self.selection / by.selection,
            held_out: self.held_out / by.held_out,
        }
    }
}

/// A fitted model on a record.
#[derive(Debug, Clone)]
pub struct Solution {
    /// The structure with its fitted shapes.
    pub structure: Structure,
    /// The non-linear parameters.
    pub free: Vec<Free>,
    /// Their values, in the order of `free`.
    pub values: Vec<f64>,
    /// Linear gains: input, eta, constant (with hysteresis), then the terms that are
    /// not output stages.
    pub gains: Vec<f64>,
    /// Linear columns through the filter, on the estimation grid.
    pub columns: Vec<Stretch>,
    /// d prediction / d value for each of `free`, through the filter.
    pub tangents: Vec<Stretch>,
    /// The prediction through the filter, on the estimation grid.
    pub prediction: Vec<f64>,
    /// The prediction before the filter, on the work grid.
    pub unfiltered: Vec<f64>,
    /// Hysteresis state on the work grid (zeros without hysteresis).
    pub eta: Vec<f64>,
    /// Target minus prediction.
    pub residual: Vec<f64>,
    /// Root mean square errors.
    pub rmse: Segments,
    /// Which of `free` lie on a bound.
    pub on_bound: Vec<bool>,
}

impl Solution {
    /// Sum of squares over the fit segment.
    #[must_use]
    pub fn sse(&self, data: &Prepared) -> f64 {
        self.rmse.fit * self.rmse.fit * data.split.fit.len() as f64
    }

    /// The value of a role, if it is free.
    #[must_use]
    pub fn value(&self, role: Role) -> Option<f64> {
        self.free
            .iter()
            .position(|f| f.role == role)
            .map(|i| self.values[i])
    }

    /// Gain of term `term`, linear or not.
    #[must_use]
    pub fn gain(&self, term: usize) -> f64 {
        let effect = &self.structure.terms[term].effect;
        if effect.is_output_stage() {
            let id = self.structure.terms.ids().get(term);
            return id
                .and_then(|&term| self.value(Role::Stage { term }))
                .unwrap_or(0.0);
        }
        if effect.is_input_stage() {
            return 1.0;
        }
        let base = self.structure.base();
        let before = self.structure.terms[..term]
            .iter()
            .filter(|t| t.is_linear())
            .count();
        self.gains[base + before]
    }

    /// The gains of the model's curve.
    pub(crate) fn curve_gains(&self) -> &[f64] {
        &self.gains[self.gains.len() - self.structure.table_gains()..]
    }

    /// The contribution of a term that is not in the model, for a gain of one, on the work grid;
    /// `None` if its channel is missing.
    #[must_use]
    pub fn adds(&self, data: &Prepared, term: &FitTerm) -> Option<Vec<f64>> {
        if term.effect.is_output_stage() {
            return Some(stage_column(data, &term.effect, &self.unfiltered));
        }
        if term.effect.is_input_stage() {
            let at = (self.free.as_slice(), self.values.as_slice());
            return series_column(data, &self.structure, at, &self.gains, term);
        }
        effect_column(data, term, &self.eta)
    }

    /// Whether the gain of a stage or a shape of this term is on a bound of its range. A lag with a
    /// gain of 1 is not: that is a whole low-pass.
    pub(crate) fn is_on_bound(&self, index: usize) -> bool {
        let terms = &self.structure.terms;
        let id = terms.ids().get(index).copied();
        let is_whole = |value: f64| terms[index].effect.name() == "lag" && value > 0.5;
        let roles = self.free.iter().zip(&self.values).zip(&self.on_bound);
        roles
            .filter(|((free, value), _)| match free.role {
                Role::Stage { term } => Some(term) == id && !is_whole(**value),
                Role::Shape { term, .. } => Some(term) == id,
                _ => false,
            })
            .any(|(_, on_bound)| *on_bound)
    }

    /// Number of shapes of the model that stopped on a bound.
    pub(crate) fn shapes_on_bound(&self) -> usize {
        self.free
            .iter()
            .zip(&self.on_bound)
            .filter(|(f, on)| **on && !matches!(f.role, Role::Eta0 { .. } | Role::Start { .. }))
            .count()
    }
}
