//! `control/learning.rs`, `control/learning/`

use crate::{any, never_panics};
use bowden::control::{IterativeLearning, IterativeLearningInput, IterativeLearningState};
use bowden::Real;
use std::hint::black_box;

/// Cells of the cycle.
const CELLS: usize = 32;

type State<T> = IterativeLearningState<T, [T; CELLS]>;

/// Any contents of a buffer.
fn buffer<T: Real>() -> [T; CELLS] {
    black_box([T::zero(); CELLS])
}

/// Any number of cells.
fn cells() -> u16 {
    black_box(2)
}

pub fn all<T: Real>() -> Option<()> {
    never_panics!(
        control_learning_try_new,
        IterativeLearning::<T>::try_new(any(), any(), cells(), cells())
    );
    let learning = black_box(IterativeLearning::<T>::try_new(
        any(),
        any(),
        cells(),
        cells(),
    ))
    .ok()?;
    never_panics!(
        control_learning_with_forgetting,
        learning.with_forgetting(any())
    );
    let learning = black_box(learning.with_forgetting(any())).ok()?;
    never_panics!(control_learning_gain, learning.gain());
    never_panics!(control_learning_limit, learning.limit());
    never_panics!(control_learning_lead, learning.lead());
    never_panics!(control_learning_half_width, learning.half_width());
    never_panics!(control_learning_forgetting, learning.forgetting());
    never_panics!(control_learning_fewest_cells, learning.fewest_cells());
    never_panics!(
        control_learning_check_cells,
        learning.check_cells(usize::from(cells()))
    );
    never_panics!(
        control_learning_start,
        learning.start(buffer::<T>(), buffer())
    );
    never_panics!(
        control_learning_resume,
        learning.resume(buffer::<T>(), buffer())
    );
    let state = learning.start(buffer::<T>(), buffer());
    let mut state: State<T> = black_box(state).ok()?;
    never_panics!(
        control_learning_new,
        IterativeLearningInput::<T>::new(any(), any(), any())
    );
    let at = black_box(IterativeLearningInput::<T>::new(any(), any(), any()));
    never_panics!(control_learning_step, learning.step(&mut state, &at));
    never_panics!(control_learning_state_learned, state.learned());
    never_panics!(control_learning_state_feed_forward, state.feed_forward());
    slices::<T>(&learning, &at)
}

/// The same over buffers that somebody else owns: its length is known to nobody.
fn slices<T: Real>(learning: &IterativeLearning<T>, at: &IterativeLearningInput<T>) -> Option<()> {
    let (mut learned, mut unfiltered) = (buffer::<T>(), buffer::<T>());
    let learned = black_box(&mut learned[..]);
    let unfiltered = black_box(&mut unfiltered[..]);
    never_panics!(
        control_learning_start,
        learning.start(&mut *learned, &mut *unfiltered)
    );
    never_panics!(
        control_learning_resume,
        learning.resume(&mut *learned, &mut *unfiltered)
    );
    let mut state = black_box(learning.start(learned, unfiltered)).ok()?;
    never_panics!(control_learning_step, learning.step(&mut state, at));
    never_panics!(control_learning_state_learned, state.learned());
    Some(())
}
