//! The exported model if the pretension has stepped: the rig after the step.
//!
//! A cable that has slipped, or a zero that has moved, stays so. The step itself belongs to its
//! record, but the state after the step is the rig of the next record. A model that was fitted over
//! both levels at once has an offset between them, and gains and a hysteresis that are bent towards
//! the step.

use crate::fit::{Segments, Solution};
use crate::problem::Prepared;

/// The record as it would be if each pretension step of a solution had come before it; `None`
/// where there is none.
pub(super) fn after_steps(data: &Prepared, solution: &Solution) -> Option<Prepared> {
    let terms = solution.structure.terms.iter().enumerate();
    let is_step = |family: &str| family == "pretension";
    let mut output = None;
    for (index, term) in terms.filter(|(_, term)| is_step(term.effect.info().family)) {
        let (step, gain) = (solution.adds(data, term)?, solution.gain(index));
        let shifted = output.get_or_insert_with(|| data.output().to_vec());
        for (y, stepped) in shifted.iter_mut().zip(step) {
            *y += gain * (1.0 - stepped);
        }
    }
    Some(data.with_output(output?))
}

/// A solution with its residual on the unchanged record.
pub(super) fn on_record(data: &Prepared, solution: Solution) -> Solution {
    let pairs = data.target.iter().zip(&solution.prediction);
    let residual: Vec<f64> = pairs.map(|(y, p)| y - p).collect();
    Solution {
        rmse: Segments::of(data, &residual),
        residual,
        ..solution
    }
}
