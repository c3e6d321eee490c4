//! The bounded-time step, derived in the documentation of the parent module.

use super::law;
use super::number::Number;
use crate::Real;
use num_traits::{One, Zero};

#[cfg(kani)]
#[path = "../../proofs/bounded.rs"]
mod proofs;

/// Above this value of `n·c·a^n`, unloading is a power law, not a straight line.
const STEEP: f64 = 3.0;
/// Above this value of `most`, `1/(1 + most)` is zero within the rounding error.
const SATURATED: f64 = 1e30;

/// Constants of the step for one set of parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Constants<N> {
    /// `2·sigma - 1`: ratio of the initial slopes of unloading and loading, minus one.
    pub c: N,
    pub n: N,
    /// `-1/n`.
    pub root: N,
    /// `0.6·n·(n + 1)`.
    pub size: N,
    /// Coefficients of the path from zero.
    pub series: Series<N>,
    /// The state after a path of length 1 from zero.
    pub after_1: N,
}

/// `1/(n + 1)` and `(1 + n - n²)/((2n + 1)·(n + 1)²)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Series<N> {
    pub first: N,
    pub second: N,
}

impl<N: Number> Constants<N> {
    /// The constants of [`BoucWen::try_new`](super::BoucWen::try_new), with derivatives if N has
    /// any.
    pub(super) fn of(c: N, n: N) -> Self {
        let (of, one) = (N::Float::from_f64, N::constant(N::Float::one()));
        let n1 = n + one;
        let first = one / n1;
        let second = (n1 - n * n) / n.scale(of(2.0)).shift(of(1.0)) * first * first;
        let series = Series { first, second };
        Self {
            c,
            n,
            root: -one / n,
            size: (n * n1).scale(of(0.6)),
            series,
            after_1: series.turned_round(one, one),
        }
    }
}

impl<N: Number> Series<N> {
    /// `zeta` after the path `p <= 1` from zero: the solution of
    /// `p = zeta·(1 + zeta^n/(n + 1) + zeta^(2n)/(2n + 1) + …)`. The argument y is `p^n`.
    #[inline]
    fn turned_round(&self, p: N, y: N) -> N {
        let below = y * (self.first + y * self.second);
        if below.value() > N::Float::zero() {
            p / below.shift(N::Float::one())
        } else {
            p
        }
    }
}

/// `zeta` after the path `p >= 0`, for `zeta` in `[-1, 1]`, in one step.
///
/// Any `p`, infinite included, ends in `[zeta, 1]`.
#[inline]
pub(super) fn follow<N: Number>(zeta: N, p: N, shape: &Constants<N>) -> N {
    follow_powered(zeta, p, powered(zeta, shape.n), shape)
}

/// `|zeta|^(n-1)`. At zero the result is arbitrary and not used.
#[inline]
pub(super) fn powered<N: Number>(zeta: N, n: N) -> N {
    (n.shift(-N::Float::one()) * zeta.abs().log2()).exp2()
}

/// The same as [`follow`], with a known result of [`powered`].
#[inline]
pub(super) fn follow_powered<N: Number>(zeta: N, p: N, powered: N, shape: &Constants<N>) -> N {
    if zeta.value() > N::Float::zero() {
        return load(zeta, p, powered, shape.n);
    }
    match unload(zeta.abs(), p, powered, shape) {
        Ok(forward) => zeta + forward,
        Err(left) => leave_zero(left, shape),
    }
}

/// The path above zero; `powered` is `zeta^(n-1)`.
#[inline]
pub(super) fn load<N: Number>(zeta: N, p: N, powered: N, n: N) -> N {
    let one = N::Float::one();
    let f = law::loading(zeta * powered);
    if f.value() > N::Float::zero() {
        let room = (-zeta).shift(one);
        let rate = f / room;
        approach(zeta, room, p * rate, n * powered / rate)
    } else {
        zeta
    }
}

/// The path from zero.
#[inline]
pub(super) fn leave_zero<N: Number>(p: N, shape: &Constants<N>) -> N {
    let one = N::Float::one();
    if p.value() < one {
        let powered = p.coarse_power(shape.n.shift(-one));
        return shape.series.turned_round(p, p * powered);
    }
    let zeta = shape.after_1;
    // From here on at the rate of saturation.
    approach(
        zeta,
        (-zeta).shift(one),
        shape.n * p.shift(-one),
        N::constant(one),
    )
}

