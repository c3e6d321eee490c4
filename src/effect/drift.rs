//! Drift: a trend in time.

use super::info::{Info, Regressor};
use super::shaped::plain;
use super::Parity::Even;
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

plain! {
    /// Drift: a trend in time.
    ///
    /// Formula: `t`.
    ///
    /// Source: J. S. Bendat, A. G. Piersol, *Random Data*, 2010, chapter 10 (trend
    /// removal).
    Drift
}

impl<T: Real> Regressor<T> for Drift {
    const INFO: &'static Info = &Info {
        name: "drift",
        family: Family::Drift,
        formula: "t",
        dimension: Dimension::TIME,
        parity: Symmetry::new(Even, Even),
        reads: &[Quantity::Time],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.time
    }
}
