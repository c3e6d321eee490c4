//! K1, K4, K5: any sample, any gains, any valid state.
//!
//! [`estimates`](super::estimates) proves that one estimate keeps its box whatever drives it;
//! here the update returns anything that this leaves, and s, the lag and the rate are anything at
//! all. So the claims rest on the checks of the step, not on its arithmetic.

use super::super::state::End;
use super::super::step::{Estimates, Evaluated};
use super::super::{Adaptive, AdaptiveInput, AdaptiveState, AdaptiveTerms};
use super::super::{Estimator, Form, SmoothSign};
use super::state::{any_state, drive, input, law, state};
use crate::control::Limits;
use crate::proofs::properties::control::{
    adaptive_commands_within_its_limits, adaptive_commands_within_its_limits_from_any_state,
    follows,
};
use crate::proofs::{limited, stubs};
use crate::signal::{Compensated, Derivative, DerivativeState};
use crate::Real;

/// What `estimate_in_its_box` proves of an update, and no more.
fn any_update<T: Real>(estimator: &Estimator<T>, _: Compensated<T>, _: T, _: T) -> Compensated<T> {
    let sum = Compensated {
        value: T::from_f64(kani::any()),
        carry: T::from_f64(kani::any()),
    };
    kani::assume(estimator.holds(&sum) || !sum.carry.is_finite());
    sum
}

/// Any rate, NaN included, and any finite last sample, for the filter keeps no other; or the
/// memory as it was.
fn any_rate<T: Real>(_: &Derivative<T>, state: &mut DerivativeState<T>, _: T, _: T) -> T {
    let last = T::from_f64(kani::any());
    if last.is_finite() && kani::any() {
        *state = DerivativeState::at(last, T::from_f64(kani::any()));
    }
    state.rate()
}

/// The same for the filter's own function.
fn any_followed<T: Real>(filter: &Derivative<T>, state: &mut DerivativeState<T>, x: T, dt: T) {
    let _ = any_rate(filter, state, x, dt);
}

/// What `a_bad_rate_shows` proves of the literal form's virtual command, and no more.
fn any_command_of_a_rate<T: Real, const N: usize>(
    _: &Adaptive<T, N>,
    terms: &AdaptiveTerms<T, N>,
    _: &AdaptiveInput<T, N>,
) -> T {
    let command = T::from_f64(kani::any());
    kani::assume(!command.is_finite() || terms.error_rate.is_finite());
    command
}

/// Any s, any lag and any filtered rate. Of what the law computes here, only the error is the
/// step's, and so is what goes out: the lag and the feed-forward.
fn any_law<T: Real, const N: usize>(
    _: &Adaptive<T, N>,
    state: &AdaptiveState<T, N>,
    input: &AdaptiveInput<T, N>,
) -> Evaluated<T, N> {
    let lag = any_sum();
    let mut error_rate = state.error_rate;
    let _ = any_rate(
        &Derivative::assumed(T::ONE),
        &mut error_rate,
        T::ONE,
        T::ONE,
    );
    let terms = AdaptiveTerms {
        error: input.measured - input.reference,
        s: T::from_f64(kani::any()),
        law: lag.value,
        unlimited: lag.value + input.feed_forward,
        ..AdaptiveTerms::at_rest(state)
    };
    Evaluated {
        terms,
        error_rate,
        lag,
    }
}

/// The same of the lag form, which leaves the rate as it is.
fn any_lag<T: Real, const N: usize>(
    law: &Adaptive<T, N>,
    state: &AdaptiveState<T, N>,
    input: &AdaptiveInput<T, N>,
) -> Evaluated<T, N> {
    Evaluated {
        error_rate: state.error_rate,
        ..any_law(law, state, input)
    }
}

/// The same of the literal form, as far as `a_command_has_a_rate` leaves it free.
fn any_literal<T: Real, const N: usize>(
    law: &Adaptive<T, N>,
    state: &AdaptiveState<T, N>,
    input: &AdaptiveInput<T, N>,
) -> Evaluated<T, N> {
    let of = any_law(law, state, input);
    kani::assume(!of.terms.unlimited.is_finite() || of.error_rate.is_finite());
    of
}

