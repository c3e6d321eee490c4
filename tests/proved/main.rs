//! What the harnesses prove of one step, asked of many steps and of random ones.
//!
//! The same functions: `proofs/properties`. A harness tries every state and one step; here a
//! few thousand runs, but with the controller, the plant and the libm that ship.

// Clippy's allowance covers the test functions, not what they share.
#![allow(clippy::unwrap_used)]

mod feed_forwards;
// The whole of what the harnesses ask; what tests/effects and tests/faults ask is not asked again.
#[allow(dead_code)]
#[path = "../../proofs/properties/mod.rs"]
mod properties;
#[path = "../shared/mod.rs"]
mod shared;

use bowden::control::*;
use bowden::effect::{DragCubic, Motion};
use bowden::hysteresis::BoucWen;
use bowden::model::{Model, Source, Term};
use bowden::signal::{Derivative, DerivativeState, Play, PlayState};
use bowden::transmission::Transmission;
use properties::{control, signal, tracking};
use proptest::prelude::*;
use shared::{any32 as any_float, with};

fn finite() -> impl Strategy<Value = f32> {
    any_float().prop_map(|x| if x.is_finite() { x } else { 1.0 })
}

fn sign() -> impl Strategy<Value = SmoothSign> {
    prop_oneof![Just(SmoothSign::Tanh), Just(SmoothSign::Clamp)]
}

/// At 1 kHz.
const LAG: Form<f32> = Form::FirstOrder {
    step: 0.001,
    plant_gain: 1.0,
};

fn form() -> impl Strategy<Value = Form<f32>> {
    let time_constant = 0.005;
    prop_oneof![Just(Form::AsPublished { time_constant }), Just(LAG)]
}

/// The law of Table 2 in any form, with beta_hat and delta_hat in their boxes.
fn table_2<const N: usize>(
    form: Form<f32>,
    change: impl FnOnce(&mut AdaptiveSettings<f32, N>),
) -> Adaptive<f32, N> {
    let settings = AdaptiveSettings {
        beta: Estimator::fixed(1.0).within(0.8, 1.2),
        delta: Estimator::fixed(1.0).within(0.0, 4.0),
        ..AdaptiveSettings::unlimited(form, 24.0, 8.0, 0.05)
    };
    Adaptive::try_new(with(settings, change)).unwrap()
}

fn range(low: f32, high: f32) -> Limits<f32> {
    Limits::try_new(low, high).unwrap()
}

/// The recursion of the errors of Table 2.
fn recursion(smooth_sign: SmoothSign) -> LagRecursion<f32> {
    let (gain, lambda, epsilon) = (24.0, 8.0, 0.05);
    LagRecursion {
        gain,
        lambda,
        epsilon,
        smooth_sign,
    }
}

/// delta of Theorem 1 for alpha = 1, theta = 0 and `|D| <= disturbance`: `sqrt(2·phi/theta)`.
fn theorem_1(law: &AdaptiveSettings<f32, 2>, disturbance: f32) -> f32 {
    let share =
        |of: &Estimator<f32>, truth: f32| of.leakage.rate() * truth * truth / (2.0 * of.gain);
    let residue = law.smooth_sign.residue::<f32>() * law.epsilon * law.lambda * disturbance;
    let phi = share(&law.beta, 1.0) + share(&law.delta, disturbance) + residue;
    let rates = [&law.beta, &law.delta, &law.theta[0], &law.theta[1]].map(|of| of.leakage.rate());
    let decay = rates
        .into_iter()
        .fold(2.0 * law.lambda * law.gain.min(1.0), f32::min);
    (2.0 * phi / decay).sqrt()
}

