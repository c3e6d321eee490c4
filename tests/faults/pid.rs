//! PI, PID, PIV.

use super::*;

#[test]
fn a_wrapped_counter_is_no_sample() {
    let (pid, mut state) = (pid(|_| ()), PidState::new());
    let good = PidInput::new(DT, 1.0, 0.9);
    let before = pid.step(&mut state, &good).command;
    let integral = state.integral();
    let out = pid.step(&mut state, &with(good, |at| at.dt = 4295.0));
    assert_eq!(out.status, Status::Held(Fault::DtTooLong));
    assert_eq!((out.command, state.integral()), (before, integral));
    // The longest that was stated is a sample.
    let late = with(good, |at| at.dt = LONGEST);
    assert_eq!(pid.step(&mut state, &late).status, Status::Good);
}

#[test]
fn a_gap_of_unknown_length_gives_no_rate() {
    // The signal moves by 1 while the clock is lost: over 1 ms that would be a rate of 1000.
    let pid = pid(|s| s.k_d = 1.0);
    for lost in [f64::NAN, -1.0, 4295.0] {
        let mut state = PidState::new();
        for (dt, y) in [(DT, 0.0), (lost, 0.5), (DT, 1.0)] {
            pid.step(&mut state, &PidInput::new(dt, 0.0, y));
        }
        assert_eq!(state.rate(), 0.0, "{lost}");
        pid.step(&mut state, &PidInput::new(DT, 0.0, 1.001));
        near(state.rate(), 1.0, 1e-9); // 0.001 in 1 ms, unfiltered
    }
}

/// What has no limits, no longest dt and no safe command says so by its name.
#[test]
fn a_short_constructor_asks_for_limits_a_longest_dt_and_a_safe_command() {
    let simulated = PidSettings::unlimited(3.0, 30.0);
    assert_eq!(simulated.limits, Limits::unlimited());
    assert_eq!(simulated.longest_dt, f64::MAX);
    assert_eq!(simulated.fallback.command(), None);
}
