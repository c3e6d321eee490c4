//! K10: other settings take a running law over.

use super::super::{Adaptive, AdaptiveInput, AdaptiveState, Estimator, Form, SmoothSign};
use super::state::{finite_state, input, law};
use crate::proofs::properties::control::{
    a_hand_over_keeps_the_command, a_start_keeps_the_command,
};
use crate::signal::DerivativeState;
use crate::Real;

/// Any z, NaN included, for what the search finds.
fn any_z<T: Real, const N: usize>(
    _: &Adaptive<T, N>,
    _: T,
    _: &AdaptiveState<T, N>,
    _: &AdaptiveInput<T, N>,
) -> T {
    T::from_f64(kani::any())
}

fn is_a_box(estimator: &Estimator<f32>) -> bool {
    estimator.low.is_finite() && estimator.high.is_finite() && estimator.low <= estimator.high
}

fn lag() -> Form<f32> {
    Form::FirstOrder {
        step: kani::any(),
        plant_gain: kani::any(),
    }
}

fn literal() -> Form<f32> {
    Form::AsPublished {
        time_constant: kani::any(),
    }
}

/// Any law of this form with boxes that are boxes, as its constructor demands.
fn checked_law(form: Form<f32>) -> Adaptive<f32, 2> {
    let law = law::<2>(form, SmoothSign::Tanh);
    let settings = &law.settings;
    let [first, second] = &settings.theta;
    kani::assume(settings.z_limit > 0.0);
    kani::assume(is_a_box(&settings.beta) && is_a_box(&settings.delta));
    kani::assume(is_a_box(first) && is_a_box(second));
    law
}

fn bumpless_transfer(form: Form<f32>) {
    let law = checked_law(form);
    let (mut state, input): (AdaptiveState<f32, 2>, _) = (finite_state(), input());
    let before = state;
    let kept = a_hand_over_keeps_the_command(&law, &mut state, &input);
    kani::cover!(state.z.value > before.z.value && state.lag != before.lag);
    kani::cover!(state.command() != before.command());
    assert!(kept && state.error_rate == DerivativeState::new());
}

/// K10. Bumpless transfer of a running law to other settings, first-order form, two regressors: for
/// any sample the applied command is kept, a slew-rate limit continues from it, and the state is
/// valid.
///
/// Assumes: nothing about gains or sample; a state with any finite numbers; any z as the result of
/// the search.
#[kani::proof]
#[kani::unwind(3)]
#[kani::stub(Adaptive::z_that_gives, any_z)]
fn hand_over() {
    bumpless_transfer(lag());
}

/// K10. The same for the form as published, whose rate of the error restarts at zero.
///
/// Assumes: the same as hand_over.
#[kani::proof]
#[kani::unwind(3)]
#[kani::stub(Adaptive::z_that_gives, any_z)]
fn hand_over_literal() {
    bumpless_transfer(literal());
}

fn resume(form: Form<f32>) {
    let law = checked_law(form);
    let settings = &law.settings;
    let starts_within = |of: &Estimator<f32>| of.contains(of.initial);
    let [first, second] = &settings.theta;
    kani::assume(starts_within(&settings.beta) && starts_within(&settings.delta));
    kani::assume(starts_within(first) && starts_within(second));
    let (output, input) = (kani::any(), input());
    kani::cover!(settings.limits.contains(output) && output > 1.0);
    assert!(a_start_keeps_the_command(&law, output, &input));
}

/// K10. A law that resumes from an output, first-order form, two regressors: for any output and
/// sample the command is that output within the range, and the state is valid.
///
/// Assumes: nothing about gains, output or sample; any z as the result of the search.
#[kani::proof]
#[kani::unwind(3)]
#[kani::stub(Adaptive::z_that_gives, any_z)]
fn resume_lag() {
    resume(lag());
}

/// K10. The same for the form as published.
///
/// Assumes: the same as resume_lag.
#[kani::proof]
#[kani::unwind(3)]
#[kani::stub(Adaptive::z_that_gives, any_z)]
fn resume_literal() {
    resume(literal());
}
