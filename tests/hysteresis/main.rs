//! The hysteresis against its equation, its closed forms and its promises.

// Clippy's allowance covers the test functions, not what they share.
#![allow(clippy::unwrap_used)]

mod bounded;
mod law;
mod sampled;
#[path = "../shared/mod.rs"]
mod shared;

use bowden::hysteresis::{BoucWen, BoucWenState, Sensitivity};
use bowden::{Error, Real};
use proptest::prelude::*;
use shared::*;
use std::f64::consts::{PI, TAU};

/// The two sets that the paper identified: rho, sigma, n, kappa_eta [N·m].
const SETS: [(f64, f64, f64, f64); 2] = [
    (0.095_82, 98.36, 3.871, 7.004),
    (0.093_53, 62.49, 3.255, 7.231),
];

fn shape(rho: f64, sigma: f64, n: f64) -> BoucWen<f64> {
    BoucWen::try_new(rho, sigma, n).unwrap()
}

fn single(rho: f64, sigma: f64, n: f64) -> BoucWen<f32> {
    BoucWen::try_new(rho as f32, sigma as f32, n as f32).unwrap()
}

/// The same in double precision, with the parameters as single precision has them.
fn widened(single: &BoucWen<f32>) -> BoucWen<f64> {
    let [rho, sigma, n] = [single.rho(), single.sigma(), single.n()].map(f64::from);
    shape(rho, sigma, n)
}

/// The two inputs of the paper [N·m] at a time [s].
fn sine(t: f64) -> f64 {
    16.0 * (PI * t).sin()
}

fn walk(t: f64) -> f64 {
    25.0 + 10.0 * (2.0 * PI * 0.25 * t).sin() + 3.0 * (2.0 * PI * 0.2 * 3_f64.sqrt() * t).sin()
}

/// The right side of (7) over tau', written as the paper writes it.
fn right_side(shape: &BoucWen<f64>, eta: f64, direction: f64) -> f64 {
    let (rho, sigma, n) = (shape.rho(), shape.sigma(), shape.n());
    let size = eta.abs();
    rho * (direction - sigma * size.powf(n - 1.0) * eta + (sigma - 1.0) * direction * size.powf(n))
}

/// One increment by `parts` classical Runge-Kutta steps of (7).
fn runge_kutta(shape: &BoucWen<f64>, mut eta: f64, change: f64, parts: usize) -> f64 {
    let direction = change.signum();
    let h = change.abs() / parts as f64;
    for _ in 0..parts {
        let k1 = right_side(shape, eta, direction);
        let k2 = right_side(shape, eta + 0.5 * h * k1, direction);
        let k3 = right_side(shape, eta + 0.5 * h * k2, direction);
        let k4 = right_side(shape, eta + h * k3, direction);
        eta += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
    }
    eta
}

/// Largest error of a step in kappa_eta·eta [N·m] over 8 s at 1 kHz.
fn record_error(
    set: (f64, f64, f64, f64),
    input: fn(f64) -> f64,
    step: impl Fn(&BoucWen<f64>, f64, f64) -> f64,
) -> f64 {
    let shape = shape(set.0, set.1, set.2);
    let (mut eta, mut reference, mut last, mut most) = (0.0, 0.0, input(0.0), 0.0_f64);
    for k in 1..8000 {
        let now = input(f64::from(k) * 1e-3);
        eta = step(&shape, eta, now - last);
        // 64 parts leave the reference 1e-12 off: RK4 alone is 3e-8 off with one.
        reference = runge_kutta(&shape, reference, now - last, 64);
        most = most.max((eta - reference).abs() * set.3);
        last = now;
    }
    most
}

type Step = fn(&BoucWen<f64>, f64, f64) -> f64;

/// The step that splits, and the one in bounded time.
const STEPS: [Step; 2] = [
    |shape, eta, dx| shape.advance(eta, dx),
    |shape, eta, dx| shape.advance_bounded(eta, dx),
];

#[test]
fn both_steps_follow_the_papers_records_within_their_documented_errors() {
    // Measured 1.01e-5, 7.7e-7, 3.7e-6, 2.7e-7 N·m and 2.42e-4, 4.2e-5, 1.14e-4, 1.9e-5 N·m; the
    // bounds leave 20 %.
    let split = [[1.2e-5, 9.5e-7], [4.5e-6, 3.2e-7]];
    let bounded = [[2.9e-4, 5.1e-5], [1.4e-4, 2.3e-5]];
    for (step, bounds) in STEPS.into_iter().zip([split, bounded]) {
        for (set, bounds) in SETS.into_iter().zip(bounds) {
            for (input, bound) in [sine as fn(f64) -> f64, walk].into_iter().zip(bounds) {
                let error = record_error(set, input, step);
                assert!(error < bound, "error {error:.2e} N·m");
            }
        }
    }
}

