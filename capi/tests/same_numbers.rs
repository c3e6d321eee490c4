//! Every step through the C interface against the crate's own, to the bit, bad samples included.

#![allow(missing_docs, clippy::undocumented_unsafe_blocks, clippy::unwrap_used)]

mod objects;
mod signal;

use bowden::*;
use core_bowden::control::{
    AntiWindup, DerivativeSource, DisturbanceObserver, Fallback, Limits, NominalPlant,
    ObserverInput, ObserverState, Pid, PidInput, PidSettings, PidState, Status,
};
use core_bowden::effect::Motion;
use core_bowden::hysteresis::{BoucWen, BoucWenState};
use core_bowden::signal::{Play, PlayState, Rates, RatesState};
use core_bowden::transmission::Transmission;
use objects::blank;
use signal::Signal;
use std::ptr::null_mut;

/// What the crate's status is in C.
fn result_of(status: Status) -> bowden_result {
    match status {
        Status::Good => bowden_result::Ok,
        Status::Degraded(_) => bowden_result::Degraded,
        Status::Held(_) => bowden_result::Held,
        Status::Safe(_) => bowden_result::Safe,
    }
}

macro_rules! pid {
    ($name:ident, $f:ident, $object:ident, $settings:ident, $sample:ident, $output:ident,
     $init:ident, $pi:ident, $step:ident, $acknowledge:ident, $latched:ident) => {
        mod $name {
            use super::*;

            fn own(damping: usize, anti_windup: usize, options: [$f; 3]) -> Pid<$f> {
                let [integral_limit, deadband, period] = options;
                let some = |value| (value != 0.0).then_some(value);
                Pid::<$f>::try_new(PidSettings {
                    k_d: 0.2,
                    derivative_time: 0.01,
                    damping: [
                        DerivativeSource::on_error(),
                        DerivativeSource::Velocity,
                        DerivativeSource::on_measurement(),
                    ][damping],
                    integral_limit: some(integral_limit),
                    deadband,
                    period: some(period),
                    anti_windup: [
                        AntiWindup::Conditional,
                        AntiWindup::None,
                        AntiWindup::Clamp,
                        AntiWindup::BackCalculation { tracking_time: 0.1 },
                    ][anti_windup],
                    ..PidSettings::new(
                        30.0,
                        18.0,
                        Limits::try_new(-20.0, 60.0)
                            .unwrap()
                            .with_slew(2000.0)
                            .unwrap(),
                        0.005,
                        Fallback::try_new(5, 1.0).unwrap(),
                    )
                })
                .unwrap()
            }

            fn in_c(damping: usize, anti_windup: usize, options: [$f; 3]) -> $object {
                let (mut settings, mut pid) = (blank::<$settings>(), blank());
                unsafe {
                    assert_eq!(
                        $pi(&mut settings, 30.0, 18.0, -20.0, 60.0, 0.005, 5, 1.0),
                        bowden_result::Ok
                    );
                    settings.k_d = 0.2;
                    settings.derivative_time = 0.01;
                    settings.damping = u32::from(damping == 1);
                    // The default is the derivative on the measurement.
                    assert_eq!(settings.derivative_weight, 0.0);
                    if damping == 0 {
                        settings.derivative_weight = 1.0;
                    }
                    [settings.integral_limit, settings.deadband, settings.period] = options;
                    settings.anti_windup = anti_windup as u32;
                    settings.tracking_time = 0.1;
                    settings.limits.slew = 2000.0;
                    assert_eq!($init(&mut pid, &settings, null_mut()), bowden_result::Ok);
                }
                pid
            }

            #[test]
            fn has_the_crates_numbers() {
                for (damping, anti_windup, options) in [
                    (0, 0, [0.0; 3]),
                    (0, 3, [0.0; 3]),
                    (1, 2, [0.0; 3]),
                    (0, 1, [0.0; 3]),
                    (2, 0, [0.5, 0.0, 0.0]),
                    (2, 3, [0.0, 0.3, 0.0]),
                    (2, 1, [4.0, 0.3, 6.0]),
                ] {
                    let own = own(damping, anti_windup, options);
                    let mut pid = in_c(damping, anti_windup, options);
                    let mut state = PidState::new();
                    let mut signal = Signal::new();
                    let (mut held, mut safe) = (0, 0);
                    for k in 0..4000 {
                        let at = PidInput::<$f> {
                            dt: signal.dt(k) as $f,
                            reference: signal.next(3.0) as $f,
                            measured: signal.measured(k) as $f,
                            velocity: signal.next(1.0) as $f,
                            feed_forward: signal.next(0.5) as $f,
                        };
                        let sample = $sample {
                            dt: at.dt,
                            reference: at.reference,
                            measured: at.measured,
                            velocity: at.velocity,
                            feed_forward: at.feed_forward,
                        };
                        let mut out = blank::<$output>();
                        let mut latched = 7;
                        if k % 1000 == 999 {
                            state.acknowledge();
                            assert_eq!(unsafe { $acknowledge(&mut pid) }, bowden_result::Ok);
                        }
                        let result = unsafe { $step(&mut pid, &sample, &mut out) };
                        unsafe { $latched(&pid, &mut latched) };
                        let expected = own.step(&mut state, &at);
                        assert_eq!(out.command.to_bits(), expected.command.to_bits(), "{k}");
                        assert_eq!((result, out.result), (result_of(expected.status), result));
                        assert_eq!(latched, u32::from(state.is_latched()));
                        held += u32::from(result == bowden_result::Held);
                        safe += u32::from(result == bowden_result::Safe);
                    }
                    assert!(held > 10 && safe > 100, "{held} {safe}");
                }
            }
        }
    };
}
pid!(
    a_pid_in_f32,
    f32,
    bowden_pid_f32,
    bowden_pid_settings_f32,
    bowden_pid_sample_f32,
    bowden_output_f32,
    bowden_pid_init_f32,
    bowden_pid_settings_pi_f32,
    bowden_pid_step_f32,
    bowden_pid_acknowledge_f32,
    bowden_pid_is_latched_f32
);
pid!(
    a_pid_in_f64,
    f64,
    bowden_pid_f64,
    bowden_pid_settings_f64,
    bowden_pid_sample_f64,
    bowden_output_f64,
    bowden_pid_init_f64,
    bowden_pid_settings_pi_f64,
    bowden_pid_step_f64,
    bowden_pid_acknowledge_f64,
    bowden_pid_is_latched_f64
);

