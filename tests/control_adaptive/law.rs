//! One step against the paper's equations, written out; limits; refusals.

use super::*;

#[test]
fn a_step_is_equations_17_to_26() {
    let law = Adaptive::<f64, 2>::paper();
    let mut state = AdaptiveState::new(&law);
    // The paper's symbols, advanced by hand beside it.
    let (k, lambda, eps) = (24.0, 8.0, 0.05);
    let (gamma, mu, mu_i, sigma) = (0.002 / 8.0, 0.05 / 8.0, 0.004 / 8.0, 0.01);
    let (mut z, mut beta, mut delta, mut theta) = (0.0_f64, 0.0_f64, 7.0_f64, [0.0_f64; 2]);
    let (h, mut rate, mut last) = (0.001, 0.0, None);
    for step in 0..400 {
        let t = h * f64::from(step);
        let (y, y_r) = (20.0 + 4.0 * (3.0 * t).sin(), 25.0 + 10.0 * (1.5 * t).sin());
        let x = [(2.0 * t).cos(), -2.0 * (2.0 * t).sin()];
        let output = law.step_with_terms(&mut state, &AdaptiveInput::new(h, y_r, y, x));

        let e = y - y_r;
        let s = e + lambda * z;
        if let Some(last) = last {
            rate = (0.005 * rate + e - last) / (0.005 + h);
        }
        last = Some(e);
        let tanh = (s / eps).tanh();
        let ubar =
            -k * s + y_r - (z + rate) / lambda + theta[0] * x[0] + theta[1] * x[1] - delta * tanh;
        let u = beta * ubar;
        z += h * e;
        beta = (beta - h * gamma * lambda * s * ubar) / (1.0 + h * sigma);
        delta = (delta + h * mu * lambda * s * tanh) / (1.0 + h * sigma);
        for i in 0..2 {
            theta[i] = (theta[i] - h * mu_i * lambda * s * x[i]) / (1.0 + h * sigma);
        }
        // 400 steps of rounding, on a command that beta_hat lets grow to thousands.
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-10 * (1.0 + b.abs());
        assert_eq!(output.status, Status::Good);
        assert!(close(output.command, u), "{step}: {} {u}", output.command);
        assert!(close(output.terms.s, s) && close(output.terms.virtual_command, ubar));
        assert!(close(state.accumulated_error(), z) && close(state.beta_hat(), beta));
        assert!(close(state.delta_hat(), delta));
        assert!(close(state.theta_hat()[0], theta[0]) && close(state.theta_hat()[1], theta[1]));
    }
}

#[test]
fn the_papers_settings_are_admissible_as_they_are() {
    let checked = Adaptive::try_new(*Adaptive::<f32, 2>::paper().settings());
    assert_eq!(checked, Ok(Adaptive::paper()));
    assert_eq!(Adaptive::<f32, 2>::paper().settings().largest_step(), None);
}

#[test]
fn a_refusal_says_which_setting_or_condition() {
    use Error::{Inadmissible, NonFinite, OutOfRange};
    type Change = fn(&mut AdaptiveSettings<f64, 1>);
    #[rustfmt::skip]
    let cases: [(Change, Error); 12] = [
        (|s| s.gain = 0.0, OutOfRange("gain")),
        (|s| s.lambda = f64::NAN, NonFinite("lambda")),
        (|s| s.longest_dt = -1.0, OutOfRange("longest_dt")),
        (|s| s.epsilon = -1.0, OutOfRange("epsilon")),
        (|s| s.theta = [Estimator::fixed(9.0).within(-5.0, 5.0)], OutOfRange("theta.initial")),
        (|s| s.delta.gain = -1.0, OutOfRange("delta.gain")),
        (|s| s.beta.leakage = Leakage::Switching { rate: 0.1, bound: 0.0 }, OutOfRange("beta.leakage.bound")),
        (|s| s.beta = Estimator::fixed(1.0).within(0.0, 1.1), Inadmissible("first-order form: beta.low > 0")),
        (|s| s.delta = Estimator::fixed(1.0).within(-1.0, 7.0), Inadmissible("first-order form: delta.low >= 0")),
        (|s| s.form = Form::FirstOrder { step: 0.5, plant_gain: 1e-3 }, Inadmissible("first-order form: h*lambda <= 1")),
        (|s| s.epsilon = 0.05, Inadmissible("first-order form: h*lambda*g*(k + delta.high/epsilon) <= 1")),
        (|s| {
            s.fallback = Fallback::try_new(3, 50.0).unwrap();
            s.limits = Limits::try_new(-10.0, 10.0).unwrap();
        }, Inadmissible("the safe command lies within the limits")),
    ];
    for (change, error) in cases {
        assert_eq!(Adaptive::try_new(with(lag(), change)).err(), Some(error));
    }
}

