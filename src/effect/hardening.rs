//! Hardening: a Bouc-Wen state that grows steeper along its stroke instead of saturating.
//!
//! Formula: `w(x)`, the state of `dw/dx = 1 + g·|w|` while it moves away from zero and
//! `dw/dx = 1 + (g + 2·beta)·|w|` on the way back, with w = 0 at the first sample. It has the
//! unit of x; the gain is the initial stiffness.
//!
//! In the form `z' = A·x' − b·|x'|·|z|^(n−1)·z − c·x'·|z|^n` with n = 1 it is `z = A·w`,
//! `beta = b` and `g = −(b + c)`: the branch beyond sigma in \[−1, 1\] of
//! [`Shape`](crate::hysteresis::Shape), which starts where b + c passes zero.
//!
//! # What holds
//! - For b + c > 0, `|z| ≤ (A/(b + c))^(1/n)` whatever the motion: that is a `Shape`, and no
//!   effect of this kind.
//! - For b + c ≤ 0 no such bound exists: a longer stroke reaches a larger w. With `beta > 0`,
//!   which the constructor asks for, w is bounded by the stroke: over a motion that stays within
//!   a range of length R, `|w| ≤ (exp(g·R) − 1)/g`, however far it travels there. Proof: the
//!   curve `U(x) = (exp(g·(x − x_min)) − 1)/g` has `U' = 1 + g·U`. Where w = U, it rises with
//!   the same slope, and falls with `1 + (g + 2·beta)·w`, which is steeper; so it never passes U.
//!   Likewise below. With `beta < 0` small reversals would pump it up without end.
//! - Cycles take energy out: the area of a loop is never negative, as the way back lies below.
//!
//! Between two samples x runs one way, and the step is the exact solution for any dx. Where
//! the exponential overflows it saturates at the largest float.
//!
//! Source: Y. K. Wen, "Method for random vibration of hysteretic systems", *Journal of the
//! Engineering Mechanics Division* 102(2), 1976; F. Ikhouane, J. Rodellar, *Systems with
//! Hysteresis*, 2007, table 2.1 (classes); the values of J. P. Noël, M. Schoukens, "Hysteretic
//! benchmark with a dynamic nonlinearity", *Workshop on Nonlinear System Identification
//! Benchmarks*, 2016, are A = 5e4 N/m, b = 800 1/m, c = −1100 1/m: g = 300, beta = 800 1/m.

use super::bounds::saturate;
use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Symmetry::{Neither, Odd};
use super::{Dimension, EffectState, Family, Parity, Quantity, Situation};
use crate::Real;

/// 1 over the channel's unit.
const PER_POSITION: Dimension = Dimension {
    channel: -1,
    ..Dimension::ONE
};

shaped! {
    /// The hardening state; starts at zero.
    ///
    /// ```
    /// use bowden::{effect::hardening::Hardening, Error};
    /// assert_eq!(Hardening::try_new(300.0, 800.0)?.g(), 300.0);
    /// assert_eq!(Hardening::try_new(300.0, -800.0), Err(Error::OutOfRange("beta")));
    /// # Ok::<(), Error>(())
    /// ```
    Hardening {
        /// How fast the slope grows with the state \[1/channel unit\].
        g: Positive, PER_POSITION;
        /// Half of what it grows faster on the way back \[1/channel unit\].
        beta: Positive, PER_POSITION;
    }
}

impl<T: Real> Hardening<T> {
    /// The largest state over a motion that stays within a range of that length.
    #[must_use]
    pub fn bound(&self, range: T) -> T {
        saturate(grown(T::zero(), self.g, range.abs()))
    }
}

/// The solution of `da/dp = 1 + rate·a` from a ≥ 0 after a path p ≥ 0.
#[inline]
fn grown<T: Real>(a: T, rate: T, p: T) -> T {
    let growth = (rate * p).exp_m1();
    a + growth * (a + T::one() / rate)
}

impl<T: Real> Regressor<T> for Hardening<T> {
    const INFO: &'static Info = &Info {
        name: "hardening",
        family: Family::Hardening,
        formula: "w(x; g, beta)",
        dimension: Dimension::POSITION,
        parity: Parity::new(Odd, Neither),
        reads: &[Quantity::Position],
        memory: true,
    };

    #[inline]
    fn value(&self, state: &mut EffectState<T>, at: &Situation<T>) -> T {
        let (zero, x) = (T::zero(), at.motion.position);
        let [before, w, ..] = state.memory.unwrap_or([x, zero, zero, zero]);
        let change = saturate(x - before);
        // Along the motion: below zero on the way back, above it away from zero.
        let sense = if change < zero { -T::one() } else { T::one() };
        let (along, path) = (sense * w, change.abs());
        let next = if along < zero {
            let back = self.g + self.beta + self.beta;
            // The path to zero, from `da/dp = −(1 + back·a)`.
            let home = (back * -along).ln_1p() / back;
            if path < home {
                -grown(-along, back, -path)
            } else {
                grown(zero, self.g, path - home)
            }
        } else {
            grown(along, self.g, path)
        };
        let w = saturate(sense * saturate(next));
        state.memory = Some([x, w, zero, zero]);
        w
    }
}
