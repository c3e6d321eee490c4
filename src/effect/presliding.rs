//! Presliding: a spring that slips, a memory beyond the one of eta.
//!
//! Formula: `s/r` with `s ← clamp(s + dx, −r, r)`, Prandtl's stop (elastic, perfectly
//! plastic). Each cycle wider than 2·r dissipates; the loop's area is
//! `4·(X − r)` for a cycle of amplitude X > r, and 0 below. It starts at s = 0.
//!
//! Source: L. Prandtl, 1928; P. R. Dahl, *A Solid Friction Model*, 1968; stops in
//! parallel, F. Al-Bender, V. Lampaert, J. Swevers, "The generalized Maxwell-slip
//! model", *IEEE Transactions on Automatic Control* 50(11), 2005.

use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Symmetry::{Neither, Odd};
use super::{Dimension, EffectState, Family, Parity, Quantity, Situation};
use crate::signal::clamp;
use crate::Real;

shaped! {
    /// The stop operator of half-width `r`, of unit height.
    ///
    /// ```
    /// use bowden::{effect::presliding::Presliding, Error};
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
        parity: Parity::new(Odd, Neither),
        reads: &[Quantity::Position],
        memory: true,
    };

    #[inline]
    fn value(&self, state: &mut EffectState<T>, at: &Situation<T>) -> T {
        let x = at.motion.position;
        let [before, stretch, _] = state.memory.unwrap_or([x, T::zero(), T::zero()]);
        let stretch = clamp(stretch + (x - before), -self.r, self.r);
        state.memory = Some([x, stretch, T::zero()]);
        stretch / self.r
    }
}
