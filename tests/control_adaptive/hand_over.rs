//! Start, change of gains and recovery without a jump of the command.

use super::*;

#[test]
fn a_resumed_law_starts_from_the_output_it_is_given() {
    let mut random = Random(5);
    for number in 0..200 {
        let sign = [SmoothSign::Tanh, SmoothSign::Clamp][number % 2];
        for settings in both() {
            let law = law(settings, |s| s.smooth_sign = sign);
            let output = random.within(-40.0, 40.0);
            let reference = random.within(0.0, 30.0);
            let input = with(at(reference, 12.0, 0.4), |at| {
                at.feed_forward = random.within(-10.0, 10.0);
                at.next_reference = reference + random.within(-0.01, 0.01);
            });
            let mut state = AdaptiveState::resume_from(&law, output, &input);
            assert!(law.is_valid(&state));
            // No time passes at a resume: without a dt, the step of the form gives the rate.
            for dt in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
                let input = AdaptiveInput { dt, ..input };
                assert_eq!(AdaptiveState::resume_from(&law, output, &input), state);
            }
            // z is found to its last bit, times k·lambda + 1/lambda = 192.
            near(law.step(&mut state, &input).command, output, 1e-11);
        }
    }
}

#[test]
fn other_gains_take_over_without_a_jump_and_keep_the_estimates() {
    let from = law(lag(), |_| ());
    let mut state = AdaptiveState::new(&from);
    for step in 0..500 {
        let y = 4.0 * (0.01 * f64::from(step)).sin();
        from.step(&mut state, &at(3.0, y, 0.1));
    }
    let to = law(lag(), |s| {
        (s.gain, s.lambda) = (15.0, 5.0);
        s.theta = [Estimator::fixed(0.0).within(-1e-6, 1e-6)];
    });
    let (before, input) = (state, at(3.0, -3.0, 0.1));
    assert!(!to.is_valid(&state), "theta_hat is above its new box");
    to.bumpless_transfer(&mut state, &input);
    assert_eq!(estimates(&state)[..2], estimates(&before)[..2]);
    assert!(to.is_valid(&state), "theta_hat is in its new box");
    near(to.step(&mut state, &input).command, before.command(), 1e-11);
}

#[test]
fn with_beta_hat_at_zero_a_resumed_law_says_what_it_can() {
    let law = Adaptive::<f64, 2>::paper();
    let input = AdaptiveInput::new(0.001, 3.0, 1.0, [0.0; 2]);
    let mut state = AdaptiveState::resume_from(&law, 7.0, &input);
    assert_eq!((state.command(), state.accumulated_error()), (7.0, 0.0));
    assert_eq!(law.step(&mut state, &input).command, 0.0);
}

#[test]
fn a_reset_is_a_new_state_at_the_command_that_is_out() {
    for form in both() {
        let law = law(form, |s| {
            s.limits = range(-60.0, 60.0).with_slew(100.0).unwrap();
            s.fallback = Fallback::try_new(3, 40.0).unwrap();
        });
        let (mut state, good) = (AdaptiveState::new(&law), at(3.0, 1.0, 1.0));
        for _ in 0..300 {
            law.step(&mut state, &good);
        }
        let out = state.command();
        assert!(out > 10.0, "{out}");
        state.reset(&law);
        assert_eq!(state.accumulated_error(), 0.0);
        assert_eq!(estimates(&state), estimates(&AdaptiveState::new(&law)));
        // A bad sample holds it, a good one goes on from it at the slew rate.
        let held = law.step(&mut state, &lost(good));
        assert_eq!(
            (held.status, held.command),
            (Status::Held(Fault::Measured), out)
        );
        let next = law.step(&mut state, &good).command;
        assert!((next - out).abs() <= 0.2 + 1e-12, "{next} after {out}");
        // An acknowledged fault is still one.
        for _ in 0..4 {
            law.step(&mut state, &lost(good));
        }
        assert_eq!(state.command(), 40.0);
        state.acknowledge();
        state.reset(&law);
        let next = law.step(&mut state, &good).command;
        assert!((next - 40.0).abs() <= 0.1 + 1e-12, "{next}");
    }
}
