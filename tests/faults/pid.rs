//! PI, PID, PIV.

use super::{fallback, limits, pi, DT, LONGEST};
use bowden::control::{AntiWindup, Fault, Limits, Pid, PidInput, PidSettings, PidState, Status};
use bowden_rig::{Reference, Rig, RigConfig};

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

/// RMS error of the true torque \[N·m\] on the reference rig after its start.
fn on_the_rig(anti_windup: AntiWindup<f64>, slew: f64) -> f64 {
    let rig = Rig::<f64, 0>::try_new(RigConfig::reference(), &[]).unwrap();
    let pid = Pid::try_new(PidSettings {
        anti_windup,
        limits: Limits::try_new(-200.0, 200.0)
            .unwrap()
            .with_slew(slew)
            .unwrap(),
        ..PidSettings::unlimited(6.0, 60.0)
    })
    .unwrap();
    let (mut plant, mut state, reference) = (rig.start(7), PidState::new(), Reference::paper());
    let (mut sum, mut count) = (0.0, 0.0);
    for _ in 0..20_000 {
        let now = plant.sample();
        let wanted = reference.at(now.time);
        let out = pid.step(&mut state, &PidInput::new(DT, wanted, now.measured));
        rig.step(&mut plant, out.command, DT);
        if now.time > 5.0 {
            sum += (now.tau_o - wanted).powi(2);
            count += 1.0;
        }
    }
    f64::sqrt(sum / count)
}

#[test]
fn conditional_anti_windup_minds_the_range_and_gives_back_what_the_slew_rate_takes() {
    // Gains that are quiet enough for 500/s: 2·k_p·noise·rate = 240. What the slew rate takes
    // is then given back as back-calculation does it, with T_t = k_p/k_i.
    let returned = on_the_rig(AntiWindup::BackCalculation { tracking_time: 0.1 }, 500.0);
    let conditional = on_the_rig(AntiWindup::Conditional, 500.0);
    let wound = on_the_rig(AntiWindup::None, 500.0);
    // The range is never met here, so that they are one law: equal to rounding.
    assert!(
        (conditional - returned).abs() < 1e-9 * returned,
        "{conditional} {returned}"
    );
    assert!(returned < 0.2 * wound, "{returned} {wound}");
}
