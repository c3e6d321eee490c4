//! Numbers that are finite and wrong, and configurations in flash.

use super::*;
use bowden::signal::{Implausible, Plausible, PlausibleState, Ramp, RampState};
use bowden::{constant, Constant};

fn plausible() -> Plausible<f64> {
    let range = Plausible::try_new(-10.0, 10.0).unwrap();
    range.with_rate(100.0).unwrap()
}

#[test]
fn a_reset_encoder_does_not_move_the_estimates() {
    // The position jumps by 0.6 rad in 1 ms: twice differenced that is 6e5 rad/s².
    let acceleration = |k: u32| match k {
        500 => 6e5,
        _ => (0.01 * f64::from(k)).sin(),
    };
    let [law, _] = forms(|s| s.limits = limits(1e12));
    let checked = Plausible::try_new(-500.0, 500.0).unwrap();
    let run = |with: bool| {
        let (mut state, mut seen) = (AdaptiveState::new(&law), PlausibleState::new());
        let mut most = 0.0_f64;
        for k in 0..600 {
            let raw = acceleration(k);
            let there = checked.step(&mut seen, raw, 0.001, true).value;
            let x = if with { there } else { raw };
            let out = law.step(&mut state, &AdaptiveInput::new(0.001, 25.0, 24.9, [x]));
            most = most.max(out.command.abs());
        }
        (state.theta_hat()[0], most)
    };
    let ((theta, most), (thrown, thrown_most)) = (run(true), run(false));
    assert!(thrown_most > 1e5, "{thrown_most}");
    assert!((thrown - theta).abs() > 1.0, "{thrown} {theta}");
    assert!(most < 200.0 && (theta - 1.0).abs() < 0.1, "{theta} {most}");
}

#[test]
fn a_sample_is_plausible_within_its_range_and_its_rate() {
    let (plausible, mut state) = (plausible(), PlausibleState::new());
    let mut fault = |sample: f64, dt: f64| plausible.step(&mut state, sample, dt, true).fault;
    let not = Some(Implausible::NotFinite);
    for (sample, dt, expected) in [
        (9.0, DT, None), // the first may be anywhere in the range
        (11.0, DT, Some(Implausible::OutOfRange)),
        (f64::NAN, DT, not),
        (f64::INFINITY, DT, not),
        (8.0, DT, Some(Implausible::TooFast)), // 0.4 in four samples
    ] {
        assert_eq!(fault(sample, dt), expected);
    }
    // After a gap of unknown length it may be anywhere in the range.
    assert_eq!(fault(f64::NAN, f64::NAN), not);
    assert_eq!(fault(-9.0, DT), None);
}

#[test]
fn a_dt_of_zero_is_no_time_and_one_that_cannot_be_used_an_unknown_or_the_longest() {
    let plausible = plausible();
    let bounded = plausible.with_longest_dt(0.005).unwrap();
    for dt in [
        4295.0,
        -0.001,
        -4295.0,
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
    ] {
        let (mut of_any, mut of_longest) = (PlausibleState::new(), PlausibleState::new());
        for (own, state) in [(&plausible, &mut of_any), (&bounded, &mut of_longest)] {
            own.step(state, 1.0, 0.001, true);
            // In no time nothing has moved; the number of before is still one.
            let moved = own.step(state, 1.01, 0.0, true);
            assert_eq!(moved.fault, Some(Implausible::TooFast));
            assert_eq!(own.step(state, 1.0, 0.0, true).fault, None);
            // No dt lets through what is no number.
            for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let output = own.step(state, bad, dt, true);
                assert_eq!(output.fault, Some(Implausible::NotFinite), "{dt}");
                assert!(output.value.is_nan());
            }
        }
        // Of an unknown time any sample in the range, and none outside of it.
        let outside = plausible.step(&mut of_any, 11.0, dt, true);
        assert_eq!(outside.fault, Some(Implausible::OutOfRange));
        assert_eq!(plausible.step(&mut of_any, -9.0, dt, true).fault, None);
        // Else each is 5 ms: 2.0 by now, and a spike is none that is believed.
        let spike = bounded.step(&mut of_longest, -9.0, dt, true);
        assert_eq!(spike.fault, Some(Implausible::TooFast), "{dt}");
        assert_eq!(bounded.step(&mut of_longest, 1.1, 0.001, true).fault, None);
    }
}

#[test]
fn a_frozen_sensor_is_told_while_the_machine_moves_only() {
    let plausible = Plausible::try_new(-10.0, 10.0).unwrap().with_stuck_after(5);
    let mut state = PlausibleState::new();
    let mut fault = |sample: f64, moves| plausible.step(&mut state, sample, 0.001, moves).fault;
    for _ in 0..100 {
        assert_eq!(fault(3.0, false), None, "at rest it may repeat itself");
    }
    for _ in 0..4 {
        assert_eq!(fault(3.0, true), None);
    }
    assert_eq!(fault(3.0, true), Some(Implausible::Stuck));
    // It has not moved since.
    assert_eq!(fault(3.0, false), Some(Implausible::Stuck));
    assert_eq!(fault(3.1, true), None);
}

