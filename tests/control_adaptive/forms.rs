//! The two forms: an exact recursion, and what happens on the wrong plant.

use super::*;

/// The static plant `y = alpha·u - theta·x - D`, with u from the sample before.
struct Static {
    alpha: f64,
    theta: f64,
    u: f64,
}

impl Static {
    fn output(&self, x: f64, d: f64) -> f64 {
        self.alpha * self.u - self.theta * x - d
    }
}

/// Largest differences between the shipped law on a static plant and the recursion, with
/// s as it is, and with s formed after z has moved.
fn deviation(smooth_sign: SmoothSign) -> (f64, f64) {
    let law = law(lag(), |s| s.smooth_sign = smooth_sign);
    let (gain, lambda, epsilon) = (24.0, 8.0, 0.2);
    let recursion = LagRecursion {
        gain,
        lambda,
        epsilon,
        smooth_sign,
    };
    let mut random = Random(3);
    let mut plant = Static {
        alpha: 0.97,
        theta: 1.3,
        u: 0.0,
    };
    let mut state = AdaptiveState::new(&law);
    let (mut r, mut x, mut d) = (2.0, 0.1, 0.5);
    let mut expected: Option<(ErrorState<f64>, f64)> = None;
    let (mut right, mut wrong) = (0.0_f64, 0.0_f64);
    for _ in 0..3000 {
        // Any sequence of steps, not only a constant one.
        let h = random.within(2e-4, 1e-3);
        let [next_r, next_x, next_d] =
            [r, x, d].map(|value| value + 0.05 * random.within(-1.0, 1.0) - 0.01 * value);
        let input = AdaptiveInput {
            next_reference: next_r,
            ..AdaptiveInput::new(h, r, plant.output(x, d), [x])
        };
        let terms = law.step_with_terms(&mut state, &input).terms;
        plant.u = state.command();
        let (s, z) = (terms.s, terms.z);
        let late = terms.error + lambda * state.accumulated_error();
        if let Some((expected, expected_late)) = expected {
            right = right.max((s - expected.s).abs());
            right = right.max((z - expected.z).abs());
            wrong = wrong.max((late - expected_late).abs());
        }
        let g = plant.alpha * terms.beta_hat;
        let feed = r + (next_r - r) / (h * lambda);
        let by = Disturbance {
            g,
            delta_hat: terms.delta_hat,
            w: (g - 1.0) * feed + (g * terms.theta_hat[0] - plant.theta) * x - d,
            xi: (next_d - d) + plant.theta * (next_x - x),
        };
        let from_late = ErrorState {
            s: late,
            z: state.accumulated_error(),
        };
        let next_late = recursion.step(from_late, h, &by).s;
        expected = Some((recursion.step(ErrorState { s, z }, h, &by), next_late));
        (r, x, d) = (next_r, next_x, next_d);
    }
    (right, wrong)
}

#[test]
fn the_lag_form_on_a_static_plant_is_its_recursion_exactly() {
    for smooth_sign in [SmoothSign::Tanh, SmoothSign::Clamp] {
        let (right, wrong) = deviation(smooth_sign);
        // Roundings of values up to 10, a few a step: nothing accumulates.
        assert!(right < 1e-12, "{right}");
        // With z updated before s the recursion would not hold.
        assert!(wrong > 1e6 * right && wrong > 1e-4, "{wrong}");
    }
}

/// The last error at 1 kHz of a law whose estimates do not move, or do: what diverges is the form,
/// not the adaptation. On a static plant, or on one with inertia: a torsional resonance at 20 rad/s
/// behind one sample of delay.
fn last_error(is_static: bool, settings: Settings, samples: u32) -> f64 {
    let law = law(settings, |_| ());
    let mut state = AdaptiveState::new(&law);
    let (omega, damping, fine) = (20.0, 0.1, 20);
    let (mut y, mut rate, mut u, mut last) = (0.0_f64, 0.0_f64, 0.0, 0.0_f64);
    for step in 0..samples {
        let wanted = |step: u32| match is_static {
            true => 5.0 + 2.0 * (0.003 * f64::from(step)).sin(),
            false => 5.0,
        };
        let measured = if is_static { u - 0.3 } else { y };
        last = measured - wanted(step);
        let input = at(wanted(step), measured, 0.0);
        let input = with(input, |at| at.next_reference = wanted(step + 1));
        let next = law.step(&mut state, &input).command;
        for _ in 0..fine {
            let h = 0.001 / f64::from(fine);
            rate += h * (omega * omega * (u - y) - 2.0 * damping * omega * rate);
            y += h * rate;
        }
        u = next;
        if last.abs() >= 1e9 {
            break;
        }
    }
    last.abs()
}

fn known(settings: Settings) -> Settings {
    with(settings, |s| {
        (s.delta, s.frozen) = (Estimator::fixed(0.5).within(0.0, 7.0), true);
    })
}

#[test]
fn on_a_static_plant_the_lag_form_settles_and_the_literal_law_diverges() {
    for samples in [3000, 30_000] {
        // D is met by the integral; the reference's curvature leaves 1e-3 or so.
        assert!(last_error(true, known(lag()), samples) < 0.01);
    }
    // Nor does adaptation help.
    for settings in [known(literal()), literal()] {
        assert!(last_error(true, settings, 3000) > 1e9);
    }
}

#[test]
fn on_a_plant_with_inertia_the_literal_law_settles_and_the_lag_form_diverges() {
    for samples in [20_000, 60_000] {
        assert!(last_error(false, known(literal()), samples) < 0.01);
    }
    for settings in [known(lag()), lag()] {
        assert!(last_error(false, settings, 60_000) > 1e9);
    }
}

#[test]
fn the_literal_law_is_stable_on_a_static_plant_below_the_stated_gain_only() {
    // g·(k + 2/(lambda·h)) < 1 at an unfiltered difference: g < 1/(24 + 250).
    let of = |share: f64| {
        let settings = with(known(literal()), |s| {
            s.form = Form::AsPublished { time_constant: 0.0 };
            s.beta = Estimator::fixed(share / 274.0);
            s.delta = Estimator::fixed(0.0);
        });
        last_error(true, settings, 40_000)
    };
    assert!(of(0.95) < 10.0);
    assert!(of(1.05) > 1e9);
}
