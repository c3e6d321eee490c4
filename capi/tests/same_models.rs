//! The adaptive law, a loaded model and its inverse through the C interface against the crate's
//! own, to the bit, bad samples included.

#![allow(missing_docs, clippy::undocumented_unsafe_blocks, clippy::unwrap_used)]

mod objects;
mod signal;

use bowden::*;
use core_bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, BenchRange, Compensator,
    CompensatorInput, CompensatorState, Estimator, Fallback, Form, Leakage, Limits, OnMissing,
    SmoothSign, Status,
};
use core_bowden::effect::Motion;
use core_bowden::model::{Model, ModelState, Sample, Source};
use objects::blank;
use signal::Signal;
use std::ptr::{null, null_mut};

const CHECKSUM: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// An effect of each kind: with a memory, an own zero, the input, the load.
const MODEL: &str = r#"
    schema = "bowden.model/1"
    mode = "torque"
    channels = ["phi_p", "phi_d"]
    terms = [
        { effect = "viscous", source = "phi_p", gain = -0.7 },
        { effect = "coulomb", source = "phi_d", gain = -0.4, shapes = [{ name = "v_e", value = 0.1 }] },
        { effect = "stiffness-progressive", source = "phi_p", origin = 0.25, gain = 0.3 },
    ]
    [transmission]
    gain = 0.95
    kappa_eta = 1.7
    offset = -0.0045
    rho = 0.5
    sigma = 0.52
    n = 1.5
"#;

