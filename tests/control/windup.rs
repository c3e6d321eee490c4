//! What the integral does while range or slew rate limit the command.

use super::*;

fn limited(anti_windup: AntiWindup<f64>, low: f64) -> (Pid<f64>, PidState<f64>) {
    let limits = range(low, 15.0);
    let change = |s: &mut PidSettings<f64>| (s.anti_windup, s.limits) = (anti_windup, limits);
    (pid(10.0, 20.0, change), PidState::new())
}

fn run(pid: &Pid<f64>, state: &mut PidState<f64>, error: f64, samples: u32) -> f64 {
    let at = PidInput::new(DT, 0.0, error);
    for _ in 0..samples {
        pid.step(state, &at);
    }
    state.command()
}

/// Samples until the command leaves its upper limit, after 1 s of windup with e = -2.
fn samples_to_leave(anti_windup: AntiWindup<f64>) -> u32 {
    let (pid, mut state) = limited(anti_windup, -5.0);
    assert_eq!(run(&pid, &mut state, -2.0, 1000), 15.0);
    (1..)
        .find(|_| run(&pid, &mut state, 0.5, 1) < 15.0)
        .unwrap()
}

#[test]
fn without_anti_windup_the_command_stays_at_its_limit_for_seconds() {
    // The integral reached 40; -k_p·e = -5 leaves 20 above the limit, -10/s unwinds it.
    let samples = samples_to_leave(AntiWindup::None);
    assert!((2000..=2002).contains(&samples), "{samples}");
}

#[test]
fn with_any_anti_windup_the_command_leaves_its_limit_with_the_sign_of_the_error() {
    let slow = AntiWindup::BackCalculation { tracking_time: 0.5 };
    for anti_windup in [AntiWindup::Clamp, AntiWindup::Conditional, slow] {
        assert_eq!(samples_to_leave(anti_windup), 1, "{anti_windup:?}");
    }
}

#[test]
fn clamp_keeps_the_integral_within_asymmetric_limits() {
    let (pid, mut state) = limited(AntiWindup::Clamp, -5.0);
    for (error, limit) in [(-2.0, 15.0), (2.0, -5.0)] {
        run(&pid, &mut state, error, 5000);
        assert_eq!(state.integral(), limit);
    }
}

#[test]
fn clamp_leaves_zero_to_the_integral_where_the_range_does_not_hold_it() {
    let (pid, mut state) = limited(AntiWindup::Clamp, 3.0);
    run(&pid, &mut state, 0.0, 3);
    assert_eq!((state.integral(), state.command()), (0.0, 3.0));
}

#[test]
fn conditional_stops_at_either_limit() {
    let (pid, mut state) = limited(AntiWindup::Conditional, -5.0);
    assert_eq!(run(&pid, &mut state, -2.0, 1000), 15.0);
    assert_eq!(state.integral(), 0.0); // -k_p·e alone was above the limit
    let mut state = PidState::new();
    assert_eq!(run(&pid, &mut state, 0.4, 2000), -5.0);
    // It filled up to the limit, -k_p·e being -4, and not a step further: 0.008 a step.
    assert!((-1.0..=-1.0 + 0.008).contains(&state.integral()));
    assert!(run(&pid, &mut state, -0.1, 1) > -1.0);
}

#[test]
fn what_back_calculation_returns_decays_with_the_tracking_time_at_any_rate() {
    // e = 0 and a feed-forward of 25 against a limit of 15: the excess is 10·(T_t/(T_t + dt))^k,
    // 10·e^(-t/T_t) where dt is short.
    let tracking_time = 0.2;
    for dt in [1e-4, 1e-3, 0.05, 0.3] {
        let (pid, mut state) = limited(AntiWindup::BackCalculation { tracking_time }, -5.0);
        let at = with(PidInput::new(dt, 1.0, 1.0), |at| at.feed_forward = 25.0);
        for k in 0..20 {
            let out = pid.step_with_terms(&mut state, &at);
            let excess = 10.0 * (tracking_time / (tracking_time + dt)).powi(k);
            // The rounding of a few sums of numbers around 25.
            near(out.terms.unlimited - out.command, excess, 1e-12);
        }
    }
}

#[test]
fn back_calculation_settles_where_the_error_and_the_excess_balance() {
    // Continuous: 0 = -k_i·e - excess/T_t. A sample of 1 ms changes that by dt/(2·T_t).
    let (pid, mut state) = limited(AntiWindup::BackCalculation { tracking_time: 0.1 }, -5.0);
    run(&pid, &mut state, -2.0, 5000);
    let excess = pid.terms(&state).unlimited - 15.0;
    near(excess, 20.0 * 2.0 * 0.1, 0.01 * excess);
}

#[test]
fn the_slew_rate_is_kept_and_seen_by_the_anti_windup() {
    let quick = AntiWindup::BackCalculation {
        tracking_time: 0.01,
    };
    for anti_windup in [AntiWindup::Conditional, quick] {
        let pid = pid(10.0, 20.0, |s| {
            s.anti_windup = anti_windup;
            s.limits = range(-100.0, 100.0).with_slew(50.0).unwrap();
        });
        let (mut state, mut last) = (PidState::new(), 0.0);
        for _ in 0..100 {
            let out = pid.step_with_terms(&mut state, &PidInput::new(DT, 4.0, 0.0));
            // 50/s for 1 ms, and an ulp of the command
            assert!((out.command - last).abs() <= 0.05 + 1e-14 && out.terms.saturated);
            last = out.command;
        }
        // Without it the integral would have taken 20·4·0.1 = 8. Conditional gives back over
        // k_p/k_i = 0.5 s: (40 - 50·t)/0.5 a second where 20·4 come in, which leaves 100·t²/2,
        // 0.5, and the 0.08 of the first sample.
        assert!(state.integral() <= 0.6, "{anti_windup:?}");
    }
}
