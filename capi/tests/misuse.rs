//! What a C caller may do wrong: told, nothing written, nothing moved.

#![allow(missing_docs, clippy::undocumented_unsafe_blocks, clippy::unwrap_used)]

mod objects;

use bowden::*;
use objects::blank;
use std::ffi::CStr;
use std::mem::{size_of, MaybeUninit};
use std::ptr::{null, null_mut};

fn settings() -> bowden_pid_settings_f32 {
    let mut settings = blank();
    let made = unsafe {
        bowden_pid_settings_pi_f32(&mut settings, 30.0, 18.0, -20.0, 60.0, 0.005, 20, 0.0)
    };
    assert_eq!(made, bowden_result::Ok);
    settings
}

fn started() -> bowden_pid_f32 {
    let mut pid = blank();
    let made = unsafe { bowden_pid_init_f32(&mut pid, &settings(), null_mut()) };
    assert_eq!(made, bowden_result::Ok);
    pid
}

const SAMPLE: bowden_pid_sample_f32 = bowden_pid_sample_f32 {
    dt: 0.001,
    reference: 1.0,
    measured: 0.5,
    velocity: 0.0,
    feed_forward: 0.0,
};

/// Text of a refusal.
fn text(about: &bowden_about) -> String {
    let bytes = about.text.iter().map(|byte| *byte as u8);
    String::from_utf8(bytes.take_while(|byte| *byte != 0).collect()).unwrap()
}

#[test]
fn a_null_pointer_is_told_at_every_place() {
    let (mut pid, mut out) = (started(), blank());
    let (mut latched, mut terms) = (0, blank());
    unsafe {
        for result in [
            bowden_pid_settings_pi_f32(null_mut(), 1.0, 1.0, 0.0, 1.0, 1.0, 1, 0.0),
            bowden_pid_init_f32(null_mut(), &settings(), null_mut()),
            bowden_pid_init_f32(&mut pid, null(), null_mut()),
            bowden_pid_step_f32(null_mut(), &SAMPLE, &mut out),
            bowden_pid_step_f32(&mut pid, null(), &mut out),
            bowden_pid_step_f32(&mut pid, &SAMPLE, null_mut()),
            bowden_pid_get_terms_f32(null(), &mut terms),
            bowden_pid_get_terms_f32(&pid, null_mut()),
            bowden_pid_acknowledge_f32(null_mut()),
            bowden_pid_reset_f32(null_mut()),
            bowden_pid_resume_f32(null_mut(), 0.0, &SAMPLE, null_mut()),
            bowden_pid_resume_f32(&mut pid, 0.0, null(), null_mut()),
            bowden_pid_change_f32(&mut pid, null(), null_mut()),
            bowden_pid_is_latched_f32(&pid, null_mut()),
            bowden_pid_is_latched_f32(null(), &mut latched),
            bowden_adaptive_step_f64(null_mut(), null(), null_mut()),
            bowden_adaptive_init_f64(null_mut(), null(), null_mut()),
            bowden_model_load_f64(null_mut(), null(), 0, 0.0, null_mut()),
            bowden_model_step_f64(null_mut(), null(), null_mut()),
            bowden_compensator_init_f64(null_mut(), null(), 1.0, null(), 0, null_mut()),
            bowden_compensator_step_f64(null_mut(), null(), null_mut()),
            bowden_rates_init_f64(null_mut(), null(), null_mut()),
            bowden_rates_step_f64(null_mut(), 0.0, 0.001, null_mut()),
            bowden_observer_init_f64(null_mut(), null(), null_mut()),
            bowden_observer_step_f64(null_mut(), 0.001, 0.0, 0.0, null_mut()),
            bowden_observer_feed_forward_f64(null(), null(), null_mut()),
            bowden_observer_reset_f64(null_mut()),
            bowden_iterative_learning_init_f64(
                null_mut(),
                null(),
                null_mut(),
                null_mut(),
                9,
                null_mut(),
            ),
            bowden_iterative_learning_resume_f64(
                null_mut(),
                null(),
                null_mut(),
                null_mut(),
                9,
                null_mut(),
            ),
            bowden_iterative_learning_step_f64(null_mut(), 0.0, 0.0, 0.0, 1, null_mut()),
            bowden_low_pass_init_f64(null_mut(), 0.5, null_mut()),
            bowden_low_pass_step_f64(null_mut(), 0.0, 0.001, null_mut()),
            bowden_biquad_init_low_pass_f64(null_mut(), null(), null_mut()),
            bowden_biquad_init_notch_f64(null_mut(), null(), null_mut()),
            bowden_biquad_step_f64(null_mut(), 0.0, 0.001, null_mut()),
            bowden_edge_velocity_init_f64(null_mut(), null(), null_mut()),
            bowden_edge_velocity_step_f64(null_mut(), 0.0, 0.001, null_mut()),
            bowden_plausible_init_f64(null_mut(), null(), null_mut()),
            bowden_plausible_step_f64(null_mut(), 0.0, 0.001, 1, null_mut()),
            bowden_play_init_f64(null_mut(), 0.5, null_mut()),
            bowden_play_step_f64(null_mut(), 0.0, null_mut()),
            bowden_cable_init_f64(null_mut(), null(), null_mut()),
            bowden_cable_step_f64(null_mut(), 0.0, null_mut()),
            bowden_inverse_init_f64(null_mut(), null(), null_mut()),
            bowden_inverse_step_f64(null_mut(), 0.0, null_mut()),
            bowden_hysteresis_init_f64(null_mut(), null(), null_mut()),
            bowden_hysteresis_step_f64(null_mut(), 0.0, null_mut()),
        ] {
            assert_eq!(result, bowden_result::ErrorNull);
        }
        // A step that was refused has moved nothing.
        bowden_pid_get_terms_f32(&pid, &mut terms);
        assert_eq!((terms.error, terms.integral), (0.0, 0.0));
        // Where the output is not wanted, null is fine.
        assert_eq!(
            bowden_pid_resume_f32(&mut pid, 3.0, &SAMPLE, null_mut()),
            bowden_result::Ok
        );
    }
}

