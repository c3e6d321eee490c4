//! Assembles solutions from the values that searches reached, and chooses among them.

use super::search::{evaluate, Evaluation};
use super::{Segments, Solution};
use crate::model::columns::weighted;
use crate::model::structure::{Free, Structure};
use crate::problem::{Prepared, Stretch};
use std::sync::Arc;

/// Assembles the solution at the given values.
pub(crate) fn settle(
    data: &Prepared,
    structure: &Structure,
    free: &[Free],
    values: Vec<f64>,
) -> Option<Solution> {
    let evaluation = evaluate(data, structure, free, &values, None)?;
    let tangents = evaluation.tangents(data, structure, free, &values)?;
    let Evaluation {
        raw,
        columns,
        linear,
        ..
    } = evaluation;
    let gains = linear.gains;
    let columns: Vec<Stretch> = columns.into_iter().map(Arc::unwrap_or_clone).collect();
    let prediction = weighted(&columns, &gains, data.target.len());
    let unfiltered = raw.output(&gains);
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
    let fitted = Structure {
        terms: structure.terms.at(free, &values)?,
        ..structure.clone()
    };
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

/// The best on the stop-check among the optima within 5 %. Optima with two shapes on bounds are
/// refused unless there is no other.
pub(super) fn choose(mut settled: Vec<Solution>) -> Option<Solution> {
    if settled.iter().any(|s| s.shapes_on_bound() < 2) {
        settled.retain(|s| s.shapes_on_bound() < 2);
    }
    let best = settled.first()?.rmse.fit;
    settled
        .into_iter()
        .filter(|s| s.rmse.fit <= 1.05 * best)
        .min_by(|a, b| a.rmse.stop.total_cmp(&b.rmse.stop))
}
