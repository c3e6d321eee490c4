//! The step of the hysteresis: error beside time, against Runge-Kutta.
//!
//! `cargo bench --bench step` prints the table of errors, then the timings. Everything
//! runs on `16·sin(pi·t)` at 1 kHz with the first set of the paper; one iteration is
//! one sample.

use bowden::hysteresis::{BoucWen, Sensitivity};
use bowden::Real;
use criterion::{criterion_group, criterion_main, Criterion};
use std::hint::black_box;

const KAPPA_ETA: f64 = 7.004;
const SAMPLES: usize = 4000;

fn shape<T: Real>(n: f64) -> BoucWen<T> {
    match BoucWen::try_new(T::from_f64(0.095_82), T::from_f64(98.36), T::from_f64(n)) {
        Ok(shape) => shape,
        Err(_) => unreachable!(),
    }
}

/// The right side of (7) over the rate, with the power as the crate takes it.
#[inline]
fn right_side<T: Real>(shape: &BoucWen<T>, eta: T, direction: T) -> T {
    let one = T::one();
    let power = Real::exp((shape.n() - one) * Real::ln(eta.abs()));
    let loss = shape.sigma() * power * eta - (shape.sigma() - one) * direction * power * eta.abs();
    shape.rho() * (direction - loss)
}

/// One classical Runge-Kutta step of (7) over an increment.
#[inline]
fn runge_kutta<T: Real>(shape: &BoucWen<T>, eta: T, change: T) -> T {
    let direction = change.signum();
    let (h, half) = (change.abs(), T::from_f64(0.5));
    let k1 = right_side(shape, eta, direction);
    let k2 = right_side(shape, eta + half * h * k1, direction);
    let k3 = right_side(shape, eta + half * h * k2, direction);
    let k4 = right_side(shape, eta + h * k3, direction);
    eta + h * (k1 + T::from_f64(2.0) * (k2 + k3) + k4) / T::from_f64(6.0)
}

/// One explicit Euler step of (7).
#[inline]
fn euler<T: Real>(shape: &BoucWen<T>, eta: T, change: T) -> T {
    eta + change.abs() * right_side(shape, eta, change.signum())
}

fn input(k: usize) -> f64 {
    16.0 * (std::f64::consts::PI * k as f64 * 1e-3).sin()
}

/// The changes of the input, sample by sample.
fn changes<T: Real>() -> Vec<T> {
    (1..SAMPLES)
        .map(|k| T::from_f64(input(k) - input(k - 1)))
        .collect()
}

/// Jumps within ±16 N·m, repeatable.
fn jumps<T: Real>() -> Vec<T> {
    let (mut state, mut last) = (1_u64, 0.0);
    (0..200)
        .map(|_| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let now = 32.0 * ((state >> 11) as f64 / (1_u64 << 53) as f64) - 16.0;
            let change = now - last;
            last = now;
            T::from_f64(change)
        })
        .collect()
}

/// Largest error in kappa_eta·eta [N·m]; the reference takes the change in many parts.
fn error<T: Real>(n: f64, changes: &[T], parts: u32, step: impl Fn(&BoucWen<T>, T, T) -> T) -> f64 {
    let (exact, shape) = (shape::<f64>(n), shape::<T>(n));
    let (mut reference, mut eta, mut most) = (0.0, T::zero(), 0.0_f64);
    for &change in changes {
        let part = change.as_f64() / f64::from(parts);
        for _ in 0..parts {
            reference = runge_kutta(&exact, reference, part);
        }
        eta = step(&shape, eta, change);
        let here = (eta.as_f64() - reference).abs() * KAPPA_ETA;
        most = if here <= most { most } else { here };
        if here.is_nan() {
            return f64::NAN;
        }
    }
    most
}

fn accuracy(_: &mut Criterion) {
    println!("largest error in kappa_eta*eta [N.m]   1 kHz record   jumps within 16 N.m");
    let (record, leaps) = (changes::<f64>(), jumps::<f64>());
    let (record32, leaps32) = (changes::<f32>(), jumps::<f32>());
    let line =
        |name: &str, slow: f64, fast: f64| println!("{name:<38} {slow:>12.1e} {fast:>15.1e}");
    let general = 3.871;
    let row = |name: &str, n: f64, step: fn(&BoucWen<f64>, f64, f64) -> f64| {
        line(
            name,
            error(n, &record, 64, step),
            error(n, &leaps, 20_000, step),
        );
    };
    row("step that splits, f64", general, |s, eta, dx| {
        s.advance(eta, dx)
    });
    row("step in bounded time, f64", general, |s, eta, dx| {
        s.advance_bounded(eta, dx)
    });
    row("closed form n = 2, f64", 2.0, |s, eta, dx| {
        s.advance(eta, dx)
    });
    row("Runge-Kutta 4, f64", general, runge_kutta);
    row("explicit Euler, f64", general, euler);
    let row = |name: &str, step: fn(&BoucWen<f32>, f32, f32) -> f32| {
        line(
            name,
            error(general, &record32, 64, step),
            error(general, &leaps32, 20_000, step),
        );
    };
    row("step in bounded time, f32", |s, eta, dx| s.advance(eta, dx));
    row("step that splits, f32", |s, eta, dx| {
        s.advance_split(eta, dx)
    });
    row("Runge-Kutta 4, f32", runge_kutta);
    jump_table();
}

