//! All 2³² arguments: what the proofs assume of libm, the tanh that they cannot follow, and
//! the error of the short logarithm and exponential.
//!
//! `cargo test --test exhaustive -- --ignored`, a minute a test on two cores.

#[path = "../proofs/contracts.rs"]
mod contracts;
// The whole of what the harnesses ask; here only some of it is.
#[allow(dead_code)]
#[path = "../proofs/properties/signal.rs"]
mod signal;

#[path = "../src/real/short.rs"]
mod short;

use bowden::control::SmoothSign;
use bowden::Real;
use std::panic::resume_unwind;

/// How many of all `f32` make `is_so` true, on every core.
fn count(is_so: impl Fn(f32) -> bool + Sync) -> u64 {
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get() as u64);
    let all = u64::from(u32::MAX) + 1;
    std::thread::scope(|scope| {
        let shards: Vec<_> = (0..threads)
            .map(|i| {
                let is_so = &is_so;
                let bits = all * i / threads..all * (i + 1) / threads;
                scope.spawn(move || bits.filter(|&b| is_so(f32::from_bits(b as u32))).count())
            })
            .collect();
        { shards.into_iter() }
            .map(|shard| shard.join().unwrap_or_else(|panic| resume_unwind(panic)) as u64)
            .sum()
    })
}

/// The next float away from zero.
fn outwards(x: f32) -> f32 {
    f32::from_bits(x.to_bits() + 1)
}

#[test]
#[ignore = "all 2^32 arguments: a minute"]
fn tanh_keeps_the_contract_that_its_stub_has() {
    assert_eq!(count(|x| !contracts::tanhf(x, Real::tanh(x))), 0);
}

#[test]
#[ignore = "all 2^32 arguments: a minute"]
fn the_exponential_less_one_keeps_the_contract_that_its_stub_has() {
    assert_eq!(count(|x| !contracts::expm1f(x, Real::exp_m1(x))), 0);
}

#[test]
#[ignore = "all 2^32 arguments of four functions: many minutes"]
fn the_functions_of_the_closed_forms_keep_the_contracts_that_their_stubs_have() {
    assert_eq!(count(|x| !contracts::log1pf(x, Real::ln_1p(x))), 0);
    assert_eq!(count(|x| !contracts::sqrtf(x, Real::sqrt(x))), 0);
    assert_eq!(count(|x| !contracts::atanf(x, Real::atan(x))), 0);
    assert_eq!(count(|x| !contracts::tanf(x, Real::tan(x))), 0);
}

#[test]
#[ignore = "all 2^32 arguments: two minutes"]
fn tanh_is_a_smooth_sign_that_leaves_at_most_its_residue() {
    let sign = SmoothSign::Tanh;
    let good = |x| {
        signal::smooth_sign_is_a_sign(sign, x)
            && signal::smooth_sign_leaves_at_most_its_residue(sign, x)
    };
    assert_eq!(count(|x| !good(x)), 0);
}

/// Not errors of the proofs, which assume neither: what a reader may not assume.
#[test]
#[ignore = "all 2^32 arguments: two minutes"]
fn tanh_falls_where_it_is_known_to_fall() {
    // Of both signs: tanh is odd to the bit.
    let falls = |x: f32| x.is_finite() && Real::tanh(outwards(x)).abs() < Real::tanh(x).abs();
    assert_eq!(count(falls), 2 * 10_739);
}

#[test]
#[ignore = "all 2^32 arguments: two minutes"]
fn the_short_logarithm_is_as_exact_as_its_docs_say() {
    let is_off = |x: f32| {
        let exact = f64::from(x).log2();
        x.is_normal() && x > 0.0 && (f64::from(short::log2(x)) - exact).abs() > 3.7e-7 * exact.abs()
    };
    assert_eq!(count(is_off), 0);
}

#[test]
#[ignore = "all 2^32 arguments: two minutes"]
fn the_short_exponential_is_as_exact_as_its_docs_say() {
    let is_off = |y: f32| {
        let exact = f64::from(y).exp2();
        (-126.0..127.0).contains(&y) && (f64::from(short::exp2(y)) - exact).abs() > 2.9e-7 * exact
    };
    assert_eq!(count(is_off), 0);
    // Below, it stays a number that no step notices; a power of nothing is 1 to the bit.
    assert_eq!(
        count(|y| y <= -126.0 && short::exp2(y) != short::exp2(-126.0)),
        0
    );
    assert_eq!((short::exp2(0.0), short::log2(1.0)), (1.0, 0.0));
}

#[test]
#[ignore = "all 2^32 arguments: two minutes"]
fn the_coarse_functions_are_as_exact_as_their_docs_say() {
    let is_off = |x: f32| {
        let exact = f64::from(x).log2();
        x.is_normal() && x > 0.0 && (f64::from(short::coarse_log2(x)) - exact).abs() > 0.0861
    };
    assert_eq!(count(is_off), 0);
    for exponent in [0.0_f32, 0.5, 2.871, 30.0] {
        let is_off = |x: f32| {
            let exact = f64::from(x).powf(f64::from(exponent));
            let coarse = f64::from(short::coarse_power(x, exponent));
            x.is_normal() && x > 0.0 && x <= 1.0 && (coarse.max(0.0) - exact).abs() > 0.112
        };
        assert_eq!(count(is_off), 0, "{exponent}");
    }
}

#[test]
#[ignore = "all 2^32 arguments: two minutes"]
fn sine_and_cosine_of_an_f32_are_within_1_6_units_in_the_last_place() {
    let is_off = |of: fn(f32) -> f32, exact: fn(f64) -> f64| {
        move |x: f32| {
            let exact = exact(f64::from(x));
            // The distance of the two floats at the result.
            let unit = f64::from(f32::EPSILON) * exact.abs().log2().floor().exp2();
            x.is_finite() && (f64::from(of(x)) - exact).abs() > 1.6 * unit
        }
    };
    assert_eq!(count(is_off(Real::sin, f64::sin)), 0);
    assert_eq!(count(is_off(Real::cos, f64::cos)), 0);
    assert_eq!(count(|x| !x.is_finite() && !Real::sin(x).is_nan()), 0);
}

#[test]
#[ignore = "all 2^32 arguments: two minutes"]
fn the_short_functions_of_the_effects_are_as_exact_as_their_docs_say() {
    let is_off = |x: f32| {
        let (wide, exact) = (f64::from(x), f64::from(x).exp());
        let bound = (6e-8 * wide.abs() + 3e-7) * exact;
        (-87.0..88.0).contains(&x) && (f64::from(short::exp(x)) - exact).abs() > bound
    };
    assert_eq!(count(is_off), 0);
    let is_off = |x: f32| {
        let exact = f64::from(x).tanh();
        let error = (f64::from(short::tanh(x)) - exact).abs();
        !x.is_nan() && error > 7e-7 * exact.abs()
    };
    assert_eq!(count(is_off), 0);
    assert_eq!(count(|x| !x.is_nan() && short::tanh(x).abs() > 1.0), 0);
    // A power of nothing, and one that is beyond all floats.
    assert_eq!(short::pow(0.0, 0.2), 0.0);
    assert!(short::pow(f32::MAX, 3.0) > 1e38);
}
