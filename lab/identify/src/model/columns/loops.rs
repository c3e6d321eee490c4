//! The hysteresis state after the input stages.

use super::effect_column;
use crate::model::structure::FitTerm;
use crate::problem::{is_silent, Prepared};
use bowden::hysteresis::{BoucWen, Sensitivity};
use rayon::prelude::*;

/// The input of the transmission: after the input stages, whose gain is one.
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
    shape: &BoucWen<f64>,
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
    shape: &BoucWen<f64>,
    eta0: &[f64],
) -> Vec<Sensitivity<f64>> {
    let mut all = vec![Sensitivity::start(0.0); data.work_len()];
    by_record(data, seen, &mut all, eta0, |seen, all, eta0| {
        with_slopes(shape, seen, all, eta0);
    });
    all
}

/// The same along one record, from its state at the start.
fn with_slopes(shape: &BoucWen<f64>, seen: &[f64], all: &mut [Sensitivity<f64>], eta0: f64) {
    let mut state = Sensitivity::start(eta0);
    let mut last = seen.first().copied().unwrap_or(0.0);
    for (slot, &input) in all.iter_mut().zip(seen) {
        state = shape.advance_with_sensitivity(state, input - last);
        // What the state at the start still does fades along the path.
        if is_silent(state.d_eta0) {
            state.d_eta0 = 0.0;
        }
        last = input;
        *slot = state;
    }
}

/// Processes each record by itself, several at a time: its input, its result, and its initial
/// state.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_state_at_the_start_fades_to_zero_and_not_to_denormal_floats() {
        let shape = BoucWen::try_new(2.0, 0.8, 1.5).unwrap();
        let seen: Vec<f64> = (0..90_000).map(|i| (0.01 * f64::from(i)).sin()).collect();
        let mut all = vec![Sensitivity::start(0.0); seen.len()];
        with_slopes(&shape, &seen, &mut all, 0.3);
        assert!(all[0].d_eta0 == 1.0 && all[20].d_eta0 > 0.0);
        assert!(all.iter().all(|s| !s.d_eta0.is_subnormal()));
        assert_eq!(all[60_000].d_eta0, 0.0);
        // Nothing else has changed.
        let (mut state, mut last) = (Sensitivity::start(0.3), seen[0]);
        for (slot, &input) in all.iter().zip(&seen) {
            state = shape.advance_with_sensitivity(state, input - last);
            last = input;
            let slopes = |s: &Sensitivity<f64>| (s.eta, s.d_rho, s.d_sigma, s.d_n);
            assert_eq!(slopes(slot), slopes(&state));
        }
    }
}