macro_rules! cable {
    ($name:ident, $f:ident, $cable:ident, $inverse:ident, $hysteresis:ident, $settings:ident, $alone:ident,
     $cable_init:ident, $cable_step:ident, $inverse_init:ident, $inverse_step:ident,
     $hysteresis_init:ident, $hysteresis_step:ident) => {
        #[test]
        fn $name() {
            let shape = BoucWen::<$f>::try_new(0.09582, 0.6, 3.871).unwrap();
            for mode in [bowden_mode::Torque, bowden_mode::Displacement] {
                let build = match mode {
                    bowden_mode::Torque => Transmission::torque,
                    bowden_mode::Displacement => Transmission::displacement,
                };
                let own = build(0.9978, 7.004, 0.05174, shape).unwrap();
                let own_inverse = own.inverse().unwrap();
                let mut states = [BoucWenState::with_eta(0.25).unwrap(); 3];
                let settings = $settings {
                    mode: mode as u32,
                    gain: 0.9978,
                    kappa_eta: 7.004,
                    offset: 0.05174,
                    rho: 0.09582,
                    sigma: 0.6,
                    n: 3.871,
                    eta: 0.25,
                    ..$settings::defaults()
                };
                let alone = $alone {
                    rho: 0.09582,
                    sigma: 0.6,
                    n: 3.871,
                    eta: 0.25,
                    ..$alone::defaults()
                };
                let (mut cable, mut inverse) = (blank::<$cable>(), blank::<$inverse>());
                let mut hysteresis = blank::<$hysteresis>();
                unsafe {
                    let nobody = null_mut();
                    assert_eq!(
                        $cable_init(&mut cable, &settings, nobody),
                        bowden_result::Ok
                    );
                    assert_eq!(
                        $inverse_init(&mut inverse, &settings, nobody),
                        bowden_result::Ok
                    );
                    let tried = $hysteresis_init(&mut hysteresis, &alone, nobody);
                    assert_eq!(tried, bowden_result::Ok);
                }
                let mut signal = Signal::new();
                for k in 0..2000 {
                    let x = signal.measured(k) as $f;
                    let (mut y, mut u, mut eta) = (7.0, 7.0, 7.0);
                    let wanted = if x.is_finite() {
                        bowden_result::Ok
                    } else {
                        bowden_result::Held
                    };
                    unsafe {
                        assert_eq!($cable_step(&mut cable, x, &mut y), wanted);
                        assert_eq!($inverse_step(&mut inverse, x, &mut u), wanted);
                        assert_eq!($hysteresis_step(&mut hysteresis, x, &mut eta), wanted);
                    }
                    let [forward, back, alone] = &mut states;
                    assert_eq!(y.to_bits(), own.step(forward, x).to_bits(), "{k}");
                    assert_eq!(u.to_bits(), own_inverse.step(back, x).to_bits(), "{k}");
                    assert_eq!(eta.to_bits(), shape.step(alone, x).to_bits(), "{k}");
                }
            }
        }
    };
}
cable!(
    a_cable_in_f32,
    f32,
    bowden_cable_f32,
    bowden_inverse_f32,
    bowden_hysteresis_f32,
    bowden_cable_settings_f32,
    bowden_hysteresis_settings_f32,
    bowden_cable_init_f32,
    bowden_cable_step_f32,
    bowden_inverse_init_f32,
    bowden_inverse_step_f32,
    bowden_hysteresis_init_f32,
    bowden_hysteresis_step_f32
);
cable!(
    a_cable_in_f64,
    f64,
    bowden_cable_f64,
    bowden_inverse_f64,
    bowden_hysteresis_f64,
    bowden_cable_settings_f64,
    bowden_hysteresis_settings_f64,
    bowden_cable_init_f64,
    bowden_cable_step_f64,
    bowden_inverse_init_f64,
    bowden_inverse_step_f64,
    bowden_hysteresis_init_f64,
    bowden_hysteresis_step_f64
);

