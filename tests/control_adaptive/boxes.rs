//! Estimates stay in their boxes, and the command in its limits, whatever comes.

use super::*;

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
    let plant_gain = 1.0;
    let forms = prop_oneof![
        (0.0..0.02_f64).prop_map(|time_constant| Form::AsPublished { time_constant }),
        Just(Form::FirstOrder {
            step: 1e-4,
            plant_gain
        }),
    ];
    let estimators = (
        estimator(0.1, 2.0),
        estimator(0.0, 8.0),
        estimator(-3.0, 3.0),
        estimator(0.0, 6.0),
    );
    let gains = (1.0..30.0_f64, 1.0..10.0_f64, 0.1..1.0_f64);
    let all = (forms, gains, estimators, any::<bool>(), any::<bool>());
    let all = all.prop_map(
        |(form, (gain, lambda, epsilon), estimators, clamped, limited)| {
            let (beta, delta, one, two) = estimators;
            with(
                AdaptiveSettings::unlimited(form, gain, lambda, epsilon),
                |s| {
                    (s.beta, s.delta, s.theta, s.z_limit) = (beta, delta, [one, two], 3.0);
                    s.smooth_sign = [SmoothSign::Tanh, SmoothSign::Clamp][usize::from(clamped)];
                    if limited {
                        s.limits = range(-4.0, 40.0).with_slew(500.0).unwrap();
                        s.fallback = Fallback::try_new(3, 1.0).unwrap();
                    }
                },
            )
        },
    );
    all.prop_filter("admissible", |s| Adaptive::try_new(cast::<f32>(s)).is_ok())
}

/// The same settings in another precision.
fn cast<T: Real>(from: &AdaptiveSettings<f64, 2>) -> AdaptiveSettings<T, 2> {
    let of = T::from_f64;
    let form = match from.form {
        Form::AsPublished { time_constant } => {
            let time_constant = of(time_constant);
            Form::AsPublished { time_constant }
        }
        Form::FirstOrder { step, plant_gain } => {
            let (step, plant_gain) = (of(step), of(plant_gain));
            Form::FirstOrder { step, plant_gain }
        }
    };
    let gains = [from.gain, from.lambda, from.epsilon].map(of);
    with(
        AdaptiveSettings::unlimited(form, gains[0], gains[1], gains[2]),
        |to| {
            to.smooth_sign = from.smooth_sign;
            (to.beta, to.delta) = (cast_estimator(&from.beta), cast_estimator(&from.delta));
            to.theta = [&from.theta[0], &from.theta[1]].map(cast_estimator);
            to.z_limit = of(from.z_limit);
            if let Some(safe) = from.fallback.command() {
                let limits =
                    Limits::try_new(of(from.limits.low()), of(from.limits.high())).unwrap();
                to.limits = limits.with_slew(of(500.0)).unwrap();
                to.fallback = Fallback::try_new(from.fallback.after(), of(safe)).unwrap();
            }
        },
    )
}

fn input<T: Real>(sample: [f64; 7]) -> AdaptiveInput<T, 2> {
    let [dt, reference, next_reference, measured, x1, x2, feed_forward] = sample.map(T::from_f64);
    AdaptiveInput {
        dt,
        reference,
        next_reference,
        measured,
        regressors: [x1, x2],
        feed_forward,
    }
}

/// What a bad sample must not touch.
fn kept<T: Real>(state: &AdaptiveState<T, 2>) -> [T; 5] {
    let ([one, two], z) = (state.theta_hat(), state.accumulated_error());
    [z, state.beta_hat(), state.delta_hat(), one, two]
}

fn stays_in_its_boxes<T: Real>(
    settings: &AdaptiveSettings<f64, 2>,
    samples: &[[f64; 7]],
) -> Result<(), TestCaseError> {
    let law = Adaptive::try_new(cast::<T>(settings)).unwrap();
    let mut state = AdaptiveState::new(&law);
    for sample in samples {
        let input = input::<T>(*sample);
        let before = state;
        let output = law.step_with_terms(&mut state, &input);
        prop_assert!(law.is_valid(&state), "{state:?}");
        prop_assert!(output.command.is_finite());
        prop_assert!(law.settings().limits.contains(output.command));
        prop_assert_eq!(output.command, state.command());
        let largest = law.settings().largest_step();
        let usable = sample.iter().all(|x| T::from_f64(*x).is_finite())
            && input.dt > T::zero()
            && largest.is_none_or(|largest| input.dt <= largest);
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
        settings in settings(),
        samples in samples(),
    ) {
        stays_in_its_boxes::<f64>(&settings, &samples)?;
        stays_in_its_boxes::<f32>(&settings, &samples)?;
    }

    #[test]
    fn a_resumed_or_taken_over_state_is_valid_whatever_it_resumes_from(
        settings in settings(),
        samples in samples(),
        output in anything(),
    ) {
        let law = Adaptive::try_new(settings).unwrap();
        let other = with(settings, |s| {
            s.beta.initial = 1.0;
            s.beta = s.beta.within(0.9, 1.1);
        });
        let other = Adaptive::try_new(other).unwrap();
        for input in samples.into_iter().map(input) {
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
    let (law, good) = (law(literal(), |_| ()), at(3.0, 1.0, 0.5));
    type Change = fn(&mut Input);
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
        let mut state = AdaptiveState::new(&law);
        law.step(&mut state, &good);
        let mut twin = state;
        let output = law.step_with_terms(&mut state, &with(good, change));
        assert_eq!(output.status, Status::Held(fault));
        assert_eq!(output.command, twin.command());
        assert_eq!(output.terms.beta_hat, twin.beta_hat());
        // As if it had never been: the next good sample gives the same command.
        let after = law.step_with_terms(&mut state, &good);
        assert_eq!(after, law.step_with_terms(&mut twin, &good));
    }
    let lag = Adaptive::try_new(lag()).unwrap();
    let late = with(good, |at| at.dt = 0.1);
    let status = lag.step(&mut AdaptiveState::new(&lag), &late).status;
    assert_eq!(status, Status::Held(Fault::DtTooLong));
}

#[test]
fn an_estimate_that_is_driven_out_stops_at_the_edge_of_its_box() {
    let law = law(lag(), |_| ());
    let mut state = AdaptiveState::new(&law);
    for _ in 0..200_000 {
        law.step(&mut state, &at(30.0, 20.0, 2.0));
    }
    assert_eq!(estimates(&state), [1.1, 7.0, 5.0]);
}
