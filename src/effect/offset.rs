//! A constant: the offset of the sensor or of the load.

use super::info::{Info, Regressor};
use super::shaped::plain;
use super::Parity::Even;
use super::{Dimension, EffectState, Family, Inputs, Symmetry};
use crate::Real;

plain! {
    /// A constant: the offset of the sensor or of the load.
    ///
    /// Formula: `1`.
    ///
    /// Source: part of any linear regression; L. Ljung, *System Identification*, 1999.
    Offset
}

impl<T: Real> Regressor<T> for Offset {
    const INFO: &'static Info = &Info {
        name: "offset",
        family: Family::Offset,
        formula: "1",
        dimension: Dimension::ONE,
        parity: Symmetry::new(Even, Even),
        reads: &[],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, _: &Inputs<T>) -> T {
        T::one()
    }
}
