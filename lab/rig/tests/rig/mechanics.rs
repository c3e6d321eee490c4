//! What the equations of motion say in closed form.

use approx::assert_relative_eq;
use bowden::effect::{Effect, Gain, Quantity, StiffnessQuadratic, Viscous};
use bowden::model::{Source, Term};
use bowden_rig::{Reference, Rig, RigConfig, RigState};

/// No hysteresis, no noise, fine converters: a linear rig.
fn linear() -> RigConfig<f64> {
    RigConfig {
        b: 1.0,
        kappa_eta: 0.0,
        t0: 0.0,
        noise: 0.0,
        input_noise: 0.0,
        converter_counts: 1e12,
        encoder_counts: 1e12,
        ..RigConfig::reference()
    }
}

fn started(config: RigConfig<f64>) -> (Rig<f64, 0>, RigState<f64, 0>) {
    let rig = Rig::try_new(config, &[]).unwrap();
    let state = rig.start(1);
    (rig, state)
}

fn settled(config: RigConfig<f64>, command: f64, seconds: f64) -> RigState<f64, 0> {
    let (rig, mut state) = started(config);
    for _ in 0..(seconds * 1e3) as usize {
        rig.step(&mut state, command, 1e-3);
    }
    state
}

#[test]
fn at_rest_the_torque_is_the_drives_and_the_angles_follow_hooke() {
    let state = settled(linear(), 50.0, 3.0);
    let now = state.sample();
    // 0.6 N·m/unit; the slowest mode, th1/(K + ...) = 20 ms, has long decayed.
    assert_relative_eq!(now.tau_o, 30.0, max_relative = 1e-9);
    assert_relative_eq!(now.tau_i, 30.0, max_relative = 1e-9);
    assert_relative_eq!(now.measured, 30.0, max_relative = 1e-9);
    assert_relative_eq!(state.distal().position, 30.0 / 150.0, max_relative = 1e-9);
    let stretch = state.proximal().position - state.distal().position;
    assert_relative_eq!(stretch, 30.0 / 1000.0, max_relative = 1e-9);
}

#[test]
fn the_transmission_is_the_papers_and_loses_seven_newton_metres() {
    let config = RigConfig {
        noise: 0.0,
        ..RigConfig::reference()
    };
    let (rig, mut state) = started(config);
    for k in 0..4000 {
        rig.step(&mut state, 0.02 * f64::from(k), 1e-3);
    }
    let now = state.sample();
    // Rising all the way to 48 N·m: 1 − eta is below e^(−rho·tau_i) = 1e-2.
    assert_relative_eq!(now.eta, 1.0, epsilon = 1e-2);
    assert_relative_eq!(
        now.tau_o,
        0.9978 * now.tau_i - 7.004 * now.eta - 0.05174,
        max_relative = 1e-12
    );
}

#[test]
fn a_rigid_joint_turns_the_motor_into_its_own_first_order_lag() {
    // Held by an endless spring the joint stands still; then phi_p is a damped oscillator
    // of th2, th1 and K_c alone, with the current loop in front of it.
    let config = RigConfig {
        load_stiffness: 1e6,
        joint_damping: 1000.0,
        joint_inertia: 1.0,
        cable_damping: 0.0,
        drive_lag: 1e-6,
        delay: 0,
        ..linear()
    };
    let (rig, mut state) = started(config);
    let (w0, decay) = ((1000.0_f64 / 0.2).sqrt(), 2.7 / 0.4);
    let w = (w0 * w0 - decay * decay).sqrt();
    for k in 1..=300 {
        rig.step(&mut state, 50.0, 1e-3);
        let t = f64::from(k) * 1e-3;
        let envelope = (-decay * t).exp();
        let exact = 0.03 * (1.0 - envelope * ((w * t).cos() + decay / w * (w * t).sin()));
        // First order: h·w0 = 1.8e-3 of the amplitude a radian; the joint yields 1e-3.
        assert_relative_eq!(
            state.proximal().position,
            exact,
            epsilon = 0.03 * (2e-3 + 1e-3 * w * t * 0.3)
        );
    }
}

