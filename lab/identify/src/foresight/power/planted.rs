//! The user's record with an added effect.

use crate::fit::Solution;
use crate::model::structure::{sign, FitTerm};
use crate::problem::Prepared;

/// The model's prediction and its residual, on the work grid.
pub(super) struct Trials {
    prediction: Vec<f64>,
    residual: Vec<f64>,
    count: usize,
}

impl Trials {
    pub(super) fn new(data: &Prepared, solution: &Solution, count: usize) -> Self {
        let pairs = data.output().iter().zip(&solution.unfiltered);
        Self {
            residual: pairs.map(|(y, p)| y - p).collect(),
            prediction: solution.unfiltered.clone(),
            count,
        }
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The residual of a trial: shifted round by an equal part of the record more each
    /// time, never by nothing, and every other time with its sign changed.
    pub(super) fn residual(&self, trial: usize) -> Vec<f64> {
        let n = self.residual.len();
        let shift = n * (2 * trial + 1) / (2 * self.count);
        let sign = if trial.is_multiple_of(2) { 1.0 } else { -1.0 };
        (0..n)
            .map(|i| sign * self.residual[(i + shift) % n])
            .collect()
    }

    /// The output of a trial; `unit` is a contribution of rms one, or empty.
    pub(super) fn output(&self, trial: usize, unit: &[f64], amplitude: f64) -> Vec<f64> {
        let mut output = self.residual(trial);
        for (y, p) in output.iter_mut().zip(&self.prediction) {
            *y += p;
        }
        for (y, c) in output.iter_mut().zip(unit) {
            *y += amplitude * c;
        }
        output
    }

    /// Rms of the prediction about its mean.
    pub(super) fn size(&self) -> f64 {
        spread(&self.prediction)
    }
}

/// What an effect adds to the output.
pub(super) struct Contribution {
    /// For a gain that makes its rms one, of the sign that the term keeps where it keeps one.
    pub(super) unit: Vec<f64>,
    /// Rms for a gain of one.
    pub(super) rms: f64,
}

/// The contribution of a term along the record; `None` if it is zero.
pub(super) fn contribution(
    data: &Prepared,
    solution: &Solution,
    term: &FitTerm,
) -> Option<Contribution> {
    let raw = solution.adds(data, term)?;
    let rms = spread(&raw);
    let size = if sign(data, term) < 0.0 { -rms } else { rms };
    let unit: Vec<f64> = raw.iter().map(|c| c / size).collect();
    unit.iter()
        .all(|c| c.is_finite())
        .then_some(Contribution { unit, rms })
}

/// Rms about the mean.
fn spread(values: &[f64]) -> f64 {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt()
}
