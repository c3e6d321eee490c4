//! A constant: what the sensor or the zero of the load adds.
//!
//! Formula: `1`.
//!
//! Source: every linear regression; L. Ljung, *System Identification*, 1999.

use super::info::{Info, Regressor};
use super::Symmetry::Even;
use super::{Dimension, EffectState, Family, Offset, Parity, Situation};
use crate::Real;

impl<T: Real> Regressor<T> for Offset {
    const INFO: &'static Info = &Info {
        name: "offset",
        family: Family::Offset,
        formula: "1",
        dimension: Dimension::ONE,
        parity: Parity::new(Even, Even),
        reads: &[],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, _: &Situation<T>) -> T {
        T::one()
    }
}
