//! K3: the hysteresis stays within ±1 and never runs backward, whatever the power function.
//!
//! The path is followed in parts. Each part is proved for any state, so that the loop over
//! them needs no bound; exponential, logarithm and square root return any float at all.

use super::path::{leave_zero, load_part, unload_part};
use crate::proofs::any::within;
use crate::proofs::stubs;

/// The longest path that is followed in parts.
const LONGEST: f32 = super::path::SATURATING as f32;

/// K3. A part of a loading path ends between where it began and 1; the last one uses up the
/// path.
///
/// Assumes: zeta ∈ (0, 1], n ∈ [1, 1e9], a path up to 40.
#[kani::proof]
#[kani::stub(libm::expf, stubs::garbage)]
#[kani::stub(libm::logf, stubs::garbage)]
#[kani::stub(libm::sqrtf, stubs::garbage)]
fn loading_part() {
    let (zeta, p, n, last) = (
        within(0.0, 1.0),
        within(0.0, LONGEST),
        within(1.0, 1e9),
        kani::any(),
    );
    kani::assume(zeta > 0.0 && p > 0.0);
    let (next, left) = load_part(zeta, p, last, n);
    kani::cover!(next > zeta && next < 1.0 && left > 0.0);
    assert!(zeta <= next && next <= 1.0);
    assert!(!last || !(left > 0.0));
}

/// K3. A part of an unloading path ends between where it began and 0; the last one gets to 0
/// or uses up the path.
///
/// Assumes: zeta ∈ [-1, -1e-9), c ∈ [0, 2e9], n ∈ [1, 1e9], a path up to 40.
#[kani::proof]
#[kani::stub(libm::expf, stubs::garbage)]
#[kani::stub(libm::logf, stubs::garbage)]
#[kani::stub(libm::sqrtf, stubs::garbage)]
fn unloading_part() {
    let (zeta, p, n, last) = (
        within(-1.0, -1e-9),
        within(0.0, LONGEST),
        within(1.0, 1e9),
        kani::any(),
    );
    let c = within(0.0, 2e9);
    kani::assume(p > 0.0);
    let (next, left) = unload_part(zeta, p, last, c, n);
    kani::cover!(next > zeta && next < 0.0 && left > 0.0);
    assert!(zeta <= next && next <= 0.0);
    assert!(!last || next == 0.0 || !(left > 0.0));
}

/// K3. The part of a path that leaves zero ends within \[0, 1\].
///
/// Assumes: n ∈ [1, 1e9], a path up to 40.
#[kani::proof]
#[kani::stub(libm::expf, stubs::garbage)]
#[kani::stub(libm::logf, stubs::garbage)]
fn part_from_zero() {
    let (p, n) = (within(0.0, LONGEST), within(1.0, 1e9));
    let (next, left) = leave_zero(p, n);
    kani::cover!(next > 0.0 && left > 0.0);
    assert!((0.0..=1.0).contains(&next) && left >= 0.0);
}