#[test]
fn without_friction_and_drive_the_energy_stays() {
    // B = 1 and no hysteresis: the cable is a spring. It is let go from a wound state.
    let config = RigConfig {
        motor_damping: 0.0,
        joint_damping: 0.0,
        cable_damping: 0.0,
        drive_lag: 1e-5,
        ..linear()
    };
    let (rig, mut state) = started(config);
    for _ in 0..200 {
        rig.step(&mut state, 30.0, 1e-3);
    }
    for _ in 0..20 {
        rig.step(&mut state, 0.0, 1e-3);
    }
    let energy = |state: &RigState<f64, 0>| {
        let (p, d) = (state.proximal(), state.distal());
        let stretch = p.position - d.position;
        0.5 * (0.2 * p.velocity.powi(2)
            + 0.004 * d.velocity.powi(2)
            + 1000.0 * stretch.powi(2)
            + 150.0 * d.position.powi(2))
    };
    let start = energy(&state);
    for _ in 0..10_000 {
        rig.step(&mut state, 0.0, 1e-3);
        // Velocities before positions: the energy wobbles by h·w of the joint, 0.013, and
        // does not drift.
        assert_relative_eq!(energy(&state), start, max_relative = 0.015);
    }
}

#[test]
fn the_command_arrives_late_by_whole_samples() {
    for delay in 0..=3_u8 {
        let config = RigConfig { delay, ..linear() };
        let (rig, mut state) = started(config);
        for k in 0..=delay {
            let now = rig.step(&mut state, 10.0, 1e-3);
            assert_eq!(now.tau_m > 0.0, k == delay);
        }
    }
}

#[test]
fn the_sensor_lags_by_its_time_constant() {
    let (rig, mut state) = started(linear());
    let mut late = Vec::new();
    for k in 0..4000 {
        // A slow ramp: what is measured is the truth of one time constant ago.
        let now = rig.step(&mut state, 0.01 * f64::from(k), 1e-3);
        if k > 3000 {
            late.push((now.tau_o - now.measured) / (0.6 * 0.01 / 1e-3));
        }
    }
    for lag in late {
        assert_relative_eq!(lag, 1e-3, max_relative = 0.02); // half a sub-step, 1.3 %
    }
}

#[test]
fn rates_are_those_of_the_encoder_through_one_and_two_lags() {
    let (rig, mut state) = started(linear());
    let w = 3.0_f64;
    for k in 0..6000 {
        let t = f64::from(k) * 1e-3;
        let now = rig.step(&mut state, 30.0 * (w * t).sin(), 1e-3);
        if k > 3000 {
            // 10 ms of lag at 3 rad/s: 3 % of the amplitude, twice that after two lags.
            let (v, a) = (state.distal().velocity, state.distal().acceleration);
            assert_relative_eq!(now.distal.velocity, v, epsilon = 0.04 * 0.12 * w);
            assert_relative_eq!(now.distal.acceleration, a, epsilon = 0.08 * 0.12 * w * w);
        }
    }
}

#[test]
fn an_encoder_tells_whole_counts_and_a_converter_saturates() {
    let config = RigConfig {
        noise: 0.0,
        ..RigConfig::reference()
    };
    let state = settled(config, 300.0, 2.0);
    let now = state.sample();
    assert!(now.tau_o > 150.0 && now.measured == 100.0);
    let counts = now.distal.position / (2.0 * std::f64::consts::PI / 16384.0);
    assert_relative_eq!(counts, counts.round(), epsilon = 1e-9);
    assert!((state.distal().position - now.distal.position).abs() <= 1.92e-4); // half a count
}