#[test]
fn single_precision_stays_within_a_thousandth_of_a_newton_metre() {
    for ((rho, sigma, n, kappa_eta), input) in SETS
        .into_iter()
        .flat_map(|set| [sine as fn(f64) -> f64, walk].map(|input| (set, input)))
    {
        let (exact, single) = (shape(rho, sigma, n), single(rho, sigma, n));
        let (mut state, mut reference, mut last) = (BoucWenState::new(), 0.0, input(0.0));
        single.step(&mut state, last as f32);
        for k in 1..8000 {
            let now = input(f64::from(k) * 1e-3);
            let eta = single.step(&mut state, now as f32);
            reference = runge_kutta(&exact, reference, now - last, 64);
            // The promise of the crate; measured 3.4e-4, from rounding the input.
            near(f64::from(eta), reference, 1e-3 / kappa_eta);
            last = now;
        }
    }
}

#[test]
fn any_jump_is_accurate_whatever_the_shape() {
    let mut random = Random(7);
    for n in [1.05, 1.5, 2.5, 3.871, 10.0] {
        for sigma in [0.5, 1.0, 98.36] {
            let shape = shape(0.095_82, sigma, n);
            let (mut eta, mut last) = (0.0, 0.0);
            for _ in 0..40 {
                let now = 32.0 * random.next() - 16.0;
                // 20 000 parts: the fastest rate, 2·sigma·n·rho, times a part is 0.1 at most.
                let reference = runge_kutta(&shape, eta, now - last, 20_000);
                eta = shape.advance(eta, now - last);
                // Measured 8e-4 (6e-3 N·m) at most over 35 000 jumps.
                near(eta, reference, 1e-3);
                last = now;
            }
        }
    }
}

/// Loading and unloading for n = 1, integrated by hand from (7).
fn exact_linear(zeta: f64, p: f64, c: f64) -> f64 {
    if zeta >= 0.0 {
        return 1.0 - (1.0 - zeta) * (-p).exp();
    }
    let crossing = (1.0 - c * zeta).ln() / c;
    if p <= crossing {
        (1.0 - (1.0 - c * zeta) * (-c * p).exp()) / c
    } else {
        1.0 - (crossing - p).exp()
    }
}

/// Loading and unloading for n = 2.
fn exact_quadratic(zeta: f64, p: f64, c: f64) -> f64 {
    if zeta >= 0.0 {
        return (p + zeta.atanh()).tanh();
    }
    let r = c.sqrt();
    let crossing = (-r * zeta).atan() / r;
    if p <= crossing {
        (r * p + (r * zeta).atan()).tan() / r
    } else {
        (p - crossing).tanh()
    }
}

#[test]
fn closed_forms_are_exact_for_n_one_and_two() {
    let mut random = Random(3);
    for _ in 0..2000 {
        let (zeta, p) = (1.98 * random.next() - 0.99, 3.0 * random.next());
        let sigma = 0.51 + 20.0 * random.next();
        let c = 2.0 * sigma - 1.0;
        for direction in [1.0, -1.0] {
            // 1e-12: a few roundings, magnified by 1/c at most 50 times.
            let got = shape(1.0, sigma, 1.0).advance(direction * zeta, direction * p);
            near(got, direction * exact_linear(zeta, p, c), 1e-12);
            let got = shape(1.0, sigma, 2.0).advance(direction * zeta, direction * p);
            near(got, direction * exact_quadratic(zeta, p, c), 1e-12);
        }
    }
}

#[test]
fn unloading_is_a_straight_line_at_sigma_one_half() {
    for n in [1.0, 1.7, 2.0, 3.871, 12.0] {
        let shape = shape(0.5, 0.5, n);
        let mut eta = -0.9;
        for k in 1..=80 {
            eta = shape.advance(eta, 0.02);
            // 80 roundings of 1e-16.
            near(eta, -0.9 + 0.01 * f64::from(k), 1e-13);
        }
        // In one go, and through zero by a path whose loading part is only 1e-6 long.
        near(shape.advance(-0.9, 1.2), -0.3, 1e-15);
        let beyond = shape.advance(-0.9, 1.8 + 2e-6);
        // zeta^(n+1)/(n+1) of 1e-6 is below 1e-12.
        near(beyond, 1e-6, 1e-12);
    }
}

