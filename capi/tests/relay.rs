//! The relay experiment in C: the crate's numbers to the bit, and what a caller may do wrong.

#![allow(missing_docs, clippy::undocumented_unsafe_blocks, clippy::unwrap_used)]

mod objects;

use bowden::*;
use core_bowden::control::{
    Fallback, Fault, Limits, PiRule, Relay, RelaySettings, RelayState, Status,
};
use objects::blank;
use std::ptr::{null, null_mut};

/// What is done to the experiment.
#[derive(Clone, Copy, PartialEq)]
enum Case {
    Sound,
    Gaps,
    WrongSign,
    NoSamples,
    DeadPlant,
    Noise,
}

macro_rules! relay {
    ($f:ident) => {
        pastey::paste! {
            fn [<own_ $f>](amplitude: $f) -> Relay<$f> {
                Relay::try_new(RelaySettings {
                    reference: 5.0,
                    centre: 10.0,
                    amplitude,
                    hysteresis: 0.05,
                    most_deviation: 8.0,
                    cycles: 4,
                    agreement: 0.05,
                    longest_time: 20.0,
                    longest_dt: 0.05,
                    limits: Limits::try_new(-20.0, 60.0).unwrap(),
                    fallback: Fallback::try_new(20, 1.0).unwrap(),
                })
                .unwrap()
            }

            fn [<settings_ $f>](amplitude: $f) -> [<bowden_relay_settings_ $f>] {
                let mut settings = [<bowden_relay_settings_ $f>]::defaults();
                (settings.reference, settings.centre) = (5.0, 10.0);
                (settings.amplitude, settings.hysteresis) = (amplitude, 0.05);
                (settings.most_deviation, settings.cycles) = (8.0, 4);
                (settings.agreement, settings.longest_time) = (0.05, 20.0);
                (settings.longest_dt, settings.fallback.after) = (0.05, 20);
                (settings.limits.low, settings.limits.high) = (-20.0, 60.0);
                settings.fallback.command = 1.0;
                settings
            }

            /// The last output of an experiment that went on for some samples after its end.
            fn [<ended_ $f>](case: Case) -> [<bowden_relay_output_ $f>] {
                let amplitude = if case == Case::WrongSign { -8.0 } else { 8.0 };
                let own = [<own_ $f>](amplitude);
                let (mut state, mut relay) = (RelayState::new(), blank::<[<bowden_relay_ $f>]>());
                let made = unsafe {
                    [<bowden_relay_init_ $f>](&mut relay, &[<settings_ $f>](amplitude), null_mut())
                };
                assert_eq!(made, bowden_result::Ok);
                let mut lags: [$f; 3] = [5.0; 3];
                let mut last = blank::<[<bowden_relay_output_ $f>]>();
                for k in 0..2100_u32 {
                    let (mut dt, mut y) = (0.01, lags[2]);
                    match case {
                        Case::Gaps if k % 97 == 3 => y = $f::NAN,
                        Case::Gaps if k % 89 == 5 => dt = 0.0,
                        Case::NoSamples if k > 50 => y = $f::INFINITY,
                        Case::DeadPlant => y = 4.0,
                        // Cycles of different lengths.
                        Case::Noise => y = if (k / 10 + k / 70) % 2 == 0 { 4.0 } else { 6.0 },
                        _ => {}
                    }
                    let result =
                        unsafe { [<bowden_relay_step_ $f>](&mut relay, dt, y, &mut last) };
                    let expected = own.step(&mut state, dt, y);
                    assert_eq!(last.command.to_bits(), expected.command.to_bits(), "{k}");
                    assert_eq!((last.result, last.cycles), (result, state.cycles()), "{k}");
                    let (wanted, phase) = match expected.status {
                        Status::Good if state.result().is_some() => {
                            (bowden_result::Ok, bowden_relay_phase::Done)
                        }
                        Status::Held(_) => (bowden_result::Held, bowden_relay_phase::Running),
                        Status::Safe(_) => (bowden_result::Safe, bowden_relay_phase::Failed),
                        _ => (bowden_result::Ok, bowden_relay_phase::Running),
                    };
                    assert_eq!((result, last.phase), (wanted, phase), "{k}");
                    let failure = match expected.status {
                        Status::Safe(Fault::OutputOutOfRange) => {
                            bowden_relay_failure::OutputOutOfRange
                        }
                        Status::Safe(Fault::NoOscillation) => bowden_relay_failure::NoOscillation,
                        Status::Safe(Fault::TimeOut) => bowden_relay_failure::TimeOut,
                        Status::Safe(_) => bowden_relay_failure::BadSamples,
                        _ => bowden_relay_failure::None,
                    };
                    assert_eq!(last.failure, failure, "{k}");
                    let mut latched = 7;
                    unsafe { [<bowden_relay_is_latched_ $f>](&relay, &mut latched) };
                    assert_eq!(latched, u32::from(state.is_latched()), "{k}");
                    let mut gains = [<bowden_pi_gains_ $f>] { k_p: 7.0, k_i: 7.0 };
                    for (rule, own_rule) in [(0, PiRule::TyreusLuyben), (1, PiRule::ZieglerNichols)] {
                        let told =
                            unsafe { [<bowden_relay_gains_ $f>](&last.ultimate, rule, &mut gains) };
                        let Some(ultimate) = state.result() else {
                            assert_eq!(told, bowden_result::ErrorOutOfRange);
                            assert_eq!((gains.k_p, gains.k_i), (7.0, 7.0));
                            continue;
                        };
                        assert_eq!(told, bowden_result::Ok);
                        let own = ultimate.pi(own_rule);
                        assert_eq!(gains.k_p.to_bits(), own.k_p.to_bits());
                        assert_eq!(gains.k_i.to_bits(), own.k_i.to_bits());
                    }
                    // A plant of three lags of 0.1 s and gain 0.5.
                    let input = [0.5 * last.command, lags[0], lags[1]];
                    for (lag, input) in lags.iter_mut().zip(input) {
                        *lag += (input - *lag) * 0.01 / 0.1;
                    }
                }
                // The next good sample after an acknowledgement is the first of a new experiment.
                unsafe { [<bowden_relay_acknowledge_ $f>](&mut relay) };
                let mut again = last;
                unsafe { [<bowden_relay_step_ $f>](&mut relay, 0.01, 5.0, &mut again) };
                let runs = last.phase == bowden_relay_phase::Failed;
                assert_eq!(again.phase == bowden_relay_phase::Running, runs);
                last
            }

            #[test]
            fn [<a_relay_experiment_in_ $f>]() {
                use bowden_relay_failure as F;
                for case in [Case::Sound, Case::Gaps] {
                    let ended = [<ended_ $f>](case);
                    assert_eq!((ended.phase, ended.failure), (bowden_relay_phase::Done, F::None));
                    // Three equal lags: the ultimate gain is 8/0.5, the period 2*pi*0.1/sqrt(3) and
                    // two samples of delay; the hysteresis makes the gain less.
                    assert!((8.0..16.0).contains(&ended.ultimate.gain), "{:?}", ended.ultimate);
                    assert!((0.36..0.46).contains(&ended.ultimate.period), "{:?}", ended.ultimate);
                }
                for (case, failure) in [
                    (Case::WrongSign, F::NoOscillation),
                    (Case::NoSamples, F::BadSamples),
                    (Case::DeadPlant, F::NoOscillation),
                    (Case::Noise, F::TimeOut),
                ] {
                    let ended = [<ended_ $f>](case);
                    assert_eq!((ended.failure, ended.command), (failure, 1.0));
                    assert_eq!(ended.ultimate, blank());
                    let fault = if failure == F::BadSamples { bowden_fault::Measured } else { bowden_fault::None };
                    assert_eq!(ended.fault, fault);
                }
            }
        }
    };
}
relay!(f32);
relay!(f64);

