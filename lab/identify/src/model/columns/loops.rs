//! The hysteresis state behind the input stages.

use super::effect_column;
use crate::model::structure::FitTerm;
use crate::problem::Prepared;
use bowden::hysteresis::{Sensitivity, Shape};

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
    for (piece, &eta0) in data.pieces.iter().zip(eta0) {
        let seen = &seen[piece.work.clone()];
        let mut state = eta0;
        let mut last = seen.first().copied().unwrap_or(0.0);
        for (slot, &input) in eta[piece.work.clone()].iter_mut().zip(seen) {
            state = shape.advance(state, input - last);
            last = input;
            *slot = state;
        }
    }
}

/// The hysteresis state and its sensitivities along the work grid.
pub(super) fn trajectory(
    data: &Prepared,
    seen: &[f64],
    shape: &Shape<f64>,
    eta0: &[f64],
) -> Vec<Sensitivity<f64>> {
    let mut all = Vec::with_capacity(data.work_len());
    for (piece, &eta0) in data.pieces.iter().zip(eta0) {
        let seen = &seen[piece.work.clone()];
        let mut state = Sensitivity::start(eta0);
        let mut last = seen.first().copied().unwrap_or(0.0);
        for &input in seen {
            state = shape.advance_with_sensitivity(state, input - last);
            last = input;
            all.push(state);
        }
    }
    all
}