/// Greatest and mean error of eta of one `f32` step over 4000 jumps, rho = 0.09582.
fn jump_error(n: f64, sigma: f64, size: f64) -> (f64, f64) {
    const JUMPS: usize = 4000;
    let rho = 0.095_82;
    let (Ok(exact), Ok(short)) = (
        BoucWen::<f64>::try_new(rho, sigma, n),
        BoucWen::<f32>::try_new(rho as f32, sigma as f32, n as f32),
    ) else {
        return (f64::NAN, f64::NAN);
    };
    let (mut state, mut last, mut eta) = (7_u64, 0.0, 0.0);
    let (mut most, mut sum) = (0.0_f64, 0.0);
    for _ in 0..JUMPS {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let now = size * (2.0 * ((state >> 11) as f64 / (1_u64 << 53) as f64) - 1.0);
        let step = short.advance(eta as f32, (now - last) as f32);
        eta = (0..30).fold(eta, |eta, _| exact.advance_split(eta, (now - last) / 30.0));
        let here = (f64::from(step) - eta).abs();
        most = most.max(here);
        sum += here;
        last = now;
    }
    (most, sum / JUMPS as f64)
}

/// What a jump costs the step in bounded time, by shape and size.
fn jump_table() {
    println!("error of eta in one f32 step: greatest (mean), jumps within");
    println!(
        "{:<26} {:>20} {:>20} {:>20}",
        "", "0.3 N.m", "3 N.m", "16 N.m"
    );
    for n in [1.0, 1.5, 2.0, 3.871, 10.0] {
        for sigma in [0.6, 3.0, 98.36] {
            let cell = |size| {
                let (most, mean) = jump_error(n, sigma, size);
                format!("{most:.1e} ({mean:.1e})")
            };
            let name = format!("n = {n}, sigma = {sigma}");
            println!(
                "{name:<26} {:>20} {:>20} {:>20}",
                cell(0.3),
                cell(3.0),
                cell(16.0)
            );
        }
    }
}

fn time<T: Real>(c: &mut Criterion, name: &str, n: f64, step: impl Fn(&BoucWen<T>, T, T) -> T) {
    let (shape, changes) = (shape::<T>(n), changes::<T>());
    let (mut eta, mut k) = (T::zero(), 0);
    c.bench_function(name, |b| {
        b.iter(|| {
            k = if k + 1 < changes.len() { k + 1 } else { 0 };
            eta = step(&shape, eta, black_box(changes[k]));
            eta
        });
    });
}

fn speed(c: &mut Criterion) {
    time::<f64>(c, "step that splits, f64", 3.871, |s, eta, dx| {
        s.advance(eta, dx)
    });
    time::<f32>(c, "step in bounded time, f32", 3.871, |s, eta, dx| {
        s.advance(eta, dx)
    });
    time::<f32>(c, "step that splits, f32", 3.871, |s, eta, dx| {
        s.advance_split(eta, dx)
    });
    time::<f64>(c, "closed form n = 2, f64", 2.0, |s, eta, dx| {
        s.advance(eta, dx)
    });
    time::<f64>(c, "Runge-Kutta 4, f64", 3.871, runge_kutta);
    time::<f32>(c, "Runge-Kutta 4, f32", 3.871, runge_kutta);
    let (shape, changes) = (shape::<f64>(3.871), changes::<f64>());
    let (mut state, mut k) = (Sensitivity::start(0.0), 0);
    c.bench_function("step with sensitivities, f64", |b| {
        b.iter(|| {
            k = if k + 1 < changes.len() { k + 1 } else { 0 };
            state = shape.advance_with_sensitivity(state, black_box(changes[k]));
            state
        });
    });
}

criterion_group! {
    name = step;
    config = Criterion::default()
        .warm_up_time(std::time::Duration::from_millis(300))
        .measurement_time(std::time::Duration::from_secs(1));
    targets = accuracy, speed
}
criterion_main!(step);
