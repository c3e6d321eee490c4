//! Assembles solutions from the results of the searches, and chooses among them.

use super::search::{evaluate, Evaluation};
use super::{Segments, Solution};
use crate::model::columns::weighted;
use crate::model::structure::{Free, Structure};
use crate::problem::{Prepared, Stretch};
use std::sync::Arc;

/// A gap between two records, which is not part of the fit segment \[s\].
struct Gap {
    /// From a period of the cut-off after the last sample that is fitted: what comes earlier
    /// reaches that through the filter.
    from: f64,
    to: f64,
    /// Where the later record begins.
    begins: f64,
}

impl Gap {
    fn all(data: &Prepared) -> impl Iterator<Item = Self> + '_ {
        let fit = &data.split.fit;
        data.pieces.iter().skip(1).filter_map(|piece| {
            let next = fit.partition_point(|&row| row < piece.rows.start);
            let (&last, &first) = (fit.get(next.checked_sub(1)?)?, fit.get(next)?);
            Some(Self {
                from: data.moment(last) + 1.0 / data.cutoff,
                to: data.moment(first),
                begins: piece.since,
            })
        })
    }

    /// A step in time within the gap may lie anywhere in it; it is put where the record begins.
    fn settled(&self, t: f64) -> f64 {
        match self.from < t && t < self.to {
            true => self.begins,
            false => t,
        }
    }
}

/// Assembles the solution at the given values; a step in time that lies where the fit sees nothing
/// between two records is put where the later one begins.
pub(crate) fn settle(
    data: &Prepared,
    structure: &Structure,
    free: &[Free],
    mut values: Vec<f64>,
) -> Option<Solution> {
    for (value, f) in values.iter_mut().zip(free) {
        if structure.terms.is_moment(f.role) {
            *value = Gap::all(data).fold(*value, |t, gap| gap.settled(t));
        }
    }
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

/// The best optimum on the selection segment among those within 5 %. Optima with two shapes on
/// bounds are rejected unless there is no other.
pub(super) fn choose(mut settled: Vec<Solution>) -> Option<Solution> {
    if settled.iter().any(|s| s.shapes_on_bound() < 2) {
        settled.retain(|s| s.shapes_on_bound() < 2);
    }
    let best = settled.first()?.rmse.fit;
    settled
        .into_iter()
        .filter(|s| s.rmse.fit <= 1.05 * best)
        .min_by(|a, b| a.rmse.selection.total_cmp(&b.rmse.selection))
}

#[cfg(test)]
mod tests {
    use super::Gap;

    #[test]
    fn a_step_that_no_fitted_sample_sees_is_where_the_next_record_begins() {
        let gap = Gap {
            from: 7.0,
            to: 12.5,
            begins: 12.0,
        };
        let settled = [6.9, 7.1, 11.0, 12.4, 12.6].map(|t| gap.settled(t));
        assert_eq!(settled, [6.9, 12.0, 12.0, 12.0, 12.6]);
    }
}
