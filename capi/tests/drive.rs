//! What the drive did with a command, and the limit that an inner loop is at: the crate's numbers.

#![allow(missing_docs, clippy::undocumented_unsafe_blocks, clippy::unwrap_used)]

mod objects;
mod signal;

use bowden::*;
use core_bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, AntiWindup, Applied, Fallback, Form,
    Limits, Pid, PidInput, PidSettings, PidState,
};
use objects::blank;
use signal::Signal;
use std::ptr::null_mut;

/// What is reported of the drive after sample `k`, in C's words.
#[derive(Clone, Copy)]
enum Report {
    Nothing,
    Command(f64),
    At(bowden_saturation),
}

fn report(k: u32) -> Report {
    match k % 11 {
        2 => Report::Command(-0.5),
        4 => Report::At(bowden_saturation::Upper),
        5 => Report::At(bowden_saturation::Lower),
        7 => Report::At(bowden_saturation::None),
        8 => Report::Command(f64::NAN),
        9 => Report::Command(2.0),
        _ => Report::Nothing,
    }
}

fn of_side<T>(side: bowden_saturation) -> Applied<T> {
    match side {
        bowden_saturation::None => Applied::AsCommanded,
        bowden_saturation::Upper => Applied::AtUpperLimit,
        bowden_saturation::Lower => Applied::AtLowerLimit,
    }
}

