//! The splitting step, derived in the documentation of the parent module.

use super::law;
use super::number::Number;
use crate::Real;
use num_traits::{One, Zero};

/// A path after which the state is saturated from any start. Unloading ends within a path of 1, and
/// `1 - e^(-39)` rounds to 1 in `f64`.
const SATURATING: f64 = 40.0;
/// A state closer to zero than this counts as zero, because `f = 1` within the rounding error.
pub(super) const NEAR_ZERO: f64 = 1e-9;
/// Below this value of `n·(1 - zeta)`, the rest of the path has a closed form.
const NEAR_SATURATION: f64 = 0.03;
/// Local accuracy of a part of a long path. The error grows with its fourth power.
const TOLERANCE: f64 = 0.25;
/// More parts than any path needs for `sigma` up to 1e30. The last part takes the rest of the path.
const MOST_PARTS: u32 = 512;

/// `zeta` after the path `p >= 0`, for `zeta` in `[-1, 1]`.
///
/// `c = 2·sigma - 1`. Any `p`, infinite included, ends in `[zeta, 1]`.
#[inline]
pub(super) fn follow<N: Number>(zeta: N, p: N, c: N, n: N) -> N {
    if p.value() > N::Float::from_f64(SATURATING) {
        return N::constant(N::Float::one());
    }
    let (zeta, p) = unload(zeta, p, c, n);
    load(zeta, p, n)
}

/// Follows the path up to `zeta = 0`; returns the state and the remaining path.
#[inline]
pub(super) fn unload<N: Number>(zeta: N, path: N, c: N, n: N) -> (N, N) {
    let zero = N::Float::zero();
    let (mut zeta, mut p) = (zeta, path);
    let mut part = 0;
    while zeta.value() < -N::Float::from_f64(NEAR_ZERO) && p.value() > zero {
        part += 1;
        (zeta, p) = unload_part(zeta, p, part == MOST_PARTS, c, n);
    }
    if zeta.value() < zero && p.value() > zero {
        // f = 1 here, so that the remaining path to zero has the length of its depth.
        let used = -zeta;
        return if p.value() > used.value() {
            (N::constant(zero), p - used)
        } else {
            (zeta + p, N::constant(zero))
        };
    }
    (zeta, p)
}

/// One part of the path below zero. The last part takes the rest of the path.
#[inline]
pub(super) fn unload_part<N: Number>(zeta: N, p: N, last: bool, c: N, n: N) -> (N, N) {
    let a = -zeta;
    let inverse = N::constant(N::Float::one()) / a;
    let powered = c * ((n.shift(-N::Float::one())) * a.ln()).exp();
    let x = powered * a;
    let f = law::unloading(x);
    let half_slope = (n * powered).scale(N::Float::from_f64(0.5));
    // The relative change of a over the path, times n: x changes by its exponential.
    let bend = n * f * inverse;
    let h = if last {
        p
    } else {
        shorter(p, bend, x.value() / f.value(), || x / f)
    };
    let turn = n * x - (n.shift(-N::Float::one()) * f).scale(N::Float::from_f64(2.0));
    let curve = half_slope * turn * inverse.scale(N::Float::from_f64(1.0 / 6.0));
    let denominator = (h * (half_slope + h * curve)).shift(N::Float::one());
    let forward = if denominator.value() > N::Float::from_f64(0.5) {
        h * f / denominator
    } else {
        h * f / (h * half_slope).shift(N::Float::one())
    };
    if forward.value() >= a.value() {
        let used = crossing(a, f, half_slope, curve, h);
        return (N::constant(N::Float::zero()), p - used);
    }
    (zeta + positive(forward), p - h)
}

/// Path from `a` to zero: the root of `h·f = a·(1 + h·half_slope + h²·curve)`.
#[inline]
fn crossing<N: Number>(a: N, f: N, half_slope: N, curve: N, longest: N) -> N {
    let line = f - half_slope * a;
    let root = line * line - (curve * a * a).scale(N::Float::from_f64(4.0));
    if root.value() > N::Float::zero() {
        let used = a.scale(N::Float::from_f64(2.0)) / (line + root.sqrt());
        if used.value() > N::Float::zero() && used.value() < longest.value() {
            return used;
        }
    }
    longest
}

/// Follows the path from `zeta >= 0` towards 1.
#[inline]
pub(super) fn load<N: Number>(zeta: N, path: N, n: N) -> N {
    let zero = N::Float::zero();
    let (mut zeta, mut p) = (zeta, path);
    if p.value() > zero && zeta.value() >= zero && zeta.value() < N::Float::from_f64(NEAR_ZERO) {
        (zeta, p) = leave_zero(p, n);
    }
    let mut part = 0;
    while p.value() > zero && zeta.value() > zero {
        part += 1;
        (zeta, p) = load_part(zeta, p, part == MOST_PARTS, n);
    }
    zeta
}

