//! Estimates stay in their boxes, and the command in its limits, whatever comes.

use super::liveness::journey;
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

/// Laws that can be shipped, with larger gains, faster leaks and priors anywhere; half without limits.
fn any_law<T: Real>() -> impl Strategy<Value = Adaptive<T, 2>> {
    let journey = any::<bool>().prop_flat_map(|is_lag| journey::<T>(is_lag));
    let gains = prop::array::uniform4(0.0..1e3_f64);
    let leaks = (0.0..100.0_f64, -50.0..50.0_f64);
    (journey, gains, leaks, any::<bool>()).prop_map(|(journey, gains, (rate, prior), limited)| {
        let settings = with(*journey.law.settings(), |s| {
            let [beta, delta, one, two] = gains.map(T::from_f64);
            (s.beta.gain, s.delta.gain) = (beta, delta);
            (s.theta[0].gain, s.theta[1].gain) = (one, two);
            let rate = T::from_f64(rate);
            s.theta[0].leakage = Leakage::Constant { rate };
            (s.delta.prior, s.theta[1].prior) = (T::from_f64(prior), T::from_f64(-prior));
            s.z_limit = T::from_f64(3.0);
            s.fallback = Fallback::try_new(3, s.limits.clamp(T::ONE)).unwrap();
            if !limited {
                (s.limits, s.longest_dt) = (Limits::unlimited(), T::HIGHEST);
                s.fallback = Fallback::hold_indefinitely();
            }
        });
        Adaptive::try_new(settings).unwrap()
    })
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
    law: &Adaptive<T, 2>,
    samples: &[[f64; 7]],
) -> Result<(), TestCaseError> {
    let mut state = AdaptiveState::new(law);
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
            && input.dt <= law.settings().longest_dt
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
        double in any_law::<f64>(),
        single in any_law::<f32>(),
        samples in samples(),
    ) {
        stays_in_its_boxes(&double, &samples)?;
        stays_in_its_boxes(&single, &samples)?;
    }

    #[test]
    fn a_resumed_or_taken_over_state_is_valid_whatever_it_resumes_from(
        law in any_law::<f64>(),
        samples in samples(),
        output in anything(),
    ) {
        let narrow = with(*law.settings(), |s| {
            s.beta.initial = s.beta.low;
            s.beta.high = s.beta.low + 0.1 * (s.beta.high - s.beta.low);
        });
        let other = Adaptive::try_new(narrow).unwrap();
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
