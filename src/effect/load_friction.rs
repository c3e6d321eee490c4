//! Load-dependent dry friction: Amontons' law.

use super::coulomb::sign;
use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Parity::Odd;
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

shaped! {
    /// Dry friction proportional to the load.
    ///
    /// Formula: `|load|·tanh(v/v_e)`.
    ///
    /// Source: P. Hamon, M. Gautier, P. Garrec, "Dynamic identification of robots with
    /// a dry friction model depending on load and velocity", *IROS*, 2010.
    ///
    /// ```
    /// use bowden::{effect::LoadFriction, Error};
    /// assert_eq!(LoadFriction::try_new(0.5)?.v_e(), 0.5);
    /// assert_eq!(LoadFriction::try_new(0.0), Err(Error::OutOfRange("v_e")));
    /// # Ok::<(), Error>(())
    /// ```
    LoadFriction {
        /// Velocity at which friction reaches 76 % \[channel unit/s\].
        v_e: Positive, Dimension::VELOCITY;
    }
}

impl<T: Real> Regressor<T> for LoadFriction<T> {
    const INFO: &'static Info = &Info {
        name: "load-friction",
        family: Family::LoadFriction,
        formula: "|load|·tanh(v/v_e)",
        dimension: Dimension::LOAD,
        parity: Symmetry::new(Odd, Odd),
        reads: &[Quantity::Load, Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.load.abs() * sign(at.motion.velocity, self.v_e)
    }
}