#[test]
fn the_general_step_agrees_with_the_closed_forms_next_to_them() {
    let mut random = Random(11);
    for exponent in [1.0, 2.0] {
        let (closed, general) = (shape(1.0, 3.0, exponent), shape(1.0, 3.0, exponent + 1e-9));
        for _ in 0..500 {
            let (eta, dx) = (2.0 * random.next() - 1.0, 4.0 * random.next() - 2.0);
            // The error that any jump may have, and 1e-9 of the exponent.
            near(closed.advance(eta, dx), general.advance(eta, dx), 1e-3);
        }
    }
}

/// Compares the sensitivities of the step that `T` takes, this one in `f64`, with its differences.
fn assert_sensitivities<T: Real>(sets: &[(f64, f64, f64)], seed: u64, step: Step, tolerance: f64) {
    let mut random = Random(seed);
    let end = |rho: f64, sigma: f64, n: f64, eta0: f64, changes: &[T]| {
        let shape = shape(rho, sigma, n);
        let advance = |eta, dx: &T| step(&shape, eta, dx.as_f64());
        changes.iter().fold(eta0, advance)
    };
    for &(rho, sigma, n) in sets {
        for largest in [0.01, 0.3, 12.0] {
            let mut draw = |_| T::from_f64(largest * (2.0 * random.next() - 1.0));
            let changes: Vec<T> = (0..25).map(&mut draw).collect();
            let eta0 = random.next() - 0.5;
            let [own_rho, own_sigma, own_n, start] = [rho, sigma, n, eta0].map(T::from_f64);
            let shape = BoucWen::try_new(own_rho, own_sigma, own_n).unwrap();
            let next = |s, &dx: &T| shape.advance_with_sensitivity(s, dx);
            let got = changes.iter().fold(Sensitivity::start(start), next);
            let state = changes
                .iter()
                .fold(start, |eta, &dx| shape.advance(eta, dx));
            assert_eq!(got.eta, state, "the same state, bit for bit");
            let by = |h: f64, at: &dyn Fn(f64) -> f64| (at(h) - at(-h)) / (2.0 * h);
            let by_rho = by(1e-6 * rho, &|h| end(rho + h, sigma, n, eta0, &changes));
            let by_sigma = by(1e-6 * sigma, &|h| end(rho, sigma + h, n, eta0, &changes));
            let by_n = by(1e-6 * n, &|h| end(rho, sigma, n + h, eta0, &changes));
            let by_eta0 = by(1e-6, &|h| end(rho, sigma, n, eta0 + h, &changes));
            for (name, exact, difference, scale) in [
                ("rho", got.d_rho, by_rho, rho),
                ("sigma", got.d_sigma, by_sigma, sigma),
                ("n", got.d_n, by_n, n),
                ("eta0", got.d_eta0, by_eta0, 1.0),
            ] {
                let error = (exact.as_f64() - difference).abs() * scale;
                assert!(
                    error < tolerance * (1.0 + difference.abs() * scale),
                    "{name}: {exact} {difference}, largest {largest}"
                );
            }
        }
    }
}

#[test]
fn sensitivities_are_the_derivatives_of_the_step_taken() {
    let sets = [
        (0.1, 0.7, 1.6),
        (0.095_82, 98.36, 3.871),
        (0.3, 5.0, 2.4),
        (0.1, 0.55, 8.0),
    ];
    // Central differences over 1e-6 lose 1e-16/1e-6 to rounding and 1e-12 to curvature.
    assert_sensitivities::<f64>(&sets, 17, STEPS[0], 1e-8);
    // 25 steps of f32, of which each multiplies by factors that round to 1e-7, and starts elsewhere
    // than f64 does by as much.
    let sets = [(0.1, 0.7, 1.6), (0.1, 20.0, 3.9), (0.3, 0.6, 2.4)];
    assert_sensitivities::<f32>(&sets, 29, STEPS[1], 1e-4);
}

#[test]
fn a_saturating_jump_forgets_where_it_started() {
    let end = shape(1.0, 2.0, 3.0).advance_with_sensitivity(Sensitivity::start(0.3), 1e3);
    let all = [end.eta, end.d_rho, end.d_sigma, end.d_n, end.d_eta0];
    assert_eq!(all, [1.0, 0.0, 0.0, 0.0, 0.0]);
}

#[test]
fn a_bad_sample_leaves_the_state_untouched() {
    let shape = single(0.1, 98.0, 3.9);
    let mut state = BoucWenState::new();
    shape.step(&mut state, 1.0);
    shape.step(&mut state, 4.0);
    let before = state;
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(shape.step(&mut state, bad), before.eta());
        assert_eq!(state, before);
        assert_eq!(shape.advance(0.25, bad), 0.25);
        let start = Sensitivity::start(0.25);
        assert_eq!(shape.advance_with_sensitivity(start, bad), start);
    }
}

