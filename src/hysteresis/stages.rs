//! A four-stage form of the unconditional step, of fourth order.
//!
//! From `zeta` with `w = 1 - zeta` the state is written `zeta + w·m/(1 + m)`, which
//! lies in `[zeta, 1]` for every `m >= 0`. Then `dm/dp = f/(1 - zeta)·(1 + m)`, and a
//! Runge-Kutta step of fourth order builds `m` from four slopes, none negative.

use super::law;
use super::path::{shorter, MOST_PARTS, NEAR_ZERO, SATURATING};
use crate::Real;

/// `zeta` after the path `p >= 0`, for `zeta` in `[-1, 1]`; `c = 2·sigma - 1`.
#[inline]
pub(super) fn follow<T: Real>(zeta: T, path: T, c: T, n: T) -> T {
    let one = T::one();
    if path > T::from_f64(SATURATING) {
        return one;
    }
    let (mut zeta, mut p) = (zeta, path);
    for part in 1..=MOST_PARTS {
        if zeta < T::zero() && -zeta < T::from_f64(NEAR_ZERO) {
            let used = least(p, -zeta);
            zeta = if used < p { T::zero() } else { zeta + used };
            p -= used;
        }
        let w = one - zeta;
        if p <= T::zero() || w <= T::zero() {
            break;
        }
        let (f, x) = right_side(zeta, c, n);
        let first = positive(f / w);
        let h = if part == MOST_PARTS {
            p
        } else {
            part_of(p, zeta, f, x, n)
        };
        let at = |m: T| {
            let w = w / (one + m);
            positive(right_side(one - w, c, n).0 / w) * (one + m)
        };
        let half = T::from_f64(0.5) * h;
        let second = at(half * first);
        let third = at(half * second);
        let fourth = at(h * third);
        let m = h * (first + T::from_f64(2.0) * (second + third) + fourth) / T::from_f64(6.0);
        let forward = w * (m / (one + m));
        if !m.is_finite() || forward >= w {
            return one;
        }
        zeta += forward;
        p -= h;
    }
    zeta
}

/// `f(zeta)`, and by how much it differs from 1.
#[inline]
fn right_side<T: Real>(zeta: T, c: T, n: T) -> (T, T) {
    let a = zeta.abs();
    let power = if a > T::zero() {
        (n * a.ln()).exp()
    } else {
        T::zero()
    };
    let beyond = if zeta < T::zero() { c * power } else { power };
    (law::f(zeta, c, power), beyond)
}

/// The part of the path that one step of four stages covers accurately.
#[inline]
fn part_of<T: Real>(p: T, zeta: T, f: T, x: T, n: T) -> T {
    let (a, near) = (zeta.abs(), T::from_f64(0.1));
    let w = T::one() - zeta;
    let h = shorter(p, f / w, w, || w);
    let h = if zeta < T::zero() {
        // Not beyond zero, where the right side has a corner; f >= 1 decreases along the path.
        least(shorter(h, n * f / a, x / f, || x / f), a / f)
    } else {
        shorter(h, n * f / (a + near), x, || x)
    };
    // The power is not smooth at zero, least of all for a small n.
    if a < near {
        least(h, near)
    } else {
        h
    }
}

/// The lesser of two paths.
#[inline]
fn least<T: Real>(a: T, b: T) -> T {
    if a < b {
        a
    } else {
        b
    }
}

/// The number if it is positive, otherwise zero (also for NaN).
#[inline]
fn positive<T: Real>(x: T) -> T {
    if x > T::zero() {
        x
    } else {
        T::zero()
    }
}
