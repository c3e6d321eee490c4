//! K10: other settings take a running law over.

use super::super::{Adaptive, AdaptiveInput, AdaptiveState, Estimator, Form, SmoothSign};
use super::state::{finite_state, input, law};
use crate::proofs::properties::control::a_hand_over_keeps_the_command;
use crate::Real;

/// Any z, NaN included, for what the search finds.
fn any_z<T: Real, const N: usize>(
    _: &Adaptive<T, N>,
    _: T,
    _: &AdaptiveState<T, N>,
    _: &AdaptiveInput<T, N>,
) -> T {
    T::of(kani::any())
}

fn is_a_box(estimator: &Estimator<f32>) -> bool {
    estimator.low.is_finite() && estimator.high.is_finite() && estimator.low <= estimator.high
}

/// K10. Other settings take a running law over, lag form, two regressors: whatever the sample,
/// the command that is out stays, from which a slew rate goes on, and the state is valid.
///
/// Assumes: nothing of gains or sample; a state of any finite numbers, any z for the one that
/// is searched.
#[kani::proof]
#[kani::unwind(3)]
#[kani::stub(Adaptive::z_that_gives, any_z)]
fn hand_over() {
    let form = Form::Lag {
        step: kani::any(),
        plant_gain: kani::any(),
    };
    let law = law::<2>(form, SmoothSign::Tanh);
    let settings = &law.settings;
    let [first, second] = &settings.theta;
    kani::assume(settings.z_limit > 0.0);
    kani::assume(is_a_box(&settings.beta) && is_a_box(&settings.delta));
    kani::assume(is_a_box(first) && is_a_box(second));
    let (mut state, input): (AdaptiveState<f32, 2>, _) = (finite_state(), input());
    let before = state;
    let kept = a_hand_over_keeps_the_command(&law, &mut state, &input);
    kani::cover!(state.z.value > before.z.value && state.lag != before.lag);
    kani::cover!(state.command() != before.command());
    assert!(kept);
}
