//! Leakage: the same at every rate, to a prior, switching, and in f32.

use super::literal;
use bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, Estimator, Form, Leakage,
};

/// delta_hat leaking from 7 with nothing to adapt to (the error is zero).
fn leaked(h: f64, seconds: f64, leakage: Leakage<f64>, prior: f64) -> f64 {
    let delta = Estimator {
        gain: 1.0,
        leakage,
        prior,
        ..Estimator::free(7.0)
    };
    let law = Adaptive::try_new(AdaptiveSettings { delta, ..literal() }).unwrap();
    let mut state = AdaptiveState::new(&law);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    for _ in 0..(seconds / h).round() as u32 {
        law.step(&mut state, &AdaptiveInput::new(h, 0.0, 0.0, [0.0]));
    }
    state.delta_hat()
}

#[test]
fn the_leakage_does_not_depend_on_the_rate() {
    let leakage = Leakage::Constant { rate: 0.05 };
    let exact = 2.0 + 5.0 * (-0.5_f64).exp();
    for h in [1e-4, 1e-3, 1e-2, 1e-1] {
        // (1 + h·sigma)^(-t/h) differs from e^(-sigma·t) by sigma²·h·t/2 of itself.
        let method = 5.0 * (-0.5_f64).exp() * 0.05 * 0.05 * h * 10.0 / 2.0;
        let error = leaked(h, 10.0, leakage, 2.0) - exact;
        assert!(error.abs() < 1.01 * method + 1e-12, "{h}: {error}");
    }
}

#[test]
fn a_leakage_faster_than_the_samples_does_not_overshoot() {
    // h·sigma = 500: an explicit step would go to -3493.
    let p = leaked(10.0, 10.0, Leakage::Constant { rate: 50.0 }, 2.0);
    assert!((p - (7.0 + 500.0 * 2.0) / 501.0).abs() < 1e-12);
}

#[test]
fn where_an_estimate_settles_does_not_depend_on_the_rate() {
    for h in [1e-3, 0.1, 30.0] {
        let theta = Estimator {
            prior: 0.5,
            ..Estimator::free(0.0).adapting(5e-4, 0.01)
        };
        let settings = AdaptiveSettings {
            theta: [theta],
            z_limit: 1e-300, // keeps s at e
            ..literal()
        };
        let law = Adaptive::try_new(settings).unwrap();
        let mut state = AdaptiveState::new(&law);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        for _ in 0..(4000.0 / h) as u32 + 100 {
            law.step(&mut state, &AdaptiveInput::new(h, 3.0, 1.0, [0.7]));
        }
        // prior + gain·v/sigma with v = -lambda·s·x and s = -2.
        let settled = 0.5 + 5e-4 * (8.0 * 2.0 * 0.7) / 0.01;
        // e^(-40) is left of the way there.
        assert!((state.theta_hat()[0] - settled).abs() < 1e-12, "{h}");
    }
}

#[test]
fn a_switching_leakage_acts_only_beyond_its_bound() {
    let leakage = |bound| Leakage::Switching { rate: 0.05, bound };
    assert_eq!(leaked(1e-3, 10.0, leakage(7.0), 0.0), 7.0);
    let full = leaked(1e-3, 1.0, leakage(3.0), 0.0);
    assert_eq!(
        full,
        leaked(1e-3, 1.0, Leakage::Constant { rate: 0.05 }, 0.0)
    );
    // It comes to rest at the bound, from above.
    let at_rest = leaked(0.1, 4000.0, leakage(6.0), 0.0);
    assert!((6.0..6.0 + 1e-9).contains(&at_rest), "{at_rest}");
}

#[test]
fn in_f32_a_leakage_below_the_rounding_still_acts() {
    let (h, sigma) = (5e-5_f32, 0.001_f32); // 20 kHz
    let mut plain = 7.0_f32;
    let delta = Estimator::free(7.0_f32).adapting(1.0, sigma);
    let form = Form::AsPublished {
        time_constant: 0.005,
    };
    let settings = AdaptiveSettings {
        delta,
        ..AdaptiveSettings::<f32, 0>::unlimited(form, 24.0, 8.0, 0.05)
    };
    let law = Adaptive::try_new(settings).unwrap();
    let mut state = AdaptiveState::new(&law);
    for _ in 0..2_000_000 {
        plain /= 1.0 + h * sigma;
        law.step(&mut state, &AdaptiveInput::new(h, 0.0, 0.0, []));
    }
    // 100 s: without compensation nothing has moved, 1 + 5e-8 being one.
    assert_eq!(plain, 7.0);
    let exact = 7.0 * (-0.1_f32).exp();
    // The carry loses half an ulp of an increment a step, 3e-8 of the way in all; the
    // rest is the rounding of h·sigma, 1e-7, and of the result.
    assert!(
        (state.delta_hat() - exact).abs() < 2e-6,
        "{}",
        state.delta_hat()
    );
}
