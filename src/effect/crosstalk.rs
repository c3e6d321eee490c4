//! Crosstalk: an output proportional to another channel.

use super::info::{Info, Regressor};
use super::shaped::plain;
use super::Parity::{Even, Odd};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

plain! {
    /// Crosstalk: an output proportional to another channel.
    ///
    /// Formula: `x` of the other channel.
    ///
    /// Source: L. Ljung, *System Identification*, 1999 (several inputs).
    Crosstalk
}

impl<T: Real> Regressor<T> for Crosstalk {
    const INFO: &'static Info = &Info {
        name: "crosstalk",
        family: Family::Crosstalk,
        formula: "x of another channel",
        dimension: Dimension::POSITION,
        parity: Symmetry::new(Odd, Even),
        reads: &[Quantity::Position],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.motion.position
    }
}
