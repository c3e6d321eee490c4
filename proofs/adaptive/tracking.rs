//! K2, K12: the whole shipped step of the lag form.

use super::super::{Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, AdaptiveTerms};
use super::super::{ErrorState, Estimator, Form, SmoothSign};
use super::estimates::any_lost;
use crate::control::status::Held;
use crate::control::{Output, Status};
use crate::proofs::any::within;
use crate::proofs::properties::control::the_lag_does_not_pass_its_target;
use crate::proofs::properties::tracking::{the_law_keeps_the_box, StaticPlant};
use crate::signal::{two_sum, Compensated};
use crate::Real;

/// Table 2 in lag form at 1 kHz on a plant of known gain, estimates at rest.
fn paper() -> Adaptive<f32, 0> {
    let lag = Form::FirstOrder {
        step: 0.001,
        plant_gain: 1.0,
    };
    Adaptive::checked(AdaptiveSettings {
        beta: Estimator::fixed(1.0).within(1.0, 1.0),
        delta: Estimator::fixed(0.0).within(0.0, 0.0),
        smooth_sign: SmoothSign::Clamp,
        frozen: true,
        ..AdaptiveSettings::unlimited(lag, 24.0, 8.0, 0.05)
    })
}

/// A step that no sample leads to.
fn never<T: Real, const N: usize>(
    _: &Adaptive<T, N>,
    state: &mut AdaptiveState<T, N>,
    _: &mut AdaptiveInput<T, N>,
) -> Output<T> {
    kani::assert(false, "a sample is refused");
    Output {
        command: state.held.command,
        status: Status::Good,
    }
}

/// K2. The controller's step on a static plant with one sample of delay, as firmware runs it: |s| ≤
/// 0.43 N·m and |z| ≤ 0.43/lambda hold after the step, and no sample is refused. One step, not an
/// induction: afterwards the carry of z may not be zero.
///
/// Assumes: Table 2 at 1 kHz, g = 1, no regressor, delta_hat = 0, reference 0, a constant
/// disturbance of up to 8 N·m, carries of zero; the rounding error of a sum as proved by
/// a_sum_and_what_it_lost.
#[kani::proof]
#[kani::unwind(5)]
#[kani::stub(Adaptive::exception, never)]
#[kani::stub(two_sum, any_lost)]
fn slow_tracking_box_of_the_law() {
    let law = paper();
    let most = ErrorState {
        s: 0.43,
        z: 0.43 / 8.0,
    };
    let plant = StaticPlant {
        gain: 1.0,
        disturbance: within(-8.0, 8.0),
    };
    let command = within(-60.0, 60.0);
    let mut state = AdaptiveState::new(&law);
    state.z = Compensated::new(within(-most.z, most.z));
    state.lag = Compensated::new(command);
    state.held = Held::new(command);
    let before = state.z.value;
    let kept = the_law_keeps_the_box(&law, &mut state, &plant, 0.001, 0.0, most);
    kani::cover!(before < -0.05 && state.z.value > before && plant.disturbance > 7.9);
    assert!(kept);
}

/// The reference that comes next: any number that a sample may hold, and the same one each
/// time that it is asked for. A law that returned another number to the step than to its
/// telemetry would let the one be finite and the other not.
fn next_reference<T: Real, const N: usize>(
    _: &Adaptive<T, N>,
    _: &AdaptiveTerms<T, N>,
    input: &AdaptiveInput<T, N>,
) -> T {
    input.next_reference
}

/// K12. The command of the lag lies between the previous command and its target, except for the
/// rounding of one subtraction and one sum.
///
/// Assumes: h·lambda = 0.008, beta_hat = 1, a previous command within ±1000, any virtual command.
/// (A claim about one step.)
#[kani::proof]
#[kani::unwind(5)]
#[kani::stub(Adaptive::virtual_command, next_reference)]
fn lag_between() {
    let law = paper();
    let mut state = AdaptiveState::new(&law);
    let before = within(-1000.0, 1000.0);
    state.lag = Compensated::new(before);
    let input = AdaptiveInput {
        next_reference: kani::any(),
        ..AdaptiveInput::new(0.001, 0.0, 0.0, [])
    };
    let out = law.step_with_terms(&mut state, &input);
    kani::cover!(out.terms.law > before && out.terms.law < out.terms.virtual_command);
    assert!(the_lag_does_not_pass_its_target(before, 0.0, &out));
}
