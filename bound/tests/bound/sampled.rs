//! The box theorem against adversaries.

use super::*;

fn law(gain: f64, lambda: f64, share: f64, smooth_sign: SmoothSign) -> Adaptive<f64, 1> {
    let beta = Estimator::fixed(1.0).within(1.0 - share, 1.0 + share);
    let settings = AdaptiveSettings {
        smooth_sign,
        beta: beta.adapting(0.01, 0.01),
        delta: Estimator::fixed(1.0).within(0.0, 7.056).adapting(0.5, 0.01),
        theta: [Estimator::fixed(0.0).within(-1.0, 1.0).adapting(0.1, 0.01)],
        ..AdaptiveSettings::unlimited(first_order(1e-9, 1.0), gain, lambda, 0.2)
    };
    // The longest step that is admissible: the condition is met with equality.
    let step = settings.largest_step().unwrap();
    Adaptive::try_new(with(settings, |s| s.form = first_order(step, 1.0))).unwrap()
}

fn plant() -> Plant<f64, 1> {
    Plant {
        delta_rate: 30.0,
        regressors: [known(between(0.2, 0.6), 2.0, 4.0)],
        reference: 38.0,
        reference_rate: 22.2,
        ..Plant::new(1.0, 7.056)
    }
}

/// The box of a law, its recursion, and its longest step.
fn boxed(law: &Adaptive<f64, 1>) -> (PeakSampled<f64>, LagRecursion<f64>, f64) {
    let s = law.settings();
    let recursion = LagRecursion {
        gain: s.gain,
        lambda: s.lambda,
        epsilon: s.epsilon,
        smooth_sign: s.smooth_sign,
    };
    let peak = PeakSampled::try_new(law, &plant()).unwrap();
    (peak, recursion, s.largest_step().unwrap())
}

/// The largest `|s|/S` and `|z|·lambda/S` that a random adversary reaches in the box.
fn attack(law: &Adaptive<f64, 1>, seed: u64) -> (f64, f64) {
    let settings = law.settings();
    let (peak, recursion, h) = boxed(law);
    let mut random = Random(seed);
    let mut at = ErrorState { s: 0.0, z: 0.0 };
    let (mut s, mut z) = (0.0_f64, 0.0_f64);
    for _ in 0..100 {
        // For a while it pushes one way with all it has, or draws everything anew.
        let (side, blind) = (random.sign(), random.within(0.0, 1.0) < 0.3);
        let while_ = (random.within(0.0, 5.0) / (h * settings.lambda)) as u32;
        for _ in 0..while_ {
            let mut by = Disturbance {
                g: peak.g.low,
                delta_hat: 0.0,
                w: side * peak.w,
                xi: -side * h * peak.xi,
            };
            if blind {
                by.g = random.within(peak.g.low, peak.g.high);
                by.delta_hat = random.within(0.0, settings.delta.high);
                by.w *= random.within(-1.0, 1.0);
                by.xi *= random.within(-1.0, 1.0);
            }
            at = recursion.step(at, h, &by);
            s = s.max(at.s.abs() / peak.s);
            z = z.max(at.z.abs() * settings.lambda / peak.s);
        }
    }
    (s, z)
}

#[test]
fn a_random_adversary_reaches_99_percent_of_the_box_and_never_leaves_it() {
    let mut random = Random(11);
    for system in 0..60 {
        // lambda²·k of 150 or more: at the corner s falls short by at most 1/(lambda²·k).
        let (gain, lambda) = (random.within(6.0, 30.0), random.within(5.0, 10.0));
        let sign = [SmoothSign::Tanh, SmoothSign::Clamp][system % 2];
        let law = law(gain, lambda, random.within(0.01, 0.4), sign);
        let (s, z) = attack(&law, 100 + system as u64);
        // Rounding of S itself.
        assert!(s <= 1.0 + 1e-12 && z <= 1.0 + 1e-12, "{system}: {s} {z}");
        assert!(s >= 0.99 && z >= 0.99, "{system}: {s} {z}");
    }
}

#[test]
fn from_outside_the_errors_come_into_the_box() {
    let law = law(24.0, 8.0, 0.1, SmoothSign::Tanh);
    let (peak, recursion, h) = boxed(&law);
    let by = Disturbance {
        g: peak.g.low,
        delta_hat: 0.0,
        w: peak.w,
        xi: -h * peak.xi,
    };
    let (s, z) = (300.0, -200.0);
    let mut at = ErrorState { s, z };
    for _ in 0..(5.0 / h) as u32 {
        at = recursion.step(at, h, &by);
    }
    // e^(-5·lambda) is 4e-18.
    assert!(at.s.abs() <= peak.s * (1.0 + 1e-12), "{at:?} {}", peak.s);
    assert!(at.z.abs() * 8.0 <= peak.s * (1.0 + 1e-12));
}

#[test]
fn beyond_the_admissible_step_the_box_is_left() {
    let (peak, recursion, h) = boxed(&law(24.0, 8.0, 0.1, SmoothSign::Clamp));
    let by = Disturbance {
        g: peak.g.high,
        delta_hat: 7.0,
        w: peak.w,
        xi: 0.0,
    };
    let mut at = ErrorState { s: 0.0, z: 0.0 };
    for _ in 0..100 {
        // Twenty times: h·lambda·g·k alone is eight, where two is the limit of any loop.
        at = recursion.step(at, 20.0 * h, &by);
    }
    assert!(at.s.abs() > 1e3 * peak.s);
}