macro_rules! rates {
    ($name:ident, $f:ident, $object:ident, $settings:ident, $output:ident,
     $init:ident, $step:ident) => {
        #[test]
        fn $name() {
            for (period, gap) in [(0.0, 0.0), (6.0, 0.0), (0.0, 0.5), (6.0, 0.5)] {
                let mut own = Rates::<$f>::try_new(0.01).unwrap();
                if period != 0.0 {
                    own = own.with_period(period).unwrap();
                }
                if gap != 0.0 {
                    own = own.with_longest_gap(gap).unwrap();
                }
                let mut state = RatesState::new();
                let mut rates = blank::<$object>();
                let settings = $settings {
                    time_constant: 0.01,
                    period,
                    longest_gap: gap,
                    ..$settings::defaults()
                };
                let tried = unsafe { $init(&mut rates, &settings, null_mut()) };
                assert_eq!(tried, bowden_result::Ok);
                let mut signal = Signal::new();
                for k in 0..4000 {
                    let (x, dt) = (signal.measured(k) as $f, signal.dt(k) as $f);
                    let mut out = blank::<$output>();
                    let result = unsafe { $step(&mut rates, x, dt, &mut out) };
                    let expected = own.step(&mut state, x, dt);
                    let name = format!("{:?}", expected.status);
                    let kind = name.split('(').next().unwrap();
                    let wanted = match kind {
                        "Good" => bowden_result::Ok,
                        "Settling" => bowden_result::Settling,
                        "Resumed" => bowden_result::Resumed,
                        _ => bowden_result::Held,
                    };
                    assert_eq!((result, out.result), (wanted, wanted), "{k}");
                    assert_eq!(out.fault == bowden_fault::None, kind != "Held");
                    let (m, e) = (out.motion, expected.motion);
                    let bits = |x: [$f; 3]| x.map($f::to_bits);
                    assert_eq!(
                        bits([m.position, m.velocity, m.acceleration]),
                        bits([e.position, e.velocity, e.acceleration])
                    );
                }
            }
        }
    };
}
rates!(
    rates_in_f32,
    f32,
    bowden_rates_f32,
    bowden_rates_settings_f32,
    bowden_rates_output_f32,
    bowden_rates_init_f32,
    bowden_rates_step_f32
);
rates!(
    rates_in_f64,
    f64,
    bowden_rates_f64,
    bowden_rates_settings_f64,
    bowden_rates_output_f64,
    bowden_rates_init_f64,
    bowden_rates_step_f64
);

