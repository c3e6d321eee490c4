//! What a law makes of what the drive did: off, limited, recovered, an inner loop at its limit.

use super::*;

fn law(k_p: f64, k_i: f64) -> Pid<f64> {
    pid(k_p, k_i, |s| s.limits = range(-20.0, 60.0))
}

#[test]
fn after_the_drive_was_off_the_command_starts_from_what_went_out() {
    for anti_windup in WINDUPS {
        let pid = pid(1.0, 10.0, |s| {
            s.limits = range(-20.0, 60.0).with_slew(100.0).unwrap();
            s.anti_windup = anti_windup;
        });
        let (mut state, mut y, mut most) = (PidState::new(), 0.0_f64, 0.0_f64);
        for k in 0..8000 {
            let last = state.command();
            let command = pid.step(&mut state, &PidInput::new(DT, 20.0, y)).command;
            // 100/s for 1 ms, and an ulp of 60.
            assert!((command - last).abs() <= 0.1 + 1e-14);
            let sent = if (2000..4000).contains(&k) {
                0.0
            } else {
                command
            };
            pid.applied(&mut state, Applied::Command(sent));
            y += DT * (sent - y) / 0.1;
            if k >= 4000 {
                most = most.max(y);
            }
        }
        // It comes back to the reference. With conditional integration and back-calculation the
        // integral kept the 20 that the load needs; the others are wound up by the slew rate.
        if !matches!(anti_windup, AntiWindup::None | AntiWindup::Clamp) {
            near(y, 20.0, 0.01);
            assert!(most < 24.0, "{anti_windup:?}: {most}");
        }
    }
}

/// A drive that gives 10 of the 40 that are wanted; then the reference falls.
fn falls_with_the_reference(told: Applied<f64>, anti_windup: AntiWindup<f64>) {
    let pid = pid(0.1, 10.0, |s| {
        s.limits = range(-20.0, 60.0);
        s.anti_windup = anti_windup;
    });
    let mut state = PidState::new();
    for _ in 0..5000 {
        if pid.step(&mut state, &PidInput::new(DT, 40.0, 10.0)).command > 10.0 {
            pid.applied(&mut state, told);
        }
    }
    // The other terms are 3; the integral holds at most what went out. Back-calculation lets it
    // run ahead by k_i·e·(T_t + dt), where the change and what flows back balance.
    let ahead = match (anti_windup, told) {
        (AntiWindup::BackCalculation { .. }, Applied::Command(_)) => 300.0 * 0.101,
        _ => 0.3,
    };
    let integral = state.integral();
    assert!(integral <= 10.0 + ahead, "{told:?}: {integral}");
    // The error turns by 5: the integral falls by 50 a second through the 0.3 that the terms
    // and the last change are above 10, and by what runs ahead of it, which flows back over
    // T_t: (27.3 + 5)·e^(-t/T_t) = 5 after 0.19 s.
    let most = if ahead > 1.0 { 190 } else { 20 };
    let falls = (0..=most).any(|_| {
        let above = pid.step(&mut state, &PidInput::new(DT, 5.0, 10.0)).command >= 10.0;
        if above {
            pid.applied(&mut state, told);
        }
        !above
    });
    assert!(falls, "{told:?} {anti_windup:?}");
}

#[test]
fn the_command_of_a_drive_that_limits_itself_falls_with_the_reference() {
    for told in [Applied::Command(10.0), Applied::AtUpperLimit] {
        for anti_windup in &WINDUPS[1..] {
            falls_with_the_reference(told, *anti_windup);
        }
    }
}

#[test]
fn a_drive_that_recovers_is_used_at_once() {
    let (pid, mut state) = (law(1.0, 10.0), PidState::new());
    let at = PidInput::new(DT, 40.0, 10.0);
    for _ in 0..1000 {
        let command = pid.step(&mut state, &at).command;
        pid.applied(&mut state, Applied::Command(command.min(10.0)));
    }
    let held = state.integral();
    // The proportional term is 30, and k_i·e·dt is 0.3: asked for also while 10 went out.
    near(pid.step(&mut state, &at).command, 30.3 + held, 1e-12);
    // Then nothing is told, and the integral keeps its change.
    near(state.integral(), held + 0.3, 1e-12);
}

#[test]
fn what_the_drive_did_is_forgotten_with_the_next_good_sample() {
    let (pid, at) = (law(1.0, 10.0), PidInput::new(DT, 5.0, 0.0));
    let (mut told, mut free) = (PidState::new(), PidState::new());
    pid.step(&mut told, &at);
    // Told again, there is nothing more to take back.
    for limit in [
        Applied::AtUpperLimit,
        Applied::AtUpperLimit,
        Applied::AtLowerLimit,
    ] {
        pid.applied(&mut told, limit);
        assert_eq!(told.integral(), 0.0);
    }
    for _ in 0..10 {
        pid.step(&mut told, &at);
        pid.step(&mut free, &at);
    }
    assert_eq!(told, free);
    // A number that is none says nothing.
    pid.applied(&mut free, Applied::Command(f64::NAN));
    pid.applied(&mut free, Applied::AsCommanded);
    assert_eq!(told, free);
}

#[test]
fn a_law_whose_integral_fills_the_range_says_that_it_is_at_its_limit() {
    // An integral alone, and a proportional term that falls as slowly as the integral may follow.
    for k_p in [0.0, 0.1] {
        let inner = pid(k_p, 20.0, |s| s.limits = range(-3.0, 3.0));
        let mut state = PidState::new();
        for (way, at_limit) in [(1.0, Applied::AtUpperLimit), (-1.0, Applied::AtLowerLimit)] {
            let mut samples = 0;
            for k in 0..2000 {
                let at = PidInput::new(DT, 5.0 * way, way * 1e-3 * f64::from(k));
                let is_there = inner.step(&mut state, &at).command == 3.0 * way;
                let told = if is_there {
                    at_limit
                } else {
                    Applied::AsCommanded
                };
                assert_eq!(inner.saturation(&state), told);
                samples += u32::from(is_there);
            }
            // From one limit to the other: 6 at 20 times an error of 3 to 5, in 0.1 s at most.
            assert!(samples >= 1900, "{k_p}: {samples}");
        }
    }
}

/// A cascade: the outer law asks for a speed, the inner one for a torque that is limited.
#[test]
fn an_outer_loop_does_not_wind_up_while_the_inner_one_is_at_its_limit() {
    let outer = pid(1.0, 0.3, |s| s.limits = range(-50.0, 50.0));
    let overshoot = |k_p: f64, tell: bool| {
        let inner = pid(k_p, 20.0, |s| s.limits = range(-3.0, 3.0));
        let (mut out, mut inside) = (PidState::new(), PidState::new());
        let (mut position, mut speed, mut most) = (0.0_f64, 0.0_f64, 0.0_f64);
        for _ in 0..60_000 {
            let wanted = outer
                .step(&mut out, &PidInput::new(DT, 20.0, position))
                .command;
            let torque = inner
                .step(&mut inside, &PidInput::new(DT, wanted, speed))
                .command;
            if tell {
                outer.applied(&mut out, inner.saturation(&inside));
            }
            speed += DT * (torque - 0.2 * speed);
            position += DT * speed;
            most = most.max(position);
        }
        (most - 20.0, position)
    };
    // Also where the inner law is an integral alone.
    for k_p in [1.0, 0.0] {
        let ((untold, _), (told, end)) = (overshoot(k_p, false), overshoot(k_p, true));
        assert!(told < 0.5 * untold, "{told} {untold}");
        assert!(k_p == 0.0 || (end - 20.0).abs() < 0.01, "{end}");
    }
}