macro_rules! drive {
    ($f:ident) => {
        pastey::paste! {
            #[test]
            fn [<a_pid_is_told_what_the_drive_did_in_ $f>]() {
                for (anti_windup, slew) in [(0, 0.0), (0, 200.0), (1, 0.0), (2, 0.0), (3, 200.0)] {
                    let limits = Limits::try_new(-4.0, 6.0).unwrap();
                    let limits = if slew == 0.0 { limits } else { limits.with_slew(slew).unwrap() };
                    let own = Pid::<$f>::try_new(PidSettings {
                        anti_windup: [
                            AntiWindup::Conditional,
                            AntiWindup::None,
                            AntiWindup::Clamp,
                            AntiWindup::BackCalculation { tracking_time: 0.1 },
                        ][anti_windup],
                        ..PidSettings::new(3.0, 18.0, limits, 0.005, Fallback::try_new(5, 1.0).unwrap())
                    })
                    .unwrap();
                    let mut settings = blank();
                    let mut pid = blank::<[<bowden_pid_ $f>]>();
                    unsafe {
                        [<bowden_pid_settings_pi_ $f>](
                            &mut settings, 3.0, 18.0, -4.0, 6.0, 0.005, 5, 1.0,
                        );
                        settings.anti_windup = anti_windup as u32;
                        settings.tracking_time = 0.1;
                        settings.limits.slew = slew;
                        let made = [<bowden_pid_init_ $f>](&mut pid, &settings, null_mut());
                        assert_eq!(made, bowden_result::Ok);
                    }
                    let (mut state, mut untold) = (PidState::new(), PidState::new());
                    let mut signal = Signal::new();
                    let (mut sides, mut differs) = ([0; 3], 0);
                    for k in 0..4000 {
                        let (reference, measured) = (signal.next(3.0) as $f, signal.measured(k) as $f);
                        let at = PidInput::<$f>::new(signal.dt(k) as $f, reference, measured);
                        let sample = [<bowden_pid_sample_ $f>] {
                            dt: at.dt,
                            reference,
                            measured,
                            velocity: 0.0,
                            feed_forward: 0.0,
                        };
                        if k % 1000 == 999 {
                            state.acknowledge();
                            untold.acknowledge();
                            unsafe { [<bowden_pid_acknowledge_ $f>](&mut pid) };
                        }
                        let (mut out, mut side) = (blank::<[<bowden_output_ $f>]>(), 7);
                        unsafe {
                            [<bowden_pid_step_ $f>](&mut pid, &sample, &mut out);
                            let read = [<bowden_pid_get_saturation_ $f>](&pid, &mut side);
                            assert_eq!(read, bowden_result::Ok);
                        }
                        let expected = own.step(&mut state, &at).command;
                        assert_eq!(out.command.to_bits(), expected.to_bits(), "{k}");
                        differs += u32::from(own.step(&mut untold, &at).command != expected);
                        let wanted = match own.saturation(&state) {
                            Applied::AtUpperLimit => 1,
                            Applied::AtLowerLimit => 2,
                            _ => 0,
                        };
                        assert_eq!(side, wanted, "{k}");
                        sides[wanted as usize] += 1;
                        let (told, wanted) = match report(k) {
                            Report::Nothing => continue,
                            Report::Command(command) => {
                                let command = command as $f;
                                own.applied(&mut state, Applied::Command(command));
                                let told = unsafe { [<bowden_pid_applied_ $f>](&mut pid, command) };
                                let good = command.is_finite();
                                (told, if good { bowden_result::Ok } else { bowden_result::Held })
                            }
                            Report::At(side) => {
                                own.applied(&mut state, of_side(side));
                                let side = side as u32;
                                let told = unsafe { [<bowden_pid_at_limit_ $f>](&mut pid, side) };
                                (told, bowden_result::Ok)
                            }
                        };
                        assert_eq!(told, wanted, "{k}");
                    }
                    assert!(sides.iter().all(|count| *count > 0), "{sides:?}");
                    // The reports are no comment: without them the commands are others.
                    assert!(anti_windup == 1 || differs > 1000, "{anti_windup}: {differs}");
                }
            }

            #[test]
            fn [<an_adaptive_law_is_told_what_the_drive_did_in_ $f>]() {
                let limits = Limits::try_new(-4.0, 6.0).unwrap().with_slew(200.0).unwrap();
                let form = Form::FirstOrder { step: 0.001, plant_gain: 1.0 };
                let fallback = Fallback::try_new(5, 1.0).unwrap();
                let own = Adaptive::<$f, 1>::try_new(AdaptiveSettings::new(
                    form, 24.0, 8.0, 0.1, limits, 0.005, fallback,
                ))
                .unwrap();
                let mut settings = [<bowden_adaptive_settings_ $f>]::defaults();
                let mut law = blank::<[<bowden_adaptive_ $f>]>();
                unsafe {
                    (settings.limits.low, settings.limits.high) = (-4.0, 6.0);
                    settings.longest_dt = 0.005;
                    (settings.fallback.after, settings.fallback.command) = (5, 1.0);
                    settings.form = bowden_form::FirstOrder as u32;
                    (settings.step, settings.plant_gain) = (0.001, 1.0);
                    settings.epsilon = 0.1;
                    settings.limits.slew = 200.0;
                    let made = [<bowden_adaptive_init_ $f>](&mut law, &settings, null_mut());
                    assert_eq!(made, bowden_result::Ok);
                }
                let (mut state, mut untold) = (AdaptiveState::new(&own), AdaptiveState::new(&own));
                let mut signal = Signal::new();
                let mut differs = 0;
                for k in 0..4000 {
                    let (reference, measured) = (signal.next(3.0) as $f, signal.measured(k) as $f);
                    let at = AdaptiveInput::new(signal.dt(k) as $f, reference, measured, [0.0]);
                    let sample = [<bowden_adaptive_sample_ $f>] {
                        dt: at.dt,
                        reference,
                        next_reference: reference,
                        measured,
                        regressors: [0.0; BOWDEN_REGRESSORS],
                        feed_forward: 0.0,
                    };
                    if k % 1000 == 999 {
                        state.acknowledge();
                        untold.acknowledge();
                        unsafe { [<bowden_adaptive_acknowledge_ $f>](&mut law) };
                    }
                    let mut out = blank::<[<bowden_output_ $f>]>();
                    unsafe { [<bowden_adaptive_step_ $f>](&mut law, &sample, &mut out) };
                    let expected = own.step(&mut state, &at).command;
                    assert_eq!(out.command.to_bits(), expected.to_bits(), "{k}");
                    differs += u32::from(own.step(&mut untold, &at).command != expected);
                    let (told, wanted) = match report(k) {
                        Report::Nothing => continue,
                        Report::Command(command) => {
                            let command = command as $f;
                            state.applied(Applied::Command(command));
                            let told = unsafe { [<bowden_adaptive_applied_ $f>](&mut law, command) };
                            let good = command.is_finite();
                            (told, if good { bowden_result::Ok } else { bowden_result::Held })
                        }
                        Report::At(side) => {
                            state.applied(of_side(side));
                            let told =
                                unsafe { [<bowden_adaptive_at_limit_ $f>](&mut law, side as u32) };
                            (told, bowden_result::Ok)
                        }
                    };
                    assert_eq!(told, wanted, "{k}");
                }
                assert!(differs > 1000, "{differs}");
            }
        }
    };
}
drive!(f32);
drive!(f64);

fn pi(k_p: f32, k_i: f32, low: f32, high: f32) -> bowden_pid_f32 {
    let (mut settings, mut pid) = (blank(), blank());
    unsafe {
        bowden_pid_settings_pi_f32(&mut settings, k_p, k_i, low, high, 0.005, 20, 0.0);
        let made = bowden_pid_init_f32(&mut pid, &settings, null_mut());
        assert_eq!(made, bowden_result::Ok);
    }
    pid
}

/// The last command of so many samples.
fn command_after(pid: &mut bowden_pid_f32, sample: &bowden_pid_sample_f32, steps: u32) -> f32 {
    let mut out = blank::<bowden_output_f32>();
    for _ in 0..steps {
        let result = unsafe { bowden_pid_step_f32(pid, sample, &mut out) };
        assert_eq!(result, bowden_result::Ok);
    }
    out.command
}

