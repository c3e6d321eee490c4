//! Saturation: one-sided, at the extremes.
//!
//! Formulas: `max(0, x − x_s)` above, `min(0, x − x_s)` below.
//!
//! Source: hinge functions, J. H. Friedman, "Multivariate adaptive regression
//! splines", *Annals of Statistics* 19(1), 1991.

use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::stiffness::above;
use super::Symmetry::{Even, Neither};
use super::{Dimension, EffectState, Family, Parity, Quantity, Situation};
use crate::Real;

shaped! {
    /// What x has above `x_s`.
    ///
    /// ```
    /// use bowden::effect::saturation::SaturationUpper;
    /// assert!(SaturationUpper::try_new(0.5).is_ok());
    /// assert!(SaturationUpper::try_new(f32::NAN).is_err());
    /// ```
    SaturationUpper {
        /// Where saturation begins \[channel unit\].
        x_s: Finite, Dimension::POSITION;
    }
}

impl<T: Real> Regressor<T> for SaturationUpper<T> {
    const INFO: &'static Info = &Info {
        name: "saturation-upper",
        family: Family::Saturation,
        formula: "max(0, x − x_s)",
        dimension: Dimension::POSITION,
        parity: Parity::new(Neither, Even),
        reads: &[Quantity::Position],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Situation<T>) -> T {
        above(at.motion.position, self.x_s)
    }
}

shaped! {
    /// What x has below `x_s`.
    ///
    /// ```
    /// use bowden::effect::saturation::SaturationLower;
    /// assert!(SaturationLower::try_new(0.5).is_ok());
    /// assert!(SaturationLower::try_new(f32::NAN).is_err());
    /// ```
    SaturationLower {
        /// Where saturation begins \[channel unit\].
        x_s: Finite, Dimension::POSITION;
    }
}

impl<T: Real> Regressor<T> for SaturationLower<T> {
    const INFO: &'static Info = &Info {
        name: "saturation-lower",
        family: Family::Saturation,
        formula: "min(0, x − x_s)",
        dimension: Dimension::POSITION,
        parity: Parity::new(Neither, Even),
        reads: &[Quantity::Position],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Situation<T>) -> T {
        -above(-at.motion.position, -self.x_s)
    }
}
