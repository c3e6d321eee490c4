//! Where limits, feed-forward, fallback and hand-over meet: one step, to the last digit.

use super::*;

#[test]
fn after_the_safe_command_the_lag_goes_on_from_it_less_the_feed_forward() {
    let law = law(lag(), |s| {
        s.fallback = Fallback::try_new(3, -20.0).unwrap();
        s.limits = range(-100.0, 100.0); // no slew rate that would hide a jump
    });
    let mut state = AdaptiveState::new(&law);
    let good = with(at(30.0, 29.9, 0.0), |at| at.feed_forward = 4.0);
    for k in 0..303 {
        law.step(&mut state, &if k < 300 { good } else { lost(good) });
    }
    assert_eq!(state.command(), -20.0);
    state.acknowledge();
    let out = law.step_with_terms(&mut state, &good);
    assert_eq!(out.status, Status::Good);
    near(out.terms.law, lagged(-24.0, &out.terms), ROUNDING);
}

#[test]
fn a_literal_law_that_takes_over_does_not_take_the_old_rate_of_the_error() {
    let from = law(literal(), |_| ());
    let mut state = AdaptiveState::new(&from);
    // The error rises by 50 N·m/s: its rate, over lambda, is 6 N·m of the virtual command.
    for step in 0..20 {
        from.step(&mut state, &at(3.0, 3.0 + 0.05 * f64::from(step), 0.1));
    }
    let (before, input) = (state.command(), at(3.0, 4.0, 0.1));
    let to = law(literal(), |s| (s.gain, s.lambda) = (15.0, 5.0));
    to.bumpless_transfer(&mut state, &input);
    let out = to.step_with_terms(&mut state, &input);
    assert_eq!(out.terms.error_rate, 0.0);
    // z is found to its last bit, times k·lambda + 1/lambda = 75.
    near(out.command, before, 1e-11);
}

#[test]
fn a_lag_that_resumes_on_a_bad_sample_goes_on_from_the_command_that_is_out() {
    let (law, good) = (law(lag(), |_| ()), at(30.0, 29.9, 0.0));
    let bad = with(good, |at| at.feed_forward = f64::NAN);
    let mut state = AdaptiveState::resume_from(&law, 25.0, &bad);
    assert_eq!(state.command(), 25.0);
    let terms = law.step_with_terms(&mut state, &good).terms;
    near(terms.law, lagged(25.0, &terms), ROUNDING);
}

/// A slew rate that cuts the command next to a feed-forward of the largest float's size: what the
/// lag would hold is beyond the float. The same where its sum owes no number.
#[test]
fn a_sample_that_the_lag_cannot_hold_overflows_and_leaves_a_valid_state() {
    let free = range(-1.7e308, 1.7e308);
    let [free, slewed] =
        [free, free.with_slew(1.0).unwrap()].map(|limits| law(lag(), |s| s.limits = limits));
    let pushed = |x| with(at(0.0, 0.0, 0.0), |at| at.feed_forward = x);
    let mut state = AdaptiveState::new(&free);
    let status = free.step(&mut state, &pushed(-1.7e308)).status;
    assert_eq!(status, Status::Good);
    let status = slewed.step(&mut state, &pushed(1.7e308)).status;
    assert_eq!(status, Status::Held(Fault::Overflow));
    assert!(slewed.is_valid(&state));
    assert_eq!(slewed.step(&mut state, &pushed(0.0)).status, Status::Good);
}
