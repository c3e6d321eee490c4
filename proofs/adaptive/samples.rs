//! K1, K4, K5: any sample, any gains, any valid state.
//!
//! [`estimates`](super::estimates) proves that one estimate keeps its box whatever drives it;
//! here the update returns anything that this leaves, and the virtual command anything at
//! all. So the claims rest on the checks of the step, not on its arithmetic.

use super::super::compensated::Compensated;
use super::super::{Adaptive, AdaptiveInput, AdaptiveTerms, Estimator, Form, SmoothSign};
use super::state::{input, law, state};
use crate::control::Limits;
use crate::proofs::properties::control::{adaptive_commands_within_its_limits, follows};
use crate::proofs::{limited, stubs};
use crate::signal::{Derivative, DerivativeState};
use crate::Real;

/// What `estimate_in_its_box` proves of an update, and no more.
fn any_update<T: Real>(
    estimator: &Estimator<T>,
    _: Compensated<T>,
    _: T,
    _: T,
) -> Option<Compensated<T>> {
    let sum = Compensated {
        value: T::of(kani::any()),
        carry: T::of(kani::any()),
    };
    kani::assume(estimator.holds(&sum));
    kani::any::<bool>().then_some(sum)
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
    kani::cover!(state.held.bad == 0 && state.beta.value != before.beta.value);
    kani::cover!(input.measured.is_nan() && state.held.command != before.held.command);
    assert!(kept);
}

/// K1, K4, K5. Lag form, two regressors: for any sample the command is finite, within its
/// limits and its slew rate, the state stays valid; a bad sample leaves the state, and the
/// command or the safe one is out; none is good with dt ≤ 0 or a number that is not finite.
///
/// Assumes: nothing of gains, sample or valid state; the update of an estimate as proved by
/// estimate_in_its_box, the limits as by slew_limit_any_rate, any virtual command.
#[kani::proof]
#[kani::unwind(3)]
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
#[kani::unwind(3)]
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
/// estimate as proved by estimate_in_its_box, the limits as by slew_limit_any_rate, the
/// virtual command as by a_bad_rate_shows.
#[kani::proof]
#[kani::unwind(3)]
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
