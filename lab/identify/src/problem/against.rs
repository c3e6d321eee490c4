//! Whether a force has the opposite sign to the motion, as with a load cell mounted the other way
//! round.

use super::Channel;
use crate::algebra::{Span, Stretch};
use crate::scale::{HALF, PART, TRACE};
use nalgebra::DVector;
use std::ops::Range;

/// The note on such an output.
pub(super) fn words(output: &str, input: &str) -> String {
    format!("`{output}` has the opposite sign to the motion of `{input}`, so friction has a negative gain")
}

/// Whether the output supplies energy to the motion instead of dissipating it, as friction and
/// hysteresis appear to do if a force is measured with the opposite sign. `seen` are the samples
/// that the fit may use, on the work grid.
///
/// The sign is that of the gain of the velocity if position, velocity and acceleration are fitted
/// together: parts that only store energy do not contribute to it. A spring whose force is delayed
/// appears to supply energy, with less than half as much in phase with the velocity as with the
/// position. In a motion of one tone the acceleration does not distinguish a mass from a spring.
pub(super) fn against(
    input: &Channel,
    output: &[f64],
    seen: &[Range<usize>],
    stride: usize,
) -> bool {
    let rows = || seen.iter().flat_map(|range| range.clone().step_by(stride));
    let centred = |value: &dyn Fn(usize) -> f64| {
        let column = DVector::from_iterator(rows().count(), rows().map(value));
        let mean = column.mean();
        column.add_scalar(-mean)
    };
    let position = centred(&|i| input.motion[i].position);
    let velocity = centred(&|i| input.motion[i].velocity);
    let output = centred(&|i| output[i]);
    let sizes = [position.norm(), velocity.norm()];
    let mut span = Span::with_tolerance(PART);
    if !(span.add(position) && span.add(velocity)) {
        return false;
    }
    span.add(centred(&|i| input.motion[i].acceleration));
    let size = output.norm();
    let gains = span.gains(&Stretch::from(output));
    let [with_position, with_velocity] = [gains[0] * sizes[0], gains[1] * sizes[1]];
    with_velocity < -TRACE * size && HALF * with_position < -with_velocity
}
