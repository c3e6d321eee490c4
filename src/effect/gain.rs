//! A gain error: what is missing is proportional to the load.
//!
//! Formula: `load`.
//!
//! Source: the gain B of the transmission, L. Ljung, *System Identification*, 1999.

use super::info::{Info, Regressor};
use super::Symmetry::{Even, Odd};
use super::{Dimension, EffectState, Family, Gain, Parity, Quantity, Situation};
use crate::Real;

impl<T: Real> Regressor<T> for Gain {
    const INFO: &'static Info = &Info {
        name: "gain",
        family: Family::Gain,
        formula: "load",
        dimension: Dimension::LOAD,
        parity: Parity::new(Odd, Even),
        reads: &[Quantity::Load],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Situation<T>) -> T {
        at.load
    }
}
