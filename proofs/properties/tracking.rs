//! The tracking error stays in its box.

use bowden::control::{Adaptive, AdaptiveInput, AdaptiveState};
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

/// Theorem 1's `|s| <= delta`, `|z| <= delta` hold after a step of `dt` \[s\] where they did
/// before, and with them `|e| <= (1 + lambda)·delta`.
pub fn errors_stay_within_theorem_1(
    law: &LagRecursion<f32>,
    at: ErrorState<f32>,
    dt: f32,
    by: &Disturbance<f32>,
    delta: f32,
) -> bool {
    let held = |at: ErrorState<f32>| at.s.abs() <= delta && at.z.abs() <= delta;
    let next = law.step(at, dt, by);
    let error = next.s - law.lambda * next.z;
    !held(at) || (held(next) && error.abs() <= (1.0 + law.lambda) * delta)
}

/// A plant that answers within a sample: `y = gain·u - disturbance`.
#[derive(Debug, Clone, Copy)]
pub struct StaticPlant {
    /// alpha \[N·m/command unit\]
    pub gain: f32,
    /// D \[N·m\]
    pub disturbance: f32,
}

impl StaticPlant {
    fn errors<const N: usize>(
        &self,
        law: &Adaptive<f32, N>,
        state: &AdaptiveState<f32, N>,
        reference: f32,
    ) -> ErrorState<f32> {
        let error = self.gain * state.command() - self.disturbance - reference;
        let z = state.accumulated_error();
        ErrorState {
            s: error + law.settings().lambda * z,
            z,
        }
    }
}

/// The controller's step on a static plant, whose output still shows the command before:
/// errors in the box `|s| <= most.s`, `|z| <= most.z` are in it when the new command is seen.
pub fn the_law_keeps_the_box<const N: usize>(
    law: &Adaptive<f32, N>,
    state: &mut AdaptiveState<f32, N>,
    plant: &StaticPlant,
    dt: f32,
    reference: f32,
    most: ErrorState<f32>,
) -> bool {
    let held = |at: ErrorState<f32>| at.s.abs() <= most.s && at.z.abs() <= most.z;
    if !held(plant.errors(law, state, reference)) {
        return true;
    }
    let measured = plant.gain * state.command() - plant.disturbance;
    law.step(
        state,
        &AdaptiveInput::new(dt, reference, measured, [0.0; N]),
    );
    held(plant.errors(law, state, reference))
}
