//! Estimates stay in their boxes, and the command in its limits, whatever comes.

use super::{cast_estimator, lag, literal};
use bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, Estimator, Fallback, Fault, Form,
    Leakage, Limits, SmoothSign, Status,
};
use bowden::Real;
use proptest::prelude::*;

/// Everything that an `f64` can be, the extremes often.
fn anything() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -50.0..50.0_f64,
        2 => any::<f64>(),
        1 => prop::sample::select(vec![
            f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN, 0.0, -0.0, 1e-310,
        ]),
        1 => (-38.0..38.5_f64).prop_map(|exponent| 10.0_f64.powf(exponent)),
    ]
}

fn step_time() -> impl Strategy<Value = f64> {
    prop_oneof![4 => 1e-5..1e-3_f64, 1 => anything()]
}

/// Samples as `[dt, reference, next reference, measured, x1, x2, feed-forward]`.
fn samples() -> impl Strategy<Value = Vec<[f64; 7]>> {
    let six = prop::array::uniform6(anything());
    let sample = (step_time(), six).prop_map(|(dt, [a, b, c, d, e, f])| [dt, a, b, c, d, e, f]);
    prop::collection::vec(sample, 1..60)
}

fn estimator(low: f64, high: f64) -> impl Strategy<Value = Estimator<f64>> {
    let leakage = prop_oneof![
        Just(Leakage::None),
        (0.0..100.0_f64).prop_map(|rate| Leakage::Constant { rate }),
        (0.0..100.0_f64, 0.1..5.0_f64).prop_map(|(rate, bound)| Leakage::Switching { rate, bound }),
    ];
    (0.0..1.0_f64, 0.0..1e3_f64, leakage, -50.0..50.0_f64).prop_map(
        move |(at, gain, leakage, prior)| Estimator {
            gain,
            leakage,
            prior,
            ..Estimator::fixed(low + (high - low) * at).within(low, high)
        },
    )
}

fn settings() -> impl Strategy<Value = AdaptiveSettings<f64, 2>> {
    let forms = prop_oneof![
        (0.0..0.02_f64).prop_map(|time_constant| Form::AsPublished { time_constant }),
        Just(Form::FirstOrder {
            step: 1e-4,
            plant_gain: 1.0
        }),
    ];
    let estimators = (
        estimator(0.1, 2.0),
        estimator(0.0, 8.0),
        estimator(-3.0, 3.0),
        estimator(0.0, 6.0),
    );
    let gains = (1.0..30.0_f64, 1.0..10.0_f64, 0.1..1.0_f64);
    (forms, gains, estimators, any::<bool>(), any::<bool>()).prop_map(
        |(form, (gain, lambda, epsilon), (beta, delta, one, two), clamped, limited)| {
            let mut settings = AdaptiveSettings {
                beta,
                delta,
                theta: [one, two],
                z_limit: 3.0,
                ..AdaptiveSettings::unlimited(form, gain, lambda, epsilon)
            };
            if clamped {
                settings.smooth_sign = SmoothSign::Clamp;
            }
            if limited {
                let limits = Limits::try_new(-4.0, 40.0).unwrap();
                settings.limits = limits.with_slew(500.0).unwrap();
                settings.fallback = Fallback::try_new(3, 1.0).unwrap();
            }
            settings
        },
    )
}

/// The same settings in another precision.
fn cast<T: Real>(from: &AdaptiveSettings<f64, 2>) -> AdaptiveSettings<T, 2> {
    let form = match from.form {
        Form::AsPublished { time_constant } => Form::AsPublished {
            time_constant: T::from_f64(time_constant),
        },
        Form::FirstOrder { step, plant_gain } => Form::FirstOrder {
            step: T::from_f64(step),
            plant_gain: T::from_f64(plant_gain),
        },
    };
    let gains = [from.gain, from.lambda, from.epsilon].map(T::from_f64);
    let mut to = AdaptiveSettings {
        smooth_sign: from.smooth_sign,
        beta: cast_estimator(&from.beta),
        delta: cast_estimator(&from.delta),
        theta: [&from.theta[0], &from.theta[1]].map(cast_estimator),
        z_limit: T::from_f64(from.z_limit),
        ..AdaptiveSettings::unlimited(form, gains[0], gains[1], gains[2])
    };
    if let Some(safe) = from.fallback.command() {
        let limits = Limits::try_new(
            T::from_f64(from.limits.low()),
            T::from_f64(from.limits.high()),
        )
        .unwrap();
        to.limits = limits.with_slew(T::from_f64(500.0)).unwrap();
        to.fallback = Fallback::try_new(from.fallback.after(), T::from_f64(safe)).unwrap();
    }
    to
}

/// What a bad sample must not touch.
fn kept<T: Real>(state: &AdaptiveState<T, 2>) -> [T; 5] {
    let [one, two] = state.theta_hat();
    [
        state.accumulated_error(),
        state.beta_hat(),
        state.delta_hat(),
        one,
        two,
    ]
}

