//! Where limits, feed-forward, fallback and hand-over meet: one step, to the last digit.

use super::{lag, literal};
use bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, Estimator, Fallback, Fault, Leakage,
    Limits, Status,
};

/// Room for the rounding of a few sums and products of numbers up to 100.
const ROUNDING: f64 = 1e-12;

/// What the lag form's share of the command must be, from where the lag starts.
fn lagged(start: f64, beta_hat: f64, virtual_command: f64) -> f64 {
    start + 0.001 * 8.0 * (beta_hat * virtual_command - start)
}

#[test]
fn after_the_safe_command_the_lag_goes_on_from_it_less_the_feed_forward() {
    let settings = AdaptiveSettings {
        fallback: Fallback::try_new(3, -20.0).unwrap(),
        limits: Limits::try_new(-100.0, 100.0).unwrap(), // no slew rate that would hide a jump
        ..lag()
    };
    let law = Adaptive::try_new(settings).unwrap();
    let mut state = AdaptiveState::new(&law);
    let good = AdaptiveInput {
        feed_forward: 4.0,
        ..AdaptiveInput::new(0.001, 30.0, 29.9, [0.0])
    };
    for _ in 0..300 {
        law.step_with_terms(&mut state, &good);
    }
    let bad = AdaptiveInput {
        measured: f64::NAN,
        ..good
    };
    for _ in 0..3 {
        law.step(&mut state, &bad);
    }
    assert_eq!(state.command(), -20.0);
    state.acknowledge();
    let out = law.step_with_terms(&mut state, &good);
    assert_eq!(out.status, Status::Good);
    let expected = lagged(-24.0, out.terms.beta_hat, out.terms.virtual_command);
    assert!(
        (out.terms.law - expected).abs() < ROUNDING,
        "{:?}",
        out.terms
    );
}

#[test]
fn at_a_limit_the_accumulated_error_waits_on_the_error_and_the_estimates_wait_on_s() {
    for settings in [literal(), lag()] {
        // The error falls from 1 N·m to -0.1 N·m in 1.1 s: z is 0.5 N·m·s then.
        let free = Adaptive::try_new(settings).unwrap();
        let mut state = AdaptiveState::new(&free);
        for step in 0..1100 {
            let measured = 4.0 - 0.001 * f64::from(step);
            free.step_with_terms(&mut state, &AdaptiveInput::new(0.001, 3.0, measured, [0.3]));
        }
        let limits = Limits::try_new(-1.0, 1.0).unwrap();
        let law = Adaptive::try_new(AdaptiveSettings { limits, ..settings }).unwrap();
        let before = state;
        // e = -0.1 asks for less of what the limit cuts, s = -0.1 + 8·0.5 for more.
        let out = law.step_with_terms(&mut state, &AdaptiveInput::new(0.001, 3.0, 2.9, [0.3]));
        assert!(out.terms.limited && out.command == -1.0, "{out:?}");
        assert!(out.terms.error < 0.0 && out.terms.s > 0.0);
        let moved = state.accumulated_error() - before.accumulated_error();
        assert!((moved + 1e-4).abs() < ROUNDING, "{moved}");
        assert_eq!(state.beta_hat(), before.beta_hat());
        assert_eq!(state.delta_hat(), before.delta_hat());
        assert_eq!(state.theta_hat(), before.theta_hat());
    }
}

#[test]
fn at_a_limit_the_lag_keeps_the_command_less_the_feed_forward() {
    let limits = Limits::try_new(-5.0, 5.0).unwrap();
    let law = Adaptive::try_new(AdaptiveSettings { limits, ..lag() }).unwrap();
    let mut state = AdaptiveState::new(&law);
    let at = AdaptiveInput {
        feed_forward: 4.0,
        ..AdaptiveInput::new(0.001, 30.0, 20.0, [0.0])
    };
    assert!(law.step_with_terms(&mut state, &at).terms.limited);
    assert_eq!(state.command(), 5.0);
    let terms = law.step_with_terms(&mut state, &at).terms;
    // The law's share of the 5 that are out is 1.
    let expected = lagged(1.0, terms.beta_hat, terms.virtual_command);
    assert!((terms.law - expected).abs() < ROUNDING, "{terms:?}");
}