#[test]
fn an_undeclared_effect_adds_its_gain_times_its_regressor() {
    let term = |effect, source, gain| Term {
        effect,
        source,
        origin: 0.05,
        gain,
    };
    let terms = [
        term(StiffnessQuadratic.into(), Source::Channel(1), -40.0),
        term(Viscous.into(), Source::Channel(0), -2.0),
        term(Gain.into(), Source::Input, 0.1),
    ];
    // `gain` is a function of the load or of the position, as the catalogue says.
    let reads = Effect::<f64>::from(Gain).info().reads;
    let from = match reads.contains(&Quantity::Position) {
        true => 0.05,
        false => 0.0,
    };
    let rig = Rig::<f64, 3>::try_new(linear(), &terms).unwrap();
    let mut state = rig.start(1);
    for k in 0..3000 {
        let t = f64::from(k) * 1e-3;
        rig.step(&mut state, 30.0 + 20.0 * (3.0 * t).sin(), 1e-3);
        let (now, p, d) = (state.sample(), state.proximal(), state.distal());
        let expected = now.tau_i - 40.0 * (d.position - 0.05).powi(2) - 2.0 * p.velocity
            + 0.1 * (now.tau_i - from);
        // The motion is that of the sub-step before: 25 µs of its rate.
        assert_relative_eq!(now.tau_o, expected, epsilon = 0.05);
    }
}

#[test]
fn a_torque_on_the_joint_moves_it_and_not_the_motor_alone() {
    let (rig, mut state) = started(linear());
    for _ in 0..3000 {
        rig.step_with_load(&mut state, 0.0, 15.0, 1e-3);
    }
    // Nothing holds the motor: the whole cable turns until the spring balances the load.
    assert_relative_eq!(state.distal().position, 0.1, max_relative = 1e-6);
    assert_relative_eq!(state.proximal().position, 0.1, max_relative = 1e-6);
}

#[test]
fn the_reference_is_the_papers_and_its_rates_are_its_derivatives() {
    let tau = 2.0 * std::f64::consts::PI;
    let paper = |t: f64| {
        25.0 + 10.0 * (tau * 0.25 * t).sin() + 3.0 * (tau * 0.2 * 3.0_f64.sqrt() * t).sin()
    };
    for reference in [Reference::paper(), Reference::paper().with_ramp(4.0)] {
        for t in times().filter(|t| *t > 4.0) {
            assert_relative_eq!(reference.at(t), paper(t), max_relative = 1e-14);
        }
        // Central differences: h² times a third derivative of 1e2, and rounding.
        assert_rates(&reference, 1e-6);
    }
}

#[test]
fn a_gait_pushes_off_once_a_second_without_a_jump() {
    for (reference, low, high) in [
        (Reference::<f64>::gait(), 5.0, 35.0),
        (Reference::gait().between(-2.0, 1.0), -2.0, 1.0),
    ] {
        for t in [0.0, 0.2, 0.65, 0.9, 1.0, 7.19] {
            assert_eq!(reference.at(t), low);
        }
        assert_relative_eq!(reference.at(3.5), high, epsilon = 1e-12);
        // Halfway up and halfway down.
        let half = 0.5 * (low + high);
        assert_relative_eq!(reference.at(2.35), half, epsilon = 1e-9);
        assert_relative_eq!(reference.at(2.575), half, epsilon = 1e-9);
        assert_relative_eq!(reference.maximum(), high, epsilon = 1e-12);
        // h² times a fourth derivative of 30·360/0.15⁴ = 2e7, and a sixth of it.
        assert_rates(&reference, 1e-3);
        for knot in [0.2, 0.5, 0.65] {
            let (before, after) = (reference.motion(knot - 1e-9), reference.motion(knot + 1e-9));
            assert_relative_eq!(before.velocity, after.velocity, epsilon = 1e-4);
            assert_relative_eq!(before.acceleration, after.acceleration, epsilon = 1e-3);
        }
    }
}

fn times() -> impl Iterator<Item = f64> {
    (0..100).map(|k| 0.0973 * f64::from(k) + 0.01)
}

/// Velocity and acceleration are the derivatives of what stands before them.
fn assert_rates(reference: &Reference<f64>, epsilon: f64) {
    for t in times() {
        let h = 1e-5;
        let here = reference.motion(t);
        let (before, after) = (reference.motion(t - h), reference.motion(t + h));
        let slope = |a: f64, b: f64| (b - a) / (2.0 * h);
        let (velocity, acceleration) = (
            slope(before.position, after.position),
            slope(before.velocity, after.velocity),
        );
        assert_relative_eq!(here.velocity, velocity, epsilon = epsilon);
        assert_relative_eq!(here.acceleration, acceleration, epsilon = epsilon);
    }
}
