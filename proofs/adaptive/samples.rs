//! K1, K4, K5: any sample, any gains, any valid state.
//!
//! [`estimates`](super::estimates) proves that one estimate keeps its box whatever drives it;
//! here the update returns anything that this leaves, and the virtual command anything at
//! all. So the claims rest on the checks of the step, not on its arithmetic.

use super::super::{Adaptive, AdaptiveInput, AdaptiveTerms, Estimator, Form, SmoothSign};
use super::estimates::any_lost;
use super::state::{any_state, input, law, state};
use crate::control::Limits;
use crate::proofs::properties::control::{
    adaptive_commands_within_its_limits, adaptive_commands_within_its_limits_from_any_state,
    follows,
};
use crate::proofs::{limited, stubs};
use crate::signal::{two_sum, Compensated, Derivative, DerivativeState};
use crate::Real;

/// What `estimate_in_its_box` proves of an update, and no more.
fn any_update<T: Real>(estimator: &Estimator<T>, _: Compensated<T>, _: T, _: T) -> Compensated<T> {
    let sum = Compensated {
        value: T::of(kani::any()),
        carry: T::of(kani::any()),
    };
    kani::assume(estimator.holds(&sum) || !sum.carry.is_finite());
    sum
}

/// Any virtual command, NaN included.
pub(super) fn any_virtual_command<T: Real, const N: usize>(
    _: &Adaptive<T, N>,
    _: &AdaptiveTerms<T, N>,
    _: &AdaptiveInput<T, N>,
) -> T {
    T::of(kani::any())
}

/// Any rate, NaN included, and any finite last sample, for the filter keeps no other; or the
/// memory as it was.
fn any_rate<T: Real>(_: &Derivative<T>, state: &mut DerivativeState<T>, _: T, _: T) -> T {
    let last = T::of(kani::any());
    if last.is_finite() && kani::any() {
        *state = DerivativeState::at(last, T::of(kani::any()));
    }
    state.rate()
}

/// What `a_bad_rate_shows` proves of the literal form's virtual command, and no more.
fn any_command_of_a_rate<T: Real, const N: usize>(
    _: &Adaptive<T, N>,
    terms: &AdaptiveTerms<T, N>,
    _: &AdaptiveInput<T, N>,
) -> T {
    let command = T::of(kani::any());
    kani::assume(!command.is_finite() || terms.error_rate.is_finite());
    command
}

fn any_sample<const N: usize>(form: Form<f32>, smooth_sign: SmoothSign) {
    let law = law::<N>(form, smooth_sign);
    let (mut state, input) = (state(&law), input());
    let before = state;
    let kept = adaptive_commands_within_its_limits(&law, &mut state, &input);
    kani::cover!(state.held.is_closed() && state.beta.value != before.beta.value);
    kani::cover!(input.measured.is_nan() && state.held.command != before.held.command);
    assert!(kept);
}

/// K1, K4, K5. Lag form, two regressors: for any sample the command is finite, within its
/// limits and its slew rate, the state stays valid; a bad sample leaves the state, and the
/// command or the safe one is out; none is good with dt ≤ 0 or a number that is not finite.
///
/// Assumes: nothing of gains, sample or valid state; the update of an estimate as proved by
/// estimate_in_its_box, what a sum loses as by a_sum_and_what_it_lost, the limits as by
/// slew_limit_any_rate, any virtual command.
#[kani::proof]
#[kani::unwind(5)]
#[kani::stub(two_sum, any_lost)]
#[kani::stub(libm::tanhf, stubs::tanhf)]
#[kani::stub(Estimator::update, any_update)]
#[kani::stub(Adaptive::virtual_command, any_virtual_command)]
#[kani::stub(Limits::apply, limited::apply)]
#[kani::stub(follows, limited::follows)]
fn lag_any_sample() {
    let form = Form::Lag {
        step: kani::any(),
        plant_gain: kani::any(),
    };
    any_sample::<2>(form, SmoothSign::Tanh);
}