#[test]
fn the_first_sample_only_says_where_the_input_is_and_the_longest_swing_saturates() {
    let mut state = BoucWenState::with_eta(0.4).unwrap();
    assert_eq!(shape(0.1, 1.0, 2.0).step(&mut state, 1e6), 0.4);
    assert_eq!(state.input(), Some(1e6));
    let (mut state, shape) = (BoucWenState::new(), single(0.1, 98.0, 3.9));
    for (input, eta) in [(f32::MAX, 0.0), (f32::MIN, -1.0), (f32::MAX, 1.0)] {
        assert_eq!(shape.step(&mut state, input), eta);
    }
}

#[test]
fn refusals_carry_the_parameters_name() {
    for (rho, sigma, n, error) in [
        (0.0, 1.0, 2.0, Some(Error::OutOfRange("rho"))),
        (0.1, 0.49, 2.0, Some(Error::OutOfRange("sigma"))),
        (0.1, 1.0, 0.99, Some(Error::OutOfRange("n"))),
        (f32::NAN, 1.0, 2.0, Some(Error::NonFinite("rho"))),
        (0.1, f32::INFINITY, 2.0, Some(Error::NonFinite("sigma"))),
        (0.1, 1.0, f32::NAN, Some(Error::NonFinite("n"))),
        (0.1, 0.5, 1.0, None),
    ] {
        assert_eq!(BoucWen::try_new(rho, sigma, n).err(), error);
    }
    for (eta, error) in [
        (-1.1, Error::OutOfRange("eta")),
        (f64::NAN, Error::NonFinite("eta")),
    ] {
        assert_eq!(BoucWenState::with_eta(eta), Err(error));
    }
}

fn any_shape() -> impl Strategy<Value = (f64, f64, f64)> {
    (1e-3..10.0_f64, 0.0..6.0_f64, 0.0..2.0_f64)
        .prop_map(|(rho, sigma, n)| (rho, 0.5 * 10_f64.powf(sigma), 10_f64.powf(n)))
}

proptest! {
    #![proptest_config(seeded(256, 1))]

    #[test]
    fn the_state_stays_within_one_for_any_input(
        (rho, sigma, n) in any_shape(),
        eta in -1.0..=1.0_f64,
        changes in prop::collection::vec(prop::num::f32::ANY, 1..40),
    ) {
        let (double, single) = (shape(rho, sigma, n), single(rho, sigma, n));
        let (mut a, mut b) = (eta, eta as f32);
        let mut s = Sensitivity::start(eta);
        for dx in changes {
            a = double.advance(a, f64::from(dx));
            b = single.advance(b, dx);
            s = double.advance_with_sensitivity(s, f64::from(dx));
            prop_assert!(a.abs() <= 1.0 && b.abs() <= 1.0 && s.eta.abs() <= 1.0);
            prop_assert!(s.d_rho.is_finite() && s.d_sigma.is_finite());
            prop_assert!(s.d_n.is_finite() && s.d_eta0.is_finite());
        }
    }

    #[test]
    fn only_the_path_counts_not_the_time_taken(
        (rho, sigma, n) in any_shape(),
        inputs in prop::collection::vec(-5.0..5.0_f64, 2..12),
        parts in 2..12_usize,
    ) {
        let shape = shape(rho, sigma, n);
        let (mut fast, mut slow) = (BoucWenState::new(), BoucWenState::new());
        let mut last = inputs[0];
        for &x in &inputs {
            shape.step(&mut fast, x);
            for k in 1..=parts {
                shape.step(&mut slow, last + (x - last) * k as f64 / parts as f64);
                // Standing still does nothing, for however long.
                let held = slow;
                let now = slow.input().unwrap();
                shape.step(&mut slow, now);
                prop_assert_eq!(held, slow);
            }
            // Twice the error that any jump may have (1e-3); a path forgets its start.
            prop_assert!((fast.eta() - slow.eta()).abs() < 2e-3);
            last = x;
        }
    }

    #[test]
    fn the_state_moves_with_the_input_further_for_more_and_alike_in_both_directions(
        (rho, sigma, n) in any_shape(),
        eta in -1.0..=1.0_f64,
        dx in -6.0..1.5_f64,
        more in 1.001..3.0_f64,
    ) {
        let dx = 10_f64.powf(dx);
        for shape in [shape(rho, sigma, n), shape(rho, sigma, 1.0), shape(rho, sigma, 2.0)] {
            for step in STEPS {
                let (near, far) = (step(&shape, eta, dx), step(&shape, eta, dx * more));
                prop_assert!(near >= eta && near <= 1.0 && far >= near - 1e-15);
                prop_assert_eq!(step(&shape, -eta, -dx), -near);
            }
        }
    }
}
