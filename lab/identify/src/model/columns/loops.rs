//! The hysteresis state behind the input stages.

use super::effect_column;
use crate::model::structure::FitTerm;
use crate::problem::Prepared;
use bowden::hysteresis::{Sensitivity, Shape};
use rayon::prelude::*;

/// The input as the transmission sees it: behind the input stages, whose gain is one.
pub(super) fn seen(data: &Prepared, terms: &[FitTerm]) -> Option<Vec<f64>> {
    let mut seen: Vec<f64> = data.input.motion.iter().map(|m| m.position).collect();
    let rest = vec![0.0; seen.len()];
    for term in terms.iter().filter(|t| t.effect.is_input_stage()) {
        for (value, part) in seen.iter_mut().zip(effect_column(data, term, &rest)?) {
            *value += part;
        }
    }
    Some(seen)
}

/// The hysteresis state along the work grid.
pub(super) fn trace(
    data: &Prepared,
    seen: &[f64],
    shape: &Shape<f64>,
    eta0: &[f64],
    eta: &mut [f64],
) {
    by_record(data, seen, eta, eta0, |seen, eta, eta0| {
        let mut state = eta0;
        let mut last = seen.first().copied().unwrap_or(0.0);
        for (slot, &input) in eta.iter_mut().zip(seen) {
            state = shape.advance(state, input - last);
            last = input;
            *slot = state;
        }
    });
}

/// The hysteresis state and its sensitivities along the work grid.
pub(super) fn trajectory(
    data: &Prepared,
    seen: &[f64],
    shape: &Shape<f64>,
    eta0: &[f64],
) -> Vec<Sensitivity<f64>> {
    let mut all = vec![Sensitivity::start(0.0); data.work_len()];
    by_record(data, seen, &mut all, eta0, |seen, all, eta0| {
        let mut state = Sensitivity::start(eta0);
        let mut last = seen.first().copied().unwrap_or(0.0);
        for (slot, &input) in all.iter_mut().zip(seen) {
            state = shape.advance_with_sensitivity(state, input - last);
            last = input;
            *slot = state;
        }
    });
    all
}

/// Walks along each record by itself, several at a time: what it sees, what becomes of it, and
/// the state that it begins with.
fn by_record<T: Send>(
    data: &Prepared,
    seen: &[f64],
    all: &mut [T],
    eta0: &[f64],
    walk: impl Fn(&[f64], &mut [T], f64) + Sync,
) {
    let mut rest = all;
    let mut own = Vec::with_capacity(data.pieces.len());
    for (piece, &eta0) in data.pieces.iter().zip(eta0) {
        let (one, others) = rest.split_at_mut(piece.work.len());
        own.push((&seen[piece.work.clone()], one, eta0));
        rest = others;
    }
    own.into_par_iter()
        .for_each(|(seen, one, eta0)| walk(seen, one, eta0));
}
