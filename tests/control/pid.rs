//! PI, PID and PIV against closed forms.

use bowden::control::{
    AntiWindup, DerivativeSource, Fallback, Limits, Pid, PidInput, PidSettings, PidState, Status,
};
use bowden::{Error, Real};

/// The rounding of a few thousand additions, in units of the largest number in them.
const ROUNDING: f64 = 1e-12;

fn close(got: f64, expected: f64) {
    let scale = 1.0 + got.abs().max(expected.abs());
    assert!(
        (got - expected).abs() <= ROUNDING * scale,
        "{got} instead of {expected}"
    );
}

#[test]
fn a_pi_answers_a_step_of_the_error_with_a_line() {
    // (15) with e = -2 from t = 0 on: u = 2·(k_p + k_i·t).
    let (pid, mut state) = (Pid::paper_pi(), PidState::new());
    for k in 1..=5000 {
        let out = pid.step_with_terms(&mut state, &PidInput::new(1e-3, 25.0, 23.0));
        close(out.command, 2.0 * (30.0 + 18.0 * 1e-3 * f64::from(k)));
        assert_eq!((out.terms.error, out.terms.proportional), (-2.0, 60.0));
    }
}

#[test]
fn the_integral_of_a_constant_error_is_the_same_for_any_split_of_the_time() {
    let pid = Pid::paper_pi();
    let integral = |parts: &[f64]| {
        let mut state = PidState::new();
        for &dt in parts {
            pid.step_with_terms(&mut state, &PidInput::new(dt, 1.0, 0.25));
        }
        state.integral()
    };
    let jittered: Vec<f64> = (0..100).map(|k| 0.005 + 0.01 * f64::from(k % 2)).collect();
    close(integral(&[1.0]), 0.75 * 18.0);
    close(integral(&jittered), 0.75 * 18.0);
    close(integral(&[1e-4; 10_000]), 0.75 * 18.0);
}

#[test]
fn an_f32_integral_does_not_stall_on_steps_below_half_an_ulp() {
    // The integral stands at 1000, an ulp of which is 6e-5; a step is 1e-6.
    let pid = Pid::try_new(PidSettings::unlimited(0.0_f32, 1.0)).unwrap();
    let mut state = PidState::new();
    let at = PidInput::new(1e-4, 0.01, 0.0);
    state.resume_from(&pid, 1000.0, &at);
    for _ in 0..1_000_000 {
        pid.step_with_terms(&mut state, &at);
    }
    // A million of them are 1; a plain sum would still stand at 1000.
    assert!((state.integral() - 1001.0).abs() < 1e-3);
}

fn filtered(time: f64, damping: DerivativeSource<f64>) -> Pid<f64> {
    Pid::try_new(PidSettings {
        k_d: 2.0,
        derivative_time: time,
        damping,
        ..PidSettings::unlimited(0.0, 0.0)
    })
    .unwrap()
}

#[test]
fn the_derivative_of_a_ramp_is_the_implicit_lag_also_with_jitter() {
    let (tau, slope) = (0.02, 3.0);
    let (pid, mut state) = (filtered(tau, DerivativeSource::on_error()), PidState::new());
    pid.step_with_terms(&mut state, &PidInput::new(1e-3, 0.0, 0.0));
    let (mut t, mut left) = (0.0, 1.0);
    for k in 0..200_u32 {
        let dt = 1e-4 * f64::from(1 + k * 7 % 13);
        t += dt;
        left *= tau / (tau + dt);
        let out = pid.step_with_terms(&mut state, &PidInput::new(dt, 0.0, slope * t));
        let exact = -2.0 * slope * (1.0 - left);
        // The quotient of two samples is rounded like the samples over dt.
        assert!((out.terms.derivative - exact).abs() < 1e-10);
    }
}

#[test]
fn a_step_of_the_reference_kicks_by_the_set_point_weight() {
    for (weight, kick) in [(1.0, 2000.0), (0.25, 500.0), (0.0, 0.0)] {
        let (pid, mut state) = (
            filtered(0.0, DerivativeSource::Rate { weight }),
            PidState::new(),
        );
        pid.step_with_terms(&mut state, &PidInput::new(1e-3, 0.0, 0.5));
        let out = pid.step_with_terms(&mut state, &PidInput::new(1e-3, 1.0, 0.5));
        close(out.terms.derivative, kick);
    }
    assert_eq!(
        DerivativeSource::on_measurement(),
        DerivativeSource::Rate { weight: 0.0 }
    );
}

#[test]
fn the_proportional_term_sees_its_share_of_the_reference_the_integral_all_of_it() {
    let pid = Pid::try_new(PidSettings {
        setpoint_weight: 0.25,
        ..PidSettings::unlimited(10.0, 1.0)
    })
    .unwrap();
    let out = pid.step_with_terms(&mut PidState::new(), &PidInput::new(0.5, 8.0, 1.0));
    assert_eq!(out.terms.proportional, 10.0 * (0.25 * 8.0 - 1.0));
    assert_eq!(out.terms.integral, 7.0 * 0.5);
    assert_eq!(out.terms.error, -7.0);
}

