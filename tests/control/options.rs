//! What a PID may have besides its gains: a wrapped error, a deadband, a limit of the integral.

use bowden::control::{
    AntiWindup, DerivativeSource, Fallback, Limits, Pid, PidInput, PidSettings, PidState,
};
use bowden::Error;

const DT: f64 = 1e-3;

fn settings(k_p: f64, k_i: f64) -> PidSettings<f64> {
    let limits = Limits::try_new(-1000.0, 1000.0).unwrap();
    PidSettings::new(k_p, k_i, limits, 0.005, Fallback::try_new(20, 0.0).unwrap())
}

fn refused(settings: PidSettings<f64>) -> Error {
    Pid::try_new(settings).unwrap_err()
}

#[test]
fn a_heading_is_turned_the_short_way_round() {
    let pid = Pid::try_new(PidSettings {
        period: Some(360.0),
        ..settings(2.0, 5.0)
    })
    .unwrap();
    for (reference, measured, error) in [
        (1.0, 359.0, -2.0),
        (359.0, 1.0, 2.0),
        (10.0, 20.0, 10.0),
        (0.0, 725.0, 5.0), // more than one turn apart
        (-179.0, 179.0, -2.0),
    ] {
        let out = pid.step_with_terms(
            &mut PidState::new(),
            &PidInput::new(DT, reference, measured),
        );
        assert_eq!(out.terms.error, error);
        assert_eq!(out.terms.proportional, -2.0 * error);
        assert!((out.terms.integral + 5.0 * error * DT).abs() < 1e-15);
    }
}

#[test]
fn a_turn_of_the_sensor_does_not_kick_the_derivative() {
    for weight in [0.0, 1.0] {
        let pid = Pid::try_new(PidSettings {
            k_d: 1.0,
            damping: DerivativeSource::Rate { weight },
            period: Some(360.0),
            ..settings(0.0, 0.0)
        })
        .unwrap();
        let mut state = PidState::new();
        for k in 0..2000 {
            // 180 a second, through the wrap; the reference half as fast.
            let t = DT * f64::from(k);
            let at = PidInput::new(DT, (90.0 * t) % 360.0, (350.0 + 180.0 * t) % 360.0);
            let out = pid.step_with_terms(&mut state, &at);
            if k > 0 {
                // The quotient of two angles near 360, rounded like them over dt.
                assert!((out.terms.derivative + 180.0 - 90.0 * weight).abs() < 1e-9);
            }
        }
    }
}

/// A closed loop through the wrap: it turns by 2, not by 358.
#[test]
fn a_wrapped_loop_reaches_its_reference_through_the_wrap() {
    let pid = Pid::try_new(PidSettings {
        period: Some(360.0),
        ..settings(5.0, 2.0)
    })
    .unwrap();
    let (mut state, mut angle, mut travel) = (PidState::new(), 359.0_f64, 0.0);
    for _ in 0..20_000 {
        let measured = angle.rem_euclid(360.0);
        let rate = pid
            .step(&mut state, &PidInput::new(DT, 1.0, measured))
            .command;
        angle += DT * rate;
        travel += DT * rate.abs();
    }
    assert!(
        (angle - 361.0).abs() < 1e-3 && travel < 4.0,
        "{angle} {travel}"
    );
}

/// Mass with static friction under a position loop: the integral hunts for ever, see K. Åström,
/// C. Canudas de Wit, "Revisiting the LuGre friction model", *IEEE Control Systems* 28(6), 2008.
fn reversals(deadband: f64) -> (u32, f64) {
    let pid = Pid::try_new(PidSettings {
        k_d: 6.0,
        deadband,
        ..settings(3.0, 4.0)
    })
    .unwrap();
    let (mut state, mut x, mut v, mut count, mut last) =
        (PidState::new(), 0.0, 0.0_f64, 0, 0.0_f64);
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
    let (hunting, _) = reversals(0.0);
    let (still, end) = reversals(0.2);
    assert!(hunting > 5, "{hunting}");
    assert_eq!(still, 0);
    assert!((end - 1.0).abs() <= 0.2, "{end}");
}

#[test]
fn within_the_deadband_the_integral_waits_and_outside_it_takes_the_whole_error() {
    let pid = Pid::try_new(PidSettings {
        deadband: 0.5,
        ..settings(1.0, 10.0)
    })
    .unwrap();
    let mut state = PidState::new();
    let out = pid.step_with_terms(&mut state, &PidInput::new(DT, 0.5, 0.0));
    assert_eq!((out.terms.integral, out.terms.proportional), (0.0, 0.5));
    pid.step(&mut state, &PidInput::new(DT, 0.51, 0.0));
    assert!((state.integral() - 0.0051).abs() < 1e-15);
    // An error that is no number does not hide in it.
    let held = pid.step(&mut state, &PidInput::new(DT, f64::NAN, 0.0));
    assert!(held.status.fault().is_some());
}

#[test]
fn the_integral_stops_at_its_own_limit_and_comes_back_from_it() {
    for anti_windup in [
        AntiWindup::None,
        AntiWindup::Clamp,
        AntiWindup::Conditional,
        AntiWindup::BackCalculation { tracking_time: 0.1 },
    ] {
        let pid = Pid::try_new(PidSettings {
            integral_limit: Some(3.0),
            anti_windup,
            ..settings(1.0, 10.0)
        })
        .unwrap();
        let mut state = PidState::new();
        for _ in 0..1000 {
            pid.step(&mut state, &PidInput::new(DT, 1.0, 0.0));
        }
        assert_eq!(state.integral(), 3.0);
        pid.step(&mut state, &PidInput::new(DT, -1.0, 0.0));
        assert!((state.integral() - 2.99).abs() < 1e-14);
        for _ in 0..1000 {
            pid.step(&mut state, &PidInput::new(DT, -1.0, 0.0));
        }
        assert_eq!(state.integral(), -3.0);
    }
}

#[test]
fn options_that_make_no_sense_are_refused_by_name() {
    let plain = settings(1.0, 1.0);
    for (period, error) in [
        (0.0, Error::OutOfRange("period")),
        (-1.0, Error::OutOfRange("period")),
        (f64::NAN, Error::NonFinite("period")),
    ] {
        let period = Some(period);
        assert_eq!(refused(PidSettings { period, ..plain }), error);
    }
    assert_eq!(
        refused(PidSettings {
            period: Some(360.0),
            setpoint_weight: 0.5,
            ..plain
        })
        .parameter(),
        "with a period: setpoint_weight 1, derivative weight 0 or 1"
    );
    for (deadband, error) in [
        (-0.1, Error::OutOfRange("deadband")),
        (f64::INFINITY, Error::NonFinite("deadband")),
    ] {
        assert_eq!(refused(PidSettings { deadband, ..plain }), error);
    }
    for (limit, error) in [
        (0.0, Error::OutOfRange("integral_limit")),
        (f64::NAN, Error::NonFinite("integral_limit")),
    ] {
        let integral_limit = Some(limit);
        assert_eq!(
            refused(PidSettings {
                integral_limit,
                ..plain
            }),
            error
        );
    }
}

#[test]
fn by_default_a_step_of_the_reference_does_not_kick_the_derivative() {
    let pid = Pid::try_new(PidSettings {
        k_d: 2.0,
        derivative_time: 0.01,
        ..settings(3.0, 0.0)
    })
    .unwrap();
    let mut state = PidState::new();
    pid.step(&mut state, &PidInput::new(DT, 0.0, 0.0));
    assert_eq!(
        pid.step(&mut state, &PidInput::new(DT, 10.0, 0.0)).command,
        30.0
    );
}