/// Any sum that, where it is no number, has lost none: that much `a_sum_and_what_it_lost` proves.
fn any_plus<T: Real>(_: Compensated<T>, _: T) -> Compensated<T> {
    let sum = any_sum::<T>();
    kani::assume(sum.value.is_finite() || !sum.carry.is_finite());
    sum
}

/// Any estimates that `any_update` admits.
fn any_estimates<T: Real, const N: usize>(
    law: &Adaptive<T, N>,
    state: &AdaptiveState<T, N>,
    _: &AdaptiveInput<T, N>,
    _: &AdaptiveTerms<T, N>,
) -> Estimates<T, N> {
    let settings = &law.settings;
    let any = |estimator| any_update(estimator, state.z, T::ZERO, T::ZERO);
    let theta = core::array::from_fn(|i| any(&settings.theta[i]));
    (any(&settings.beta), any(&settings.delta), theta)
}

/// Whether a command, and the state with it, is what `step` takes for good.
fn is_good<const N: usize>(
    law: &Adaptive<f32, N>,
    [before, after]: [&AdaptiveState<f32, N>; 2],
    input: &AdaptiveInput<f32, N>,
    (frozen, command): (bool, f32),
) -> bool {
    let limits = &law.settings.limits;
    let mut held = before.held;
    held.command = command;
    let waits = before.beta == after.beta && before.delta == after.delta;
    let wait = waits && before.theta == after.theta;
    can_be_used(law, input)
        && limits.contains(command)
        && follows(limits, before.held.command, command, input.dt)
        && after.held == held
        && (wait || !frozen)
        && law.is_valid(after)
}

/// Whether every number of the sample is one, and `dt` one of the law's.
fn can_be_used<T: Real, const N: usize>(law: &Adaptive<T, N>, input: &AdaptiveInput<T, N>) -> bool {
    let numbers = [
        input.reference,
        input.next_reference,
        input.measured,
        input.feed_forward,
    ];
    let finite = |x: &T| x.is_finite();
    input.dt > T::ZERO
        && input.dt <= law.longest
        && numbers.iter().all(finite)
        && input.regressors.iter().all(finite)
}

/// The numbers of a state as bits.
fn bits<const N: usize>(state: &AdaptiveState<f32, N>) -> (AdaptiveState<f32, N>, u32, u32) {
    let Compensated { value, carry } = state.lag;
    let lag = Compensated::new(0.0);
    let rest = AdaptiveState { lag, ..*state };
    (rest, value.to_bits(), carry.to_bits())
}

fn advance_any_sample(form: Form<f32>) {
    let law = law::<2>(form, SmoothSign::Tanh);
    // After a return from the safe command the lag may have overflowed.
    let lag = any_sum();
    let before = AdaptiveState { lag, ..state(&law) };
    let (mut after, input, frozen) = (before, input(), kani::any());
    let command = law.advance(&mut after, &input, frozen, drive());
    kani::cover!(command.is_some() && after.beta.value != before.beta.value);
    kani::cover!(command.is_none() && can_be_used(&law, &input));
    let kept = match command {
        Some(command) => is_good(&law, [&before, &after], &input, (frozen, command)),
        None => bits(&before) == bits(&after),
    };
    assert!(kept);
}

/// K1, K4, K5. First-order form, two regressors: if the law gives a command, the numbers of the
/// sample are usable, the command is within the limits and the slew-rate limit, and the state stays
/// valid, with unchanged estimates if they are frozen. If the law gives no command, nothing
/// changes.
///
/// Assumes: nothing about gains, sample or valid state, for any lag; the update of an estimate as
/// proved by estimate_in_its_box, the rounding error of a sum as proved by a_sum_and_what_it_lost,
/// the limits as proved by slew_limit_any_rate; any s and any lag afterwards.
#[kani::proof]
#[kani::unwind(5)]
#[kani::stub(Compensated::plus, any_plus)]
#[kani::stub(Adaptive::evaluated, any_lag)]
#[kani::stub(Adaptive::adapted, any_estimates)]
#[kani::stub(Limits::apply, limited::apply)]
#[kani::stub(follows, limited::follows)]
fn lag_advance() {
    let form = Form::FirstOrder {
        step: kani::any(),
        plant_gain: kani::any(),
    };
    advance_any_sample(form);
}

