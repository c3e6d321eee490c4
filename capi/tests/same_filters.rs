//! The filters, the velocity from counts and the check of samples: the crate's numbers, to the bit.

#![allow(missing_docs, clippy::undocumented_unsafe_blocks, clippy::unwrap_used)]

mod objects;
mod signal;

use bowden::*;
use core_bowden::signal::{
    Biquad, BiquadState, EdgeVelocity, EdgeVelocityState, Implausible, LowPass, LowPassState,
    Plausible, PlausibleState, RateStatus,
};
use objects::blank;
use signal::Signal;
use std::ptr::null_mut;

macro_rules! filters {
    ($f:ident) => {
        pastey::paste! {
            /// What a filter's step has to return.
            fn [<wanted_ $f>](sample: $f, dt: $f) -> bowden_result {
                if sample.is_finite() && dt.is_finite() && dt > 0.0 {
                    bowden_result::Ok
                } else {
                    bowden_result::Held
                }
            }

            #[test]
            fn [<a_low_pass_in_ $f>]() {
                for time_constant in [0.0, 0.01, 1.0] {
                    let own = LowPass::<$f>::try_new(time_constant).unwrap();
                    let mut state = LowPassState::new();
                    let mut filter = blank::<[<bowden_low_pass_ $f>]>();
                    let made = unsafe {
                        [<bowden_low_pass_init_ $f>](&mut filter, time_constant, null_mut())
                    };
                    assert_eq!(made, bowden_result::Ok);
                    let (mut signal, mut held) = (Signal::new(), 0);
                    for k in 0..4000 {
                        let (x, dt) = (signal.measured(k) as $f, signal.dt(k) as $f);
                        let mut y = 7.0;
                        let result =
                            unsafe { [<bowden_low_pass_step_ $f>](&mut filter, x, dt, &mut y) };
                        assert_eq!(result, [<wanted_ $f>](x, dt), "{k}");
                        assert_eq!(y.to_bits(), own.step(&mut state, x, dt).to_bits(), "{k}");
                        held += u32::from(result == bowden_result::Held);
                    }
                    assert!(held > 100, "{held}");
                }
            }

            #[test]
            fn [<low_pass_and_notch_in_ $f>]() {
                let mut settings = [<bowden_biquad_settings_ $f>]::defaults();
                (settings.frequency, settings.q, settings.sample_time) = (35.0, 2.5, 0.001);
                for is_notch in [false, true] {
                    let (design, init): (fn($f, $f, $f) -> Result<Biquad<$f>, _>, unsafe extern "C" fn(_, _, _) -> _) =
                        if is_notch {
                            (Biquad::notch, [<bowden_biquad_init_notch_ $f>])
                        } else {
                            (Biquad::low_pass, [<bowden_biquad_init_low_pass_ $f>])
                        };
                    let own = design(35.0, 2.5, 0.001).unwrap();
                    let mut state = BiquadState::new();
                    let mut filter = blank::<[<bowden_biquad_ $f>]>();
                    let made = unsafe { init(&mut filter, &settings, null_mut()) };
                    assert_eq!(made, bowden_result::Ok);
                    let mut signal = Signal::new();
                    for k in 0..4000 {
                        let (x, dt) = (signal.measured(k) as $f, signal.dt(k) as $f);
                        let mut y = 7.0;
                        let result =
                            unsafe { [<bowden_biquad_step_ $f>](&mut filter, x, dt, &mut y) };
                        assert_eq!(result, [<wanted_ $f>](x, dt), "{k}");
                        assert_eq!(y.to_bits(), own.step(&mut state, x, dt).to_bits(), "{k}");
                    }
                }
            }

            #[test]
            fn [<a_velocity_from_counts_in_ $f>]() {
                for period in [0.0, 64.0] {
                    let mut own = EdgeVelocity::<$f>::try_new(0.5, 0.01, 0.04).unwrap();
                    if period != 0.0 {
                        own = own.with_period(period).unwrap();
                    }
                    let mut state = EdgeVelocityState::new();
                    let mut edges = blank::<[<bowden_edge_velocity_ $f>]>();
                    let settings = [<bowden_edge_velocity_settings_ $f>] {
                        count: 0.5,
                        time_constant: 0.01,
                        longest_gap: 0.04,
                        period,
                        ..[<bowden_edge_velocity_settings_ $f>]::defaults()
                    };
                    let made = unsafe {
                        [<bowden_edge_velocity_init_ $f>](&mut edges, &settings, null_mut())
                    };
                    assert_eq!(made, bowden_result::Ok);
                    let (mut signal, mut angle, mut seen) = (Signal::new(), 0.0_f64, [0; 4]);
                    for k in 0..4000 {
                        // Fast, slow, at rest; counts of 0.5 that wrap at 64.
                        angle += [0.2, 0.02, 0.0, -0.1][k as usize / 100 % 4];
                        let sound = signal.measured(k);
                        let counts = (angle * 2.0).floor() / 2.0;
                        let counts = if period == 0.0 { counts } else { counts.rem_euclid(64.0) };
                        let x = if sound.is_finite() { counts as $f } else { sound as $f };
                        let dt = signal.dt(k) as $f;
                        let mut out = blank::<[<bowden_edge_velocity_output_ $f>]>();
                        let result = unsafe {
                            [<bowden_edge_velocity_step_ $f>](&mut edges, x, dt, &mut out)
                        };
                        let expected = own.step(&mut state, x, dt);
                        let (wanted, kind) = match expected.status {
                            RateStatus::Good => (bowden_result::Ok, 0),
                            RateStatus::Settling => (bowden_result::Settling, 1),
                            RateStatus::Stopped => (bowden_result::Stopped, 2),
                            RateStatus::Resumed | RateStatus::Held(_) => (bowden_result::Held, 3),
                        };
                        seen[kind] += 1;
                        assert_eq!((result, out.result), (wanted, wanted), "{k}");
                        assert_eq!(out.fault == bowden_fault::None, kind != 3, "{k}");
                        assert_eq!(out.velocity.to_bits(), expected.velocity.to_bits(), "{k}");
                    }
                    assert!(seen.iter().all(|count| *count > 1), "{seen:?}");
                }
            }

            #[test]
            fn [<a_check_of_samples_in_ $f>]() {
                // Range only; with a rate; with the period of the sensor; with all.
                for (rate, sample_period, stuck_after, longest_dt) in [
                    (0.0, 0.0, 0, 0.0),
                    (200.0, 0.0, 0, 0.0),
                    (200.0, 0.005, 0, 0.0),
                    (200.0, 0.005, 3, 0.01),
                ] {
                    let mut own =
                        Plausible::<$f>::try_new(-2.5, 2.5).unwrap().with_stuck_after(stuck_after);
                    if rate != 0.0 {
                        own = own.with_rate(rate).unwrap();
                    }
                    if sample_period != 0.0 {
                        own = own.with_sample_period(sample_period).unwrap();
                    }
                    if longest_dt != 0.0 {
                        own = own.with_longest_dt(longest_dt).unwrap();
                    }
                    let mut state = PlausibleState::new();
                    let mut plausible = blank::<[<bowden_plausible_ $f>]>();
                    let settings = [<bowden_plausible_settings_ $f>] {
                        low: -2.5,
                        high: 2.5,
                        rate,
                        sample_period,
                        stuck_after,
                        longest_dt,
                        ..[<bowden_plausible_settings_ $f>]::defaults()
                    };
                    let made = unsafe {
                        [<bowden_plausible_init_ $f>](&mut plausible, &settings, null_mut())
                    };
                    assert_eq!(made, bowden_result::Ok);
                    let (mut signal, mut last, mut seen) = (Signal::new(), 0.0, [0; 5]);
                    for k in 0..4000 {
                        let (new, dt) = (signal.measured(k) as $f, signal.dt(k) as $f);
                        // Two of three numbers repeat the last one.
                        let x = if k % 9 < 6 { last } else { new };
                        last = x;
                        let moves = k % 2;
                        let mut out = blank::<[<bowden_plausible_output_ $f>]>();
                        let result = unsafe {
                            [<bowden_plausible_step_ $f>](&mut plausible, x, dt, moves, &mut out)
                        };
                        let expected = own.step(&mut state, x, dt, moves != 0);
                        let (wanted, reason) = match expected.fault {
                            None => (bowden_result::Ok, bowden_implausible::None),
                            Some(fault) => (
                                bowden_result::Implausible,
                                match fault {
                                    Implausible::NotFinite => bowden_implausible::NotFinite,
                                    Implausible::OutOfRange => bowden_implausible::OutOfRange,
                                    Implausible::TooFast => bowden_implausible::TooFast,
                                    _ => bowden_implausible::Stuck,
                                },
                            ),
                        };
                        seen[reason as usize] += 1;
                        assert_eq!((result, out.result, out.reason), (wanted, wanted, reason), "{k}");
                        assert_eq!(out.value.is_nan(), expected.value.is_nan(), "{k}");
                        assert!(out.value.is_nan() || out.value.to_bits() == expected.value.to_bits());
                    }
                    assert!(seen[0] > 100 && seen[1] > 10 && seen[2] > 10, "{seen:?}");
                    assert_eq!(seen[3] > 0, rate != 0.0, "{seen:?}");
                    assert_eq!(seen[4] > 0, stuck_after != 0, "{seen:?}");
                }
            }
        }
    };
}
filters!(f32);
filters!(f64);
