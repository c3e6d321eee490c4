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
    let shard = |i: u64| {
        let bits = all * i / threads..all * (i + 1) / threads;
        bits.filter(|&b| is_so(f32::from_bits(b as u32))).count() as u64
    };
    std::thread::scope(|scope| {
        let shard = &shard;
        let shards: Vec<_> = (0..threads)
            .map(|i| scope.spawn(move || shard(i)))
            .collect();
        let counts = shards.into_iter().map(|shard| shard.join());
        counts
            .map(|count| count.unwrap_or_else(|panic| resume_unwind(panic)))
            .sum()
    })
}

#[test]
#[ignore = "all 2^32 arguments of six functions: many minutes"]
fn the_functions_keep_the_contracts_that_their_stubs_have() {
    assert_eq!(count(|x| !contracts::tanhf(x, Real::tanh(x))), 0);
    assert_eq!(count(|x| !contracts::expm1f(x, Real::exp_m1(x))), 0);
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
    let falls = |x: f32| {
        let outwards = f32::from_bits(x.to_bits() + 1);
        x.is_finite() && Real::tanh(outwards).abs() < Real::tanh(x).abs()
    };
    // Of both signs: tanh is odd to the bit.
    assert_eq!(count(falls), 2 * 10_739);
}

/// How many of all `f32` for which `is_meant` are off by more than `bound`: of the argument and
/// the exact result.
fn off(
    is_meant: impl Fn(f32) -> bool + Sync,
    of: impl Fn(f32) -> f32 + Sync,
    exact: impl Fn(f64) -> f64 + Sync,
    bound: impl Fn(f64, f64) -> f64 + Sync,
) -> u64 {
    count(|x| {
        is_meant(x) && {
            let (wide, exact) = (f64::from(x), exact(f64::from(x)));
            let error = (f64::from(of(x)) - exact).abs();
            error.is_nan() || error > bound(wide, exact.abs())
        }
    })
}

fn is_logarithms(x: f32) -> bool {
    x.is_normal() && x > 0.0
}

#[test]
#[ignore = "all 2^32 arguments: a minute"]
fn the_short_logarithm_is_as_exact_as_its_docs_say() {
    let bound = |_, exact| 3.7e-7 * exact;
    assert_eq!(off(is_logarithms, short::log2, f64::log2, bound), 0);
}

#[test]
#[ignore = "all 2^32 arguments: a minute"]
fn the_short_exponential_is_as_exact_as_its_docs_say() {
    let is_meant = |y: f32| (-126.0..127.0).contains(&y);
    let bound = |_, exact| 2.9e-7 * exact;
    assert_eq!(off(is_meant, short::exp2, f64::exp2, bound), 0);
    // Below, it stays a number that no step notices; a power of nothing is 1 to the bit.
    let least = short::exp2(-126.0);
    assert_eq!(count(|y| y <= -126.0 && short::exp2(y) != least), 0);
    assert_eq!((short::exp2(0.0), short::log2(1.0)), (1.0, 0.0));
}

#[test]
#[ignore = "all 2^32 arguments: a minute"]
fn the_coarse_functions_are_as_exact_as_their_docs_say() {
    let bound = |_, _| 0.0861;
    assert_eq!(off(is_logarithms, short::coarse_log2, f64::log2, bound), 0);
    // Every eighth: the exact power is slow.
    let is_share = |x: f32| x.to_bits() % 8 == 5 && is_logarithms(x) && x <= 1.0;
    for exponent in [0.0_f32, 0.5, 2.871, 30.0] {
        let of = |x| short::coarse_power(x, exponent).max(0.0);
        let exact = |x: f64| x.powf(f64::from(exponent));
        assert_eq!(off(is_share, of, exact, |_, _| 0.112), 0, "{exponent}");
    }
}

#[test]
#[ignore = "all 2^32 arguments: a minute"]
fn the_short_functions_of_the_effects_are_as_exact_as_their_docs_say() {
    let is_meant = |x: f32| (-87.0..88.0).contains(&x);
    let bound = |x: f64, exact| (8e-8 * x.abs() + 3e-7) * exact;
    assert_eq!(off(is_meant, short::exp, f64::exp, bound), 0);
    // Odd to the bit: half of the arguments are enough.
    let positive = |x: f32| x >= 0.0;
    let is_odd = |x: f32| short::tanh(-x) == -short::tanh(x);
    assert_eq!(count(|x| positive(x) && !is_odd(x)), 0);
    let below_ten = |x: f32| positive(x) && x < 10.0;
    let bound = |_, exact| 4e-7 * exact;
    assert_eq!(off(below_ten, short::tanh, f64::tanh, bound), 0);
    assert_eq!(count(|x| x >= 10.0 && short::tanh(x) != 1.0), 0);
    assert_eq!(count(|x| positive(x) && short::tanh(x) > 1.0), 0);
    // A power of nothing, and one that is beyond all floats.
    assert_eq!(short::pow(0.0, 0.2), 0.0);
    assert!(short::pow(f32::MAX, 3.0) > 1e38);
}

#[test]
#[ignore = "all 2^32 arguments: a minute"]
fn sine_and_cosine_of_an_f32_are_within_1_6_units_in_the_last_place() {
    // All up to 1e4, and a sixteenth of those beyond, where the exact ones are slow.
    let is_meant = |x: f32| x.is_finite() && x >= 0.0 && (x < 1e4 || x.to_bits() % 16 == 3);
    // Odd and even to the bit: half of the arguments are enough.
    let is_odd = |x: f32| Real::sin(-x) == -Real::sin(x) && Real::cos(-x) == Real::cos(x);
    assert_eq!(count(|x| is_meant(x) && !is_odd(x)), 0);
    // The distance of the floats at the result: 2^-23 times the power of 2 next below it.
    let bound = |_, exact: f64| {
        let power = f64::from_bits(exact.to_bits() & 0x7ff0_0000_0000_0000);
        1.6 * f64::from(f32::EPSILON) * power
    };
    assert_eq!(off(is_meant, Real::sin, f64::sin, bound), 0);
    assert_eq!(off(is_meant, Real::cos, f64::cos, bound), 0);
    assert_eq!(count(|x| !x.is_finite() && !Real::sin(x).is_nan()), 0);
}
