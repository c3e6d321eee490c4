//! Presliding: a spring that slips, with a memory in addition to eta.

use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::sum::add;
use super::Parity::{Neither, Odd};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::signal::clamp;
use crate::Real;

shaped! {
    /// The stop operator with half-width `r` and unit height.
    ///
    /// Formula: `s/r` with `s ← clamp(s + dx, −r, r)`, Prandtl's stop (elastic, perfectly plastic).
    /// Each cycle wider than 2·r dissipates energy. The loop's area is `4·(X − r)` for a cycle of
    /// amplitude X > r, and 0 for a smaller cycle. The state starts at s = 0. With the opposite sign
    /// this is [`Backlash`](super::Backlash) with the same r, except for a factor of r.
    ///
    /// The second formula, `dahl(x; r)`, bends gradually instead of slipping:
    /// `dz/dx = (1 − z·sgn dx)/r`, Dahl's equation with exponent 1. If x is monotone between two
    /// samples, the step `z ← sgn dx + (z − sgn dx)·exp(−|dx|/r)` is exact for any dx. Every cycle
    /// dissipates energy: the loop's area is `4·(X − r·tanh(X/r))`, and z swings between
    /// ±tanh(X/r). The state starts at `z = 0`.
    ///
    /// Source: L. Prandtl, 1928; P. R. Dahl, *A Solid Friction Model*, 1968; stops in
    /// parallel, F. Al-Bender, V. Lampaert, J. Swevers, "The generalized Maxwell-slip
    /// model", *IEEE Transactions on Automatic Control* 50(11), 2005.
    ///
    /// ```
    /// use bowden::{effect::Presliding, Error};
    /// assert_eq!(Presliding::try_new(0.5)?.r(), 0.5);
    /// assert_eq!(Presliding::try_new(0.0), Err(Error::OutOfRange("r")));
    /// # Ok::<(), Error>(())
    /// ```
    Presliding {
        /// Distance at which the spring slips \[channel unit\].
        r: Positive, Dimension::POSITION;
    }
}

impl<T: Real> Regressor<T> for Presliding<T> {
    const INFO: &'static Info = &Info {
        name: "presliding",
        family: Family::Presliding,
        formula: "stop(x; r)/r",
        dimension: Dimension::ONE,
        parity: Symmetry::new(Odd, Neither),
        reads: &[Quantity::Position],
        memory: true,
    };

    #[inline]
    fn value(&self, state: &mut EffectState<T>, at: &Inputs<T>) -> T {
        let x = at.motion.position;
        let [before, stretch, ..] = state.memory.unwrap_or(fresh(x));
        let stretch = clamp(stretch + (x - before), -self.r, self.r);
        state.memory = Some([x, stretch, T::zero(), T::zero()]);
        stretch / self.r
    }
}

shaped! {
    /// Dahl's curve with length `r` and unit height.
    ///
    /// Formula: `dahl(x; r)`; source: [`Presliding`](super::Presliding).
    ///
    /// ```
    /// use bowden::{effect::PreslidingDahl, Error};
    /// assert_eq!(PreslidingDahl::try_new(0.5)?.r(), 0.5);
    /// assert_eq!(PreslidingDahl::try_new(0.0), Err(Error::OutOfRange("r")));
    /// # Ok::<(), Error>(())
    /// ```
    PreslidingDahl {
        /// Distance after which the change reaches 63 % \[channel unit\].
        r: Positive, Dimension::POSITION;
    }
}

impl<T: Real> Regressor<T> for PreslidingDahl<T> {
    const INFO: &'static Info = &Info {
        name: "presliding-dahl",
        family: Family::Presliding,
        formula: "dahl(x; r)",
        dimension: Dimension::ONE,
        parity: Symmetry::new(Odd, Neither),
        reads: &[Quantity::Position],
        memory: true,
    };

    #[inline]
    fn value(&self, state: &mut EffectState<T>, at: &Inputs<T>) -> T {
        let x = at.motion.position;
        let [before, z, carry, _] = state.memory.unwrap_or(fresh(x));
        let change = x - before;
        let share = -(-change.abs() / self.r).exp_m1();
        let end = if change < T::zero() {
            -T::one()
        } else {
            T::one()
        };
        let [z, carry] = add([z, carry], (end - z) * share);
        // Rounding alone stays within ±1; a stored state may not.
        let z = clamp(z, -T::one(), T::one());
        state.memory = Some([x, z, carry, T::zero()]);
        z
    }
}

/// The memory at the first sample: neither spring is deflected.
fn fresh<T: Real>(x: T) -> [T; 4] {
    [x, T::zero(), T::zero(), T::zero()]
}
