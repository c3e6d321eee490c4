//! The gates that an effect passes before it is added.

use crate::fit::Solution;
use crate::ledger::Gate;
use crate::problem::Prepared;
use crate::score::scan::{blocks, Regime, BLOCKS};
use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Of the share that an effect removes on the fit segment, so much it has to remove on
/// the stop-check.
const CARRIED_OVER: f64 = 0.25;

/// A share that searching a null has not been seen to reach.
const LARGE: f64 = 0.3;

/// The same without a test: there a longer memory makes larger shares by chance.
const LARGE_UNTESTED: f64 = 0.6;

/// What the scan knows about the record's independent stretches.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Evidence {
    pub(crate) regime: Regime,
    /// Correlation time of what the forward set leaves \[s\].
    pub(crate) correlation_time: f64,
    /// Level that is left for each test.
    pub(crate) level: f64,
}

impl Evidence {
    /// Share of the squared error that an effect has to remove which moves `freedoms` parameters.
    ///
    /// Without a test: what chance gives at the same level to a residual of that
    /// correlation, with one independent value every two correlation times.
    pub(crate) fn least_share(&self, data: &Prepared, freedoms: usize) -> f64 {
        match self.regime {
            Regime::Blocks => 0.05,
            Regime::Effect => {
                let step = data.dt * data.stride as f64;
                let seconds = data.split.fit.len() as f64 * step;
                let values = seconds / (2.0 * self.correlation_time.max(step));
                let chance = ChiSquared::new(freedoms.max(1) as f64)
                    .map_or(f64::INFINITY, |c| c.inverse_cdf(1.0 - self.level));
                (chance / values).clamp(0.10, MOST_ASKED)
            }
        }
    }
}

/// More than this is never asked for: what removes half of the error is worth proposing.
const MOST_ASKED: f64 = 0.5;

/// The gates of a round; the number of blocks on which the new model is better.
pub(crate) fn judge(
    data: &Prepared,
    old: &Solution,
    new: &Solution,
    evidence: &Evidence,
) -> Result<usize, Gate> {
    let regime = evidence.regime;
    let parameters = |s: &Solution| s.free.len() + s.gains.len();
    let freedoms = parameters(new).saturating_sub(parameters(old));
    if new.sse(data) > (1.0 - evidence.least_share(data, freedoms)) * old.sse(data) {
        return Err(Gate::Share);
    }
    let (better, enough) = on_blocks(data, old, new, regime);
    if !enough {
        return Err(Gate::Blocks);
    }
    // The stop-check is the only part that no search has seen: what is real shows there
    // too. A mere "not worse" lets one coloured null in fifty through. Where much is
    // missing at once, one effect removed may uncover another just there; what no null
    // reaches need only not be worse.
    let explained = 1.0 - new.sse(data) / old.sse(data);
    let there = 1.0 - (new.rmse.stop / old.rmse.stop).powi(2);
    let (large, worse) = match regime {
        Regime::Blocks => (LARGE, 1.02),
        Regime::Effect => (LARGE_UNTESTED, 1.10),
    };
    let holds = there >= CARRIED_OVER * explained
        || (explained >= large && new.rmse.stop <= worse * old.rmse.stop);
    if !holds {
        return Err(Gate::StopCheck);
    }
    Ok(better)
}

/// On how many blocks left out the new model is better, and whether that is enough.
pub(crate) fn on_blocks(
    data: &Prepared,
    old: &Solution,
    new: &Solution,
    regime: Regime,
) -> (usize, bool) {
    let (before, after) = (left_out(data, old), left_out(data, new));
    let ratios: Vec<f64> = before
        .iter()
        .zip(&after)
        .map(|(b, a)| (b / a).ln())
        .collect();
    let better = ratios.iter().filter(|r| **r > 0.0).count();
    let enough = match regime {
        Regime::Blocks => {
            let n = ratios.len() as f64;
            let mean = ratios.iter().sum::<f64>() / n;
            let variance = ratios.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / (n - 1.0);
            mean > (variance / n).sqrt() && better >= 10
        }
        Regime::Effect => better >= 9,
    };
    (better, enough)
}

/// Loss on each block with the gains fitted on the others, shapes frozen.
fn left_out(data: &Prepared, solution: &Solution) -> Vec<f64> {
    let rows = &data.split.fit;
    let blocks = blocks(data);
    let m = solution.columns.len();
    let scale: Vec<f64> = solution
        .columns
        .iter()
        .map(|c| {
            rows.iter()
                .map(|&i| c[i] * c[i])
                .sum::<f64>()
                .sqrt()
                .max(1e-300)
        })
        .collect();
    let parts: Vec<(DMatrix<f64>, DVector<f64>)> = blocks
        .iter()
        .map(|block| {
            let rows = &rows[block.clone()];
            let x = DMatrix::from_fn(rows.len(), m, |k, j| {
                solution.columns[j][rows[k]] / scale[j]
            });
            let y = DVector::from_iterator(rows.len(), rows.iter().map(|&i| solution.residual[i]));
            (x.tr_mul(&x), x.tr_mul(&y))
        })
        .collect();
    // Gains move from their fitted values by what the residual asks for.
    let mut losses = Vec::with_capacity(BLOCKS);
    for (out, block) in blocks.iter().enumerate() {
        let mut gram = DMatrix::zeros(m, m);
        let mut score = DVector::zeros(m);
        for (_, (g, s)) in parts.iter().enumerate().filter(|(b, _)| *b != out) {
            gram += g;
            score += s;
        }
        let change = nalgebra::SVD::new(gram, true, true)
            .solve(&score, 1e-10)
            .unwrap_or_else(|_| DVector::zeros(m));
        let loss: f64 = rows[block.clone()]
            .iter()
            .map(|&i| {
                let moved: f64 = (0..m)
                    .map(|j| change[j] * solution.columns[j][i] / scale[j])
                    .sum();
                (solution.residual[i] - moved).powi(2)
            })
            .sum();
        losses.push(loss.max(1e-300));
    }
    losses
}
