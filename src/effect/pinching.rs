//! Pinching: the loop is narrower or wider at its centre.

use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Parity::{Even, Odd};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

shaped! {
    /// A change of the loop around eta = 0.
    ///
    /// Formula: `eta·exp(−(eta/w)²)`.
    ///
    /// Source: T. T. Baber, M. N. Noori, "Random vibration of degrading, pinching
    /// systems", *Journal of Engineering Mechanics* 111(8), 1985.
    ///
    /// ```
    /// use bowden::{effect::Pinching, Error};
    /// assert_eq!(Pinching::try_new(0.5)?.w(), 0.5);
    /// assert_eq!(Pinching::try_new(0.0), Err(Error::OutOfRange("w")));
    /// # Ok::<(), Error>(())
    /// ```
    Pinching {
        /// Width, in the units of eta (dimensionless).
        w: Positive, Dimension::ONE;
    }
}

impl<T: Real> Regressor<T> for Pinching<T> {
    const INFO: &'static Info = &Info {
        name: "pinching",
        family: Family::Pinching,
        formula: "eta·exp(−(eta/w)²)",
        dimension: Dimension::ONE,
        parity: Symmetry::new(Odd, Even),
        reads: &[Quantity::Eta],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        let ratio = at.eta / self.w;
        at.eta * (-(ratio * ratio)).short_exp()
    }
}
