//! Variable projection: gains by QR, shapes by Levenberg-Marquardt.
//!
//! The output is linear in the gains once the shapes are known, so the gains are
//! eliminated (Golub and Pereyra, 1973; Kaufman's derivative, 1975) and the search
//! runs over rho, sigma, n, eta(0) and the effects' own shapes only. The hysteresis
//! column comes with its exact sensitivities in the same pass.

mod compressed;
mod linear;
pub(crate) mod projection;
pub(crate) mod search;
pub(crate) mod settle;
mod solution;
pub(crate) mod starts;
mod tie;

use crate::model::structure::{Free, Range, Role, Structure};
use crate::problem::Prepared;
use search::{descend, descend_fully};
use settle::{choose, settle};
pub use solution::{Segments, Solution};
use starts::starts;
pub use starts::Known;

/// Fits a structure: short searches from all starts on a coarse grid, then full searches from the
/// best three; starts that reach the same optimum are searched once.
///
/// `from` is the optimum of the previous round (its structure is a prefix of this one).
/// `stage_gain` starts the gain of an output stage that is new.
#[must_use]
pub fn fit(
    data: &Prepared,
    structure: &Structure,
    from: Option<&Solution>,
    stage_gain: f64,
) -> Option<Solution> {
    fit_from(data, structure, from.map(Known::of).as_ref(), stage_gain)
}

/// As [`fit`], from start values of some of the parameters.
#[must_use]
pub fn fit_from(
    data: &Prepared,
    structure: &Structure,
    from: Option<&Known>,
    stage_gain: f64,
) -> Option<Solution> {
    use rayon::prelude::*;
    let free = structure.free(data);
    let starts = starts(data, structure, &free, from, stage_gain);
    let (coarse, fine) = (data.for_search(true), data.for_search(false));
    let run = |data: &Prepared, from: &[Vec<f64>], most: usize, tolerance: f64| -> Vec<Vec<f64>> {
        let mut reached: Vec<(f64, Vec<f64>)> = from
            .par_iter()
            .map(|start| descend(data, structure, &free, start, most, tolerance))
            .collect::<Vec<_>>()
            .into_iter()
            .flatten()
            .collect();
        reached.sort_by(|a, b| a.0.total_cmp(&b.0));
        if tolerance <= CLOSE {
            // Of equal optima the best is searched further.
            reached = distinct(&free, reached);
        }
        reached.truncate(3);
        reached.into_iter().map(|(_, values)| values).collect()
    };
    let rough = run(&coarse, &starts, 12, 1e-3);
    let better = run(&coarse, &rough, 70, CLOSE);
    let best: Vec<Vec<f64>> = better
        .par_iter()
        .filter_map(|start| descend_fully(&fine, structure, &free, start))
        .collect();
    let settled: Vec<Option<Solution>> = best
        .into_par_iter()
        .map(|values| settle(data, structure, &free, values))
        .collect();
    let mut settled: Vec<Solution> = settled.into_iter().flatten().collect();
    settled.sort_by(|a, b| a.rmse.fit.total_cmp(&b.rmse.fit));
    choose(settled)
}

/// Tolerance of the searches on the coarse grid after which optima are distinguished.
const CLOSE: f64 = 1e-6;
/// Two searches have reached one optimum where each parameter differs by less than this on the unbounded
/// scale of its range. A choice.
const SAME_PLACE: f64 = 0.02;

/// The optima that differ from all better ones, by a hundred times the tolerance of the error or by a
/// parameter; `reached` is in the order of the errors.
fn distinct(free: &[Free], reached: Vec<(f64, Vec<f64>)>) -> Vec<(f64, Vec<f64>)> {
    let near = |(f, (a, b)): (&Free, (&f64, &f64))| match f.range {
        Range::Free => (a - b).abs() <= SAME_PLACE * a.abs(),
        range => (range.encode(*a) - range.encode(*b)).abs() <= SAME_PLACE,
    };
    let mut kept: Vec<(f64, Vec<f64>)> = Vec::with_capacity(reached.len());
    for (sse, values) in reached {
        let is_known = kept.iter().any(|(better, known)| {
            sse - better <= 100.0 * CLOSE * better
                && free.iter().zip(known.iter().zip(&values)).all(near)
        });
        if !is_known {
            kept.push((sse, values));
        }
    }
    kept
}

/// Refines a solution on another split of its record.
#[must_use]
pub fn refit(data: &Prepared, from: &Solution) -> Option<Solution> {
    let structure = &from.structure;
    let free = structure.free(data);
    let fine = data.for_search(false);
    let values = descend_fully(&fine, structure, &free, &from.values)?;
    settle(data, structure, &free, values)
}

/// One short search from the present optimum on the coarse grid; returns the sum of squares and
/// the structure with refined shapes.
#[must_use]
pub fn glance(
    data: &Prepared,
    structure: &Structure,
    from: &Solution,
    stage_gain: f64,
) -> Option<(f64, Structure, f64)> {
    glance_from(data, structure, &Known::of(from), stage_gain)
}

/// As [`glance`], from start values of some of the parameters.
#[must_use]
pub fn glance_from(
    data: &Prepared,
    structure: &Structure,
    from: &Known,
    stage_gain: f64,
) -> Option<(f64, Structure, f64)> {
    let free = structure.free(data);
    let starts = starts(data, structure, &free, Some(from), stage_gain);
    // The present hysteresis may have adapted to the missing effect.
    let rough = starts
        .iter()
        .enumerate()
        .filter(|(index, _)| [0, 2, 6].contains(index))
        .filter_map(|(_, start)| descend(data, structure, &free, start, 10, 1e-3));
    let (_, start) = rough.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let (sse, values) = descend(data, structure, &free, &start, 30, 1e-4)?;
    let refined = Structure {
        terms: structure.terms.at(&free, &values)?,
        ..structure.clone()
    };
    let last = structure.terms.ids().last();
    let own = last.and_then(|&term| free.iter().position(|f| f.role == Role::Stage { term }));
    let gain = own.map_or(stage_gain, |i| values[i]);
    Some((sse, refined, gain))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn optima_are_one_where_error_and_place_are() {
        let free = |range| Free {
            role: Role::Rho,
            range,
        };
        let free = [free(Range::Free), free(Range::Log(0.1, 10.0))];
        let at = |sse: f64, x: f64, rho: f64| (sse, vec![x, rho]);
        let all = vec![
            at(1.0, 5.0, 2.0),
            // Equal.
            at(1.00001, 5.01, 2.005),
            // Elsewhere, each parameter.
            at(1.00002, 6.0, 2.0),
            at(1.00003, 5.0, 3.0),
            // Equal to the one before.
            at(1.00004, 5.0, 3.01),
            // At the first place, but far from its error: it has not arrived.
            at(1.1, 5.0, 2.0),
        ];
        let kept: Vec<f64> = distinct(&free, all).iter().map(|(sse, _)| *sse).collect();
        assert_eq!(kept, [1.0, 1.00002, 1.00003, 1.1]);
    }
}
