//! The starting amplitude, from linear theory.
//!
//! The column and each trial's residual, projected off all that the model can move, give the
//! sixteen block scores a·c'c + c'r of the scan. So the sign-flip test and the share of the squared
//! error are known for every amplitude `a` without a fit. Other candidates, refits and gates are
//! not considered here, only in the complete trials.

use super::planted::Trials;
use super::{needed, STEPS};
use crate::fit::projection::{rows, Span};
use crate::fit::Solution;
use crate::problem::Prepared;
use crate::scale::TWENTIETH;
use crate::score::blocks::{blocks, sign_flip_p, Regime, BLOCKS};
use crate::search::policy::EXCITED;
use crate::search::tests;
use nalgebra::DVector;

/// The smallest amplitude, as a share of the largest.
const SMALLEST: f64 = 1e-8;

pub(super) struct Screen {
    span: Span,
    residuals: Vec<DVector<f64>>,
    blocks: Vec<std::ops::Range<usize>>,
    level: f64,
    regime: Regime,
    largest: f64,
}

pub(super) enum Outcome {
    NotExcited,
    Never,
    From(f64),
}

impl Screen {
    pub(super) fn new(data: &Prepared, solution: &Solution, trials: &Trials) -> Self {
        let (regime, level) = tests(data, solution);
        let span = Span::of(data, solution.columns.iter().chain(&solution.tangents));
        let residuals = (0..trials.count())
            .map(|k| span.off(rows(data, &data.filtered(&trials.residual(k)))))
            .collect();
        Self {
            span,
            residuals,
            blocks: blocks(data),
            level,
            regime,
            largest: trials.size(),
        }
    }

    /// The largest amplitude that is tried: the output's own.
    pub(super) fn largest(&self) -> f64 {
        self.largest
    }

    /// The smallest amplitude of a contribution that nine trials of ten would show.
    pub(super) fn amplitude(&self, data: &Prepared, unit: &[f64]) -> Outcome {
        let column = rows(data, &data.filtered(unit));
        let mean = column.mean();
        let varying = column.map(|v| v - mean).norm_squared();
        let column = self.span.off(column);
        let norm = column.norm_squared();
        let excited = norm.is_finite() && norm > EXCITED * varying && norm > 0.0;
        if !excited {
            return Outcome::NotExcited;
        }
        let shown = |a: f64| {
            let hits = self.residuals.iter().filter(|r| self.passes(&column, r, a));
            hits.count() >= needed(self.residuals.len())
        };
        if !shown(self.largest) {
            return Outcome::Never;
        }
        let (mut low, mut high) = ((SMALLEST * self.largest).ln(), self.largest.ln());
        for _ in 0..STEPS {
            let middle = 0.5 * (low + high);
            if shown(middle.exp()) {
                high = middle;
            } else {
                low = middle;
            }
        }
        Outcome::From(high.exp())
    }

    fn passes(&self, column: &DVector<f64>, residual: &DVector<f64>, a: f64) -> bool {
        let norm = column.norm_squared();
        let score = a * norm + column.dot(residual);
        let sse = residual.norm_squared() + 2.0 * a * column.dot(residual) + a * a * norm;
        let share = score * score / norm / sse;
        // No gate lets a smaller share pass; without p-values it has to be twice that.
        if self.regime == Regime::Effect {
            return share >= 2.0 * TWENTIETH;
        }
        let mut scores = [0.0; BLOCKS];
        for (slot, block) in scores.iter_mut().zip(&self.blocks) {
            let part = block
                .clone()
                .map(|k| column[k] * (residual[k] + a * column[k]));
            *slot = part.sum();
        }
        share >= TWENTIETH && sign_flip_p(&scores) <= self.level
    }
}