/// K1, K5. The same as lag_advance for the form as published.
///
/// Assumes: the same as lag_advance; the filtered rate as proved by a_command_has_a_rate.
#[kani::proof]
#[kani::unwind(5)]
#[kani::stub(Compensated::plus, any_plus)]
#[kani::stub(Adaptive::evaluated, any_literal)]
#[kani::stub(Adaptive::adapted, any_estimates)]
#[kani::stub(Limits::apply, limited::apply)]
#[kani::stub(follows, limited::follows)]
fn literal_advance() {
    let time_constant = kani::any();
    advance_any_sample(Form::AsPublished { time_constant });
}

/// What `lag_advance` and `literal_advance` prove, and no more.
fn any_advance<T: Real, const N: usize>(
    law: &Adaptive<T, N>,
    state: &mut AdaptiveState<T, N>,
    input: &AdaptiveInput<T, N>,
    frozen: bool,
    _: Option<End>,
) -> Option<T> {
    if !can_be_used(law, input) || kani::any() {
        return None;
    }
    let (limits, last) = (&law.settings.limits, state.held.command);
    let asked = kani::any();
    let wanted = T::from_f64(f64::from(kani::any::<f32>()));
    let command = if asked {
        limits.apply(last, wanted, input.dt)
    } else {
        wanted
    };
    kani::assume(limits.contains(command) && (asked || limits.slew().is_none()));
    let (beta, delta, theta) = if frozen {
        (state.beta, state.delta, state.theta)
    } else {
        (any_sum(), any_sum(), core::array::from_fn(|_| any_sum()))
    };
    let rate = DerivativeState::at(T::from_f64(kani::any()), T::from_f64(kani::any()));
    let mut held = state.held;
    held.command = command;
    *state = AdaptiveState {
        z: any_sum(),
        error_rate: if kani::any() {
            rate
        } else {
            DerivativeState::new()
        },
        lag: any_sum(),
        beta,
        delta,
        theta,
        held,
        gap: T::ZERO,
        drive: state.drive,
    };
    kani::assume(law.is_valid(state));
    Some(command)
}

/// Where a return from the safe command starts: any z of its box, and any lag.
fn any_start<T: Real, const N: usize>(
    law: &Adaptive<T, N>,
    state: &mut AdaptiveState<T, N>,
    _: &AdaptiveInput<T, N>,
) {
    let z = T::from_f64(kani::any());
    kani::assume(z.abs() <= law.settings.z_limit);
    state.z = Compensated::new(z);
    state.error_rate = DerivativeState::new();
    state.gap = T::ZERO;
    state.lag = any_sum();
}

fn any_sample<const N: usize>(form: Form<f32>) {
    let law = law::<N>(form, SmoothSign::Tanh);
    let (mut state, input) = (state(&law), input());
    let before = state;
    let kept = adaptive_commands_within_its_limits(&law, &mut state, &input);
    kani::cover!(!state.held.is_latched() && state.beta.value != before.beta.value);
    kani::cover!(input.measured.is_nan() && state.held.command != before.held.command);
    assert!(kept);
}

/// K1, K4, K5. First-order form, two regressors: for any sample the command is finite and within
/// its limits and its slew-rate limit, and the state stays valid. A bad sample leaves the state
/// unchanged, and either the last command or the safe command is applied. No sample counts as good
/// if dt ≤ 0 or a number is not finite.
///
/// Assumes: nothing about gains, sample or valid state; a command and its state as proved by
/// lag_advance.
#[kani::proof]
#[kani::unwind(5)]
#[kani::stub(Adaptive::advance, any_advance)]
#[kani::stub(Limits::apply, limited::apply)]
#[kani::stub(follows, limited::follows)]
fn lag_any_sample() {
    let form = Form::FirstOrder {
        step: kani::any(),
        plant_gain: kani::any(),
    };
    any_sample::<2>(form);
}