#[test]
fn the_shipped_step_never_leaves_the_box_on_a_static_plant() {
    let mut random = Random(3);
    let mut reached = 0.0_f64;
    for system in 0..40 {
        let sign = [SmoothSign::Tanh, SmoothSign::Clamp][system % 2];
        let (gain, lambda) = (random.within(6.0, 30.0), random.within(5.0, 10.0));
        let law = law(gain, lambda, 0.2, sign);
        let (peak, _, h) = boxed(&law);
        let theta = random.within(0.2, 0.6);
        let (mut x, mut d) = (0.0, random.within(-7.0, 7.0));
        // The reference starts where the plant is at rest: e = 0.
        let (mut r, mut u) = (-d, 0.0);
        let mut state = AdaptiveState::new(&law);
        let mut side = 1.0;
        for _ in 0..20_000 {
            if random.within(0.0, 1.0) < 0.004 {
                side = random.sign();
            }
            let toward =
                |value: f64, most: f64, rate: f64| (value + side * h * rate).clamp(-most, most);
            let next = [
                toward(r, 38.0, 22.2),
                toward(x, 2.0, 4.0),
                toward(d, 7.056, 30.0),
            ];
            let y = u - theta * x - d;
            let input = AdaptiveInput::new(h, r, y, [x]);
            let input = with(input, |at| at.next_reference = next[0]);
            let output = law.step_with_terms(&mut state, &input);
            u = output.command;
            let terms = output.terms;
            assert!(terms.s.abs() <= peak.s && terms.z.abs() * lambda <= peak.s);
            assert!(terms.error.abs() <= peak.bound && u.abs() <= peak.command);
            reached = reached.max(terms.s.abs() / peak.s);
            [r, x, d] = next;
        }
    }
    // What this simpler adversary reaches shows that the assertion is not idle.
    assert!(reached > 0.25, "{reached}");
}

/// From z = 0, on a static plant with signals at the ends of what is stated.
#[test]
fn the_mean_square_of_the_error_stays_within_the_sampled_certificate() {
    let mut random = Random(23);
    let mut reached = 0.0_f64;
    for system in 0..40 {
        let sign = [SmoothSign::Tanh, SmoothSign::Clamp][system % 2];
        let (gain, lambda) = (random.within(6.0, 30.0), random.within(3.0, 10.0));
        let law = law(gain, lambda, 0.1, sign);
        let known = with(plant(), |p| (p.delta_rate, p.reference_rate) = (3.0, 0.0));
        let certificate = RmsSampled::try_new(&law, &known).unwrap();
        let h = law.settings().largest_step().unwrap();
        let (theta, mut d, mut sum) = (0.4, 7.0, 0.0);
        let (r, x) = (-38.0, 0.0);
        let input = |y| AdaptiveInput::new(h, r, y, [x]);
        let mut state = AdaptiveState::resume_from(&law, r + theta * x + d, &input(r));
        let steps = 20_000;
        for n in 0..steps {
            let y = state.command() - theta * x - d;
            let output = law.step_with_terms(&mut state, &input(y));
            sum += output.terms.error.powi(2);
            // One way, then the other: each takes as long as D needs at its rate.
            let period = 4.0 * 7.0 / 3.0;
            let phase = (f64::from(n) * h / period).fract();
            d += if phase < 0.5 { -3.0 * h } else { 3.0 * h };
            d = d.clamp(-7.056, 7.056);
        }
        let rms = (sum / f64::from(steps)).sqrt();
        let promised = certificate.over(f64::from(steps) * h, 0.0);
        assert!(rms <= promised, "{system}: {rms} {promised}");
        assert!(certificate.bound <= promised);
        reached = reached.max(rms / certificate.bound);
    }
    println!("reached {reached} of the bound over a long time");
    assert!(reached > 0.02, "{reached}");
}

#[test]
fn a_short_time_begins_with_the_whole_lyapunov_function() {
    // A leakage beyond 1/h, which V weighs by 1 + h·sigma = 5.
    let (k, lambda, h, gain, sigma) = (24.0, 8.0, 0.001, 0.5, 4000.0);
    let form = Form::FirstOrder {
        step: h,
        plant_gain: 1.0,
    };
    let delta = Estimator::fixed(0.0)
        .within(0.0, 7.056)
        .adapting(gain, sigma);
    let law = Adaptive::try_new(AdaptiveSettings {
        beta: Estimator::fixed(1.0),
        delta,
        ..AdaptiveSettings::<f64, 0>::unlimited(form, k, lambda, 0.2)
    })
    .unwrap();
    let found = RmsSampled::try_new(&law, &Plant::new(1.0, 7.056)).unwrap();
    // In the limit, rms(s)² = V(0)/(k·lambda·T), with delta_hat at zero and its aim elsewhere.
    let v = (1.0 + h * sigma) * found.target.powi(2) / (2.0 * gain);
    assert!(v > 0.0, "the aim is {}", found.target);
    let duration = 1e-12;
    let s = (v / (k * lambda * duration)).sqrt();
    assert!(found.over(duration, 0.0) >= s);
}
