//! The Bouc-Wen state.

use crate::numbers::Numbers;
use bowden::hysteresis::{BoucWenState, Sensitivity};
use bowden::Real;

/// Whatever the shape and the input: eta stays within ±1, moves with the input, and a bad
/// input leaves the state.
pub fn check(data: &[u8]) {
    let mut from = Numbers::new(data);
    let _ = match from.flag() {
        Some(true) => run::<f32>(&mut from),
        _ => run::<f64>(&mut from),
    };
}

/// Whether `next` lies where a change of the input may take eta.
fn follows<T: Real>(eta: T, change: T, next: T) -> bool {
    next.abs() <= T::one()
        && (if change > T::zero() {
            next >= eta
        } else if change < T::zero() {
            next <= eta
        } else {
            next == eta
        })
}

fn run<T: Real>(from: &mut Numbers) -> Option<()> {
    // A byte of the seeds that selects nothing.
    from.byte()?;
    let shape = from.shape::<T>()?;
    let start = from.any()?;
    let mut state = BoucWenState::with_eta(start).unwrap_or_default();
    let mut sensitivity = Sensitivity::start(state.eta());
    loop {
        let (input, before): (T, _) = (from.any()?, state);
        let eta = shape.step(&mut state, input);
        assert!(eta == state.eta());
        if !input.is_finite() {
            assert!(state == before);
            continue;
        }
        assert!(state.input() == Some(input));
        let change = input - before.input().unwrap_or(input);
        assert!(follows(before.eta(), change, eta));
        let was = sensitivity.eta;
        sensitivity = shape.advance_with_sensitivity(sensitivity, change);
        if change.is_finite() {
            assert!(follows(was, change, sensitivity.eta));
        }
    }
}
