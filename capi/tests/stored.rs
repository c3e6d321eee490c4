//! Objects that were stored, and settings that change while a law runs: the crate's numbers.

#![allow(missing_docs, clippy::undocumented_unsafe_blocks, clippy::unwrap_used)]

mod objects;

use bowden::*;
use core_bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, Estimator, Fallback, Form, Limits,
    Pid, PidInput, PidSettings, PidState,
};
use objects::blank;
use std::ptr::null_mut;

const SAMPLE: bowden_pid_sample_f32 = bowden_pid_sample_f32 {
    dt: 0.001,
    reference: 20.0,
    measured: 19.0,
    velocity: 0.0,
    feed_forward: 0.0,
};

fn step(pid: &mut bowden_pid_f32, sample: &bowden_pid_sample_f32) -> (f32, bowden_result) {
    let mut out = blank::<bowden_output_f32>();
    let result = unsafe { bowden_pid_step_f32(pid, sample, &mut out) };
    (out.command, result)
}

#[test]
fn a_pid_starts_from_nothing_after_the_power_was_off() {
    let mut settings = blank::<bowden_pid_settings_f32>();
    let mut pid = blank::<bowden_pid_f32>();
    unsafe {
        bowden_pid_settings_pi_f32(&mut settings, 3.0, 30.0, -60.0, 60.0, 0.005, 3, 0.0);
        assert_eq!(
            bowden_pid_init_f32(&mut pid, &settings, null_mut()),
            bowden_result::Ok
        );
    }
    let limits = Limits::try_new(-60.0_f32, 60.0).unwrap();
    let fallback = Fallback::try_new(3, 0.0).unwrap();
    let own = Pid::try_new(PidSettings::new(3.0, 30.0, limits, 0.005, fallback)).unwrap();
    let mut state = PidState::new();
    let input = PidInput::new(0.001, 20.0, 19.0);
    for _ in 0..300 {
        step(&mut pid, &SAMPLE);
        own.step(&mut state, &input);
    }
    unsafe { assert_eq!(bowden_pid_restore_f32(&mut pid), bowden_result::Ok) };
    state.restore(&own);
    for _ in 0..100 {
        let expected = own.step(&mut state, &input).command;
        assert_eq!(step(&mut pid, &SAMPLE), (expected, bowden_result::Ok));
    }
    // A latched fault outlives it.
    let dead = bowden_pid_sample_f32 {
        measured: f32::NAN,
        ..SAMPLE
    };
    for _ in 0..3 {
        step(&mut pid, &dead);
    }
    unsafe { bowden_pid_restore_f32(&mut pid) };
    assert_eq!(step(&mut pid, &SAMPLE), (0.0, bowden_result::Safe));
    unsafe {
        assert_eq!(bowden_pid_restore_f32(null_mut()), bowden_result::ErrorNull);
        assert_eq!(
            bowden_pid_restore_f32(&mut blank()),
            bowden_result::ErrorUninitialised
        );
    }
}

#[test]
fn a_play_before_the_inverse_is_the_crates_and_nonsense_is_refused() {
    use core_bowden::control::{Compensator, CompensatorInput, CompensatorState};
    use core_bowden::model::Model;
    let bytes = include_bytes!("../../examples/data/demo.postcard");
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
    let model: Model<f32, 8> = postcard::from_bytes_crc32(bytes, crc.digest()).unwrap();
    let own = Compensator::try_new(&model)
        .and_then(|own| own.with_play(0.3))
        .unwrap();
    let mut state = CompensatorState::new();
    let (mut object, mut loaded) = (
        blank::<bowden_compensator_f32>(),
        blank::<bowden_model_f32>(),
    );
    unsafe {
        let begun =
            bowden_model_load_f32(&mut loaded, bytes.as_ptr(), bytes.len(), 1.0, null_mut());
        assert_eq!(begun, bowden_result::Ok);
        let compensator = &raw mut object;
        let begun =
            bowden_compensator_init_f32(compensator, &loaded, 1.0, null_mut(), 0, null_mut());
        assert_eq!(begun, bowden_result::Ok);
        let set =
            |half_width: f32| bowden_compensator_set_play_f32(compensator, half_width, null_mut());
        assert_eq!(set(0.3), bowden_result::Ok);
        assert_eq!(set(-1.0), bowden_result::ErrorOutOfRange);
        assert_eq!(set(f32::NAN), bowden_result::ErrorNonFinite);
        let nobody = bowden_compensator_set_play_f32(null_mut(), 0.3, null_mut());
        assert_eq!(nobody, bowden_result::ErrorNull);
    }
    let rest = core_bowden::effect::Motion::default();
    let still = blank::<bowden_motion_f32>();
    for k in 0..400 {
        let desired = 6.0 * (0.02 * k as f32).sin() + if k % 2 == 0 { 0.2 } else { -0.2 };
        let at = CompensatorInput {
            channels: &[rest],
            ..CompensatorInput::new(0.001, desired)
        };
        let mut sample = blank::<bowden_compensator_sample_f32>();
        (sample.dt, sample.desired) = (0.001, desired);
        (sample.channels, sample.channel_count) = (&still, 1);
        let mut out = blank::<bowden_compensator_output_f32>();
        let result = unsafe { bowden_compensator_step_f32(&mut object, &sample, &mut out) };
        let expected = own.step(&mut state, &at).command;
        assert_eq!((result, out.command), (bowden_result::Ok, expected), "{k}");
    }
}

