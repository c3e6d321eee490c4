//! Leakage: the same at every rate, to a prior, switching, and in f32.

use super::*;

/// delta_hat leaking from a start with nothing to adapt to (the error is zero).
fn leaked(h: f64, seconds: f64, leakage: Leakage<f64>, (start, prior): (f64, f64)) -> f64 {
    let delta = Estimator {
        gain: 1.0,
        leakage,
        prior,
        ..Estimator::free(start)
    };
    let law = law(literal(), |s| s.delta = delta);
    let mut state = AdaptiveState::new(&law);
    for _ in 0..(seconds / h).round() as u32 {
        law.step(&mut state, &AdaptiveInput::new(h, 0.0, 0.0, [0.0]));
    }
    state.delta_hat()
}

#[test]
fn the_leakage_does_not_depend_on_the_rate_and_does_not_overshoot() {
    let exact = 2.0 + 5.0 * (-0.5_f64).exp();
    for h in [1e-4, 1e-3, 1e-2, 1e-1] {
        // (1 + h·sigma)^(-t/h) differs from e^(-sigma·t) by sigma²·h·t/2 of itself.
        let method = 5.0 * (-0.5_f64).exp() * 0.05 * 0.05 * h * 10.0 / 2.0;
        let got = leaked(h, 10.0, Leakage::Constant { rate: 0.05 }, (7.0, 2.0));
        near(got, exact, 1.01 * method + 1e-12);
    }
    // h·sigma = 500: an explicit step would go to -3493.
    let p = leaked(10.0, 10.0, Leakage::Constant { rate: 50.0 }, (7.0, 2.0));
    near(p, (7.0 + 500.0 * 2.0) / 501.0, 1e-12);
}

#[test]
fn where_an_estimate_settles_does_not_depend_on_the_rate() {
    for h in [1e-3, 0.1, 30.0] {
        let law = law(literal(), |s| {
            s.theta = [Estimator::free(0.0).adapting(5e-4, 0.01)];
            s.theta[0].prior = 0.5;
            s.z_limit = 1e-300; // keeps s at e
        });
        let mut state = AdaptiveState::new(&law);
        for _ in 0..(4000.0 / h) as u32 + 100 {
            law.step(&mut state, &AdaptiveInput::new(h, 3.0, 1.0, [0.7]));
        }
        // prior + gain·v/sigma with v = -lambda·s·x and s = -2; e^(-40) is left of the way there.
        let settled = 0.5 + 5e-4 * (8.0 * 2.0 * 0.7) / 0.01;
        near(state.theta_hat()[0], settled, 1e-12);
    }
}

#[test]
fn a_switching_leakage_acts_only_beyond_its_bound() {
    let switching = |bound| Leakage::Switching { rate: 0.05, bound };
    assert_eq!(leaked(1e-3, 10.0, switching(7.0), (7.0, 0.0)), 7.0);
    let full = leaked(1e-3, 1.0, switching(3.0), (7.0, 0.0));
    let constant = Leakage::Constant { rate: 0.05 };
    assert_eq!(full, leaked(1e-3, 1.0, constant, (7.0, 0.0)));
    // It comes to rest at the bound, from above.
    let at_rest = leaked(0.1, 4000.0, switching(6.0), (7.0, 0.0));
    assert!((6.0..6.0 + 1e-9).contains(&at_rest), "{at_rest}");
}

#[test]
fn a_switching_leakage_is_the_same_on_both_sides_of_the_prior() {
    let leakage = Leakage::Switching {
        rate: 0.5,
        bound: 2.0,
    };
    for distance in [2.5, 3.0, 8.0] {
        let [above, below] =
            [distance, -distance].map(|by| leaked(0.001, 1.0, leakage, (10.0 + by, 10.0)) - 10.0);
        assert!(above < distance - 0.05, "{above}");
        near(above, -below, ROUNDING);
    }
}

#[test]
fn in_f32_a_leakage_below_the_rounding_still_acts() {
    let (h, sigma, time_constant) = (5e-5_f32, 0.001_f32, 0.005); // 20 kHz
    let form = Form::AsPublished { time_constant };
    let settings = AdaptiveSettings::<f32, 0>::unlimited(form, 24.0, 8.0, 0.05);
    let delta = Estimator::free(7.0_f32).adapting(1.0, sigma);
    let law = Adaptive::try_new(with(settings, |s| s.delta = delta)).unwrap();
    let (mut state, mut plain) = (AdaptiveState::new(&law), 7.0_f32);
    for _ in 0..2_000_000 {
        plain /= 1.0 + h * sigma;
        law.step(&mut state, &AdaptiveInput::new(h, 0.0, 0.0, []));
    }
    // 100 s: without compensation nothing has moved, 1 + 5e-8 being one.
    assert_eq!(plain, 7.0);
    let exact = 7.0 * (-0.1_f32).exp();
    // The carry loses half an ulp of an increment a step, 3e-8 of the way in all; the
    // rest is the rounding of h·sigma, 1e-7, and of the result.
    near(f64::from(state.delta_hat()), f64::from(exact), 2e-6);
}