#[test]
fn a_switching_leakage_is_the_same_on_both_sides_of_the_prior() {
    let leakage = Leakage::Switching {
        rate: 0.5,
        bound: 2.0,
    };
    let leaked = |start: f64| {
        let delta = Estimator {
            leakage,
            prior: 10.0,
            ..Estimator::free(start)
        };
        let law = Adaptive::try_new(AdaptiveSettings { delta, ..literal() }).unwrap();
        let mut state = AdaptiveState::new(&law);
        for _ in 0..1000 {
            law.step_with_terms(&mut state, &AdaptiveInput::new(0.001, 0.0, 0.0, [0.0]));
        }
        state.delta_hat() - 10.0
    };
    for distance in [2.5, 3.0, 8.0] {
        let (above, below) = (leaked(10.0 + distance), leaked(10.0 - distance));
        assert!(above < distance - 0.05, "{above}");
        assert!((above + below).abs() < ROUNDING, "{above} {below}");
    }
}

#[test]
fn a_literal_law_that_takes_over_does_not_take_the_old_rate_of_the_error() {
    let from = Adaptive::try_new(literal()).unwrap();
    let mut state = AdaptiveState::new(&from);
    // The error rises by 50 N·m/s: its rate, over lambda, is 6 N·m of the virtual command.
    for step in 0..20 {
        let measured = 3.0 + 0.05 * f64::from(step);
        from.step_with_terms(&mut state, &AdaptiveInput::new(0.001, 3.0, measured, [0.1]));
    }
    let before = state.command();
    let to = AdaptiveSettings {
        gain: 15.0,
        lambda: 5.0,
        ..literal()
    };
    let to = Adaptive::try_new(to).unwrap();
    let input = AdaptiveInput::new(0.001, 3.0, 4.0, [0.1]);
    to.bumpless_transfer(&mut state, &input);
    let out = to.step_with_terms(&mut state, &input);
    assert_eq!(out.terms.error_rate, 0.0);
    // z is found to its last bit, times k·lambda + 1/lambda = 75.
    assert!((out.command - before).abs() < 1e-11, "{out:?} {before}");
}

#[test]
fn a_lag_that_resumes_on_a_bad_sample_goes_on_from_the_command_that_is_out() {
    let law = Adaptive::try_new(lag()).unwrap();
    let good = AdaptiveInput::new(0.001, 30.0, 29.9, [0.0]);
    let bad = AdaptiveInput {
        feed_forward: f64::NAN,
        ..good
    };
    let mut state = AdaptiveState::resume_from(&law, 25.0, &bad);
    assert_eq!(state.command(), 25.0);
    let terms = law.step_with_terms(&mut state, &good).terms;
    let expected = lagged(25.0, terms.beta_hat, terms.virtual_command);
    assert!((terms.law - expected).abs() < ROUNDING, "{terms:?}");
}

/// A slew rate that cuts the command next to a feed-forward of the largest float's size: what the
/// lag would hold is beyond the float. The same where its sum owes no number.
#[test]
fn a_sample_that_the_lag_cannot_hold_overflows_and_leaves_a_valid_state() {
    let free = Limits::try_new(-1.7e308, 1.7e308).unwrap();
    let [free, slewed] = [free, free.with_slew(1.0).unwrap()]
        .map(|limits| Adaptive::try_new(AdaptiveSettings { limits, ..lag() }).unwrap());
    let at_rest = AdaptiveInput::new(0.001, 0.0, 0.0, [0.0]);
    let pushed = |feed_forward| AdaptiveInput {
        feed_forward,
        ..at_rest
    };
    let mut state = AdaptiveState::new(&free);
    assert_eq!(
        free.step(&mut state, &pushed(-1.7e308)).status,
        Status::Good
    );
    let status = slewed.step(&mut state, &pushed(1.7e308)).status;
    assert_eq!(status, Status::Held(Fault::Overflow));
    assert!(slewed.is_valid(&state));
    assert_eq!(slewed.step(&mut state, &at_rest).status, Status::Good);
}
