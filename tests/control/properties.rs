//! For any numbers: finite commands within their limits, a state that nothing poisons.

use super::*;

fn any64() -> impl Strategy<Value = f64> {
    prop_oneof![2 => -100.0..100.0_f64, 1 => any::<u64>().prop_map(f64::from_bits)]
}

fn period() -> impl Strategy<Value = f64> {
    prop_oneof![4 => 1e-5..0.1_f64, 1 => any::<u64>().prop_map(f64::from_bits)]
}

/// Settings over all that `try_new` admits, gains within a firmware's reach.
fn any_pid<T: Real>() -> impl Strategy<Value = Pid<T>> {
    let gains = (0.0..1e4_f64, 0.0..1e4_f64, 0.0..1e3_f64, any::<bool>());
    let shapes = (
        0_u8..3,
        0.0..=1.0_f64,
        0.0..=1.0_f64,
        0_usize..4,
        0.0..0.5_f64,
    );
    let range = (
        -100.0..50.0_f64,
        1e-3..100.0_f64,
        0.0..=1.0_f64,
        0.0..2e3_f64,
    );
    let rarer = (
        prop::option::of(1e-3..100.0_f64),
        prop_oneof![Just(0.0), 0.0..10.0_f64],
        prop::option::of(1e-3..400.0_f64),
    );
    (gains, shapes, range, rarer).prop_map(|(gains, shapes, range, rarer)| {
        let (p, i, d, reverse) = gains;
        let (kind, b, c, windup, tau) = shapes;
        let (low, width, safe, slew) = range;
        let (most, deadband, period) = rarer;
        let of = T::from_f64;
        let sign = if reverse { -1.0 } else { 1.0 };
        let limits = Limits::try_new(of(low), of(low + width)).unwrap();
        let safe = limits.clamp(limits.low() + of(safe) * (limits.high() - limits.low()));
        let weight = of(if period.is_some() { c.round() } else { c });
        let tracking_time = of(tau + 1e-3);
        Pid::try_new(PidSettings {
            k_p: of(sign * p),
            k_i: of(sign * i),
            k_d: of(if kind == 0 { 0.0 } else { sign * d }),
            damping: match kind {
                2 => DerivativeSource::Velocity,
                _ => DerivativeSource::Rate { weight },
            },
            derivative_time: of(tau),
            setpoint_weight: of(if period.is_some() { 1.0 } else { b }),
            integral_limit: most.map(of),
            deadband: of(deadband),
            period: period.map(of),
            anti_windup: match windup {
                0 => AntiWindup::None,
                1 => AntiWindup::Clamp,
                2 => AntiWindup::BackCalculation { tracking_time },
                _ => AntiWindup::Conditional,
            },
            limits: match slew > 1e3 {
                true => limits,
                false => limits.with_slew(of(slew + 0.1)).unwrap(),
            },
            longest_dt: of(0.5),
            fallback: Fallback::try_new(5, safe).unwrap(),
        })
        .unwrap()
    })
}