#[test]
fn what_is_wrong_with_a_relay_is_told() {
    let mut relay = blank::<bowden_relay_f64>();
    let mut about = blank::<bowden_about>();
    type Change = fn(&mut bowden_relay_settings_f64);
    let unset = bowden_relay_settings_f64::defaults();
    assert_eq!((unset.cycles, unset.fallback.after), (0, 0));
    let cases: [(Change, bowden_result, &str); 7] = [
        (
            |s| s.reference = f64::MAX,
            bowden_result::ErrorOutOfRange,
            "reference",
        ),
        (
            |s| s.centre = f64::MAX,
            bowden_result::ErrorOutOfRange,
            "centre",
        ),
        (
            |s| s.amplitude = 0.0,
            bowden_result::ErrorOutOfRange,
            "amplitude",
        ),
        (
            |s| s.hysteresis = -1.0,
            bowden_result::ErrorOutOfRange,
            "hysteresis",
        ),
        (|s| s.cycles = 0, bowden_result::ErrorOutOfRange, "cycles"),
        (
            |s| s.limits.slew = 5.0,
            bowden_result::ErrorInadmissible,
            "the limits of a relay must not include a slew-rate limit",
        ),
        (
            |s| s.fallback.after = BOWDEN_HOLD_FOR_EVER,
            bowden_result::ErrorInadmissible,
            "a relay must have a safe command",
        ),
    ];
    for (change, code, name) in cases {
        let mut settings = settings_f64(8.0);
        change(&mut settings);
        let told = unsafe { bowden_relay_init_f64(&mut relay, &settings, &mut about) };
        let text = unsafe { std::ffi::CStr::from_ptr(about.text.as_ptr()) };
        assert_eq!((told, text.to_str().unwrap()), (code, name));
        assert_eq!(relay.opaque, [0; BOWDEN_RELAY_F64_WORDS]);
    }
}

