//! Closed-form solutions of the path for `n = 1` and `n = 2`.
//!
//! A path is split at `zeta = 0`. Unloading ends there after a known path, and loading from zero
//! follows.

use crate::Real;

/// Exact `zeta` after the path `p` for `n = 1`.
///
/// Loading gives `1 - (1 - z)·e^(-p)`. Unloading reaches zero after the path `ln(1 + c·|z|)/c`.
#[inline]
pub(super) fn linear<T: Real>(zeta: T, p: T, c: T) -> T {
    let (zeta, p) = if zeta < T::zero() {
        let crossing = if c > T::zero() {
            (-c * zeta).ln_1p() / c
        } else {
            -zeta
        };
        if p < crossing {
            // d|z|/dp = -(1 + c·|z|), so that 1 + c·|z| decays as e^(-c·p).
            let decay = (-c * p).exp_m1();
            return if c > T::zero() {
                zeta - (T::one() - c * zeta) * decay / c
            } else {
                zeta + p
            };
        }
        (T::zero(), p - crossing)
    } else {
        (zeta, p)
    };
    zeta - (T::one() - zeta) * (-p).exp_m1()
}

/// Exact `zeta` after the path `p` for `n = 2`.
///
/// Loading gives `(z + t)/(1 + z·t)` with `t = tanh p`. Unloading reaches zero after the path
/// `atan(r·|z|)/r` with `r = sqrt(c)`.
#[inline]
pub(super) fn quadratic<T: Real>(zeta: T, p: T, c: T) -> T {
    let (zeta, p) = if zeta < T::zero() {
        let r = c.sqrt();
        let angle = (-r * zeta).atan();
        let crossing = if c > T::zero() { angle / r } else { -zeta };
        if p < crossing {
            return if c > T::zero() {
                -(angle - r * p).tan() / r
            } else {
                zeta + p
            };
        }
        (T::zero(), p - crossing)
    } else {
        (zeta, p)
    };
    let t = p.tanh();
    // z + t - z - z²·t over 1 + z·t: the increment has no cancellation near 1.
    zeta + t * (T::one() - zeta) * (T::one() + zeta) / (T::one() + zeta * t)
}
