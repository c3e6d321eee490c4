//! The late output of a delay, what a term adds, and the hardening hysteresis against its equation.

use super::*;

/// A tone behind the delay, once its start is forgotten: the largest difference to the tone
/// that is late by that time.
fn lateness(late: f64, dt: f64, w: f64) -> f64 {
    let (delay, mut state) = (make::<f64>("delay"), EffectState::default());
    let mut worst: f64 = 0.0;
    for k in 0..4000 {
        let t = dt * f64::from(k);
        let y = (w * t).sin();
        let z = y + delay.contribution(late, &mut state, &out(y, dt));
        if k > 2000 {
            worst = worst.max((z - (w * (t - late)).sin()).abs());
        }
    }
    worst
}

#[test]
fn a_delay_is_late_by_its_gain_and_takes_nothing_from_the_amplitude() {
    // Whole samples are exact. Rounding of the phase, 4000·1e-16, and of as many steps.
    assert!(lateness(0.01, 0.01, 130.0) < 1e-11);
    for (late, dt) in [
        (0.0115, 0.025),
        (0.004, 0.001),
        (0.0004, 0.001),
        (0.02, 0.001),
    ] {
        for w in [0.02, 0.1, 0.3] {
            let w = w / f64::max(late, dt);
            // The docs: a share of (w·max(T, dt))²/12 of the delay, hence of the phase; the
            // next term is of fourth order.
            let share = (w * f64::max(late, dt)).powi(2) / 12.0;
            let bound = 1.1 * share * w * late;
            let own = lateness(late, dt, w);
            assert!(own < bound, "T {late}, dt {dt}, w {w}: {own} of {bound}");
        }
    }
    // At a fifth of the sampling rate and half a sample: the all-pass errs by 0.067, a straight
    // line between two samples takes 0.19 from the amplitude.
    let (dt, w) = (0.025, 2.0 * std::f64::consts::PI / (5.0 * 0.025));
    assert!(lateness(0.46 * dt, dt, w) < 0.07);
}

#[test]
fn a_contribution_is_gain_times_regressor_but_for_a_late_output() {
    let path = stroke([0.3, -0.4, 1.1, 0.2, 0.9], 0.01);
    for name in crate::names() {
        let effect = make::<f64>(name);
        for gain in [-0.3, 0.0, 0.7] {
            let (mut a, mut b) = (EffectState::default(), EffectState::default());
            for (at, output) in path.iter().zip([1.0, -2.0, 0.5, 3.0, 2.0]) {
                let at = Inputs { output, ..*at };
                let linear = gain * effect.regressor(&mut a, &at);
                let own = effect.contribution(gain, &mut b, &at);
                assert!(own == linear || (name == "delay" && gain > 0.0), "{name}");
            }
        }
    }
}

#[test]
fn a_late_output_is_finite_and_a_bad_sample_moves_nothing() {
    let (delay, mut state) = (make::<f64>("delay"), EffectState::default());
    for (dt, output, gain) in [
        (0.01, f64::MAX, 1.0),
        (0.01, f64::MIN, 1.0),
        (f64::MAX, f64::MAX, f64::MAX),
        (f64::MIN_POSITIVE, f64::MIN, f64::MIN_POSITIVE),
        (f64::MIN_POSITIVE, 1.0, f64::MAX),
        (0.01, 1.0, 1e-300),
    ] {
        let own = delay.contribution(gain, &mut state, &out(output, dt));
        assert!(own.is_finite());
    }
    let before = state;
    let (nan, infinity) = (f64::NAN, f64::INFINITY);
    for (dt, output) in [(-0.1, 1.0), (nan, 1.0), (0.1, nan), (0.1, infinity)] {
        assert_eq!(delay.contribution(1.0, &mut state, &out(output, dt)), 0.0);
        assert_eq!(state, before);
    }
    // The same sample again: the same lateness, and the memory stays.
    let held = [(); 2].map(|()| delay.contribution(0.02, &mut state, &out(5.0, 0.0)));
    assert_eq!(held[0], held[1]);
    assert_eq!(state, before);
}

/// A step in x by equation: fourth-order Runge-Kutta in small parts.
fn hardened(w: f64, change: f64, [g, beta]: [f64; 2]) -> f64 {
    let h = change / 200.0;
    let slope = |w: f64| {
        let back = if w * change < 0.0 { 2.0 * beta } else { 0.0 };
        1.0 + (g + back) * w.abs()
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