#[test]
fn a_misaligned_pointer_is_told() {
    let mut memory = [0_u64; 64];
    let odd = |by: usize| -> *mut u8 { memory.as_ptr().cast::<u8>().wrapping_add(by).cast_mut() };
    let mut out = blank::<bowden_output_f32>();
    let mut pid = started();
    unsafe {
        for by in 1..8 {
            let result = bowden_pid_init_f32(odd(by).cast(), &settings(), null_mut());
            assert_eq!(result, bowden_result::ErrorMisaligned);
            let result = bowden_pid_step_f32(odd(by).cast(), &SAMPLE, &mut out);
            assert_eq!(result, bowden_result::ErrorMisaligned);
        }
        for by in 1..4 {
            let result = bowden_pid_step_f32(&mut pid, odd(by).cast(), &mut out);
            assert_eq!(result, bowden_result::ErrorMisaligned);
            let result = bowden_pid_step_f32(&mut pid, &SAMPLE, odd(by).cast());
            assert_eq!(result, bowden_result::ErrorMisaligned);
        }
    }
    memory[0] = 1;
    assert_eq!(memory[1..], [0; 63]);
}

#[test]
fn memory_that_was_not_initialised_or_was_written_over_is_told() {
    let mut out = bowden_output_f32 {
        command: 7.0,
        result: bowden_result::Safe,
        fault: bowden_fault::Other,
        regressor: 9,
    };
    let before = out;
    for byte in [0x00, 0xff, 0xa5] {
        let mut pid = MaybeUninit::<bowden_pid_f32>::uninit();
        unsafe {
            pid.as_mut_ptr().write_bytes(byte, 1);
            let result = bowden_pid_step_f32(pid.as_mut_ptr(), &SAMPLE, &mut out);
            assert_eq!(result, bowden_result::ErrorUninitialised);
        }
    }
    // A word too far from the object before, or from the one behind it.
    for word in [0, BOWDEN_PID_F32_WORDS - 1] {
        let mut pid = started();
        pid.opaque[word] ^= 1;
        let result = unsafe { bowden_pid_step_f32(&mut pid, &SAMPLE, &mut out) };
        assert_eq!(result, bowden_result::ErrorUninitialised);
    }
    // An object of another type.
    let mut pid = started();
    let other: *mut bowden_pid_f32 = &mut pid;
    let mut motion = blank();
    let result = unsafe { bowden_rates_step_f32(other.cast(), 0.0, 0.001, &mut motion) };
    assert_eq!(result, bowden_result::ErrorUninitialised);
    assert_eq!(out, before);
}

