//! Viscous friction: odd in the velocity, and linear.

use super::info::{Info, Regressor};
use super::shaped::plain;
use super::Parity::Odd;
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

plain! {
    /// Viscous friction: odd in the velocity, and linear.
    ///
    /// Formula: `v`.
    ///
    /// Source: B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit, "A survey of
    /// models, analysis tools and compensation methods for the control of machines
    /// with friction", *Automatica* 30(7), 1994.
    Viscous
}

impl<T: Real> Regressor<T> for Viscous {
    const INFO: &'static Info = &Info {
        name: "viscous",
        family: Family::Viscous,
        formula: "v",
        dimension: Dimension::VELOCITY,
        parity: Symmetry::new(Odd, Odd),
        reads: &[Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.motion.velocity
    }
}