fn stays_in_its_boxes<T: Real>(
    settings: &AdaptiveSettings<f64, 2>,
    samples: &[[f64; 7]],
) -> Result<(), TestCaseError> {
    let law = Adaptive::try_new(cast::<T>(settings)).unwrap();
    let mut state = AdaptiveState::new(&law);
    for sample in samples {
        let [dt, reference, next_reference, measured, x1, x2, feed_forward] =
            sample.map(T::from_f64);
        let input = AdaptiveInput {
            dt,
            reference,
            next_reference,
            measured,
            regressors: [x1, x2],
            feed_forward,
        };
        let before = state;
        let output = law.step_with_terms(&mut state, &input);
        prop_assert!(law.is_valid(&state), "{state:?}");
        prop_assert!(output.command.is_finite());
        prop_assert!(law.settings().limits.contains(output.command));
        prop_assert_eq!(output.command, state.command());
        let finite = [reference, next_reference, measured, x1, x2, feed_forward];
        let usable = finite.iter().all(|value| value.is_finite())
            && dt.is_finite()
            && dt > T::zero()
            && law
                .settings()
                .largest_step()
                .is_none_or(|largest| dt <= largest);
        match output.status {
            Status::Good => prop_assert!(usable),
            Status::Held(fault) => {
                prop_assert_eq!(usable, fault == Fault::Overflow);
                prop_assert_eq!(kept(&state), kept(&before));
                prop_assert_eq!(state.command(), before.command());
            }
            Status::Degraded(_) => prop_assert!(false, "nothing may be dropped"),
            Status::Safe(_) => {
                prop_assert_eq!(kept(&state), kept(&before));
                prop_assert_eq!(Some(output.command), law.settings().fallback.command());
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn no_input_moves_an_estimate_out_of_its_box(
        settings in settings().prop_filter("admissible", |s| Adaptive::try_new(cast::<f32>(s)).is_ok()),
        samples in samples(),
    ) {
        stays_in_its_boxes::<f64>(&settings, &samples)?;
        stays_in_its_boxes::<f32>(&settings, &samples)?;
    }

    #[test]
    fn a_resumed_or_taken_over_state_is_valid_whatever_it_resumes_from(
        settings in settings().prop_filter("admissible", |s| Adaptive::try_new(cast::<f32>(s)).is_ok()),
        samples in samples(),
        output in anything(),
    ) {
        let law = Adaptive::try_new(settings).unwrap();
        let narrow = Estimator { initial: 1.0, ..settings.beta }.within(0.9, 1.1);
        let other = Adaptive::try_new(AdaptiveSettings { beta: narrow, ..settings }).unwrap();
        for [dt, reference, next_reference, measured, x1, x2, feed_forward] in samples {
            let regressors = [x1, x2];
            let input = AdaptiveInput {
                dt, reference, next_reference, measured, regressors, feed_forward,
            };
            let mut state = AdaptiveState::resume_from(&law, output, &input);
            prop_assert!(law.is_valid(&state), "{state:?}");
            law.step_with_terms(&mut state, &input);
            other.bumpless_transfer(&mut state, &input);
            prop_assert!(other.is_valid(&state), "{state:?}");
        }
    }
}

#[test]
fn each_bad_sample_is_named() {
    let law = Adaptive::try_new(literal()).unwrap();
    let good = AdaptiveInput::new(0.001, 3.0, 1.0, [0.5]);
    type Change = fn(&mut AdaptiveInput<f64, 1>);
    let cases: [(Change, Fault); 9] = [
        (|at| at.dt = f64::NAN, Fault::Dt),
        (|at| at.dt = 0.0, Fault::DtNotPositive),
        (|at| at.dt = -0.1, Fault::DtNotPositive),
        (|at| at.reference = f64::NAN, Fault::Reference),
        (|at| at.next_reference = f64::INFINITY, Fault::Reference),
        (|at| at.measured = f64::NAN, Fault::Measured),
        (|at| at.regressors = [f64::NAN], Fault::Regressor(0)),
        (|at| at.feed_forward = f64::NAN, Fault::FeedForward),
        (|at| at.measured = f64::MAX, Fault::Overflow),
    ];
    for (change, fault) in cases {
        let mut bad = good;
        change(&mut bad);
        let mut state = AdaptiveState::new(&law);
        law.step_with_terms(&mut state, &good);
        let mut twin = state;
        let output = law.step_with_terms(&mut state, &bad);
        assert_eq!(output.status, Status::Held(fault));
        assert_eq!(output.command, twin.command());
        assert_eq!(output.terms.beta_hat, twin.beta_hat());
        // As if it had never been: the next good sample gives the same command.
        let after = law.step_with_terms(&mut state, &good);
        assert_eq!(after, law.step_with_terms(&mut twin, &good));
    }
    let lag = Adaptive::try_new(lag()).unwrap();
    let mut state = AdaptiveState::new(&lag);
    let late = AdaptiveInput { dt: 0.1, ..good };
    assert_eq!(
        lag.step(&mut state, &late).status,
        Status::Held(Fault::DtTooLong)
    );
}

#[test]
fn an_estimate_that_is_driven_out_stops_at_the_edge_of_its_box() {
    let law = Adaptive::try_new(lag()).unwrap();
    let mut state = AdaptiveState::new(&law);
    for _ in 0..200_000 {
        law.step_with_terms(&mut state, &AdaptiveInput::new(0.001, 30.0, 20.0, [2.0]));
    }
    assert_eq!((state.beta_hat(), state.delta_hat()), (1.1, 7.0));
    assert_eq!(state.theta_hat(), [5.0]);
}
