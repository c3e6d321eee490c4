//! The tracking error stays in its box.

use bowden::control::{Disturbance, ErrorState, LagRecursion};

/// Whether errors lie in the box: `|s| <= most`, `|z| <= most/lambda`.
pub fn in_box(law: &LagRecursion<f32>, at: ErrorState<f32>, most: f32) -> bool {
    at.s.abs() <= most && (law.lambda * at.z).abs() <= most
}

/// Errors in their box are in it after a step of `dt` \[s\].
pub fn errors_stay_in_their_box(
    law: &LagRecursion<f32>,
    at: ErrorState<f32>,
    dt: f32,
    by: &Disturbance<f32>,
    most: f32,
) -> bool {
    !in_box(law, at, most) || in_box(law, law.step(at, dt, by), most)
}
