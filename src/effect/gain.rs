//! A gain error, proportional to the load.

use super::info::{Info, Regressor};
use super::shaped::plain;
use super::Parity::{Even, Odd};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

plain! {
    /// A gain error, proportional to the load.
    ///
    /// Formula: `load`.
    ///
    /// Source: the gain B of the transmission, L. Ljung, *System Identification*, 1999.
    Gain
}

impl<T: Real> Regressor<T> for Gain {
    const INFO: &'static Info = &Info {
        name: "gain",
        family: Family::Gain,
        formula: "load",
        dimension: Dimension::LOAD,
        parity: Symmetry::new(Odd, Even),
        reads: &[Quantity::Load],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.load
    }
}