/// K1. Form as published, two regressors: if the error's rate is not finite, the virtual command is
/// not finite either, and the step refuses the sample.
#[kani::proof]
#[kani::unwind(5)]
fn a_bad_rate_shows() {
    let time_constant = kani::any();
    let law = law::<2>(Form::AsPublished { time_constant }, SmoothSign::Clamp);
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

/// K1. Form as published, two regressors: if the law's command is finite, so is the stored filtered
/// rate.
///
/// Assumes: nothing about gains; a sample with a finite error, as the step has checked; a valid
/// state, any filtered rate, the virtual command as proved by a_bad_rate_shows, beta_hat above zero
/// as its bounds require.
#[kani::proof]
#[kani::unwind(5)]
#[kani::stub(libm::tanhf, stubs::tanhf)]
#[kani::stub(Derivative::follow, any_followed)]
#[kani::stub(Adaptive::virtual_command, any_command_of_a_rate)]
fn a_command_has_a_rate() {
    let time_constant = kani::any();
    let law = law::<2>(Form::AsPublished { time_constant }, SmoothSign::Tanh);
    let (state, input) = (state(&law), input());
    kani::assume(law.settings.beta.low > 0.0);
    kani::assume((input.measured - input.reference).is_finite());
    let of = law.evaluated(&state, &input);
    kani::cover!(of.error_rate != state.error_rate && of.terms.unlimited == 3.0);
    kani::cover!(!of.error_rate.is_finite());
    assert!(!of.terms.unlimited.is_finite() || of.error_rate.is_finite());
}

/// K1, K5. The same as lag_any_sample for the form as published.
///
/// Assumes: nothing about gains, sample or valid state; a command and its state as proved by
/// literal_advance; for the start of a return, any z within its bounds, as proved by
/// hand_over_literal.
#[kani::proof]
#[kani::unwind(5)]
#[kani::stub(Adaptive::advance, any_advance)]
#[kani::stub(Adaptive::settle, any_start)]
#[kani::stub(Limits::apply, limited::apply)]
#[kani::stub(follows, limited::follows)]
fn literal_any_sample() {
    let time_constant = kani::any();
    any_sample::<2>(Form::AsPublished { time_constant });
}

/// Any z, NaN included, for what the search of a return finds.
fn any_z<T: Real, const N: usize>(
    _: &Adaptive<T, N>,
    _: T,
    _: &AdaptiveState<T, N>,
    _: &AdaptiveInput<T, N>,
) -> T {
    T::from_f64(kani::any())
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

/// K15. First-order form, two regressors, from any state with any bits: the command is finite and
/// within the limits, and a latched safe command stays applied.
///
/// Assumes: nothing about gains, sample or state; the limits as proved by slew_limit_any_rate, any
/// s and any lag, any estimates.
#[kani::proof]
#[kani::unwind(5)]
#[kani::stub(Compensated::plus, any_plus)]
#[kani::stub(Adaptive::evaluated, any_lag)]
#[kani::stub(Adaptive::adapted, any_sums)]
#[kani::stub(Limits::apply, limited::apply)]
fn lag_from_any_state() {
    let form = Form::FirstOrder {
        step: kani::any(),
        plant_gain: kani::any(),
    };
    from_any_state(form);
}

/// K15. The same for the form as published.
///
/// Assumes: the same as lag_from_any_state; any filtered rate, any z as the result of the search of
/// a return.
#[kani::proof]
#[kani::unwind(5)]
#[kani::stub(Compensated::plus, any_plus)]
#[kani::stub(Adaptive::evaluated, any_law)]
#[kani::stub(Adaptive::adapted, any_sums)]
#[kani::stub(Adaptive::z_that_gives, any_z)]
#[kani::stub(Limits::apply, limited::apply)]
fn literal_from_any_state() {
    let time_constant = kani::any();
    from_any_state(Form::AsPublished { time_constant });
}

/// Any sum: more than an update can give.
fn any_sum<T: Real>() -> Compensated<T> {
    Compensated {
        value: T::from_f64(kani::any()),
        carry: T::from_f64(kani::any()),
    }
}

/// Any estimates: more than their updates can give.
fn any_sums<T: Real, const N: usize>(
    _: &Adaptive<T, N>,
    _: &AdaptiveState<T, N>,
    _: &AdaptiveInput<T, N>,
    _: &AdaptiveTerms<T, N>,
) -> Estimates<T, N> {
    (any_sum(), any_sum(), core::array::from_fn(|_| any_sum()))
}