#[test]
fn gains_of_nonsense_and_bad_pointers_are_told() {
    let mut relay = blank::<bowden_relay_f64>();
    let ultimate = bowden_ultimate_f64 {
        gain: 8.0,
        period: 3.6,
        amplitude: 0.2,
        duty: 0.5,
    };
    let mut gains = bowden_pi_gains_f64 { k_p: 7.0, k_i: 7.0 };
    let (mut out, mut latched) = (blank(), 7);
    unsafe {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let period = bowden_ultimate_f64 {
                period: bad,
                ..ultimate
            };
            // An infinite period would give an integral gain of zero.
            let told = bowden_relay_gains_f64(&period, 0, &mut gains);
            assert_eq!(told, bowden_result::ErrorOutOfRange, "{bad}");
        }
        for (result, wanted) in [
            (
                bowden_relay_gains_f64(&ultimate, 2, &mut gains),
                bowden_result::ErrorChoice,
            ),
            (
                bowden_relay_gains_f64(null(), 0, &mut gains),
                bowden_result::ErrorNull,
            ),
            (
                bowden_relay_gains_f64(&ultimate, 0, null_mut()),
                bowden_result::ErrorNull,
            ),
            (
                bowden_relay_step_f64(null_mut(), 0.1, 0.0, &mut out),
                bowden_result::ErrorNull,
            ),
            (
                bowden_relay_step_f64(&mut relay, 0.1, 0.0, null_mut()),
                bowden_result::ErrorNull,
            ),
            (
                bowden_relay_step_f64(&mut relay, 0.1, 0.0, &mut out),
                bowden_result::ErrorUninitialised,
            ),
            (
                bowden_relay_acknowledge_f64(&mut relay),
                bowden_result::ErrorUninitialised,
            ),
            (
                bowden_relay_is_latched_f64(&relay, &mut latched),
                bowden_result::ErrorUninitialised,
            ),
        ] {
            assert_eq!(result, wanted);
        }
    }
    assert_eq!((gains.k_p, gains.k_i, latched), (7.0, 7.0, 7));
}
