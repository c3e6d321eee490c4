//! The hardening hysteresis against its equation, and within the bound of its stroke.

use crate::memory::stroke;
use crate::{along, make};
use proptest::prelude::*;

/// A step in x by equation: fourth-order Runge-Kutta in small parts.
fn hardened(w: f64, change: f64, [g, beta]: [f64; 2]) -> f64 {
    let h = change / 200.0;
    let slope = |w: f64| match w * change < 0.0 {
        true => 1.0 + (g + 2.0 * beta) * w.abs(),
        false => 1.0 + g * w.abs(),
    };
    (0..200).fold(w, |w, _| {
        let a = slope(w);
        let b = slope(w + 0.5 * h * a);
        let c = slope(w + 0.5 * h * b);
        let d = slope(w + h * c);
        w + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
    })
}

proptest! {
    #[test]
    fn hardening_follows_its_equation_and_stays_within_what_its_stroke_allows(
        path in prop::collection::vec(-1.0..1.0_f64, 2..60),
        g in 0.05..3.0_f64,
        beta in 0.01..5.0_f64,
    ) {
        let own = bowden::effect::Hardening::try_new(g, beta).unwrap();
        let values = along(&own.into(), &stroke(path.iter().copied(), 0.01));
        prop_assert_eq!(values[0], 0.0);
        let (mut low, mut high) = (path[0], path[0]);
        for k in 1..path.len() {
            low = low.min(path[k]);
            high = high.max(path[k]);
            let expected = hardened(values[k - 1], path[k] - path[k - 1], [g, beta]);
            // Two hundred steps of fourth order; the one that crosses zero has a corner.
            prop_assert!((values[k] - expected).abs() < 2e-3 * (1.0 + expected.abs()));
            let bound = (g * (high - low)).exp_m1() / g;
            // Rounding of sixty exponentials.
            prop_assert!(values[k].abs() <= bound * (1.0 + 1e-12), "{} of {}", values[k], bound);
        }
    }
}

#[test]
fn small_reversals_do_not_pump_a_hardening_state_up() {
    let effect = make::<f64>("hardening");
    let cycles = (0..20_000).map(|k| if k % 2 == 0 { 1.0 } else { 0.9 });
    let values = along(&effect, &stroke(std::iter::once(0.0).chain(cycles), 0.01));
    let most = values.iter().fold(0.0_f64, |most, w| most.max(w.abs()));
    // One stroke of 1 with g = 0.7.
    assert!(most <= (0.7_f64.exp_m1() / 0.7) * (1.0 + 1e-12), "{most}");
    assert!(values[20_000] < 0.9, "{}", values[20_000]); // it relaxes into a small loop
}
