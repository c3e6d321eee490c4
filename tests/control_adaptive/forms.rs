//! The two forms: an exact recursion, and what happens on the wrong plant.

use super::{lag, literal, Random};
use bowden::control::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, Disturbance, ErrorState, Estimator,
    Form, LagRecursion, SmoothSign,
};

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
fn deviation(settings: AdaptiveSettings<f64, 1>, seed: u64) -> (f64, f64) {
    let law = Adaptive::try_new(settings).unwrap();
    let recursion = LagRecursion {
        gain: settings.gain,
        lambda: settings.lambda,
        epsilon: settings.epsilon,
        smooth_sign: settings.smooth_sign,
    };
    let mut random = Random(seed);
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
            [r, x, d].map(|value| value + 0.05 * random.next() - 0.01 * value);
        let y = plant.output(x, d);
        let input = AdaptiveInput {
            next_reference: next_r,
            ..AdaptiveInput::new(h, r, y, [x])
        };
        let terms = law.step_with_terms(&mut state, &input).terms;
        plant.u = state.command();
        let at = ErrorState {
            s: terms.s,
            z: terms.z,
        };
        let late = terms.error + settings.lambda * state.accumulated_error();
        if let Some((expected, expected_late)) = expected {
            right = right
                .max((at.s - expected.s).abs())
                .max((at.z - expected.z).abs());
            wrong = wrong.max((late - expected_late).abs());
        }
        let g = plant.alpha * terms.beta_hat;
        let feed = r + (next_r - r) / (h * settings.lambda);
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
        expected = Some((
            recursion.step(at, h, &by),
            recursion.step(from_late, h, &by).s,
        ));
        (r, x, d) = (next_r, next_x, next_d);
    }
    (right, wrong)
}

#[test]
fn the_lag_form_on_a_static_plant_is_its_recursion_exactly() {
    for smooth_sign in [SmoothSign::Tanh, SmoothSign::Clamp] {
        let (right, _) = deviation(
            AdaptiveSettings {
                smooth_sign,
                ..lag()
            },
            3,
        );
        // Roundings of values up to 10, a few a step: nothing accumulates.
        assert!(right < 1e-12, "{right}");
    }
}

#[test]
fn with_z_updated_before_s_the_recursion_would_not_hold() {
    let (right, wrong) = deviation(lag(), 3);
    assert!(wrong > 1e6 * right && wrong > 1e-4, "{wrong}");
}

/// The largest error of the last of `samples` samples at 1 kHz on a static plant.
fn on_a_static_plant(settings: AdaptiveSettings<f64, 1>, samples: u32) -> f64 {
    let law = Adaptive::try_new(settings).unwrap();
    let mut plant = Static {
        alpha: 1.0,
        theta: 0.0,
        u: 0.0,
    };
    let mut state = AdaptiveState::new(&law);
    let mut last = 0.0;
    for step in 0..samples {
        let at = |step: u32| 5.0 + 2.0 * (0.003 * f64::from(step)).sin();
        let y = plant.output(0.0, 0.3);
        last = y - at(step);
        let input = AdaptiveInput {
            next_reference: at(step + 1),
            ..AdaptiveInput::new(0.001, at(step), y, [0.0])
        };
        plant.u = law.step_with_terms(&mut state, &input).command;
        if last.abs() >= 1e9 {
            break;
        }
    }
    last.abs()
}

/// The same on a plant with inertia: a torsional resonance at 20 rad/s.
fn on_an_inertial_plant(settings: AdaptiveSettings<f64, 1>, samples: u32) -> f64 {
    let law = Adaptive::try_new(settings).unwrap();
    let mut state = AdaptiveState::new(&law);
    let (omega, damping, fine) = (20.0, 0.1, 20);
    let (mut y, mut rate, mut u, mut last) = (0.0_f64, 0.0_f64, 0.0, 0.0);
    for _ in 0..samples {
        last = y - 5.0;
        let input = AdaptiveInput::new(0.001, 5.0, y, [0.0]);
        let next = law.step_with_terms(&mut state, &input).command;
        for _ in 0..fine {
            let h = 0.001 / f64::from(fine);
            rate += h * (omega * omega * (u - y) - 2.0 * damping * omega * rate);
            y += h * rate;
        }
        u = next; // one sample of delay
        if last.abs() >= 1e9 {
            break;
        }
    }
    last.abs()
}

/// Estimates that do not move: what diverges is the form, not the adaptation.
fn known(settings: AdaptiveSettings<f64, 1>) -> AdaptiveSettings<f64, 1> {
    AdaptiveSettings {
        delta: Estimator::fixed(0.5).within(0.0, 7.0),
        frozen: true,
        ..settings
    }
}

#[test]
fn on_a_static_plant_the_lag_form_settles_and_the_literal_law_diverges() {
    for samples in [3000, 30_000] {
        // D is met by the integral; the reference's curvature leaves 1e-3 or so.
        assert!(on_a_static_plant(known(lag()), samples) < 0.01);
    }
    assert!(on_a_static_plant(known(literal()), 3000) > 1e9);
    assert!(
        on_a_static_plant(literal(), 3000) > 1e9,
        "nor does adaptation help"
    );
}

#[test]
fn on_a_plant_with_inertia_the_literal_law_settles_and_the_lag_form_diverges() {
    for samples in [20_000, 60_000] {
        assert!(on_an_inertial_plant(known(literal()), samples) < 0.01);
    }
    assert!(on_an_inertial_plant(known(lag()), 60_000) > 1e9);
    assert!(
        on_an_inertial_plant(lag(), 60_000) > 1e9,
        "nor does adaptation help"
    );
}

#[test]
fn the_literal_law_is_stable_on_a_static_plant_below_the_stated_gain_only() {
    // g·(k + 2/(lambda·h)) < 1 at an unfiltered difference: g < 1/(24 + 250).
    let limit = 1.0 / 274.0;
    let at = |g: f64| {
        let settings = AdaptiveSettings {
            form: Form::AsPublished { time_constant: 0.0 },
            beta: Estimator::fixed(g),
            delta: Estimator::fixed(0.0),
            ..known(literal())
        };
        on_a_static_plant(settings, 40_000)
    };
    assert!(at(0.95 * limit) < 10.0);
    assert!(at(1.05 * limit) > 1e9);
}
