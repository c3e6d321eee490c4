//! Rate dependence: the loop's height changes with speed.

use super::info::{Info, Regressor};
use super::shaped::plain;
use super::Parity::{Even, Odd};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

plain! {
    /// Rate dependence: the loop's height changes with speed.
    ///
    /// Formulas: `eta·v` and `eta·|v|`.
    ///
    /// Source: M. Al Janaideh, P. Krejčí, "Inverse rate-dependent Prandtl-Ishlinskii
    /// model for feedforward compensation of hysteresis in a piezomicropositioning
    /// actuator", *IEEE/ASME Transactions on Mechatronics* 18(5), 2013.
    Rate
}

impl<T: Real> Regressor<T> for Rate {
    const INFO: &'static Info = &Info {
        name: "rate",
        family: Family::Rate,
        formula: "eta·v",
        dimension: Dimension::VELOCITY,
        parity: Symmetry::new(Even, Odd),
        reads: &[Quantity::Eta, Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.eta * at.motion.velocity
    }
}

plain! {
    /// Rate dependence through the magnitude of the velocity.
    ///
    /// Formula: `eta·|v|`; source: [`Rate`](super::Rate).
    RateSymmetric
}

impl<T: Real> Regressor<T> for RateSymmetric {
    const INFO: &'static Info = &Info {
        name: "rate-symmetric",
        family: Family::Rate,
        formula: "eta·|v|",
        dimension: Dimension::VELOCITY,
        parity: Symmetry::new(Odd, Even),
        reads: &[Quantity::Eta, Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.eta * at.motion.velocity.abs()
    }
}