#[test]
fn the_step_that_is_offered_is_admissible_and_a_longer_one_is_not() {
    let sharp = with(lag(), |s| s.epsilon = 0.05);
    let largest = sharp.largest_step().unwrap();
    // h·lambda·g⁺·(k + Dmax/eps) = 1 with 8·1.1·(24 + 140).
    near(largest, 1.0 / 1443.2, 1e-12);
    let plant_gain = 1.0;
    let of = |step| {
        Adaptive::try_new(with(sharp, |s| {
            s.form = Form::FirstOrder { step, plant_gain }
        }))
    };
    assert!(of(largest * 1.000_001).is_err());
    let law = of(largest).unwrap();
    let mut state = AdaptiveState::new(&law);
    let late = Status::Held(Fault::DtTooLong);
    for (dt, status) in [(largest, Status::Good), (largest * 1.01, late)] {
        let input = with(at(1.0, 0.0, 0.0), |at| at.dt = dt);
        assert_eq!(law.step(&mut state, &input).status, status);
    }
}

#[test]
fn against_a_limit_nothing_winds_up_and_the_command_comes_back_at_once() {
    for settings in both() {
        let law = law(settings, |s| s.limits = range(-5.0, 5.0));
        let (mut state, short) = (AdaptiveState::new(&law), at(30.0, 4.0, 0.3));
        for _ in 0..50 {
            law.step(&mut state, &short);
        }
        let wound = (
            state.accumulated_error(),
            state.beta_hat(),
            state.theta_hat(),
        );
        for _ in 0..60_000 {
            let output = law.step_with_terms(&mut state, &short);
            assert!(output.terms.limited && output.command == 5.0);
        }
        let now = (
            state.accumulated_error(),
            state.beta_hat(),
            state.theta_hat(),
        );
        assert_eq!(now, wound);
        // A minute at the limit, and it leaves it with the first sample that allows.
        assert!(law.step(&mut state, &at(4.0, 5.0, 0.3)).command < 5.0);
    }
}

#[test]
fn either_smooth_sign_is_odd_bounded_and_no_steeper_than_one() {
    for sign in [SmoothSign::Tanh, SmoothSign::Clamp] {
        let mut worst = 0.0_f64;
        for i in 0..40_000 {
            let x = 1e-4 * f64::from(i);
            let (here, next) = (sign.of(x), sign.of(x + 1e-4));
            assert_eq!(sign.of(-x), -here);
            assert!(next >= here && next <= 1.0);
            // One rounding of a value near one.
            assert!(next - here <= 1e-4 + 3e-16);
            worst = worst.max(x * (1.0 - here));
        }
        // The grid of 1e-4 misses the top by at most 1e-8 (its curvature is about one).
        near(worst, sign.residue(), 1e-8);
        assert_eq!(sign.of(f64::INFINITY), 1.0);
        assert!(sign.of(f64::NAN).is_nan());
    }
    // W(1/e) solves w·e^w = 1/e.
    let w = SmoothSign::Tanh.residue::<f64>();
    near(w * w.exp(), (-1.0_f64).exp(), 1e-16);
}