/// What must hold at every step, whatever the numbers are.
fn holds<T: Real>(
    pid: &Pid<T>,
    state: &mut PidState<T>,
    at: &PidInput<T>,
) -> Result<(), TestCaseError> {
    let before = *state;
    let mut twin = before;
    let out = pid.step_with_terms(state, at);
    prop_assert_eq!(pid.step(&mut twin, at).command, out.command);
    prop_assert_eq!(twin, *state);
    let limits = pid.settings().limits;
    prop_assert!(out.command.is_finite() && limits.contains(out.command));
    prop_assert!(state.integral().is_finite() && state.rate().is_finite());
    prop_assert!(out.terms.unlimited.is_finite() && out.terms.error.is_finite());
    match out.status {
        Status::Good => {
            prop_assert!(!state.is_latched() && state.fault_counter() <= before.fault_counter());
            let difference = at.measured - at.reference;
            match pid.settings().period {
                None => prop_assert_eq!(out.terms.error, difference),
                Some(period) => {
                    // Half a period, and the rounding of the measurement and of its turn.
                    let angles = at.measured.abs() + at.reference.abs();
                    let rounding = T::from_f64(4.0) * T::epsilon() * angles;
                    prop_assert!(out.terms.error.abs() <= T::from_f64(0.5) * period + rounding);
                }
            }
            if let (Some(slew), true) = (limits.slew(), limits.contains(before.command())) {
                let reach = slew * at.dt + T::from_f64(4.0) * T::epsilon() * T::from_f64(300.0);
                prop_assert!((out.command - before.command()).abs() <= reach);
            }
        }
        Status::Degraded(_) => prop_assert!(false, "a PID drops nothing"),
        Status::Held(_) | Status::Safe(_) => {
            prop_assert_eq!(state.integral(), before.integral());
            prop_assert_eq!(state.rate(), before.rate());
            prop_assert_eq!(pid.terms(state), pid.terms(&before));
            let safe = pid.settings().fallback.command();
            if matches!(out.status, Status::Safe(_)) {
                prop_assert_eq!(Some(out.command), safe);
                prop_assert!(state.is_latched());
            }
        }
    }
    Ok(())
}

/// Samples as `[reference, measured, velocity, feed-forward]` with their `dt`.
fn all_hold<T: Real>(pid: &Pid<T>, samples: Vec<(f64, [T; 4])>) -> Result<(), TestCaseError> {
    let mut state = PidState::new();
    samples
        .iter()
        .try_for_each(|sample| holds(pid, &mut state, &input(sample)))
}

fn input<T: Real>(
    &(dt, [reference, measured, velocity, feed_forward]): &(f64, [T; 4]),
) -> PidInput<T> {
    let dt = T::from_f64(dt);
    PidInput {
        dt,
        reference,
        measured,
        velocity,
        feed_forward,
    }
}

proptest! {
    #![proptest_config(seeded(256, 3))]

    #[test]
    fn any_f32_gives_a_finite_command_within_the_limits(
        pid in any_pid::<f32>(),
        samples in prop::collection::vec((period(), prop::array::uniform4(any32())), 1..60),
    ) {
        all_hold(&pid, samples)?;
    }

    #[test]
    fn any_f64_gives_a_finite_command_within_the_limits(
        pid in any_pid::<f64>(),
        samples in prop::collection::vec((period(), prop::array::uniform4(any64())), 1..60),
    ) {
        all_hold(&pid, samples)?;
    }

    #[test]
    fn any_hand_over_leaves_a_state_that_works(
        from in any_pid::<f32>(),
        to in any_pid::<f32>(),
        output in any32(),
        samples in prop::collection::vec((period(), prop::array::uniform4(any32())), 2..40),
    ) {
        let mut state = PidState::new();
        let half = samples.len() / 2;
        state.resume_from(&from, output, &input(&samples[0]));
        for (k, sample) in samples.iter().enumerate() {
            if k == half {
                let before = state.command();
                to.bumpless_transfer(&mut state);
                prop_assert_eq!(state.command(), before);
            }
            holds(if k < half { &from } else { &to }, &mut state, &input(sample))?;
        }
    }

    #[test]
    fn the_anti_windup_never_lets_the_integral_beyond_what_fills_the_limits(
        k_p in 0.0..50.0_f64,
        k_i in 0.1..500.0_f64,
        samples in prop::collection::vec(-5.0..5.0_f64, 1..400),
    ) {
        for anti_windup in [AntiWindup::Clamp, AntiWindup::Conditional] {
            let pid = pid(k_p, k_i, |s| (s.anti_windup, s.limits) = (anti_windup, range(-10.0, 30.0)));
            let mut state = PidState::new();
            for &error in &samples {
                pid.step(&mut state, &PidInput::new(1e-3, 0.0, error));
                // Clamp: the range itself. Conditional: what the range leaves beside the
                // proportional term, which is at most 5·k_p.
                let room = if anti_windup == AntiWindup::Clamp { 0.0 } else { 5.0 * k_p };
                prop_assert!((-10.0 - room..=30.0 + room).contains(&state.integral()));
            }
        }
    }
}
