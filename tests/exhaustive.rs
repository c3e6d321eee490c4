//! All 2³² arguments: what the proofs assume of libm, and the tanh that they cannot follow.
//!
//! `cargo test --test exhaustive -- --ignored`, a minute a test on two cores.

#[path = "../proofs/contracts.rs"]
mod contracts;
// The whole of what the harnesses ask; here only some of it is.
#[allow(dead_code)]
#[path = "../proofs/properties/signal.rs"]
mod signal;

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