fn sample(reference: f32, measured: f32) -> bowden_pid_sample_f32 {
    bowden_pid_sample_f32 {
        dt: 0.001,
        reference,
        measured,
        velocity: 0.0,
        feed_forward: 0.0,
    }
}

/// A current loop of k_i = 200 /s: one step of 12 A moves the integral by 2.4, over the whole range
/// of the duty.
#[test]
fn a_large_error_takes_the_command_from_one_limit_to_the_other() {
    let mut pid = pi(0.02, 200.0, -1.0, 1.0);
    assert_eq!(command_after(&mut pid, &sample(0.1, 0.0), 2000), 1.0);
    assert_eq!(command_after(&mut pid, &sample(0.0, 12.0), 1), -1.0);
    assert_eq!(command_after(&mut pid, &sample(0.0, 12.0), 9999), -1.0);
}

/// The integral of the start returns to zero with a time constant of 1 s.
#[test]
fn a_p_law_that_was_resumed_commands_zero_after_a_minute_without_error() {
    let mut pid = pi(4.0, 0.0, -20.0, 20.0);
    let mut out = blank::<bowden_output_f32>();
    let resumed = unsafe { bowden_pid_resume_f32(&mut pid, 0.0, &sample(2.0, 0.0), &mut out) };
    assert_eq!((resumed, out.command), (bowden_result::Ok, 0.0));
    // -8 at the start: what the terms lack there.
    let first = command_after(&mut pid, &sample(2.0, 2.0), 1);
    assert!((-8.0..-7.9).contains(&first), "{first}");
    // 8*exp(-60) is 7e-26.
    assert!(command_after(&mut pid, &sample(2.0, 2.0), 60_000).abs() < 1e-20);
}

/// The inner loop's drive is at its limit; the outer loop, whose command is the inner reference,
/// is told and does not wind up: it turns back with the first sample of the other sign.
#[test]
fn a_cascade_does_not_wind_up_while_its_inner_loop_is_at_the_limit() {
    let (mut inner, mut outer) = (pi(1.0, 10.0, -1.0, 1.0), pi(0.0, 10.0, -100.0, 100.0));
    let (mut alone, mut side) = (pi(0.0, 10.0, -100.0, 100.0), 7);
    let mut wanted = 0.0;
    for _ in 0..5000 {
        wanted = command_after(&mut outer, &sample(1.0, 0.0), 1);
        command_after(&mut alone, &sample(1.0, 0.0), 1);
        command_after(&mut inner, &sample(wanted, 0.0), 1);
        unsafe {
            let read = bowden_pid_get_saturation_f32(&inner, &mut side);
            assert_eq!(read, bowden_result::Ok);
            let told = bowden_pid_at_limit_f32(&mut outer, side);
            assert_eq!(told, bowden_result::Ok);
        }
    }
    assert_eq!(side, bowden_saturation::Upper as u32);
    // 10 /s for 5 s would be 50; the inner loop is at its limit of 1 within 0.5 s.
    assert!(command_after(&mut alone, &sample(1.0, 0.0), 1) > 49.0);
    assert!(wanted < 5.0, "{wanted}");
}

#[test]
fn a_limit_that_there_is_not_is_refused_and_changes_nothing() {
    let mut pid = pi(1.0, 10.0, -1.0, 1.0);
    command_after(&mut pid, &sample(0.5, 0.0), 10);
    let words = pid.opaque;
    for side in [3, u32::MAX] {
        let told = unsafe { bowden_pid_at_limit_f32(&mut pid, side) };
        assert_eq!(told, bowden_result::ErrorChoice);
    }
    for command in [f32::NAN, f32::INFINITY] {
        let told = unsafe { bowden_pid_applied_f32(&mut pid, command) };
        assert_eq!(told, bowden_result::Held);
    }
    assert_eq!(pid.opaque, words);
    let (mut other, mut side) = (blank::<bowden_adaptive_f32>(), 7);
    unsafe {
        for result in [
            bowden_adaptive_applied_f32(&mut other, 0.0),
            bowden_adaptive_at_limit_f32(&mut other, 1),
            bowden_pid_applied_f32(&mut blank(), 0.0),
            bowden_pid_at_limit_f32(&mut blank(), 1),
            bowden_pid_get_saturation_f32(&blank(), &mut side),
        ] {
            assert_eq!(result, bowden_result::ErrorUninitialised);
        }
        for result in [
            bowden_adaptive_applied_f32(null_mut(), 0.0),
            bowden_adaptive_at_limit_f32(null_mut(), 1),
            bowden_pid_applied_f32(null_mut(), 0.0),
            bowden_pid_at_limit_f32(null_mut(), 1),
            bowden_pid_get_saturation_f32(&pid, null_mut()),
        ] {
            assert_eq!(result, bowden_result::ErrorNull);
        }
    }
    assert_eq!(side, 7);
}