/// One part of the path above zero. The last part takes the rest of the path.
#[inline]
pub(super) fn load_part<N: Number>(zeta: N, p: N, last: bool, n: N) -> (N, N) {
    let (one, end) = (N::Float::one(), N::constant(N::Float::zero()));
    let room = (-zeta).shift(one);
    if room.value() <= N::Float::zero() {
        return (zeta, end);
    }
    if n.value() * room.value() <= N::Float::from_f64(NEAR_SATURATION) {
        return (saturate(zeta, room, p, n), end);
    }
    let powered = (n.shift(-one) * zeta.ln()).exp();
    let f = law::loading(zeta * powered);
    let half_slope = (n * powered).scale(N::Float::from_f64(0.5));
    let concave = n.shift(-one) * f / zeta;
    let rate = f / room;
    let curve = (half_slope * (half_slope + concave)).scale(N::Float::from_f64(1.0 / 3.0));
    let h = if last {
        p
    } else {
        let h = shorter(p, rate, room.value(), || room);
        // Within r <= 1 the step is monotone in h.
        let h = if h.value() * rate.value() > one {
            N::constant(one) / rate
        } else {
            h
        };
        let bend = (half_slope * concave).scale(N::Float::from_f64(2.0));
        let limit = N::Float::from_f64(TOLERANCE);
        if h.value() * h.value() * bend.value() > limit * limit {
            N::constant(limit) / bend.sqrt()
        } else {
            h
        }
    };
    let r = h * rate;
    let r2 = r * r;
    let series = (h * (half_slope + h * curve)).shift(one);
    let denominator = series + (r2 * r2).scale(N::Float::from_f64(27.0 / 256.0));
    let forward = positive(h * f / denominator);
    if forward.value() >= room.value() {
        return (N::constant(one), end);
    }
    (zeta + forward, p - h)
}

/// The first part of the path from zero, from two terms of the inverse
/// `p = zeta·(1 + zeta^n/(n+1) + …)` of the loading branch.
#[inline]
pub(super) fn leave_zero<N: Number>(p: N, n: N) -> (N, N) {
    let one = N::Float::one();
    // 0.09 for n = 1, 0.28 for n = 3.9: the omitted term stays below 1e-4.
    let reach = n / n.shift(N::Float::from_f64(10.0));
    let (h, left) = if p.value() > reach.value() {
        (reach, p - reach)
    } else {
        (p, N::constant(N::Float::zero()))
    };
    if h.value() < N::Float::from_f64(NEAR_ZERO) {
        return (h, left);
    }
    let power = (n * h.ln()).exp();
    let zeta = h / (power / n.shift(one)).shift(one);
    if zeta.value() >= N::Float::zero() && zeta.value() <= h.value() {
        (zeta, left)
    } else {
        (h, left)
    }
}

/// The rest of the path if `n·w <= 0.03`, `w = 1 - zeta`.
///
/// Here `f = n·w - n·(n-1)/2·w²` to 2e-4, which is a logistic equation. With `E = e^(-n·p)` and
/// `k = (n-1)/2`, `w` becomes `w·E/(1 - k·w·(1 - E))`, with an error of 2e-6/n.
#[inline]
fn saturate<N: Number>(zeta: N, w: N, p: N, n: N) -> N {
    let one = N::Float::one();
    let bend = n.shift(-one).scale(N::Float::from_f64(0.5)) * w;
    let gone = (-((-(n * p)).exp())).shift(one);
    let forward = positive(w * gone * (-bend).shift(one) / (-(bend * gone)).shift(one));
    if forward.value() >= w.value() {
        return N::constant(one);
    }
    zeta + forward
}

/// The longest part of `p` with `(part·rate)⁴·weight <= TOLERANCE⁴`.
#[inline]
fn shorter<N: Number>(p: N, rate: N, weight: N::Float, dual: impl Fn() -> N) -> N {
    let limit = N::Float::from_f64(TOLERANCE);
    let stretch = p.value() * rate.value();
    let square = stretch * stretch;
    if square * square * weight <= limit * limit * limit * limit {
        return p;
    }
    let part = N::constant(limit) / (rate * dual().sqrt().sqrt());
    if part.value() > N::Float::zero() && part.value() < p.value() {
        part
    } else {
        p
    }
}

/// The number if it is positive, otherwise zero (including for NaN).
#[inline]
fn positive<N: Number>(x: N) -> N {
    if x.value() > N::Float::zero() {
        x
    } else {
        N::constant(N::Float::zero())
    }
}
