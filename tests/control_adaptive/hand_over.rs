//! Start, change of gains and recovery without a jump of the command.

use super::{lag, literal, Random};
use bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, Estimator, Fallback, Fault, Limits,
    SmoothSign, Status,
};

#[test]
fn a_resumed_law_starts_from_the_output_it_is_given() {
    let mut random = Random(5);
    for _ in 0..200 {
        let smooth_sign = if random.next() > 0.0 {
            SmoothSign::Tanh
        } else {
            SmoothSign::Clamp
        };
        for settings in [literal(), lag()] {
            let law = Adaptive::try_new(AdaptiveSettings {
                smooth_sign,
                ..settings
            })
            .unwrap();
            let output = random.within(-40.0, 40.0);
            let reference = random.within(0.0, 30.0);
            let input = AdaptiveInput {
                feed_forward: random.within(-10.0, 10.0),
                next_reference: reference + random.within(-0.01, 0.01),
                ..AdaptiveInput::new(0.001, reference, 12.0, [0.4])
            };
            let mut state = AdaptiveState::resume_from(&law, output, &input);
            assert!(law.is_valid(&state));
            // No time passes at a resume: without a dt, the step of the form gives the rate.
            for dt in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
                let input = AdaptiveInput { dt, ..input };
                assert_eq!(AdaptiveState::resume_from(&law, output, &input), state);
            }
            // z is found to its last bit, times k·lambda + 1/lambda = 192.
            let command = law.step(&mut state, &input).command;
            assert!((command - output).abs() < 1e-11, "{command} {output}");
        }
    }
}

#[test]
fn other_gains_take_over_without_a_jump_and_keep_the_estimates() {
    let from = Adaptive::try_new(lag()).unwrap();
    let mut state = AdaptiveState::new(&from);
    for step in 0..500 {
        let y = 4.0 * (0.01 * f64::from(step)).sin();
        from.step(&mut state, &AdaptiveInput::new(0.001, 3.0, y, [0.1]));
    }
    let to = AdaptiveSettings {
        gain: 15.0,
        lambda: 5.0,
        ..lag()
    };
    let to = Adaptive::try_new(AdaptiveSettings {
        theta: [Estimator::fixed(0.0).within(-1e-6, 1e-6)],
        ..to
    })
    .unwrap();
    let before = state;
    let input = AdaptiveInput::new(0.001, 3.0, -3.0, [0.1]);
    to.bumpless_transfer(&mut state, &input);
    assert_eq!(state.beta_hat(), before.beta_hat());
    assert_eq!(state.delta_hat(), before.delta_hat());
    assert!(to.is_valid(&state), "theta_hat is in its new box");
    let command = to.step(&mut state, &input).command;
    assert!((command - before.command()).abs() < 1e-11);
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
fn after_the_safe_command_both_forms_go_on_from_it() {
    let limits = Limits::try_new(-100.0, 100.0)
        .unwrap()
        .with_slew(1000.0)
        .unwrap();
    let fallback = Fallback::try_new(3, -20.0).unwrap();
    for settings in [literal(), lag()] {
        let settings = AdaptiveSettings {
            limits,
            fallback,
            ..settings
        };
        let law = Adaptive::try_new(settings).unwrap();
        let mut state = AdaptiveState::new(&law);
        let good = AdaptiveInput::new(0.001, 3.0, 2.9, [0.0]);
        for _ in 0..100 {
            law.step(&mut state, &good);
        }
        let held = state.command();
        let bad = AdaptiveInput {
            measured: f64::NAN,
            ..good
        };
        for _ in 0..2 {
            let output = law.step(&mut state, &bad);
            assert_eq!(
                (output.status, output.command),
                (Status::Held(Fault::Measured), held)
            );
        }
        for _ in 0..5 {
            let output = law.step(&mut state, &bad);
            assert_eq!(
                (output.status, output.command),
                (Status::Safe(Fault::Measured), -20.0)
            );
        }
        state.acknowledge();
        let output = law.step(&mut state, &good);
        assert_eq!(output.status, Status::Good);
        assert!(
            (output.command + 20.0).abs() <= 1.0 + 1e-12,
            "{}",
            output.command
        );
        let output = law.step(&mut state, &good);
        assert!(output.command > -20.0);
    }
}

#[test]
fn a_reset_is_a_new_state_at_the_command_that_is_out() {
    for form in [literal(), lag()] {
        let limits = Limits::try_new(-60.0, 60.0).unwrap();
        let limits = limits.with_slew(100.0).unwrap();
        let fallback = Fallback::try_new(3, 40.0).unwrap();
        let settings = AdaptiveSettings {
            limits,
            fallback,
            ..form
        };
        let law = Adaptive::try_new(settings).unwrap();
        let mut state = AdaptiveState::new(&law);
        let good = AdaptiveInput::new(0.001, 3.0, 1.0, [1.0]);
        let bad = AdaptiveInput::new(0.001, 3.0, f64::NAN, [1.0]);
        for _ in 0..300 {
            law.step(&mut state, &good);
        }
        let out = state.command();
        assert!(out > 10.0, "{out}");
        state.reset(&law);
        let fresh = AdaptiveState::new(&law);
        assert_eq!(state.accumulated_error(), 0.0);
        assert_eq!(state.theta_hat(), fresh.theta_hat());
        assert_eq!(state.beta_hat(), fresh.beta_hat());
        // A bad sample holds it, a good one goes on from it at the slew rate.
        let held = law.step(&mut state, &bad);
        assert_eq!(
            (held.status, held.command),
            (Status::Held(Fault::Measured), out)
        );
        let next = law.step(&mut state, &good).command;
        assert!((next - out).abs() <= 0.2 + 1e-12, "{next} after {out}");
        // An acknowledged fault is still one.
        for _ in 0..4 {
            law.step(&mut state, &bad);
        }
        assert_eq!(state.command(), 40.0);
        state.acknowledge();
        state.reset(&law);
        let next = law.step(&mut state, &good).command;
        assert!((next - 40.0).abs() <= 0.1 + 1e-12, "{next}");
        state = AdaptiveState::new(&law);
        assert_eq!(state, fresh);
    }
}
