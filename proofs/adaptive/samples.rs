//! K1, K4, K5: any sample, any gains, any valid state.

use super::super::{Form, SmoothSign};
use super::state::{input, law, state};
use crate::proofs::properties::control::adaptive_commands_within_its_limits;
use crate::proofs::stubs;

fn any_sample<const N: usize>(form: Form<f32>, smooth_sign: SmoothSign) {
    let law = law::<N>(form, smooth_sign);
    let (mut state, input) = (state(&law), input());
    let before = state;
    let kept = adaptive_commands_within_its_limits(&law, &mut state, &input);
    kani::cover!(state.held.bad == 0 && state.beta.value != before.beta.value);
    kani::cover!(input.measured.is_nan() && state.held.command != before.held.command);
    assert!(kept);
}

fn lag() -> Form<f32> {
    Form::Lag {
        step: kani::any(),
        plant_gain: kani::any(),
    }
}

/// K1, K4, K5. Lag form, one regressor, clamped line.
#[kani::proof]
#[kani::unwind(3)]
fn lag_any_sample() {
    any_sample::<1>(lag(), SmoothSign::Clamp);
}

/// K1, K4, K5. Lag form, two regressors; tanh by its contract.
#[kani::proof]
#[kani::unwind(3)]
#[kani::stub(libm::tanhf, stubs::tanhf)]
fn slow_lag_any_sample_tanh() {
    any_sample::<2>(lag(), SmoothSign::Tanh);
}

/// K1, K5. Literal form, two regressors; tanh and e^x - 1 by their contracts.
#[kani::proof]
#[kani::unwind(3)]
#[kani::stub(libm::tanhf, stubs::tanhf)]
#[kani::stub(libm::expm1f, stubs::expm1f)]
fn slow_literal_any_sample() {
    let time_constant = kani::any();
    any_sample::<2>(Form::Literal { time_constant }, SmoothSign::Tanh);
}
