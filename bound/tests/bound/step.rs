//! Theorem 1 in sampled time: V from step to step, on 1500 random systems.

use super::*;

/// A law with boxes that hold a random plant's truth, at a random admissible step.
struct System {
    law: Adaptive<f64, 1>,
    known: Plant<f64, 1>,
    alpha: f64,
    theta: f64,
    h: f64,
}

impl System {
    fn draw(random: &mut Random, boxed: bool) -> Self {
        let alpha = random.within(0.4, 2.0);
        let theta = random.within(-2.0, 2.0);
        let delta = random.within(0.1, 8.0);
        // Far boxes never clamp; near ones do, and one may end below Delta.
        let (reach, most, side) = match boxed {
            true => (0.05, delta * random.within(0.6, 1.2), 0.05),
            false => (0.5, 40.0, 10.0),
        };
        let mut estimator = |low: f64, high: f64, gain: f64| Estimator {
            prior: random.within(low, high),
            ..Estimator::fixed(random.within(low, high))
                .within(low, high)
                .adapting(random.within(0.1, 1.0) * gain, random.within(0.001, 2.0))
        };
        let beta = estimator((1.0 - reach) / alpha, (1.0 + reach) / alpha, 1e-3);
        let estimators = (
            beta,
            estimator(0.0, most, 0.05),
            estimator(theta - side, theta + side, 0.01),
        );
        let (gain, lambda) = (random.within(1.5, 30.0), random.within(2.0, 10.0));
        let form = first_order(1.0, alpha);
        let settings = AdaptiveSettings::unlimited(form, gain, lambda, random.within(0.05, 1.0));
        let settings = with(settings, |s| {
            s.smooth_sign = random.smooth_sign();
            (s.beta, s.delta, s.theta) = (estimators.0, estimators.1, [estimators.2]);
        });
        let h = settings.largest_step().unwrap() * random.within(0.1, 1.0);
        let known = Plant {
            delta_rate: 30.0,
            regressors: [known(Interval::exactly(theta), 2.0, 20.0)],
            reference: 20.0,
            reference_rate: 40.0,
            ..Plant::new(alpha, delta)
        };
        let law = with(settings, |s| s.form = first_order(h, alpha));
        Self {
            law: Adaptive::try_new(law).unwrap(),
            known,
            alpha,
            theta,
            h,
        }
    }

    /// `c·(1 + h·sigma)/(2·m)` of an estimator.
    fn weight(&self, estimator: &Estimator<f64>, c: f64) -> f64 {
        c * (1.0 + self.h * estimator.leakage.rate()) / (2.0 * estimator.gain)
    }

    /// V as the certificate's documentation has it.
    fn v(&self, target: f64, s: f64, z: f64, [beta, delta, theta]: [f64; 3]) -> f64 {
        let settings = self.law.settings();
        let square = |x: f64| x * x;
        0.5 * (s * s + z * z)
            + self.weight(&settings.beta, self.alpha) * square(1.0 / self.alpha - beta)
            + self.weight(&settings.delta, 1.0) * square(target - delta)
            + self.weight(&settings.theta[0], 1.0) * square(self.theta - theta)
    }
}

/// What the plant does between two samples.
struct Push {
    d: f64,
    xi: f64,
    x: f64,
}

/// Walks a system and hands each step to `check`: terms, push, next s and z, estimates.
fn walk(
    system: &System,
    random: &mut Random,
    samples: u32,
    mut check: impl FnMut(&AdaptiveTerms<f64, 1>, &Push, [f64; 2], [f64; 3]),
) {
    let (law, h, known) = (&system.law, system.h, &system.known);
    let mut state = AdaptiveState::new(law);
    let (mut x, mut d, mut u) = (0.0, random.within(-1.0, 1.0) * known.delta, 0.0);
    let mut r = -d; // the error starts at zero
    let mut last: Option<(AdaptiveTerms<f64, 1>, Push, [f64; 3])> = None;
    for _ in 0..samples {
        let mut toward = |value: f64, most: f64, rate: f64| {
            (value + random.within(-1.0, 1.0).signum() * h * rate).clamp(-most, most)
        };
        let next = [
            toward(r, 20.0, 40.0),
            toward(x, 2.0, 20.0),
            toward(d, known.delta, 30.0),
        ];
        let y = system.alpha * u - system.theta * x - d;
        let input = AdaptiveInput::new(h, r, y, [x]);
        let input = with(input, |at| at.next_reference = next[0]);
        let output = law.step_with_terms(&mut state, &input);
        if let Some((terms, push, after)) = last {
            check(&terms, &push, [output.terms.s, output.terms.z], after);
        }
        u = output.command;
        let xi = (next[2] - d) + system.theta * (next[1] - x);
        let after = [state.beta_hat(), state.delta_hat(), state.theta_hat()[0]];
        last = Some((output.terms, Push { d, xi, x }, after));
        [r, x, d] = next;
    }
}