/// An adaptive law over one regressor in C.
fn law(gain: f64) -> bowden_adaptive_settings_f64 {
    let mut settings = bowden_adaptive_settings_f64::defaults();
    (settings.limits.low, settings.limits.high) = (-60.0, 60.0);
    (settings.longest_dt, settings.fallback.after) = (0.005, 3);
    settings.form = bowden_form::AsPublished as u32;
    let adapts = |initial: f64, low: f64, high: f64, gain: f64| bowden_estimator_f64 {
        initial,
        low,
        high,
        gain,
        leakage: bowden_leakage::Constant as u32,
        leakage_rate: 0.01,
        ..bowden_estimator_f64::defaults()
    };
    settings.gain = gain;
    settings.beta = adapts(1.0, 0.9, 1.1, 2.5e-4);
    settings.delta = adapts(1.0, 0.0, 7.0, 6.25e-3);
    settings.regressors = 1;
    settings.theta[0] = adapts(1.0, -5.0, 5.0, 5e-4);
    settings
}

/// The same in Rust.
fn own_law(gain: f64) -> Adaptive<f64, 1> {
    let limits = Limits::try_new(-60.0, 60.0).unwrap();
    let fallback = Fallback::try_new(3, 0.0).unwrap();
    let form = Form::AsPublished {
        time_constant: 0.005,
    };
    Adaptive::try_new(AdaptiveSettings {
        beta: Estimator::fixed(1.0)
            .within(0.9, 1.1)
            .adapting(2.5e-4, 0.01),
        delta: Estimator::fixed(1.0)
            .within(0.0, 7.0)
            .adapting(6.25e-3, 0.01),
        theta: [Estimator::fixed(1.0).within(-5.0, 5.0).adapting(5e-4, 0.01)],
        ..AdaptiveSettings::new(form, gain, 8.0, 0.05, limits, 0.005, fallback)
    })
    .unwrap()
}

#[test]
fn an_adaptive_law_keeps_its_estimates_through_a_power_cut_and_other_gains() {
    let mut object = blank::<bowden_adaptive_f64>();
    let begun = unsafe { bowden_adaptive_init_f64(&mut object, &law(24.0), null_mut()) };
    assert_eq!(begun, bowden_result::Ok);
    let mut sample = blank::<bowden_adaptive_sample_f64>();
    (sample.dt, sample.reference, sample.next_reference) = (0.001, 20.0, 20.0);
    (sample.measured, sample.regressors[0]) = (19.0, 0.2);
    let input = AdaptiveInput::new(0.001, 20.0, 19.0, [0.2]);
    let mut own = own_law(24.0);
    let mut state = AdaptiveState::new(&own);
    let run = |object: &mut bowden_adaptive_f64,
               own: &Adaptive<f64, 1>,
               state: &mut AdaptiveState<f64, 1>| {
        let mut out = blank::<bowden_output_f64>();
        for _ in 0..200 {
            let result = unsafe { bowden_adaptive_step_f64(object, &sample, &mut out) };
            let expected = own.step(state, &input).command;
            assert_eq!((result, out.command), (bowden_result::Ok, expected));
        }
    };
    run(&mut object, &own, &mut state);
    unsafe { assert_eq!(bowden_adaptive_restore_f64(&mut object), bowden_result::Ok) };
    state.restore(&own);
    run(&mut object, &own, &mut state);
    let before = state.beta_hat();
    let changed =
        unsafe { bowden_adaptive_change_f64(&mut object, &law(30.0), &sample, null_mut()) };
    assert_eq!(changed, bowden_result::Ok);
    own = own_law(30.0);
    own.bumpless_transfer(&mut state, &input);
    assert_eq!(state.beta_hat(), before);
    run(&mut object, &own, &mut state);

    // What is refused changes nothing.
    let mut about = blank::<bowden_about>();
    let refused =
        unsafe { bowden_adaptive_change_f64(&mut object, &law(-1.0), &sample, &mut about) };
    assert_eq!(refused, bowden_result::ErrorOutOfRange);
    let refused =
        unsafe { bowden_adaptive_change_f64(&mut object, &law(30.0), null_mut(), null_mut()) };
    assert_eq!(refused, bowden_result::ErrorNull);
    run(&mut object, &own, &mut state);
}