macro_rules! adaptive {
    ($name:ident, $f:ident, $object:ident, $settings:ident, $sample:ident, $output:ident,
     $estimates:ident, $init:ident, $step:ident, $get:ident, $acknowledge:ident) => {
        mod $name {
            use super::*;

            fn own(form: usize, sign: usize, missing: usize) -> Adaptive<$f, 2> {
                let (step, plant_gain) = (0.001, 1.0);
                let leaks = Estimator {
                    leakage: Leakage::Switching {
                        rate: 0.1,
                        bound: 0.05,
                    },
                    gain: 0.02,
                    prior: 0.3,
                    ..Estimator::fixed(0.1).within(-3.0, 3.0)
                };
                // As many regressors as the law has: those of C that are not used are zero.
                Adaptive::<$f, 2>::try_new(AdaptiveSettings {
                    smooth_sign: [SmoothSign::Tanh, SmoothSign::Clamp][sign],
                    beta: Estimator::fixed(1.0)
                        .within(0.8, 1.2)
                        .adapting(2.5e-4, 0.01),
                    delta: Estimator::fixed(1.0).within(0.0, 3.0).adapting(6e-3, 0.01),
                    theta: [leaks, Estimator::fixed(0.5)],
                    missing: [
                        [OnMissing::Hold, OnMissing::DropRegressor][missing],
                        OnMissing::Hold,
                    ],
                    z_limit: 0.01,
                    ..AdaptiveSettings::new(
                        [
                            Form::AsPublished {
                                time_constant: 0.005,
                            },
                            Form::FirstOrder { step, plant_gain },
                        ][form],
                        24.0,
                        8.0,
                        0.1,
                        Limits::try_new(-20.0, 60.0).unwrap(),
                        0.005,
                        Fallback::try_new(5, 1.0).unwrap(),
                    )
                })
                .unwrap()
            }

            fn in_c(form: usize, sign: usize, missing: usize) -> $object {
                let (mut settings, mut law) = ($settings::defaults(), blank::<$object>());
                unsafe {
                    (settings.limits.low, settings.limits.high) = (-20.0, 60.0);
                    settings.longest_dt = 0.005;
                    (settings.fallback.after, settings.fallback.command) = (5, 1.0);
                    settings.form = form as u32;
                    (settings.step, settings.plant_gain) = (0.001, 1.0);
                    settings.epsilon = 0.1;
                    settings.smooth_sign = sign as u32;
                    for (own, low, high, gain) in [
                        (&mut settings.beta, 0.8, 1.2, 2.5e-4),
                        (&mut settings.delta, 0.0, 3.0, 6e-3),
                    ] {
                        own.initial = 1.0;
                        (own.low, own.high, own.gain) = (low, high, gain);
                        own.leakage = bowden_leakage::Constant as u32;
                        own.leakage_rate = 0.01;
                    }
                    settings.regressors = 2;
                    let theta = &mut settings.theta[0];
                    (theta.initial, theta.low, theta.high, theta.gain) = (0.1, -3.0, 3.0, 0.02);
                    theta.leakage = bowden_leakage::Switching as u32;
                    theta.prior = 0.3;
                    (theta.leakage_rate, theta.leakage_bound) = (0.1, 0.05);
                    let theta = &mut settings.theta[1];
                    (theta.initial, theta.low, theta.high) = (0.5, 0.5, 0.5);
                    settings.missing[0] = missing as u32;
                    settings.z_limit = 0.01;
                    // Not read.
                    settings.theta[2].low = $f::NAN;
                    settings.missing[3] = 99;
                    assert_eq!($init(&mut law, &settings, null_mut()), bowden_result::Ok);
                }
                law
            }

            #[test]
            fn is_the_crates() {
                for (form, sign, missing) in [(0, 0, 0), (0, 1, 1), (1, 0, 1), (1, 1, 0)] {
                    let seen = compare(&own(form, sign, missing), in_c(form, sign, missing));
                    assert_eq!(seen[1] > 0, missing == 1, "{seen:?}");
                    assert!(seen[0] > 1000 && seen[2] > 10 && seen[3] > 100, "{seen:?}");
                }
            }

            /// Steps both; how many samples had each status.
            fn compare(own: &Adaptive<$f, 2>, mut law: $object) -> [u32; 4] {
                let mut state = AdaptiveState::new(own);
                let mut signal = Signal::new();
                let mut seen = [0; 4];
                for k in 0..4000 {
                    let dt = signal.dt(k) as $f;
                    let reference = signal.next(3.0) as $f;
                    let next_reference = signal.next(3.0) as $f;
                    let measured = signal.measured(k) as $f;
                    let spoiled = if k % 500 == 7 {
                        $f::NAN
                    } else {
                        signal.next(2.0) as $f
                    };
                    let regressors = [spoiled, signal.next(9.0) as $f];
                    let feed_forward = signal.next(0.5) as $f;
                    let sample = $sample {
                        dt,
                        reference,
                        next_reference,
                        measured,
                        regressors: [regressors[0], regressors[1], $f::NAN, $f::INFINITY],
                        feed_forward,
                    };
                    let at = AdaptiveInput {
                        next_reference,
                        feed_forward,
                        ..AdaptiveInput::new(dt, reference, measured, regressors)
                    };
                    if k % 1000 == 999 {
                        state.acknowledge();
                        assert_eq!(unsafe { $acknowledge(&mut law) }, bowden_result::Ok);
                    }
                    let (mut out, mut estimates) = (blank::<$output>(), blank::<$estimates>());
                    let result = unsafe { $step(&mut law, &sample, &mut out) };
                    unsafe { $get(&law, &mut estimates) };
                    let expected = own.step(&mut state, &at);
                    assert_eq!(out.command.to_bits(), expected.command.to_bits(), "{k}");
                    let wanted = match expected.status {
                        Status::Good => 0,
                        Status::Degraded(_) => 1,
                        Status::Held(_) => 2,
                        Status::Safe(_) => 3,
                    };
                    let codes = [
                        bowden_result::Ok,
                        bowden_result::Degraded,
                        bowden_result::Held,
                        bowden_result::Safe,
                    ];
                    assert_eq!(result, codes[wanted]);
                    seen[wanted] += 1;
                    assert_eq!(estimates.z.to_bits(), state.accumulated_error().to_bits());
                    assert_eq!(estimates.beta.to_bits(), state.beta_hat().to_bits());
                    assert_eq!(estimates.delta.to_bits(), state.delta_hat().to_bits());
                    assert_eq!(estimates.theta[..2], state.theta_hat());
                    assert_eq!(estimates.theta[2..], [0.0, 0.0]);
                }
                seen
            }
        }
    };
}
adaptive!(
    adaptive_law_in_f32,
    f32,
    bowden_adaptive_f32,
    bowden_adaptive_settings_f32,
    bowden_adaptive_sample_f32,
    bowden_output_f32,
    bowden_estimates_f32,
    bowden_adaptive_init_f32,
    bowden_adaptive_step_f32,
    bowden_adaptive_get_estimates_f32,
    bowden_adaptive_acknowledge_f32
);
adaptive!(
    adaptive_law_in_f64,
    f64,
    bowden_adaptive_f64,
    bowden_adaptive_settings_f64,
    bowden_adaptive_sample_f64,
    bowden_output_f64,
    bowden_estimates_f64,
    bowden_adaptive_init_f64,
    bowden_adaptive_step_f64,
    bowden_adaptive_get_estimates_f64,
    bowden_adaptive_acknowledge_f64
);

