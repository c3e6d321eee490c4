//! The state equation as it is printed, and along the path.

use super::*;
use bowden::hysteresis::law::{eta_rate, f};

proptest! {
    /// `eta' = d·rho·|x'|·f(d·eta)`: the path does not contain time.
    #[test]
    fn the_printed_equation_is_the_one_along_the_path(
        rho in 0.01..1.0, sigma in 0.5..100.0, n in 1.0..10.0,
        x_rate in -100.0..100.0, eta in -1.0..1.0
    ) {
        let printed: f64 = eta_rate(rho, sigma, n, x_rate, eta);
        let d = f64::signum(x_rate);
        let power = f64::powf(f64::abs(eta), n);
        let along = f(d * eta, 2.0 * sigma - 1.0, power);
        // Terms up to 2·sigma·rho·|x'| = 2e4 cancel, at a rounding of 1e-16 and the power's.
        prop_assert!((printed - d * rho * f64::abs(x_rate) * along).abs() < 1e-10);
        prop_assert!((0.0..=2.0 * sigma).contains(&along));
        let shape = shape(rho, sigma, n);
        let slope = shape.slope(eta, d);
        prop_assert!((slope - rho * along).abs() < 1e-12 * sigma);
        // Both are sums of terms as large as the steepest slope.
        let expected = d * right_side(&shape, eta, d);
        prop_assert!((slope - expected).abs() < 1e-13 * rho * 2.0 * sigma);
    }

    /// A small step is the equation, in both floats and for each method.
    #[test]
    fn a_short_step_follows_the_equation(
        rho in 0.1..1.0, sigma in 0.5..3.0, n in 1.0..6.0, eta in -0.9..0.9
    ) {
        let shape = BoucWen::try_new(rho, sigma, n).unwrap();
        for change in [-1e-6_f64, 1e-6] {
            let rate = eta_rate(rho, sigma, n, change, eta);
            for next in [shape.advance_bounded(eta, change), shape.advance_split(eta, change)] {
                // The error of 4e-7 of the short power, and the second order in the change:
                // |f'|·f·path/2, with |f'| <= 2·sigma·n and f <= 2·sigma.
                let path = rho * f64::abs(change);
                let tolerance = 2.0 * sigma * (1e-6 + sigma * n * path);
                prop_assert!((next - eta - rate).abs() <= path * tolerance);
            }
        }
    }
}