/// K1. Literal form, two regressors: where the error's rate is not finite, the virtual
/// command is not either, and the step refuses the sample.
#[kani::proof]
#[kani::unwind(5)]
fn a_bad_rate_shows() {
    let time_constant = kani::any();
    let law = law::<2>(Form::Literal { time_constant }, SmoothSign::Clamp);
    let state = state(&law);
    let terms = AdaptiveTerms {
        error_rate: kani::any(),
        s: kani::any(),
        smooth_sign: kani::any(),
        ..AdaptiveTerms::at_rest(&state)
    };
    let command = law.virtual_command(&terms, &input());
    kani::cover!(terms.error_rate.is_infinite());
    assert!(terms.error_rate.is_finite() || !command.is_finite());
}

/// K1, K5. The literal form as the lag form above.
///
/// Assumes: nothing of gains, sample, valid state or filtered rate; the update of an
/// estimate as proved by estimate_in_its_box, what a sum loses as by a_sum_and_what_it_lost, the
/// limits as by slew_limit_any_rate, the virtual command as by a_bad_rate_shows.
#[kani::proof]
#[kani::unwind(5)]
#[kani::stub(two_sum, any_lost)]
#[kani::stub(libm::tanhf, stubs::tanhf)]
#[kani::stub(Derivative::step, any_rate)]
#[kani::stub(Estimator::update, any_update)]
#[kani::stub(Adaptive::virtual_command, any_command_of_a_rate)]
#[kani::stub(Limits::apply, limited::apply)]
#[kani::stub(follows, limited::follows)]
fn literal_any_sample() {
    let time_constant = kani::any();
    any_sample::<2>(Form::Literal { time_constant }, SmoothSign::Tanh);
}

/// Any z, NaN included, for what the search of a return finds.
fn any_z<T: Real, const N: usize>(
    _: &Adaptive<T, N>,
    _: T,
    _: &crate::control::AdaptiveState<T, N>,
    _: &AdaptiveInput<T, N>,
) -> T {
    T::of(kani::any())
}

fn from_any_state(form: Form<f32>) {
    let law = law::<2>(form, SmoothSign::Tanh);
    let (mut state, input) = (any_state(), input());
    let before = state;
    let kept = adaptive_commands_within_its_limits_from_any_state(&law, &mut state, &input);
    kani::cover!(before.command().is_nan() && input.dt == 0.001);
    kani::cover!(before.is_latched());
    assert!(kept);
}

/// K15. Lag form, two regressors, from any state of whatever bits: the command is finite and
/// within the limits, and a safe command that is latched stays out.
///
/// Assumes: nothing of gains, sample or state; the limits as by slew_limit_any_rate, any
/// virtual command, any sum of an estimate.
#[kani::proof]
#[kani::unwind(5)]
#[kani::stub(libm::tanhf, stubs::tanhf)]
#[kani::stub(Estimator::update, any_sum)]
#[kani::stub(Adaptive::virtual_command, any_virtual_command)]
#[kani::stub(Limits::apply, limited::apply)]
fn lag_from_any_state() {
    let form = Form::Lag {
        step: kani::any(),
        plant_gain: kani::any(),
    };
    from_any_state(form);
}

/// K15. The same of the literal form.
///
/// Assumes: as lag_from_any_state; any filtered rate, any z for the one that a return searches.
#[kani::proof]
#[kani::unwind(5)]
#[kani::stub(libm::tanhf, stubs::tanhf)]
#[kani::stub(Derivative::step, any_rate)]
#[kani::stub(Estimator::update, any_sum)]
#[kani::stub(Adaptive::virtual_command, any_virtual_command)]
#[kani::stub(Adaptive::z_that_gives, any_z)]
#[kani::stub(Limits::apply, limited::apply)]
fn literal_from_any_state() {
    let time_constant = kani::any();
    from_any_state(Form::Literal { time_constant });
}

/// Any sum: more than an update can give.
fn any_sum<T: Real>(_: &Estimator<T>, _: Compensated<T>, _: T, _: T) -> Compensated<T> {
    Compensated {
        value: T::of(kani::any()),
        carry: T::of(kani::any()),
    }
}
