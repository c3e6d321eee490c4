//! Coulomb friction: odd in the velocity, and flat.
//!
//! Formula: `tanh(v/v_e)`. The width v_e is a shape and not a constant: a step
//! sharper than the friction's own would be mended by a false Stribeck effect.
//!
//! Source: S. Andersson, A. Söderberg, S. Björklund, "Friction models for sliding
//! dry, boundary and mixed lubricated contacts", *Tribology International* 40(4),
//! 2007.

use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Symmetry::Odd;
use super::{Dimension, EffectState, Family, Parity, Quantity, Situation};
use crate::Real;

shaped! {
    /// Coulomb friction, smoothed over the velocity `v_e`.
    ///
    /// ```
    /// use bowden::{effect::coulomb::Coulomb, Error};
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
        parity: Parity::new(Odd, Odd),
        reads: &[Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Situation<T>) -> T {
        sign(at.motion.velocity, self.v_e)
    }
}

/// sgn(v), smoothed: `tanh(v/v_e)`. All dry friction of the catalogue goes through it.
#[inline]
pub(super) fn sign<T: Real>(v: T, v_e: T) -> T {
    (v / v_e).short_tanh()
}
