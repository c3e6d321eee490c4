//! The equations of the law, one by one: what the paper derives from them holds.

use super::*;
use bowden::control::law;

/// A plant (11) with two regressors, the law's gains and one instant of the closed loop.
#[derive(Debug, Clone)]
struct Instant {
    alpha: f64,
    theta: [f64; 2],
    /// D and its bound Delta.
    disturbance: (f64, f64),
    x: [f64; 2],
    /// k, lambda, epsilon.
    gains: (f64, f64, f64),
    /// gamma and sigma of beta_hat, delta_hat and both theta_hat.
    adaptation: [(f64, f64); 4],
    /// The estimates in this order.
    estimates: [f64; 4],
    /// s, z, e' and y_r.
    signals: [f64; 4],
}

fn instants() -> impl Strategy<Value = Instant> {
    let gain = (1e-3..10.0, 1e-3..2.0);
    let plant = (
        0.1..3.0,
        [0.0..5.0, 0.0..5.0],
        (-1.0..1.0, 0.1..10.0),
        [-5.0..5.0, -5.0..5.0],
    );
    let law = (
        (0.1..50.0, 0.1..20.0, 0.01..1.0),
        [gain.clone(), gain.clone(), gain.clone(), gain],
        [0.0..5.0, 0.0..10.0, -5.0..5.0, -5.0..5.0],
        [-3.0..3.0, -3.0..3.0, -100.0..100.0, -40.0..40.0],
    );
    (plant, law).prop_map(
        |((alpha, theta, (share, delta), x), (gains, adaptation, estimates, signals))| Instant {
            alpha,
            theta,
            disturbance: (share * delta, delta),
            x,
            gains,
            adaptation,
            estimates,
            signals,
        },
    )
}

/// V of (27), its rate by (20)-(26), and the right side of (34).
fn lyapunov(at: &Instant) -> (f64, f64, f64) {
    let ((k, lambda, epsilon), [s, z, e_rate, y_r]) = (at.gains, at.signals);
    let (disturbance, delta) = at.disturbance;
    let truth = [1.0 / at.alpha, delta, at.theta[0], at.theta[1]];
    let [beta_hat, delta_hat, theta_hat @ ..] = at.estimates;
    let dot = |a: [f64; 2]| a[0] * at.x[0] + a[1] * at.x[1];

    let sign = law::smooth_sign(s / epsilon);
    let damped = law::damped(law::proportional(k, s, y_r), z, e_rate, lambda);
    let u_bar = law::virtual_command(damped, dot(theta_hat), delta_hat, sign);
    let y = law::plant_command(at.alpha, truth[0] - beta_hat, u_bar) - dot(at.theta) - disturbance;
    let excitation = [
        law::beta_excitation(lambda * s, u_bar),
        law::delta_excitation(lambda * s, sign),
        law::theta_excitation(lambda * s, at.x[0]),
        law::theta_excitation(lambda * s, at.x[1]),
    ];

    let mut v = 0.5 * (s * s + z * z);
    let e = law::error(y, y_r);
    let mut rate = s * law::s_rate(e_rate, lambda, e) + z * law::z_rate(s, lambda, z);
    let mut theta = (2.0 * lambda).min(2.0 * k * lambda);
    let residue = SmoothSign::Tanh.residue::<f64>();
    let mut phi = residue * epsilon * lambda * delta;
    for i in 0..4 {
        let ((gamma, sigma), weight) = (at.adaptation[i], if i == 0 { at.alpha } else { 1.0 });
        // Over one second, without the implicit denominator: the rate of the estimate.
        let p_rate = law::estimate_increment(1.0, gamma, excitation[i], sigma, at.estimates[i])
            * (1.0 + sigma);
        let error = truth[i] - at.estimates[i];
        v += weight * error * error / (2.0 * gamma);
        rate -= weight * error * p_rate / gamma;
        theta = theta.min(sigma);
        phi += weight * sigma * truth[i] * truth[i] / (2.0 * gamma);
    }
    (v, rate, phi - theta * v)
}

proptest! {
    /// (34): `V' <= -theta·V + phi` at any instant. A wrong sign or factor in one of the equations
    /// violates it.
    #[test]
    fn the_lyapunov_function_falls_as_the_paper_proves(at in instants()) {
        let (v, rate, bound) = lyapunov(&at);
        // The products that cancel in V' are up to 1e6 times as large as V'.
        prop_assert!(rate <= bound + 1e-9 * (1.0 + v + rate.abs() + bound.abs()) * 1e3, "{v} {rate} {bound}");
    }

    /// (20): the command's effect on the plant, from the estimate and from its error.
    #[test]
    fn the_plant_sees_the_virtual_command(
        alpha in 0.1_f64..3.0, beta_hat in 0.0..5.0, u_bar in -100.0..100.0
    ) {
        let sent = alpha * law::command(beta_hat, u_bar);
        let seen = law::plant_command(alpha, 1.0 / alpha - beta_hat, u_bar);
        // Rounding of numbers up to 1500.
        prop_assert!((sent - seen).abs() < 1e-11);
    }

    /// (17), (18), (21): e is what s and z say that it is.
    #[test]
    fn s_and_z_give_the_error(e in -10.0_f64..10.0, lambda in 0.1..20.0, z in -5.0..5.0, h in 0.0..0.01) {
        let s = law::filtered_error(e, lambda, z);
        prop_assert!((law::z_rate(s, lambda, z) - e).abs() < 1e-13);
        prop_assert_eq!(law::z_increment(h, e), h * e);
    }

    /// (19) in the first-order form: the command approaches its target and does not pass it.
    #[test]
    fn the_first_order_form_approaches(
        h in 0.0_f64..0.125, lambda in 0.1..8.0, wanted in -100.0..100.0, u in -100.0..100.0
    ) {
        let next = u + law::first_order_increment(h, lambda, wanted - u);
        let (low, high) = if u < wanted { (u, wanted) } else { (wanted, u) };
        // Rounding of numbers up to 100.
        prop_assert!(low - 1e-13 <= next && next <= high + 1e-13);
    }

    /// The sigma-modification: without excitation an estimate approaches its prior at any rate and
    /// step; with it, the increment vanishes at `gamma·v/sigma`.
    #[test]
    fn leakage_does_not_overshoot(
        h in 0.0..100.0, sigma in 0.0..100.0, distance in -10.0_f64..10.0, gamma in 0.0..10.0
    ) {
        let by: f64 = law::estimate_increment(h, gamma, 0.0, sigma, distance);
        prop_assert!(by * distance <= 0.0 && by.abs() <= distance.abs());
        let rest: f64 = law::estimate_increment(h, gamma, 3.0, sigma.max(0.1), gamma * 3.0 / sigma.max(0.1));
        // A difference of two numbers up to 30, over h·sigma at least: two roundings.
        prop_assert!(rest.abs() <= 1e-12 * (1.0 + h));
    }

    /// The first-order form is the published one with the rate of the reference for that of the error.
    #[test]
    fn the_first_order_form_has_the_rate_of_the_reference(
        p in -100.0_f64..100.0, z in -5.0..5.0, y_r_rate in -100.0_f64..100.0, lambda in 0.1..20.0
    ) {
        let published = law::damped(p, z, -y_r_rate, lambda);
        prop_assert_eq!(law::first_order_damped(p, z, y_r_rate, lambda), published);
    }
}
