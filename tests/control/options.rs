//! What a PID may have besides its gains: a wrapped error, a deadband, a limit of the integral.

use super::*;

#[test]
fn a_heading_is_turned_the_short_way_round() {
    let pid = pid(2.0, 5.0, |s| s.period = Some(360.0));
    for (reference, measured, error) in [
        (1.0, 359.0, -2.0),
        (359.0, 1.0, 2.0),
        (10.0, 20.0, 10.0),
        (0.0, 725.0, 5.0), // more than one turn apart
        (-179.0, 179.0, -2.0),
    ] {
        let at = PidInput::new(DT, reference, measured);
        let terms = pid.step_with_terms(&mut PidState::new(), &at).terms;
        assert_eq!((terms.error, terms.proportional), (error, -2.0 * error));
        near(terms.integral, -5.0 * error * DT, 1e-15);
    }
}

#[test]
fn a_turn_of_the_sensor_does_not_kick_the_derivative() {
    for weight in [0.0, 1.0] {
        let pid = pid(0.0, 0.0, |s| {
            (s.k_d, s.damping) = (1.0, DerivativeSource::Rate { weight });
            s.period = Some(360.0);
        });
        let mut state = PidState::new();
        for k in 0..2000 {
            // 180 a second, through the wrap; the reference half as fast.
            let t = DT * f64::from(k);
            let at = PidInput::new(DT, (90.0 * t) % 360.0, (350.0 + 180.0 * t) % 360.0);
            let out = pid.step_with_terms(&mut state, &at);
            if k > 0 {
                // The quotient of two angles near 360, rounded like them over dt.
                near(out.terms.derivative, 90.0 * weight - 180.0, 1e-9);
            }
        }
    }
}

#[test]
fn a_wrapped_loop_reaches_its_reference_through_the_wrap() {
    let pid = pid(5.0, 2.0, |s| s.period = Some(360.0));
    let (mut state, mut angle, mut travel) = (PidState::new(), 359.0_f64, 0.0);
    for _ in 0..20_000 {
        let at = PidInput::new(DT, 1.0, angle.rem_euclid(360.0));
        let rate = pid.step(&mut state, &at).command;
        angle += DT * rate;
        travel += DT * rate.abs();
    }
    near(angle, 361.0, 1e-3);
    assert!(travel < 4.0, "{travel}");
}

/// Mass with static friction under a position loop: the integral hunts for ever, see K. Åström,
/// C. Canudas de Wit, "Revisiting the LuGre friction model", *IEEE Control Systems* 28(6), 2008.
fn reversals(deadband: f64) -> (u32, f64) {
    let pid = pid(3.0, 4.0, |s| (s.k_d, s.deadband) = (6.0, deadband));
    let (mut state, mut x, mut v) = (PidState::new(), 0.0, 0.0_f64);
    let (mut count, mut last) = (0, 0.0_f64);
    for k in 0..300_000 {
        let force = pid.step(&mut state, &PidInput::new(DT, 1.0, x)).command;
        // Sticks below 1.5, slides against 1.
        if v == 0.0 && force.abs() <= 1.5 {
            continue;
        }
        let way = if v == 0.0 { force.signum() } else { v.signum() };
        let next = v + DT * (force - way);
        v = if next * way <= 0.0 { 0.0 } else { next };
        x += DT * v;
        // Counted in the second half, when what is there stays.
        if v != 0.0 && v.signum() != last {
            (count, last) = (count + u32::from(k > 150_000), v.signum());
        }
    }
    (count, x)
}

#[test]
fn a_deadband_ends_the_hunting_of_static_friction() {
    let ((hunting, _), (still, end)) = (reversals(0.0), reversals(0.2));
    assert!(hunting > 5 && still == 0, "{hunting} {still}");
    assert!((end - 1.0).abs() <= 0.2, "{end}");
}

#[test]
fn within_the_deadband_the_integral_waits_and_outside_it_takes_the_whole_error() {
    let (pid, mut state) = (pid(1.0, 10.0, |s| s.deadband = 0.5), PidState::new());
    let out = pid.step_with_terms(&mut state, &PidInput::new(DT, 0.5, 0.0));
    assert_eq!((out.terms.integral, out.terms.proportional), (0.0, 0.5));
    pid.step(&mut state, &PidInput::new(DT, 0.51, 0.0));
    near(state.integral(), 0.0051, 1e-15);
    // An error that is no number does not hide in it.
    let held = pid.step(&mut state, &PidInput::new(DT, f64::NAN, 0.0));
    assert!(held.status.fault().is_some());
}

#[test]
fn the_integral_stops_at_its_own_limit_and_comes_back_from_it() {
    for anti_windup in WINDUPS {
        let pid = pid(1.0, 10.0, |s| {
            (s.integral_limit, s.anti_windup) = (Some(3.0), anti_windup);
            s.limits = range(-1000.0, 1000.0);
        });
        let mut state = PidState::new();
        let mut run = |reference, samples| {
            let at = PidInput::new(DT, reference, 0.0);
            for _ in 0..samples {
                pid.step(&mut state, &at);
            }
            state.integral()
        };
        assert_eq!(run(1.0, 1000), 3.0);
        near(run(-1.0, 1), 2.99, 1e-14);
        assert_eq!(run(-1.0, 1000), -3.0);
    }
}
