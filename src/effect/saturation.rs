//! Saturation: one-sided, at either end of the range.

use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::stiffness::above;
use super::Parity::{Even, Neither};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

shaped! {
    /// The excess of x above `x_s`.
    ///
    /// Formulas: `max(0, x − x_s)` above, `min(0, x − x_s)` below.
    ///
    /// Source: hinge functions, J. H. Friedman, "Multivariate adaptive regression
    /// splines", *Annals of Statistics* 19(1), 1991.
    ///
    /// ```
    /// use bowden::{effect::SaturationUpper, Error};
    /// assert_eq!(SaturationUpper::try_new(0.5)?.x_s(), 0.5);
    /// assert_eq!(SaturationUpper::try_new(f64::NAN), Err(Error::NonFinite("x_s")));
    /// # Ok::<(), Error>(())
    /// ```
    SaturationUpper {
        /// Start of the saturation \[channel unit\].
        x_s: Finite, Dimension::POSITION;
    }
}

impl<T: Real> Regressor<T> for SaturationUpper<T> {
    const INFO: &'static Info = &Info {
        name: "saturation-upper",
        family: Family::Saturation,
        formula: "max(0, x − x_s)",
        dimension: Dimension::POSITION,
        parity: Symmetry::new(Neither, Even),
        reads: &[Quantity::Position],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        above(at.motion.position, self.x_s)
    }
}

shaped! {
    /// The excess of x below `x_s`.
    ///
    /// Formula: `min(0, x − x_s)`; source: [`SaturationUpper`](super::SaturationUpper).
    ///
    /// ```
    /// use bowden::{effect::SaturationLower, Error};
    /// assert_eq!(SaturationLower::try_new(0.5)?.x_s(), 0.5);
    /// assert_eq!(SaturationLower::try_new(f64::NAN), Err(Error::NonFinite("x_s")));
    /// # Ok::<(), Error>(())
    /// ```
    SaturationLower {
        /// Start of the saturation \[channel unit\].
        x_s: Finite, Dimension::POSITION;
    }
}

impl<T: Real> Regressor<T> for SaturationLower<T> {
    const INFO: &'static Info = &Info {
        name: "saturation-lower",
        family: Family::Saturation,
        formula: "min(0, x − x_s)",
        dimension: Dimension::POSITION,
        parity: Symmetry::new(Neither, Even),
        reads: &[Quantity::Position],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        -above(-at.motion.position, -self.x_s)
    }
}
