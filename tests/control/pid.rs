//! PI, PID and PIV against closed forms.

use super::*;

/// To the rounding of a few thousand additions, in units of the largest number in them.
fn close(got: f64, expected: f64) {
    near(got, expected, 1e-12 * (1.0 + got.abs().max(expected.abs())));
}

#[test]
fn a_pi_answers_a_step_of_the_error_with_a_line() {
    // (15) with e = -2 from t = 0 on: u = 2·(k_p + k_i·t). A plant that acts in reverse takes
    // negative gains.
    for (pid, sign) in [(Pid::paper_pi(), 1.0), (pid(-30.0, -18.0, |_| ()), -1.0)] {
        let mut state = PidState::new();
        for k in 1..=5000 {
            let out = pid.step_with_terms(&mut state, &PidInput::new(DT, 25.0, 23.0));
            close(out.command, sign * 2.0 * (30.0 + 18.0 * DT * f64::from(k)));
            assert_eq!(
                (out.terms.error, out.terms.proportional),
                (-2.0, sign * 60.0)
            );
            assert_eq!(out.status, Status::Good);
        }
    }
}

#[test]
fn the_integral_of_a_constant_error_is_the_same_for_any_split_of_the_time() {
    let jittered: Vec<f64> = (0..100).map(|k| 0.005 + 0.01 * f64::from(k % 2)).collect();
    for parts in [&[1.0][..], &jittered, &[1e-4; 10_000]] {
        let (pid, mut state) = (Pid::paper_pi(), PidState::new());
        for &dt in parts {
            pid.step(&mut state, &PidInput::new(dt, 1.0, 0.25));
        }
        close(state.integral(), 0.75 * 18.0);
    }
}

#[test]
fn an_f32_integral_does_not_stall_on_steps_below_half_an_ulp() {
    // The integral stands at 1000, an ulp of which is 6e-5; a step is 1e-6.
    let pid = Pid::try_new(PidSettings::unlimited(0.0_f32, 1.0)).unwrap();
    let mut state = PidState::new();
    let at = PidInput::new(1e-4, 0.01, 0.0);
    state.resume_from(&pid, 1000.0, &at);
    for _ in 0..1_000_000 {
        pid.step(&mut state, &at);
    }
    // A million of them are 1; a plain sum would still stand at 1000.
    near(f64::from(state.integral()), 1001.0, 1e-3);
}

fn filtered(time: f64, damping: DerivativeSource<f64>) -> Pid<f64> {
    pid(0.0, 0.0, |s| {
        (s.k_d, s.derivative_time, s.damping) = (2.0, time, damping)
    })
}

#[test]
fn the_derivative_of_a_ramp_is_the_implicit_lag_also_with_jitter() {
    let (tau, slope) = (0.02, 3.0);
    let (pid, mut state) = (filtered(tau, DerivativeSource::on_error()), PidState::new());
    pid.step(&mut state, &PidInput::new(DT, 0.0, 0.0));
    let (mut t, mut left) = (0.0, 1.0);
    for k in 0..200_u32 {
        let dt = 1e-4 * f64::from(1 + k * 7 % 13);
        t += dt;
        left *= tau / (tau + dt);
        let out = pid.step_with_terms(&mut state, &PidInput::new(dt, 0.0, slope * t));
        // The quotient of two samples is rounded like the samples over dt.
        near(out.terms.derivative, -2.0 * slope * (1.0 - left), 1e-10);
    }
}

#[test]
fn a_step_of_the_reference_kicks_by_the_set_point_weight_and_by_default_not_at_all() {
    let on_measurement = DerivativeSource::Rate { weight: 0.0 };
    assert_eq!(DerivativeSource::on_measurement(), on_measurement);
    assert_eq!(pid(3.0, 0.0, |_| ()).settings().damping, on_measurement);
    for (weight, kick) in [(1.0, 2000.0), (0.25, 500.0), (0.0, 0.0)] {
        let (pid, mut state) = (
            filtered(0.0, DerivativeSource::Rate { weight }),
            PidState::new(),
        );
        pid.step(&mut state, &PidInput::new(DT, 0.0, 0.5));
        let out = pid.step_with_terms(&mut state, &PidInput::new(DT, 1.0, 0.5));
        close(out.terms.derivative, kick);
    }
}

#[test]
fn the_proportional_term_sees_its_share_of_the_reference_the_integral_all_of_it() {
    let pid = pid(10.0, 1.0, |s| s.setpoint_weight = 0.25);
    let terms = pid
        .step_with_terms(&mut PidState::new(), &PidInput::new(0.5, 8.0, 1.0))
        .terms;
    assert_eq!(terms.proportional, 10.0 * (0.25 * 8.0 - 1.0));
    assert_eq!((terms.integral, terms.error), (7.0 * 0.5, -7.0));
}

#[test]
fn piv_damps_with_the_measured_velocity_as_it_is() {
    // (16) with Table 1: u = -30·e - 18·∫e - 10·v.
    let at = with(PidInput::new(DT, 25.0, 25.0), |at| {
        (at.velocity, at.feed_forward) = (0.3, 4.0)
    });
    let out = Pid::paper_piv().step_with_terms(&mut PidState::new(), &at);
    assert_eq!((out.terms.velocity, out.terms.derivative), (-3.0, 0.0));
    assert_eq!(out.command, 1.0);
}