#[test]
fn a_setting_that_is_refused_is_named_and_the_object_is_as_it_was() {
    use bowden_result as R;
    type Change = fn(&mut bowden_pid_settings_f32);
    let cases: [(Change, R, &str); 11] = [
        (|s| s.k_p = f32::NAN, R::ErrorNonFinite, "k_p"),
        (|s| s.k_i = f32::INFINITY, R::ErrorNonFinite, "k_i"),
        (
            |s| s.k_i = -1.0,
            R::ErrorInadmissible,
            "k_p and k_i must have the same sign",
        ),
        (|s| s.damping = 2, R::ErrorChoice, "damping"),
        (|s| s.anti_windup = u32::MAX, R::ErrorChoice, "anti_windup"),
        (|s| s.limits.low = 60.0, R::ErrorInadmissible, "low < high"),
        (|s| s.limits.slew = -1.0, R::ErrorOutOfRange, "slew"),
        (|s| s.longest_dt = 0.0, R::ErrorOutOfRange, "longest_dt"),
        (|s| s.fallback.after = 0, R::ErrorOutOfRange, "after"),
        (|s| s.fallback.weight = 0, R::ErrorOutOfRange, "weight"),
        (
            |s| s.fallback.command = 99.0,
            R::ErrorInadmissible,
            "the safe command lies within the limits",
        ),
    ];
    let mut running = started();
    let mut out = blank::<bowden_output_f32>();
    unsafe { bowden_pid_step_f32(&mut running, &SAMPLE, &mut out) };
    let words = running.opaque;
    for (change, code, name) in cases {
        let mut bad = settings();
        change(&mut bad);
        let mut about = blank();
        let mut pid = blank::<bowden_pid_f32>();
        assert_eq!(
            unsafe { bowden_pid_init_f32(&mut pid, &bad, &mut about) },
            code
        );
        assert_eq!(text(&about), name);
        assert_eq!(pid.opaque, [0; BOWDEN_PID_F32_WORDS]);
        assert_eq!(
            unsafe { bowden_pid_change_f32(&mut running, &bad, &mut about) },
            code
        );
        assert_eq!(running.opaque[..], words);
    }
    let mut about = blank();
    let made = unsafe { bowden_pid_init_f32(&mut running, &settings(), &mut about) };
    assert_eq!((made, text(&about)), (R::Ok, String::new()));
}

#[test]
fn a_half_width_that_is_refused_is_named_and_the_play_is_as_it_was() {
    let (mut play, mut y) = (blank::<bowden_play_f32>(), 0.0);
    unsafe {
        bowden_play_init_f32(&mut play, 0.5, null_mut());
        bowden_play_step_f32(&mut play, 2.0, &mut y);
    }
    let words = play.opaque;
    for (half_width, code) in [
        (-0.5, bowden_result::ErrorOutOfRange),
        (f32::NAN, bowden_result::ErrorNonFinite),
        (f32::INFINITY, bowden_result::ErrorNonFinite),
    ] {
        let mut about = blank();
        let made = unsafe { bowden_play_init_f32(&mut play, half_width, &mut about) };
        assert_eq!((made, text(&about).as_str()), (code, "half_width"));
        assert_eq!(play.opaque, words);
    }
}

/// A model whose sigma is above what can be turned round.
#[test]
fn a_long_condition_is_told_whole() {
    let mut settings = bowden_cable_settings_f64 {
        mode: bowden_mode::Torque as u32,
        gain: 0.952,
        kappa_eta: 2.29,
        offset: 0.05,
        rho: 0.382,
        sigma: 2.97,
        n: 1.02,
        ..bowden_cable_settings_f64::defaults()
    };
    let (mut inverse, mut about) = (blank(), blank());
    let made = unsafe { bowden_inverse_init_f64(&mut inverse, &settings, &mut about) };
    assert_eq!(made, bowden_result::ErrorInadmissible);
    let shape = core_bowden::hysteresis::BoucWen::try_new(0.382, 2.97, 1.02).unwrap();
    let cable = core_bowden::transmission::Transmission::torque(0.952, 2.29, 0.05, shape);
    let error = cable.unwrap().inverse().unwrap_err();
    assert!(error.parameter().is_ascii());
    assert_eq!(text(&about), error.parameter());
    settings.mode = 2;
    let made = unsafe { bowden_inverse_init_f64(&mut inverse, &settings, &mut about) };
    assert_eq!(
        (made, text(&about)),
        (bowden_result::ErrorChoice, "mode".to_owned())
    );
}

