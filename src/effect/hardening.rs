//! Hardening: a Bouc-Wen state whose slope grows along the stroke instead of saturating.

use super::bounds::saturate;
use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Parity::{Neither, Odd};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

/// 1 over the channel's unit.
const PER_POSITION: Dimension = Dimension {
    channel: -1,
    ..Dimension::ONE
};

shaped! {
    /// The hardening state; starts at zero.
    ///
    /// Formula: `w(x)`, the state of `dw/dx = 1 + g·|w|` while it moves away from zero and
    /// `dw/dx = 1 + (g + 2·beta)·|w|` on the return, with w = 0 at the first sample. It has the
    /// unit of x; the gain is the initial stiffness.
    ///
    /// In the form `z' = A·x' − b·|x'|·|z|^(n−1)·z − c·x'·|z|^n` with n = 1, `z = A·w`, `beta = b`
    /// and `g = −(b + c)`. This branch lies beyond the range of
    /// [`BoucWen`](crate::hysteresis::BoucWen), with sigma outside \[−1, 1\]; it begins where b + c
    /// passes zero.
    ///
    /// # Bounds
    /// - For b + c > 0, `|z| ≤ (A/(b + c))^(1/n)` for any motion. This case is a `BoucWen`, not a
    ///   `Hardening`.
    /// - For b + c ≤ 0 no such bound exists: a longer stroke reaches a larger w. With `beta > 0`,
    ///   which the constructor requires, the stroke bounds w. Over a motion within a range of
    ///   length R, `|w| ≤ (exp(g·R) − 1)/g`, for any distance travelled. Proof: the curve
    ///   `U(x) = (exp(g·(x − x_min)) − 1)/g` has `U' = 1 + g·U`. At w = U, the state rises with the
    ///   same slope, and falls with the steeper slope `1 + (g + 2·beta)·w`; so w never exceeds U.
    ///   The same holds for negative w. With `beta < 0`, small reversals would increase w without
    ///   limit.
    /// - Cycles dissipate energy: the area of a loop is never negative, because the return branch
    ///   lies below the outward one.
    ///
    /// If x is monotone between two samples, the step is the exact solution for any dx. If the
    /// exponential overflows, the step saturates at the largest float.
    ///
    /// Source: Y. K. Wen, "Method for random vibration of hysteretic systems", *Journal of the
    /// Engineering Mechanics Division* 102(2), 1976; F. Ikhouane, J. Rodellar, *Systems with
    /// Hysteresis*, 2007, table 2.1 (classes); the values of J. P. Noël, M. Schoukens, "Hysteretic
    /// benchmark with a dynamic nonlinearity", *Workshop on Nonlinear System Identification
    /// Benchmarks*, 2016, are A = 5e4 N/m, b = 800 1/m, c = −1100 1/m, so g = 300, beta = 800 1/m.
    ///
    /// ```
    /// use bowden::{effect::Hardening, Error};
    /// assert_eq!(Hardening::try_new(300.0, 800.0)?.g(), 300.0);
    /// assert_eq!(Hardening::try_new(300.0, -800.0), Err(Error::OutOfRange("beta")));
    /// # Ok::<(), Error>(())
    /// ```
    Hardening {
        /// Growth of the slope with the state \[1/channel unit\].
        g: Positive, PER_POSITION;
        /// Half of the additional growth on the return \[1/channel unit\].
        beta: Positive, PER_POSITION;
    }
}

impl<T: Real> Hardening<T> {
    /// The largest state over a motion within a range of this length.
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
        parity: Symmetry::new(Odd, Neither),
        reads: &[Quantity::Position],
        memory: true,
    };

    #[inline]
    fn value(&self, state: &mut EffectState<T>, at: &Inputs<T>) -> T {
        let (zero, x) = (T::zero(), at.motion.position);
        let [before, w, ..] = state.memory.unwrap_or([x, zero, zero, zero]);
        let change = saturate(x - before);
        // Along the motion: negative on the return, positive away from zero.
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
