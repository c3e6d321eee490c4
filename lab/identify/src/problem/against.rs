//! Whether a force has the opposite sign to the motion, as with a load cell mounted the other way
//! round.

use super::Channel;
use crate::algebra::{Span, Stretch};
use nalgebra::DVector;
use std::ops::Range;

/// Least share of the output that determines its sign.
const PLAIN: f64 = 0.01;
/// A spring whose force is delayed appears to supply energy. If the part in phase with the position
/// exceeds the part in phase with the velocity by more than this factor, it is such a spring.
const SPRING: f64 = 2.0;
/// If less than this share of the acceleration is independent of the position, as in a motion of
/// one tone, the acceleration does not distinguish a mass from a spring.
const ALIKE: f64 = 0.1;

/// The note on such an output.
pub(super) fn words(output: &str, input: &str) -> String {
    format!("`{output}` has the opposite sign to the motion of `{input}`: friction has a negative gain here")
}

/// Whether the output supplies energy to the motion instead of dissipating it, as friction and
/// hysteresis appear to do if a force is measured with the opposite sign. `seen` are the samples
/// that the fit may use, on the work grid.
///
/// The sign is that of the gain of the velocity if position, velocity and acceleration are fitted
/// together: parts that only store energy do not contribute to it.
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
    let mut span = Span::with_tolerance(ALIKE);
    if !(span.add(position) && span.add(velocity)) {
        return false;
    }
    span.add(centred(&|i| input.motion[i].acceleration));
    let size = output.norm();
    let gains = span.gains(&Stretch::from(output));
    let [with_position, with_velocity] = [gains[0] * sizes[0], gains[1] * sizes[1]];
    with_velocity < -PLAIN * size && with_position < -SPRING * with_velocity
}