macro_rules! model {
    ($name:ident, $f:ident, $object:ident, $inverse:ident, $sample:ident,
     $wish:ident, $output:ident, $range:ident, $motion:ident,
     $load:ident, $step:ident, $init:ident, $inverse_step:ident) => {
        mod $name {
            use super::*;

            fn motion(m: $motion) -> Motion<$f> {
                Motion {
                    position: m.position,
                    velocity: m.velocity,
                    acceleration: m.acceleration,
                }
            }

            /// The ends of the range of channel 0.
            fn ends() -> [$motion; 2] {
                [-1.0, 1.0].map(|position| $motion {
                    position,
                    velocity: 0.5 * position,
                    acceleration: position,
                })
            }

            fn own() -> (Model<$f, 16>, Compensator<$f, 16>) {
                let own: Model<$f, 16> = toml::from_str(MODEL).unwrap();
                let [low, high] = ends().map(motion);
                let source = Source::Channel(0);
                let inverse = Compensator::try_new(&own)
                    .and_then(|inverse| inverse.with_longest_dt(0.005))
                    .and_then(|inverse| inverse.with_ranges(&[BenchRange { source, low, high }]));
                (own, inverse.unwrap())
            }

            fn in_c(own: &Model<$f, 16>) -> ($object, $inverse) {
                let bytes = postcard::to_allocvec_crc32(own, CHECKSUM.digest()).unwrap();
                let (mut model, mut inverse) = (blank::<$object>(), blank::<$inverse>());
                let [low, high] = ends();
                unsafe {
                    let loaded = $load(&mut model, bytes.as_ptr(), bytes.len(), 0.125, null_mut());
                    assert_eq!(loaded, bowden_result::Ok);
                    let range = $range {
                        source: 0,
                        low,
                        high,
                    };
                    let made = $init(&mut inverse, &model, 0.005, &range, 1, null_mut());
                    assert_eq!(made, bowden_result::Ok);
                }
                (model, inverse)
            }

            #[test]
            fn is_the_crates() {
                let (own, own_inverse) = own();
                let (mut model, mut inverse) = in_c(&own);
                let mut state = ModelState::with_eta(0.125).unwrap();
                let mut inverse_state = CompensatorState::new();
                let mut signal = Signal::new();
                let mut held = 0;
                for k in 0..4000 {
                    let mut next = || $motion {
                        position: signal.next(2.0) as $f,
                        velocity: signal.next(2.0) as $f,
                        acceleration: signal.next(2.0) as $f,
                    };
                    let (mut input, phi_p, phi_d) = (next(), next(), next());
                    input.position = signal.measured(k) as $f;
                    let (dt, load) = (signal.dt(k) as $f, signal.next(2.0) as $f);
                    let channels = [phi_p, phi_d];
                    // A channel is missing now and then.
                    let count = if k % 700 == 3 { 1 } else { 2 };
                    let own_channels = channels.map(motion);
                    let at = Sample {
                        dt,
                        input: motion(input),
                        load,
                        channels: &own_channels[..count],
                    };
                    let sample = $sample {
                        dt,
                        input,
                        load,
                        channels: channels.as_ptr(),
                        channel_count: count,
                    };
                    let mut y = 7.0;
                    let result = unsafe { $step(&mut model, &sample, &mut y) };
                    let good = own.accepts(&at);
                    assert_eq!(result == bowden_result::Ok, good, "{k} {result:?}");
                    assert_eq!(y.to_bits(), own.step(&mut state, &at).to_bits(), "{k}");
                    held += u32::from(result == bowden_result::Held);

                    let wish = $wish {
                        dt,
                        desired: input.position,
                        input,
                        load,
                        channels: channels.as_ptr(),
                        channel_count: count,
                    };
                    let mut out = blank::<$output>();
                    let result = unsafe { $inverse_step(&mut inverse, &wish, &mut out) };
                    let expected = own_inverse.step(
                        &mut inverse_state,
                        &CompensatorInput {
                            dt,
                            desired: input.position,
                            input: motion(input),
                            load,
                            channels: &own_channels[..count],
                        },
                    );
                    assert_eq!(result == bowden_result::Ok, expected.status == Status::Good);
                    assert_eq!(out.command.to_bits(), expected.command.to_bits(), "{k}");
                    assert_eq!(out.eta.to_bits(), inverse_state.eta().to_bits(), "{k}");
                    assert_eq!(out.effects.to_bits(), expected.effects.to_bits(), "{k}");
                }
                assert!(held > 100, "{held}");
            }
        }
    };
}
model!(
    model_in_f32,
    f32,
    bowden_model_f32,
    bowden_compensator_f32,
    bowden_model_sample_f32,
    bowden_compensator_sample_f32,
    bowden_compensator_output_f32,
    bowden_range_f32,
    bowden_motion_f32,
    bowden_model_load_f32,
    bowden_model_step_f32,
    bowden_compensator_init_f32,
    bowden_compensator_step_f32
);
model!(
    model_in_f64,
    f64,
    bowden_model_f64,
    bowden_compensator_f64,
    bowden_model_sample_f64,
    bowden_compensator_sample_f64,
    bowden_compensator_output_f64,
    bowden_range_f64,
    bowden_motion_f64,
    bowden_model_load_f64,
    bowden_model_step_f64,
    bowden_compensator_init_f64,
    bowden_compensator_step_f64
);

