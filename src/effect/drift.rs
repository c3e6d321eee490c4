//! Drift: a trend in time.
//!
//! Formula: `t`.
//!
//! Source: J. S. Bendat, A. G. Piersol, *Random Data*, 2010, chapter 10 (trend
//! removal).

use super::info::{Info, Regressor};
use super::Symmetry::Even;
use super::{Dimension, Drift, EffectState, Family, Parity, Quantity, Situation};
use crate::Real;

impl<T: Real> Regressor<T> for Drift {
    const INFO: &'static Info = &Info {
        name: "drift",
        family: Family::Drift,
        formula: "t",
        dimension: Dimension::TIME,
        parity: Parity::new(Even, Even),
        reads: &[Quantity::Time],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Situation<T>) -> T {
        at.time
    }
}
