//! K15: any sample to the learning, from any state.

use super::*;
use crate::proofs::properties::control::learning_keeps_its_limit;

/// Cells of the cycle: as few as lead and filter of the harness need.
const CELLS: usize = 13;

/// Any learning that its constructors accept and that fits the cells.
fn learning() -> IterativeLearning<f32> {
    let (lead, half_width): (u16, u16) = (kani::any(), kani::any());
    let learning = IterativeLearning::try_new(kani::any(), kani::any(), lead, half_width)
        .and_then(|learning| learning.with_forgetting(kani::any()));
    kani::assume(learning.is_ok() && lead <= 2 && half_width <= 1);
    match learning {
        Ok(learning) => learning,
        Err(_) => unreachable!(),
    }
}

/// Any number, NaN included: what the cells around one come to is not needed.
fn any_mean<T: Real>(_: &[T], _: usize, _: usize) -> T {
    T::from_f64(kani::any())
}

/// Any number between the middles of two cells, likewise.
fn any_reading<T: Real>(_: &[T], _: usize, _: T) -> T {
    T::from_f64(kani::any())
}

/// K15. Iterative learning: for any sample, any state and any contents of the buffers, NaN
/// included, the feed-forward is finite and within its limit, a cell that learns ends within the
/// limit, nothing changes without a phase, and the status of every sample is correct.
///
/// Assumes: 13 cells, a lead of at most 2 and a half width of at most 1; any means and readings.
#[kani::proof]
#[kani::unwind(15)]
#[kani::stub(triangle, any_mean)]
#[kani::stub(between, any_reading)]
fn learning_from_any_state() {
    let learning = learning();
    let mut state = IterativeLearningState::<f32, [f32; CELLS]> {
        learned: kani::any(),
        unfiltered: kani::any(),
        cell: kani::any(),
        sum: kani::any(),
        count: kani::any(),
        output: kani::any(),
        missed: kani::any(),
        since: kani::any(),
    };
    let at = IterativeLearningInput::<f32> {
        phase: kani::any(),
        reference: kani::any(),
        measured: kani::any(),
        learns: kani::any(),
    };
    kani::cover!(state.feed_forward().is_nan());
    kani::cover!(state.cell > CELLS);
    let mut before = [0.0; CELLS];
    assert!(learning_keeps_its_limit(
        &learning,
        &mut state,
        &at,
        &mut before
    ));
}