proptest! {
#[test]
fn errors_never_leave_their_box(
    sign in sign(),
    start in (-0.43..=0.43_f32, -0.05375..=0.05375_f32),
    steps in prop::collection::vec((0.8..=1.2_f32, 0.0..=4.0_f32, -8.0..=8.0_f32), 1..300),
    worst in any::<bool>(),
) {
    let law = recursion(sign);
    let mut at = ErrorState { s: start.0, z: start.1 };
    for (g, delta_hat, w) in steps {
        // The adversary pushes outwards with all that it has.
        let w = if worst { 8.0_f32.copysign(at.s) } else { w };
        let by = Disturbance { g, delta_hat, w, xi: 0.0 };
        prop_assert!(tracking::errors_stay_in_their_box(&law, at, 0.001, &by, 0.43));
        at = law.step(at, 0.001, &by);
    }
}

#[test]
fn theorem_1_is_carried_over_every_step(
    sign in sign(),
    start in (-1.0..=1.0_f32, -1.0..=1.0_f32),
    steps in prop::collection::vec(
        (0.8..=1.2_f32, 0.0..=4.0_f32, -8.0..=8.0_f32, -0.008..=0.008_f32), 1..300
    ),
) {
    // What `bowden_bound::Theorem1` gives for Table 2, alpha = 1 and Delta = 7.056 N·m.
    let delta = theorem_1(Adaptive::paper().settings(), 7.056);
    let law = recursion(sign);
    let mut at = ErrorState { s: start.0 * delta, z: start.1 * delta };
    for (g, delta_hat, w, xi) in steps {
        let by = Disturbance { g, delta_hat, w, xi };
        prop_assert!(tracking::errors_stay_within_theorem_1(&law, at, 0.001, &by, delta));
        at = law.step(at, 0.001, &by);
        prop_assert!((at.s - law.lambda * at.z).abs() <= (1.0 + law.lambda) * delta);
    }
}

#[test]
fn the_law_keeps_the_error_in_its_box_on_a_static_plant(
    sign in sign(),
    g in 0.8..=1.2_f32,
    disturbance in -5.0..5.0_f32,
    reference in -10.0..10.0_f32,
    s in -0.43..=0.43_f32,
) {
    // |w| = |(g - 1)·r - D| <= 0.2·10 + 5 < 8.
    let law = table_2::<0>(LAG, |s| {
        (s.beta.initial, s.smooth_sign) = (g, sign);
        s.delta = s.delta.adapting(6e-3, 0.01);
    });
    let plant = tracking::StaticPlant { gain: 1.0, disturbance };
    // z = 0, and the command that gives this error.
    let at = AdaptiveInput::new(0.001, reference, reference + s, []);
    let mut state = AdaptiveState::resume_from(&law, reference + s + disturbance, &at);
    let most = ErrorState { s: 0.43, z: 0.43 / 8.0 };
    for _ in 0..500 {
        prop_assert!(tracking::the_law_keeps_the_box(
            &law, &mut state, &plant, 0.001, reference, most
        ));
    }
}

#[test]
fn a_projection_moves_towards_the_truth(
    p in any_float(), truth in finite(), low in finite(), high in finite()
) {
    prop_assert!(p.is_nan() || signal::projection_moves_towards_the_truth(p, truth, low, high));
}

#[test]
fn a_smooth_sign_is_a_sign_and_leaves_at_most_its_residue(sign in sign(), x in any_float()) {
    prop_assert!(signal::smooth_sign_is_a_sign(sign, x));
    prop_assert!(signal::smooth_sign_leaves_at_most_its_residue(sign, x));
}

#[test]
fn a_play_holds_its_band(r in 0.0..50.0_f32, inputs in prop::collection::vec(any_float(), 1..50)) {
    let play = Play::try_new(r).unwrap();
    let mut state = PlayState::new();
    for input in inputs {
        prop_assert!(signal::play_holds_its_band(&play, state, input));
        play.step(&mut state, input);
    }
}

#[test]
fn a_filtered_rate_exceeds_nothing(
    tau in 0.0..0.1_f32, dt in 1e-4..0.1_f32,
    samples in prop::collection::vec(-100.0..100.0_f32, 2..50),
) {
    let filter = Derivative::try_new(tau).unwrap();
    let mut state = DerivativeState::new();
    filter.step(&mut state, samples[0], dt);
    for pair in samples.windows(2) {
        let change = pair[1] - pair[0];
        prop_assert!(signal::rate_exceeds_nothing(&filter, state, change, pair[1], dt));
        filter.step(&mut state, pair[1], dt);
    }
}

#[test]
fn the_rate_of_a_bounded_signal_stays_by_it(
    tau in 1e-3..0.1_f32, samples in prop::collection::vec(-1.0..=1.0_f32, 2..200),
    edges in any::<bool>(),
) {
    let filter = Derivative::try_new(tau).unwrap();
    let (mut state, dt) = (DerivativeState::new(), 1.0 / 1024.0);
    let sample = |x: f32| if edges { 1.0_f32.copysign(x) } else { x };
    filter.step(&mut state, sample(samples[0]), dt);
    for pair in samples.windows(2) {
        let (last, next) = (sample(pair[0]), sample(pair[1]));
        prop_assert!(signal::rate_stays_by_its_signal(&filter, state, last, next, 1e-4));
        filter.step(&mut state, next, dt);
    }
}

#[test]
fn limits_are_kept(
    low in -1e3..0.0_f32, width in 1e-3..1e3_f32, slew in 1e-3..1e6_f32,
    last in finite(), wanted in finite(), dt in 1e-6..10.0_f32,
) {
    let limits = range(low, low + width);
    prop_assert!(control::limits_are_kept(&limits, last, wanted, dt));
    let limits = limits.with_slew(slew).unwrap();
    prop_assert!(control::limits_are_kept(&limits, last, wanted, dt));
}

#[test]
fn the_integral_always_makes_progress(
    gains in (0.0_f32..50.0, 0.0_f32..500.0, 0.0_f32..=1.0, -1.0_f32..20.0),
    clamp in any::<bool>(),
    (low, width) in (-100.0_f32..50.0, 1e-2_f32..100.0),
    samples in prop::collection::vec((1e-4_f32..0.05, finite(), finite(), finite()), 1..50),
    start in finite(),
) {
    let (k_p, k_i, setpoint_weight, deadband) = gains;
    let pid = Pid::try_new(PidSettings {
        setpoint_weight,
        deadband: deadband.max(0.0),
        anti_windup: if clamp { AntiWindup::Clamp } else { AntiWindup::Conditional },
        limits: range(low, low + width),
        ..PidSettings::unlimited(k_p, k_i)
    }).unwrap();
    let mut state = PidState::new();
    for (k, (dt, reference, measured, feed_forward)) in samples.into_iter().enumerate() {
        let at = PidInput { feed_forward, ..PidInput::new(dt, reference, measured) };
        if k == 0 {
            state.resume_from(&pid, start, &at);
        }
        prop_assert!(control::the_integral_makes_progress(&pid, &state, &at));
        pid.step(&mut state, &at);
    }
}

#[test]
fn controllers_command_within_their_limits(
    samples in prop::collection::vec(prop::array::uniform5(any_float()), 1..50),
    form in form(),
) {
    let limits = range(-20.0, 60.0).with_slew(1e4).unwrap();
    let fallback = Fallback::try_new(3, -2.0).unwrap();
    let pid = Pid::try_new(PidSettings {
        k_d: 2.0, derivative_time: 0.1, limits, fallback, ..PidSettings::unlimited(30.0, 18.0)
    }).unwrap();
    let law = table_2::<1>(form, |s| {
        (s.beta, s.delta) = (s.beta.adapting(2.5e-4, 0.01), s.delta.adapting(6e-3, 0.01));
        s.theta = [Estimator::fixed(0.0).within(-5.0, 5.0).adapting(5e-4, 0.01)];
        (s.limits, s.fallback) = (limits, fallback);
    });
    let (mut state, mut adapted) = (PidState::new(), AdaptiveState::new(&law));
    for [dt, reference, measured, x, feed_forward] in samples {
        // Mostly a millisecond, so that samples are good ones.
        let dt = if dt > 0.0 && dt < 100.0 { 0.001 } else { dt };
        let at = PidInput { velocity: x, feed_forward, ..PidInput::new(dt, reference, measured) };
        prop_assert!(control::pid_commands_within_its_limits(&pid, &mut state, &at));
        let at = AdaptiveInput {
            feed_forward, ..AdaptiveInput::new(dt, reference, measured, [x])
        };
        prop_assert!(control::adaptive_commands_within_its_limits(&law, &mut adapted, &at));
    }
}

#[test]
fn the_lag_does_not_pass_its_target(
    samples in prop::collection::vec((1e-5..=1e-3_f32, -50.0..50.0_f32, -50.0..50.0_f32), 1..100),
) {
    let law = table_2::<0>(LAG, |s| {
        (s.beta, s.delta) = (s.beta.within(1.0, 1.0), s.delta.within(0.0, 1.0));
    });
    let mut state = AdaptiveState::new(&law);
    for (dt, reference, measured) in samples {
        // Without limits and feed-forward the command that is out is the lag's.
        let before = state.command();
        let out = law.step_with_terms(&mut state, &AdaptiveInput::new(dt, reference, measured, []));
        prop_assert_eq!(out.status, Status::Good);
        // Half an ulp is owed by the sum, and half an ulp is rounded.
        let owed = f32::EPSILON * before.abs().max(out.terms.law.abs());
        prop_assert!(control::the_lag_does_not_pass_its_target(before, owed, &out));
    }
}

#[test]
fn from_a_state_of_another_law_a_command_is_within_the_limits_of_the_law_that_steps(
    wide in 20.0..1e6_f32,
    narrow in 0.1..20.0_f32,
    form in form(),
    safe: bool,
    samples in prop::collection::vec(prop::array::uniform4(any_float()), 1..40),
) {
    let limits = |most: f32| range(-most, most);
    let fallback = |most: f32| match safe {
        true => Fallback::try_new(3, most).unwrap(),
        false => Fallback::hold_indefinitely(),
    };
    let law = |most: f32| table_2::<1>(form, |s| {
        (s.beta, s.delta) = (s.beta.adapting(2.5e-4, 0.01), Estimator::fixed(0.0));
        (s.limits, s.longest_dt, s.fallback) = (limits(most), 0.005, fallback(most));
    });
    let pid = |most: f32| Pid::try_new(
        PidSettings::new(3.0, 30.0, limits(most), 0.005, fallback(most))
    ).unwrap();
    let (mut state, mut adapted) = (PidState::new(), AdaptiveState::new(&law(wide)));
    for (k, [reference, measured, x, feed_forward]) in samples.into_iter().enumerate() {
        let most = if k % 2 == 0 { wide } else { narrow };
        let at = PidInput { feed_forward, ..PidInput::new(0.001, reference, measured) };
        prop_assert!(
            control::pid_commands_within_its_limits_from_any_state(&pid(most), &mut state, &at)
        );
        let at = AdaptiveInput {
            feed_forward, ..AdaptiveInput::new(0.001, reference, measured, [x])
        };
        prop_assert!(control::adaptive_commands_within_its_limits_from_any_state(
            &law(most), &mut adapted, &at
        ));
    }
}

    #[test]
fn a_hand_over_keeps_the_command(
    at in prop::array::uniform5(any_float()), samples in 0_usize..50, high in 5.0..60.0_f32,
    form in form(),
) {
    let quiet = Adaptive::<f32, 2>::paper();
    let mut state = AdaptiveState::new(&quiet);
    for _ in 0..samples {
        quiet.step_with_terms(&mut state, &AdaptiveInput::new(0.001, 25.0, 20.0, [0.1, 0.0]));
    }
    let eager = table_2::<2>(form, |s| (s.gain, s.z_limit, s.limits) = (12.0, 0.5, range(-5.0, high)));
    let [dt, reference, measured, x, feed_forward] = at;
    let input = AdaptiveInput {
        feed_forward, ..AdaptiveInput::new(dt, reference, measured, [x, 0.0])
    };
    prop_assert!(control::a_hand_over_keeps_the_command(&eager, &mut state, &input));
}

#[test]
fn a_start_keeps_the_command_that_is_out(
    at in prop::array::uniform6(any_float()), high in 5.0..60.0_f32, form in form(),
) {
    let limits = range(-5.0, high);
    let law = table_2::<1>(form, |s| (s.gain, s.z_limit, s.limits) = (12.0, 0.5, limits));
    let [output, dt, reference, measured, x, feed_forward] = at;
    let input = AdaptiveInput {
        feed_forward, ..AdaptiveInput::new(dt, reference, measured, [x])
    };
    prop_assert!(control::a_start_keeps_the_command(&law, output, &input));
    let settings = PidSettings { limits, ..PidSettings::unlimited(30.0, 18.0) };
    let pid = Pid::try_new(settings).unwrap();
    let at = PidInput { feed_forward, ..PidInput::new(dt, reference, measured) };
    let mut state = PidState::new();
    prop_assert!(control::a_pid_start_keeps_the_command(&pid, &mut state, output, &at));
}

#[test]
fn a_compensator_commands_what_is_finite(
    samples in prop::collection::vec(prop::array::uniform4(any_float()), 1..50),
    sigma in 0.5..2.0_f32,
) {
    let shape = BoucWen::try_new(0.095_82, sigma, 3.871).unwrap();
    let cable = Transmission::torque(0.997_8, 2.0, 0.051_74, shape).unwrap();
    let (effect, source) = (DragCubic.into(), Source::Channel(0));
    let friction = Term { effect, source, origin: 0.0, gain: -0.5 };
    let model = Model::<f32, 1>::try_new(Some(cable), &[friction]).unwrap();
    let compensator = Compensator::try_new(&model).unwrap();
    let mut state = CompensatorState::new();
    for [dt, desired, velocity, load] in samples {
        let dt = if dt > 0.0 && dt < 100.0 { 0.001 } else { dt };
        let pulley = [Motion { velocity, ..Motion::default() }];
        let at = CompensatorInput { load, channels: &pulley, ..CompensatorInput::new(dt, desired) };
        prop_assert!(control::compensator_commands_are_finite(&compensator, &mut state, &at));
    }
}

}