macro_rules! observer {
    ($name:ident, $f:ident, $object:ident, $settings:ident, $output:ident, $motion:ident,
     $init:ident, $step:ident, $feed:ident, $reset:ident) => {
        #[test]
        fn $name() {
            for latency in [0.0, 0.003] {
                let settings = $settings {
                    gain: 0.6,
                    natural_frequency: 25.5,
                    damping_ratio: 0.265,
                    time_constant: 0.016,
                    limit: 30.0,
                    longest_dt: 0.005,
                    latency,
                    ..$settings::defaults()
                };
                let plant = NominalPlant::<$f>::try_new(0.6, 25.5, 0.265).unwrap();
                let own = DisturbanceObserver::try_new(plant, 0.016, 30.0, 0.005)
                    .and_then(|own| own.with_latency(latency))
                    .unwrap();
                let mut state = ObserverState::new();
                let mut observer = blank::<$object>();
                let tried = unsafe { $init(&mut observer, &settings, null_mut()) };
                assert_eq!(tried, bowden_result::Ok);
                let mut signal = Signal::new();
                for k in 0..4000 {
                    let (measured, dt) = (signal.measured(k) as $f, signal.dt(k) as $f);
                    let sent = signal.next(20.0) as $f;
                    let mut out = blank::<$output>();
                    let result = unsafe { $step(&mut observer, dt, sent, measured, &mut out) };
                    let expected = own.step(&mut state, &ObserverInput { dt, sent, measured });
                    let good = expected.status == Status::Good;
                    let wanted = if good {
                        bowden_result::Ok
                    } else {
                        bowden_result::Held
                    };
                    assert_eq!((result, out.result), (wanted, wanted), "{k}");
                    assert_eq!(out.fault == bowden_fault::None, good);
                    assert_eq!(out.estimate.to_bits(), expected.command.to_bits(), "{k}");
                    if k == 3000 {
                        assert_eq!(unsafe { $reset(&mut observer) }, bowden_result::Ok);
                        state = ObserverState::new();
                    }
                }
                let wanted = $motion {
                    position: 3.0,
                    velocity: -4.0,
                    acceleration: 50.0,
                };
                let mut command = 0.0;
                let result = unsafe { $feed(&observer, &wanted, &mut command) };
                let expected = plant.feed_forward(&Motion {
                    position: 3.0,
                    velocity: -4.0,
                    acceleration: 50.0,
                });
                assert_eq!(result, bowden_result::Ok);
                assert_eq!(command.to_bits(), expected.to_bits());
            }
        }
    };
}
observer!(
    observer_in_f32,
    f32,
    bowden_observer_f32,
    bowden_observer_settings_f32,
    bowden_observer_output_f32,
    bowden_motion_f32,
    bowden_observer_init_f32,
    bowden_observer_step_f32,
    bowden_observer_feed_forward_f32,
    bowden_observer_reset_f32
);
observer!(
    observer_in_f64,
    f64,
    bowden_observer_f64,
    bowden_observer_settings_f64,
    bowden_observer_output_f64,
    bowden_motion_f64,
    bowden_observer_init_f64,
    bowden_observer_step_f64,
    bowden_observer_feed_forward_f64,
    bowden_observer_reset_f64
);

macro_rules! play {
    ($name:ident, $f:ident, $object:ident, $init:ident, $step:ident) => {
        #[test]
        fn $name() {
            for half_width in [0.0, 0.5, 2.5] {
                let own = Play::<$f>::try_new(half_width).unwrap();
                let mut state = PlayState::new();
                let mut play = blank::<$object>();
                let tried = unsafe { $init(&mut play, half_width, null_mut()) };
                assert_eq!(tried, bowden_result::Ok);
                let mut signal = Signal::new();
                // Bad samples before the first good one as well.
                let early = [<$f>::NAN, <$f>::INFINITY];
                let then = (0..4000).map(|k| signal.measured(k) as $f);
                for (k, x) in early.into_iter().chain(then).enumerate() {
                    let mut y = 7.0;
                    let wanted = if x.is_finite() {
                        bowden_result::Ok
                    } else {
                        bowden_result::Held
                    };
                    assert_eq!(unsafe { $step(&mut play, x, &mut y) }, wanted, "{k}");
                    assert_eq!(y.to_bits(), own.step(&mut state, x).to_bits(), "{k}");
                    assert!(k >= 2 || y == 0.0, "{y}");
                }
            }
        }
    };
}
play!(
    a_play_in_f32,
    f32,
    bowden_play_f32,
    bowden_play_init_f32,
    bowden_play_step_f32
);
play!(
    a_play_in_f64,
    f64,
    bowden_play_f64,
    bowden_play_init_f64,
    bowden_play_step_f64
);