#[test]
fn v_falls_as_certified_on_1500_random_systems() {
    let mut random = Random(17);
    let mut steps = 0;
    for number in 0..1500 {
        let system = System::draw(&mut random, number % 2 == 0);
        let certified = PerStep::try_new(&system.law, &system.known).unwrap();
        let h = system.h;
        walk(&system, &mut random, 200, |terms, _, [s, z], after| {
            let before = [terms.beta_hat, terms.delta_hat, terms.theta_hat[0]];
            let v = system.v(certified.target, terms.s, terms.z, before);
            let next = system.v(certified.target, s, z, after);
            let promised = (1.0 - h * certified.rate) * v + h * certified.input;
            assert!(next <= promised + 1e-9, "{number}: {next} {promised}");
            steps += 1;
        });
    }
    assert_eq!(steps, 1500 * 199);
}

#[test]
fn without_clamping_v_changes_exactly_as_theorem_1s_algebra_says() {
    let mut random = Random(23);
    let mut compared = 0;
    for _ in 0..1500 {
        let system = System::draw(&mut random, false);
        let settings = *system.law.settings();
        let (h, k, lambda, target) = (system.h, settings.gain, settings.lambda, system.known.delta);
        walk(&system, &mut random, 100, |terms, push, [s, z], after| {
            let is_inside = |own: Estimator<f64>, p: f64| own.low < p && p < own.high;
            if !is_inside(settings.beta, after[0]) || !is_inside(settings.delta, after[1]) {
                return;
            }
            let before = [terms.beta_hat, terms.delta_hat, terms.theta_hat[0]];
            let v = system.v(target, terms.s, terms.z, before);
            // (28)-(30) without the inequality: the cross terms have cancelled.
            let mut change = -k * lambda * terms.s * terms.s
                - lambda * terms.z * terms.z
                - lambda * terms.s * (push.d + target * terms.smooth_sign)
                - terms.s * push.xi / h;
            let squares = ((s - terms.s) / h).powi(2) + ((z - terms.z) / h).powi(2);
            let mut second_order = 0.5 * h * squares;
            let drives = [-terms.virtual_command, terms.smooth_sign, -push.x];
            let truths = [1.0 / system.alpha, target, system.theta];
            let estimators = [settings.beta, settings.delta, settings.theta[0]];
            for (i, estimator) in estimators.iter().enumerate() {
                let c = if i == 0 { system.alpha } else { 1.0 };
                let (m, sigma) = (estimator.gain, estimator.leakage.rate());
                let drive = lambda * terms.s * drives[i];
                let truth = truths[i] - estimator.prior;
                let tilde = truths[i] - before[i] - h * m * drive;
                // Convexity of the implicit leakage, written out.
                change += c * sigma * truth * truth / (2.0 * m);
                change -= c * sigma * (tilde - truth).powi(2) / (2.0 * m * (1.0 + h * sigma));
                second_order += 0.5 * h * c * m * drive * drive;
                // V's own factor 1 + h·sigma of the step before.
                change -= c * sigma * (truths[i] - before[i]).powi(2) / (2.0 * m);
            }
            let expected = v + h * (change + second_order);
            let next = system.v(target, s, z, after);
            // Roundings of a V that estimates far from the truth make large.
            near(next, expected, 1e-9 * (1.0 + 1e-3 * v));
            compared += 1;
        });
    }
    assert!(compared > 50_000, "{compared}");
}
