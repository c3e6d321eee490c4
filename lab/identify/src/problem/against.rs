//! Whether a force has the opposite sign to the motion, as with a load cell mounted the other way
//! round.

use super::Channel;
use crate::algebra::{Span, Stretch};
use nalgebra::DVector;
use std::ops::Range;

/// Less of the output than this does not say which way it counts.
const PLAIN: f64 = 0.01;
/// A spring whose force comes late seems to give energy; with a part in phase with the position
/// that is more than so many times the part with the velocity, that is what it is.
const SPRING: f64 = 2.0;
/// An acceleration of which less than this share is left beside the position, as in a motion of
/// one tone, does not tell a mass from a spring.
const ALIKE: f64 = 0.1;

/// What is said of such an output.
pub(super) fn words(output: &str, input: &str) -> String {
    format!("`{output}` has the opposite sign to the motion of `{input}`: friction has a negative gain here")
}

/// Whether the output gives energy to the motion instead of taking it, as friction and hysteresis do
/// where a force is measured with the other sign. `seen` is what the fit may see, on the work
/// grid.
///
/// The sign is that of the velocity's gain where position, velocity and acceleration are
/// fitted together: what only stores energy has no share in it.
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