/// What is bounded is `w = (g - 1)·(r + r'/lambda) + (g·theta_hat - theta)'x - D`, not D.
#[test]
fn a_disturbance_in_its_bound_leaves_the_box_where_w_with_the_reference_is_beyond() {
    let g = 0.8_f32;
    let law = table_2::<0>(LAG, |s| {
        (s.beta.initial, s.delta.initial) = (g, 0.0);
        (s.frozen, s.smooth_sign) = (true, SmoothSign::Clamp);
    });
    // The largest |s| and lambda·|z| in 20 s, from rest at e = 0.
    let reached = |reference: f32, disturbance: f32| {
        let at = AdaptiveInput::new(0.001, reference, reference, []);
        let mut state = AdaptiveState::resume_from(&law, reference + disturbance, &at);
        let mut most = 0.0_f32;
        for _ in 0..20_000 {
            let measured = state.command() - disturbance;
            let at = AdaptiveInput::new(0.001, reference, measured, []);
            let out = law.step_with_terms(&mut state, &at);
            most = most.max(out.terms.s.abs());
        }
        most
    };
    // D is 8 N·m in both. With a reference of 25 N·m w is -0.2·25 - 8 = -13 N·m: the box is left.
    assert!(reached(25.0, 8.0) > 0.6);
    // With one of -25 N·m w is 5 - 8 = -3 N·m, and with D = 3 N·m it is -8 N·m: within the bound.
    assert!(reached(-25.0, 8.0) <= 0.43);
    assert!(reached(25.0, 3.0) <= 0.43);
}

#[test]
fn a_start_outside_of_the_box_is_outside_for_a_while() {
    let law = recursion(SmoothSign::Clamp);
    let by = Disturbance {
        g: 0.8,
        delta_hat: 0.0,
        w: 8.0,
        xi: 0.0,
    };
    // |s| is in its range, |z| = 10 N·m·s is not: 0.43/lambda is 0.054.
    let (s, z) = (0.43_f32, -10.0);
    let mut at = ErrorState { s, z };
    let mut most = 0.0_f32;
    for _ in 0..5_000 {
        at = law.step(at, 0.001, &by);
        most = most.max(at.s.abs());
    }
    assert!(most > 0.43);
    // That it comes in is a theorem, not a harness; this run does.
    assert!(tracking::in_box(&law, at, 0.43));
}
