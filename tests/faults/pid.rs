//! PI, PID, PIV.

use super::{fallback, limits, pi, DT, LONGEST};
use bowden::control::{Fault, Limits, Pid, PidInput, PidSettings, PidState, Status};

#[test]
fn a_wrapped_counter_is_no_sample() {
    let pid = Pid::try_new(pi()).unwrap();
    let mut state = PidState::new();
    let good = PidInput::new(DT, 1.0, 0.9);
    let before = pid.step(&mut state, &good).command;
    let integral = state.integral();
    let wrapped = PidInput { dt: 4295.0, ..good };
    let out = pid.step(&mut state, &wrapped);
    assert_eq!(out.status, Status::Held(Fault::DtTooLong));
    assert_eq!((out.command, state.integral()), (before, integral));
    // The longest that was stated is a sample.
    let late = PidInput {
        dt: LONGEST,
        ..good
    };
    assert_eq!(pid.step(&mut state, &late).status, Status::Good);
}

#[test]
fn a_gap_of_unknown_length_gives_no_rate() {
    // The signal moves by 1 while the clock is lost: over 1 ms that would be a rate of 1000.
    let pid = Pid::try_new(PidSettings { k_d: 1.0, ..pi() }).unwrap();
    for lost in [f64::NAN, -1.0, 4295.0] {
        let mut state = PidState::new();
        pid.step(&mut state, &PidInput::new(DT, 0.0, 0.0));
        pid.step(&mut state, &PidInput::new(lost, 0.0, 0.5));
        pid.step(&mut state, &PidInput::new(DT, 0.0, 1.0));
        assert_eq!(state.rate(), 0.0, "{lost}");
        pid.step(&mut state, &PidInput::new(DT, 0.0, 1.001));
        assert!((state.rate() - 1.0).abs() < 1e-9); // 0.001 in 1 ms, unfiltered
    }
}

#[test]
fn a_short_constructor_asks_for_limits_a_longest_dt_and_a_safe_command() {
    let short = pi();
    assert_eq!(short.limits, limits(60.0));
    assert_eq!(short.longest_dt, LONGEST);
    assert_eq!(short.fallback, fallback());
    // What has none of them says so by its name.
    let simulated = PidSettings::unlimited(3.0, 30.0);
    assert_eq!(simulated.limits, Limits::unlimited());
    assert_eq!(simulated.longest_dt, f64::MAX);
    assert_eq!(simulated.fallback.command(), None);
}