/// Range, longest dt \[s\] and safe command of a drive, in flash.
const RANGE: Limits<f32> = constant!(Limits::<f32>::try_new(-20.0, 60.0).with_slew(2000.0));
const SAFE: Fallback<f32> = constant!(Fallback::<f32>::try_new(20, 0.0));
static PI: Pid<f32> = constant!(Pid::<f32>::try_new(PidSettings::new(
    30.0, 18.0, RANGE, 0.005, SAFE
)));
static PI_64: Pid<f64> = constant!(Pid::<f64>::try_new(PidSettings::new(
    30.0,
    18.0,
    constant!(Limits::<f64>::try_new(-20.0, 60.0)),
    0.005,
    constant!(Fallback::<f64>::try_new(20, 0.0)),
)));
const LAG: Form<f32> = Form::FirstOrder {
    step: 0.001,
    plant_gain: 1.0,
};
static LAW: Adaptive<f32, 2> = constant!(Adaptive::<f32, 2>::try_new(AdaptiveSettings {
    beta: Estimator::fixed(1.0)
        .within(0.9, 1.1)
        .adapting(2.5e-4, 0.01),
    delta: Estimator::fixed(1.0).within(0.0, 7.0).adapting(6e-3, 0.01),
    smooth_sign: SmoothSign::Clamp,
    ..AdaptiveSettings::new(LAG, 24.0, 8.0, 0.2, RANGE, 0.005, SAFE)
}));
static LAW_64: Adaptive<f64, 0> =
    constant!(Adaptive::<f64, 0>::try_new(AdaptiveSettings::unlimited(
        Form::AsPublished {
            time_constant: 0.005
        },
        24.0,
        8.0,
        0.05
    )));

#[test]
fn a_configuration_in_flash_is_the_one_that_is_checked_at_run_time() {
    assert_eq!(Ok(PI), Pid::try_new(*PI.settings()));
    assert_eq!(Ok(PI_64), Pid::try_new(*PI_64.settings()));
    assert_eq!(Ok(LAW), Adaptive::try_new(*LAW.settings()));
    assert_eq!(Ok(LAW_64), Adaptive::try_new(*LAW_64.settings()));
    let out = PI.step(&mut PidState::new(), &PidInput::new(0.001, 1.0, 0.9));
    assert_eq!(out.status, Status::Good);
}

#[test]
fn a_constant_is_refused_with_the_words_of_the_run_time() {
    for (low, high) in [(1.0, 0.0), (f32::NAN, 0.0)] {
        let refused = Constant::<Limits<f32>>::try_new(low, high);
        assert_eq!(refused, Limits::try_new(low, high));
    }
    let refused = Constant::<Limits<f32>>::with_slew(RANGE, 0.0);
    assert_eq!(refused, RANGE.with_slew(0.0));
    for (after, command) in [(0, 0.0), (1, f32::NAN)] {
        let refused = Constant::<Fallback<f32>>::try_new(after, command);
        assert_eq!(refused, Fallback::try_new(after, command));
    }
    let change: [fn(&mut PidSettings<f32>); 6] = [
        |s| s.k_p = f32::NAN,
        |s| s.k_i = -1.0,
        |s| s.k_d = -1.0,
        |s| s.setpoint_weight = 2.0,
        |s| s.derivative_time = -1.0,
        |s| s.longest_dt = 0.0,
    ];
    for change in change {
        let settings = with(PidSettings::unlimited(30.0, 18.0), change);
        let refused = Constant::<Pid<f32>>::try_new(settings);
        assert!(refused.is_err());
        assert_eq!(refused, Pid::try_new(settings));
    }
    let change: [fn(&mut AdaptiveSettings<f32, 2>); 6] = [
        |s| s.epsilon = 0.0,
        |s| s.epsilon = 1e-3,
        |s| s.lambda = 1e4,
        |s| s.delta = Estimator::fixed(-1.0),
        |s| s.beta = Estimator::free(1.0),
        |s| s.longest_dt = f32::NAN,
    ];
    for change in change {
        let settings = with(*LAW.settings(), change);
        let refused = Constant::<Adaptive<f32, 2>>::try_new(settings);
        assert!(refused.is_err());
        assert_eq!(refused, Adaptive::try_new(settings));
    }
}

/// The controller refuses a counter's wrap; the reference before it must not have moved on.
#[test]
fn a_wrapped_counter_does_not_move_a_ramp_with_a_longest_dt() {
    let ramp = Ramp::try_new(50.0, 0.02).unwrap();
    // Without a longest dt the ramp arrives.
    assert!(ramp.step(&mut RampState::at(0.0), 25.0, 4295.0) > 24.9);
    let ramp = ramp.with_longest_dt(0.005).unwrap();
    let mut state = RampState::at(0.0);
    ramp.step(&mut state, 25.0, 0.001);
    let before = state;
    ramp.step(&mut state, 25.0, 4295.0);
    assert_eq!(state, before);
    assert!(ramp.with_longest_dt(0.0).is_err() && ramp.with_longest_dt(f64::NAN).is_err());
    assert!(Ramp::try_new(0.0, 0.0).is_err() && Ramp::try_new(1.0, -1.0).is_err());
}
