//! Coulomb friction: odd in the velocity, and constant in magnitude.

use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Parity::Odd;
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

shaped! {
    /// Coulomb friction, smoothed over the velocity `v_e`.
    ///
    /// Formula: `tanh(v/v_e)`. The width v_e is a shape parameter. With a fixed width that is too
    /// small, a spurious Stribeck effect would compensate for the error.
    ///
    /// Source: S. Andersson, A. Söderberg, S. Björklund, "Friction models for sliding
    /// dry, boundary and mixed lubricated contacts", *Tribology International* 40(4),
    /// 2007.
    ///
    /// ```
    /// use bowden::{effect::Coulomb, Error};
    /// assert_eq!(Coulomb::try_new(0.5)?.v_e(), 0.5);
    /// assert_eq!(Coulomb::try_new(0.0), Err(Error::OutOfRange("v_e")));
    /// # Ok::<(), Error>(())
    /// ```
    Coulomb {
        /// Velocity at which friction reaches 76 % \[channel unit/s\].
        v_e: Positive, Dimension::VELOCITY;
    }
}

impl<T: Real> Regressor<T> for Coulomb<T> {
    const INFO: &'static Info = &Info {
        name: "coulomb",
        family: Family::Coulomb,
        formula: "tanh(v/v_e)",
        dimension: Dimension::ONE,
        parity: Symmetry::new(Odd, Odd),
        reads: &[Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        sign(at.motion.velocity, self.v_e)
    }
}

/// sgn(v), smoothed: `tanh(v/v_e)`. All dry friction of the catalogue uses this function.
#[inline]
pub(super) fn sign<T: Real>(v: T, v_e: T) -> T {
    (v / v_e).short_tanh()
}