/// Text of a refusal.
fn text(about: &bowden_about) -> String {
    let bytes = about.text.iter().map(|byte| *byte as u8);
    String::from_utf8(bytes.take_while(|byte| *byte != 0).collect()).unwrap()
}

#[test]
fn bytes_that_are_damaged_or_of_the_other_precision_are_told() {
    let own: Model<f32, 16> = toml::from_str(MODEL).unwrap();
    let wide: Model<f64, 16> = toml::from_str(MODEL).unwrap();
    let bytes = postcard::to_allocvec_crc32(&own, CHECKSUM.digest()).unwrap();
    let wide_bytes = postcard::to_allocvec_crc32(&wide, CHECKSUM.digest()).unwrap();
    let mut about = blank::<bowden_about>();
    let (mut model, mut other) = (blank::<bowden_model_f32>(), blank::<bowden_model_f64>());
    let mut load = |bytes: &[u8]| {
        let result = unsafe {
            bowden_model_load_f32(&mut model, bytes.as_ptr(), bytes.len(), 0.0, &mut about)
        };
        (result, text(&about))
    };
    for at in 0..bytes.len() {
        for bit in 0..8 {
            let mut damaged = bytes.clone();
            damaged[at] ^= 1 << bit;
            assert_eq!(
                load(&damaged),
                (bowden_result::ErrorModel, "checksum".to_owned())
            );
        }
        assert_eq!(load(&bytes[..at]).0, bowden_result::ErrorModel);
    }
    let precision = "precision, version or number of terms".to_owned();
    assert_eq!(
        load(&wide_bytes),
        (bowden_result::ErrorModel, precision.clone())
    );
    assert_eq!(
        load(&[0; 5000]),
        (bowden_result::ErrorCapacity, "bytes".to_owned())
    );
    assert_eq!(load(&bytes), (bowden_result::Ok, String::new()));
    // A term more than there is room for.
    let terms = vec![own.terms()[0]; BOWDEN_TERMS + 1];
    let many = Model::<f32, 17>::try_new(None, &terms).unwrap();
    let many = postcard::to_allocvec_crc32(&many, CHECKSUM.digest()).unwrap();
    assert_eq!(load(&many), (bowden_result::ErrorModel, precision));
    // A channel more than a sample has.
    let far = core_bowden::model::Term {
        source: Source::Channel(16),
        ..own.terms()[0]
    };
    let far = Model::<f32, 1>::try_new(None, &[far]).unwrap();
    let far = postcard::to_allocvec_crc32(&far, CHECKSUM.digest()).unwrap();
    assert_eq!(
        load(&far),
        (bowden_result::ErrorCapacity, "channels".to_owned())
    );
    let result =
        unsafe { bowden_model_load_f64(&mut other, bytes.as_ptr(), bytes.len(), 0.0, null_mut()) };
    assert_eq!(result, bowden_result::ErrorModel);
    let result = unsafe { bowden_model_load_f32(&mut model, null(), 0, 0.0, null_mut()) };
    assert_eq!(result, bowden_result::ErrorNull);
}

/// What the repository has of the lab: `bowden identify --model-out demo.postcard`.
#[test]
fn the_bytes_that_the_lab_wrote_load() {
    let bytes = include_bytes!("../../examples/data/demo.postcard");
    let mut model = blank::<bowden_model_f32>();
    let loaded =
        unsafe { bowden_model_load_f32(&mut model, bytes.as_ptr(), bytes.len(), 0.0, null_mut()) };
    assert_eq!(loaded, bowden_result::Ok);
}