#[test]
fn the_terms_add_up_to_the_unlimited_command() {
    let pid = Pid::try_new(with(*Pid::paper_pid().settings(), |s| {
        s.limits = range(-1.0, 2.0);
        s.anti_windup = AntiWindup::BackCalculation { tracking_time: 0.1 };
    }));
    let (pid, mut state) = (pid.unwrap(), PidState::new());
    for k in 0..1000 {
        let t = DT * f64::from(k);
        let at = PidInput::new(DT, (7.0 * t).sin(), (5.0 * t).sin());
        let at = with(at, |at| at.feed_forward = t.cos());
        let terms = pid.step_with_terms(&mut state, &at).terms;
        let sum = terms.proportional + terms.integral + terms.derivative;
        close(terms.unlimited, sum + terms.velocity + terms.feed_forward);
        assert_eq!(terms, pid.terms(&state));
    }
}

#[test]
fn the_papers_gains_are_those_of_its_table_1() {
    let papers = [Pid::<f32>::paper_pi(), Pid::paper_pid(), Pid::paper_piv()];
    for (pid, k_d) in papers.into_iter().zip([0.0, 2.0, 10.0]) {
        let s = *pid.settings();
        assert_eq!((s.k_p, s.k_i, s.k_d), (30.0, 18.0, k_d));
        assert_eq!(Pid::try_new(s), Ok(pid));
    }
}

#[test]
fn settings_are_refused_by_name() {
    use Error::{Inadmissible, NonFinite, OutOfRange};
    type Change = fn(&mut PidSettings<f64>);
    let weighted = "with a period: setpoint_weight 1, derivative weight 0 or 1";
    #[rustfmt::skip]
    let cases: [(Change, Error); 17] = [
        (|s| s.k_p = f64::NAN, NonFinite("k_p")),
        (|s| s.k_i = f64::INFINITY, NonFinite("k_i")),
        (|s| s.k_d = f64::NAN, NonFinite("k_d")),
        (|s| s.derivative_time = -1e-3, OutOfRange("derivative_time")),
        (|s| s.longest_dt = 0.0, OutOfRange("longest_dt")),
        (|s| s.longest_dt = f64::NAN, NonFinite("longest_dt")),
        (|s| s.setpoint_weight = 1.5, OutOfRange("setpoint_weight")),
        (|s| s.damping = DerivativeSource::Rate { weight: -0.1 }, OutOfRange("derivative weight")),
        (|s| s.anti_windup = AntiWindup::BackCalculation { tracking_time: 0.0 }, OutOfRange("tracking_time")),
        (|s| s.period = Some(0.0), OutOfRange("period")),
        (|s| s.period = Some(-1.0), OutOfRange("period")),
        (|s| s.period = Some(f64::NAN), NonFinite("period")),
        (|s| s.deadband = -0.1, OutOfRange("deadband")),
        (|s| s.deadband = f64::INFINITY, NonFinite("deadband")),
        (|s| s.integral_limit = Some(0.0), OutOfRange("integral_limit")),
        (|s| s.integral_limit = Some(f64::NAN), NonFinite("integral_limit")),
        (|s| (s.period, s.setpoint_weight) = (Some(360.0), 0.5), Inadmissible(weighted)),
    ];
    for (change, error) in cases {
        assert_eq!(refused(change), error);
    }
}

#[test]
fn gains_of_opposite_signs_and_a_safe_command_outside_the_limits_are_refused() {
    type Change = fn(&mut PidSettings<f64>);
    let outside: Change = |s| {
        s.limits = range(5.0, 20.0);
        s.fallback = Fallback::try_new(3, 0.0).unwrap();
    };
    let condition = "the safe command lies within the limits";
    assert_eq!(refused(outside), Error::Inadmissible(condition));
    let weight = Fallback::try_new(20, 0.0).unwrap().with_weight(0);
    assert_eq!(weight, Err(Error::OutOfRange("weight")));
    let reversed: Change = |s| (s.k_p, s.k_i, s.k_d) = (-30.0, -18.0, 2.0);
    for change in [outside, reversed, |s| s.k_i = -18.0, |s| s.k_d = -2.0] {
        assert!(matches!(refused(change), Error::Inadmissible(_)));
    }
    // A velocity sensor may well count the other way.
    pid(30.0, 18.0, |s| {
        (s.k_d, s.damping) = (-2.0, DerivativeSource::Velocity)
    });
}

#[cfg(feature = "serde")]
#[test]
fn settings_and_states_are_read_through_their_checks() {
    let pid = Pid::paper_pi();
    for pid in [pid, Pid::paper_pid(), Pid::paper_piv()] {
        reads_back(&pid, &[]);
    }
    // The gains alone, where limits, longest dt and fallback are said.
    let rest = r#""limits": {"low": -1.7976931348623157e308, "high": 1.7976931348623157e308},
        "longest_dt": 1.7976931348623157e308, "fallback": {"after": 4294967295}"#;
    let read = |own: &str| serde_json::from_str::<Pid<f64>>(&format!("{{{own}, {rest}}}"));
    assert_eq!(read(r#""k_p": 30.0, "k_i": 18.0"#).unwrap(), pid);
    let error = |own: &str| read(own).err().unwrap().to_string();
    assert!(error(r#""k_p": 30.0, "k_i": -18.0"#).contains("same sign"));
    assert!(error(r#""k_p": 1, "k_i": 1, "kd": 1"#).contains("kd"));
    // A line that was lost must not turn a safe command into none.
    for lost in [
        r#"{"after": 20}"#,
        r#"{"after": 20, "weight": 0}"#,
        r#"{"after": 4294967295, "weight": 1}"#,
    ] {
        assert!(
            serde_json::from_str::<Fallback<f64>>(lost).is_err(),
            "{lost}"
        );
    }
    reads_back(&Fallback::<f64>::hold_indefinitely(), &[]);
    let mut state = PidState::new();
    pid.step(&mut state, &PidInput::new(DT, 1.0, 0.5));
    reads_back(&state, &[("\"gap\":0.0", "\"gap\":-1.0")]);
}
