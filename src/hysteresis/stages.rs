//! A four-stage form of the unconditional step, of fourth order.
//!
//! From `zeta` with `w = 1 - zeta` the state is written `zeta + w·m/(1 + m)`, which
//! lies in `[zeta, 1]` for every `m >= 0`. Then `dm/dp = f/(1 - zeta)·(1 + m)`, and a
//! Runge-Kutta step of fourth order builds `m` from four slopes, none negative.

use crate::Real;

/// Most parts that a path is split into; the last takes what is left.
const MOST_PARTS: u32 = 512;
/// Longest part, in units of the local scale of the path.
const TOLERANCE: f64 = 0.25;

/// `zeta` after the path `p >= 0`, for `zeta` in `[-1, 1]`; `c = 2·sigma - 1`.
#[inline]
pub(super) fn follow<T: Real>(zeta: T, path: T, c: T, n: T) -> T {
    let one = T::one();
    if path > T::of(40.0) {
        return one;
    }
    let (mut zeta, mut p) = (zeta, path);
    for part in 1..=MOST_PARTS {
        let w = one - zeta;
        if p <= T::zero() || w <= T::zero() {
            break;
        }
        let first = rate(zeta, c, n);
        let h = if part == MOST_PARTS {
            p
        } else {
            part_of(p, zeta, first, w, n)
        };
        let at = |m: T| {
            let w = w / (one + m);
            rate(one - w, c, n) * (one + m)
        };
        let half = T::of(0.5) * h;
        let second = at(half * first);
        let third = at(half * second);
        let fourth = at(h * third);
        let m = h * (first + T::of(2.0) * (second + third) + fourth) / T::of(6.0);
        if !m.is_finite() {
            return one;
        }
        let forward = w * (m / (one + m));
        if forward >= w {
            return one;
        }
        zeta += forward;
        p -= h;
    }
    zeta
}

/// `f(zeta)/(1 - zeta)`, never negative.
#[inline]
fn rate<T: Real>(zeta: T, c: T, n: T) -> T {
    let a = zeta.abs();
    let power = if a > T::zero() {
        (n * a.ln()).exp()
    } else {
        T::zero()
    };
    let f = if zeta < T::zero() {
        T::one() + c * power
    } else {
        T::one() - power
    };
    let rate = f / (T::one() - zeta);
    if rate > T::zero() {
        rate
    } else {
        T::zero()
    }
}

/// The part of the path that one step of four stages covers accurately.
#[inline]
fn part_of<T: Real>(p: T, zeta: T, rate: T, w: T, n: T) -> T {
    let limit = T::of(TOLERANCE);
    // A change of the state by limit/n changes its power by a factor e^limit at most.
    let fast = rate
        * if zeta < T::zero() {
            n * w
        } else {
            T::one() + n * w
        };
    let distance = if zeta < T::zero() {
        T::of(0.1) - zeta
    } else {
        T::one()
    };
    let part = limit * distance / fast;
    if p <= part {
        p
    } else {
        part
    }
}
