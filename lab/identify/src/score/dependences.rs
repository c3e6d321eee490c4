//! The variables that a residual depends on: free curves of ten hats, tested by sign flips.

use super::blocks::Regime;
use super::hats::{is_phase, score, Scored, HATS};
use crate::fit::projection::{rows, Span};
use crate::fit::Solution;
use crate::model::Variable;
use crate::problem::{Prepared, Stretch};
use crate::scale::{LEVEL, PART};

/// Least reduction of the SSE to first order, as a share of the best curve's.
const CLOSE: f64 = 0.7;
/// Maximum number of curves.
const CURVES: usize = 3;

/// A variable on which a residual depends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dependence {
    /// The variable.
    pub variable: Variable,
    /// Share of the squared error that a free curve of ten hats over it removes.
    pub share: f64,
    /// Exact sign-flip p-value of that curve; `None` if the residual after it is correlated for
    /// too long to be tested on sixteen blocks.
    pub p: Option<f64>,
}

/// The variables that a residual depends on jointly with the columns `held`, the strongest
/// first: their curves pass the test and remove nearly as much as the best one.
pub(crate) fn dependences(data: &Prepared, now: &Solution, held: &[Stretch]) -> Vec<Dependence> {
    let all = Variable::all(data, now.structure.hysteresis);
    let held = Span::of(data, held.iter());
    let found = curves(data, now, &held, &all);
    found
        .into_iter()
        .filter_map(|(scored, p)| {
            let mut span = held.clone();
            for column in scored.table.columns(data, &now.eta)? {
                span.add(rows(data, &data.filtered(&column)));
            }
            let rest = span.off(rows(data, &now.residual));
            let (regime, _) = Regime::of(data, rest.as_slice());
            Some(Dependence {
                variable: scored.table.variable,
                share: scored.share,
                p: (regime == Regime::Blocks).then_some(p),
            })
        })
        .collect()
}

/// The curves that pass the test with their p-values, the largest first.
fn curves(
    data: &Prepared,
    now: &Solution,
    moved: &Span,
    variables: &[Variable],
) -> Vec<(Scored, f64)> {
    use rayon::prelude::*;
    if now.structure.table.is_some() {
        return Vec::new();
    }
    let level = LEVEL / Variable::all(data, now.structure.hysteresis).len() as f64;
    let scored: Vec<Option<Scored>> = variables
        .par_iter()
        .map(|&variable| score(data, now, moved, variable, HATS))
        .collect();
    let mut found: Vec<(Scored, f64)> = scored
        .into_iter()
        .flatten()
        .map(|s| {
            let p = s.p(data);
            (s, p)
        })
        .filter(|(s, p)| *p <= level && !is_phase(data, now, s.table.variable))
        .collect();
    found.sort_by(|a, b| b.0.share.total_cmp(&a.0.share));
    let best = found.first().map_or(0.0, |(s, _)| s.share);
    found.retain(|(s, _)| s.share >= CLOSE * best && s.share >= PART);
    found.truncate(CURVES);
    found
}
