//! On which variables a residual depends, as free curves of ten hats tested by sign flips.

use super::blocks::Regime;
use super::hats::{is_phase, score, Scored, HATS};
use crate::fit::projection::{rows, Span};
use crate::fit::Solution;
use crate::model::Variable;
use crate::problem::Prepared;

/// Level of the curve's test, divided among the variables.
const LEVEL: f64 = 0.01;
/// A curve takes at least this share of the squared error.
const SHARE: f64 = 0.1;
/// A curve comes into question if to first order it takes this share of what the best takes.
const CLOSE: f64 = 0.7;
/// At most this many curves are told.
const CURVES: usize = 3;

/// A variable on which a residual depends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dependence {
    /// Which.
    pub variable: Variable,
    /// Share of the squared error that a free curve of ten hats over it takes.
    pub share: f64,
    /// Exact sign-flip p-value of that curve; `None` where what it leaves is correlated for
    /// too long to be tested on sixteen blocks.
    pub p: Option<f64>,
}

/// On what a residual depends beside what is held fixed, the strongest first: variables
/// whose curve passes the test, and takes nearly as much as the best.
pub(crate) fn dependences(data: &Prepared, now: &Solution, held: &[Vec<f64>]) -> Vec<Dependence> {
    let all = Variable::all(data, now.structure.hysteresis);
    let held = Span::of(data, held.iter());
    let found = curves(data, now, &held, &all);
    found
        .into_iter()
        .filter_map(|scored| {
            let mut span = held.clone();
            for column in scored.table.columns(data, &now.eta)? {
                span.add(rows(data, &data.filtered(&column)));
            }
            let rest = span.off(rows(data, &now.residual));
            let (regime, _) = Regime::of(data, rest.as_slice());
            Some(Dependence {
                variable: scored.table.variable,
                share: scored.share,
                p: (regime == Regime::Blocks).then(|| scored.p(data)),
            })
        })
        .collect()
}

/// The curves that pass the test, the largest first.
fn curves(data: &Prepared, now: &Solution, moved: &Span, variables: &[Variable]) -> Vec<Scored> {
    use rayon::prelude::*;
    if now.structure.table.is_some() {
        return Vec::new();
    }
    let level = LEVEL / Variable::all(data, now.structure.hysteresis).len() as f64;
    let scored: Vec<Option<Scored>> = variables
        .par_iter()
        .map(|&variable| score(data, now, moved, variable, HATS))
        .collect();
    let mut found: Vec<Scored> = scored
        .into_iter()
        .flatten()
        .filter(|s| s.p(data) <= level && !is_phase(data, now, s.table.variable))
        .collect();
    found.sort_by(|a, b| b.share.total_cmp(&a.share));
    let best = found.first().map_or(0.0, |s| s.share);
    found.retain(|s| s.share >= CLOSE * best && s.share >= SHARE);
    found.truncate(CURVES);
    found
}