#[test]
fn piv_damps_with_the_measured_velocity_as_it_is() {
    // (16) with Table 1: u = -30·e - 18·∫e - 10·v.
    let mut state = PidState::new();
    let at = PidInput {
        velocity: 0.3,
        feed_forward: 4.0,
        ..PidInput::new(1e-3, 25.0, 25.0)
    };
    let out = Pid::paper_piv().step_with_terms(&mut state, &at);
    assert_eq!((out.terms.velocity, out.terms.derivative), (-3.0, 0.0));
    assert_eq!(out.command, 1.0);
}

#[test]
fn the_terms_add_up_to_the_unlimited_command() {
    let pid = Pid::try_new(PidSettings {
        limits: Limits::try_new(-1.0, 2.0).unwrap(),
        anti_windup: AntiWindup::BackCalculation { tracking_time: 0.1 },
        ..*Pid::paper_pid().settings()
    })
    .unwrap();
    let mut state = PidState::new();
    for k in 0..1000 {
        let t = 1e-3 * f64::from(k);
        let at = PidInput {
            feed_forward: t.cos(),
            ..PidInput::new(1e-3, (7.0 * t).sin(), (5.0 * t).sin())
        };
        let terms = pid.step_with_terms(&mut state, &at).terms;
        let sum = terms.proportional + terms.integral + terms.derivative;
        close(terms.unlimited, sum + terms.velocity + terms.feed_forward);
        assert_eq!(terms, pid.terms(&state));
    }
}

#[test]
fn the_papers_gains_are_those_of_its_table_1() {
    let gains = |pid: Pid<f64>| {
        let settings = pid.settings();
        (settings.k_p, settings.k_i, settings.k_d)
    };
    assert_eq!(gains(Pid::paper_pi()), (30.0, 18.0, 0.0));
    assert_eq!(gains(Pid::paper_pid()), (30.0, 18.0, 2.0));
    assert_eq!(gains(Pid::paper_piv()), (30.0, 18.0, 10.0));
    for pid in [Pid::<f32>::paper_pi(), Pid::paper_pid(), Pid::paper_piv()] {
        assert_eq!(Pid::try_new(*pid.settings()), Ok(pid));
    }
}

fn refused<T: Real>(change: impl Fn(&mut PidSettings<T>)) -> Error {
    let mut settings = PidSettings::unlimited(T::from_f64(30.0), T::from_f64(18.0));
    change(&mut settings);
    Pid::try_new(settings).unwrap_err()
}

#[test]
fn settings_are_refused_by_name() {
    let nan = f64::NAN;
    assert_eq!(refused(|s| s.k_p = nan), Error::NonFinite("k_p"));
    assert_eq!(refused(|s| s.k_i = 1.0 / 0.0), Error::NonFinite("k_i"));
    assert_eq!(refused(|s| s.k_d = nan), Error::NonFinite("k_d"));
    let out = |name| Error::OutOfRange(name);
    assert_eq!(
        refused(|s| s.derivative_time = -1e-3),
        out("derivative_time")
    );
    assert_eq!(refused(|s| s.setpoint_weight = 1.5), out("setpoint_weight"));
    let weight = DerivativeSource::Rate { weight: -0.1 };
    assert_eq!(refused(|s| s.damping = weight), out("derivative weight"));
    let tracking_time = 0.0;
    let tracking = AntiWindup::BackCalculation { tracking_time };
    assert_eq!(refused(|s| s.anti_windup = tracking), out("tracking_time"));
}

#[test]
fn gains_of_opposite_signs_and_a_safe_command_outside_the_limits_are_refused() {
    let inadmissible = |error| matches!(error, Error::Inadmissible(_));
    assert!(inadmissible(refused::<f64>(|s| s.k_i = -18.0)));
    assert!(inadmissible(refused::<f32>(|s| s.k_d = -2.0)));
    // A velocity sensor may well count the other way.
    let settings = PidSettings {
        k_d: -2.0,
        damping: DerivativeSource::Velocity,
        ..PidSettings::unlimited(30.0, 18.0)
    };
    assert!(Pid::try_new(settings).is_ok());
    assert!(inadmissible(refused::<f64>(|s| {
        s.limits = Limits::try_new(5.0, 20.0).unwrap();
        s.fallback = Fallback::try_new(3, 0.0).unwrap();
    })));
}

#[test]
fn a_plant_that_acts_in_reverse_takes_negative_gains() {
    let pid = Pid::try_new(PidSettings::unlimited(-30.0, -18.0)).unwrap();
    let out = pid.step_with_terms(&mut PidState::new(), &PidInput::new(1e-3, 1.0, 0.0));
    close(out.command, -30.018);
    assert_eq!(out.status, Status::Good);
}

#[cfg(feature = "serde")]
#[test]
fn settings_and_states_are_read_through_their_checks() {
    let pid = Pid::paper_pi();
    for pid in [pid, Pid::paper_pid(), Pid::paper_piv()] {
        super::reads_back(&pid, &[]);
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
    let fallback = |text: &str| serde_json::from_str::<Fallback<f64>>(text);
    for lost in [
        r#"{"after": 20}"#,
        r#"{"after": 20, "weight": 0}"#,
        r#"{"after": 4294967295, "weight": 1}"#,
    ] {
        assert!(fallback(lost).is_err(), "{lost}");
    }
    super::reads_back(&Fallback::<f64>::hold_indefinitely(), &[]);
    let mut state = PidState::new();
    pid.step_with_terms(&mut state, &PidInput::new(1e-3, 1.0, 0.5));
    super::reads_back(&state, &[("\"gap\":0.0", "\"gap\":-1.0")]);
}