/// `zeta + w·(1 - 1/(1 + m)²)` with `w = 1 - zeta`. Except for `f''`, `m` agrees with the equation
/// to third order in `r = p·f/w`. The argument `turn` is `w·|f'|/f`.
#[inline]
fn approach<N: Number>(zeta: N, w: N, r: N, turn: N) -> N {
    let (of, one) = (N::Float::from_f64, N::Float::one());
    // f is concave, so that only rounding exceeds 1; the coefficients stay above zero.
    let turn = if turn.value() < one {
        turn
    } else {
        N::constant(one)
    };
    let second = turn.scale(of(-0.25)).shift(of(0.375));
    let third = (turn * turn.scale(of(1.0 / 12.0)).shift(of(-0.375))).shift(of(0.3125));
    let m = r * (r * (second + r * third)).shift(of(0.5));
    let most = m * m.shift(of(2.0));
    if most.value() < of(SATURATED) {
        zeta + w * (most / most.shift(one))
    } else {
        N::constant(one)
    }
}

/// The distance of the path from `a` below zero towards zero, or the remaining path at zero.
#[inline]
pub(super) fn unload<N: Number>(a: N, p: N, powered: N, shape: &Constants<N>) -> Result<N, N> {
    let (of, one) = (N::Float::from_f64, N::Float::one());
    let n = shape.n;
    let x = shape.c * (a * powered);
    let (f, nx) = (law::unloading(x), n * x);
    let is_steep = nx.value() > of(STEEP);
    let (share, inverse) = if is_steep {
        (steep_share(f, shape), f)
    } else {
        flat_share(x, n)
    };
    let length = a * share;
    if p.value() >= length.value() {
        return Err(p - length);
    }
    let t = p / length;
    let bend = f * share;
    let first = bend.shift(-one);
    let forward = if is_steep {
        let k = n.shift(-one);
        let second = (share * bend * (nx - f)).shift(one) - k * first * first;
        let s = first * first * t / (first + second.scale(of(0.5)) * t);
        a - a * ((-t).shift(one) * inverse_power(s, n))
    } else {
        let second = bend * (first - (share * nx).scale(of(0.5)));
        let third = inverse - bend - second;
        let curve = t * (second + t * third);
        a * t * (bend + curve) / (t * (first + curve)).shift(one)
    };
    if forward.value() >= N::Float::zero() && forward.value() < a.value() {
        Ok(forward)
    } else {
        Err(N::constant(N::Float::zero()))
    }
}

/// `(1 + (n - 1)·s)^(-1/(n - 1))` to second order in `s`, with an error of at most 0.1 for any `s`.
#[inline]
fn inverse_power<N: Number>(s: N, n: N) -> N {
    let (of, one) = (N::Float::from_f64, N::Float::one());
    let half = n.scale(of(0.5));
    let above = half.shift(of(-0.9)).abs();
    let first = above.shift(one);
    let below = s * (first + s * (first - half));
    (s * above).shift(one) / below.shift(one)
}

/// The path from `a` to zero, divided by `a`, and the inverse of this quotient. It is a convergent
/// of the continued fraction of the integral of `1/(1 + x·s^n)` over `s` from 0 to 1, with
/// `x = c·a^n`.
#[inline]
fn flat_share<N: Number>(x: N, n: N) -> (N, N) {
    let n1 = n.shift(N::Float::one());
    let n2 = n1 + n;
    let first = x / n1;
    let third = n1 * n1 * x / (n2 + n);
    let above = n2 + third + n * n * first;
    let below = above + first * (n2 + third);
    (above / below, below / above)
}

/// The same quotient for a large x, with an error of up to 7 %: `f^(-1/n)` for `f = 1 + x`, times a
/// correction.
#[inline]
fn steep_share<N: Number>(f: N, shape: &Constants<N>) -> N {
    let log = f.coarse_log2();
    let size = shape.size * log;
    f.coarse_power(shape.root) * size / (size - log).shift(N::Float::one())
}