#[test]
fn more_items_than_there_is_room_for_are_refused() {
    let bytes = include_bytes!("../../examples/data/demo.postcard");
    let (mut model, mut y) = (blank::<bowden_model_f32>(), 0.0);
    let channels = [bowden_motion_f32::default(); BOWDEN_CHANNELS + 1];
    let mut sample = blank::<bowden_model_sample_f32>();
    sample.dt = 0.001;
    sample.channels = channels.as_ptr();
    unsafe {
        bowden_model_load_f32(&mut model, bytes.as_ptr(), bytes.len(), 0.0, null_mut());
        for (count, result) in [
            (0, bowden_result::Held),
            (1, bowden_result::Ok),
            (BOWDEN_CHANNELS, bowden_result::Ok),
            (BOWDEN_CHANNELS + 1, bowden_result::ErrorCapacity),
            (usize::MAX, bowden_result::ErrorCapacity),
        ] {
            sample.channel_count = count;
            assert_eq!(
                bowden_model_step_f32(&mut model, &sample, &mut y),
                result,
                "{count}"
            );
        }
        sample.channel_count = 2;
        sample.channels = null();
        let result = bowden_model_step_f32(&mut model, &sample, &mut y);
        assert_eq!(result, bowden_result::ErrorNull);
        let mut law = bowden_adaptive_settings_f32::defaults();
        let mut own = blank::<bowden_adaptive_f32>();
        (law.limits.low, law.limits.high) = (0.0, 1.0);
        (law.longest_dt, law.fallback.after) = (0.005, 5);
        law.regressors = 5;
        let result = bowden_adaptive_init_f32(&mut own, &law, null_mut());
        assert_eq!(result, bowden_result::ErrorCapacity);
    }
}

/// What the README says is refused after the start, beside pointers and objects.
#[test]
fn what_is_refused_after_the_start_leaves_the_object_as_it_was() {
    let bytes = include_bytes!("../../examples/data/demo.postcard");
    let (mut model, mut turned) = (blank::<bowden_model_f32>(), blank());
    let mut pid = started();
    let channels = [bowden_motion_f32::default(); BOWDEN_CHANNELS + 1];
    let mut sample = blank::<bowden_compensator_sample_f32>();
    (sample.dt, sample.channels) = (0.001, channels.as_ptr());
    sample.channel_count = BOWDEN_CHANNELS + 1;
    let mut bad = settings();
    bad.k_p = f32::NAN;
    let (mut eta, mut out) = (7.0, blank());
    unsafe {
        bowden_model_load_f32(&mut model, bytes.as_ptr(), bytes.len(), 0.25, null_mut());
        let (none, about) = (null(), null_mut());
        let made = bowden_compensator_init_f32(&mut turned, &model, 0.01, none, 0, about);
        assert_eq!(made, bowden_result::Ok);
        let (before, of_pid) = ((model.opaque, turned.opaque), pid.opaque);
        for (value, result) in [
            (f32::NAN, bowden_result::ErrorNonFinite),
            (f32::INFINITY, bowden_result::ErrorNonFinite),
            (1.5, bowden_result::ErrorOutOfRange),
        ] {
            assert_eq!(bowden_model_reset_f32(&mut model, value), result);
            assert_eq!(bowden_compensator_reset_f32(&mut turned, value), result);
        }
        let result = bowden_compensator_step_f32(&mut turned, &sample, &mut out);
        assert_eq!(result, bowden_result::ErrorCapacity);
        let result = bowden_pid_change_f32(&mut pid, &bad, null_mut());
        assert_eq!(result, bowden_result::ErrorNonFinite);
        assert_eq!((model.opaque, turned.opaque), before);
        assert_eq!(pid.opaque, of_pid);
        bowden_model_eta_f32(&model, &mut eta);
        assert_eq!(eta, 0.25);
    }
}

#[test]
fn every_code_has_a_text_of_ascii_and_no_other_has_one_of_theirs() {
    let of = |pointer| {
        unsafe { CStr::from_ptr(pointer) }
            .to_str()
            .unwrap()
            .to_owned()
    };
    let texts: Vec<String> = (-10..=7).map(|code| of(bowden_result_text(code))).collect();
    for (index, text) in texts.iter().enumerate() {
        assert!(text.is_ascii() && !text.is_empty());
        assert_eq!(texts.iter().position(|other| other == text), Some(index));
    }
    for code in [-11, 8, i32::MIN, i32::MAX] {
        assert_eq!(of(bowden_result_text(code)), "no result of this library");
        assert_eq!(
            of(bowden_fault_text(code.saturating_add(50))),
            "another fault"
        );
    }
    assert_eq!(of(bowden_version()), "0.2.0");
}

/// A copy of an object goes on as the object itself does.
#[test]
fn an_object_may_be_copied() {
    let (mut pid, mut out) = (started(), blank::<bowden_output_f32>());
    unsafe { bowden_pid_step_f32(&mut pid, &SAMPLE, &mut out) };
    let mut copy = bowden_pid_f32 { opaque: pid.opaque };
    let mut other = blank::<bowden_output_f32>();
    unsafe {
        bowden_pid_step_f32(&mut pid, &SAMPLE, &mut out);
        bowden_pid_step_f32(&mut copy, &SAMPLE, &mut other);
    }
    assert_eq!(out, other);
    assert_eq!(size_of::<bowden_pid_f32>(), 8 * BOWDEN_PID_F32_WORDS);
}
