//! A preload step, for example from a slipped clamp or a re-tensioned cable.

use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Parity::Even;
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

shaped! {
    /// A step of the preload at the time `t_s`.
    ///
    /// Formula: `1` if `t ≥ t_s`, otherwise 0.
    ///
    /// Source: for the effect of the preload, V. Agrawal, W. J. Peine, B. Yao, "Modeling
    /// of transmission characteristics across a cable-conduit system", *IEEE
    /// Transactions on Robotics* 26(5), 2010.
    ///
    /// ```
    /// use bowden::{effect::Pretension, Error};
    /// assert_eq!(Pretension::try_new(0.5)?.t_s(), 0.5);
    /// assert_eq!(Pretension::try_new(f64::NAN), Err(Error::NonFinite("t_s")));
    /// # Ok::<(), Error>(())
    /// ```
    Pretension {
        /// Time of the step \[s\].
        t_s: Finite, Dimension::TIME;
    }
}

impl<T: Real> Regressor<T> for Pretension<T> {
    const INFO: &'static Info = &Info {
        name: "pretension",
        family: Family::Pretension,
        formula: "1 where t ≥ t_s",
        dimension: Dimension::ONE,
        parity: Symmetry::new(Even, Even),
        reads: &[Quantity::Time],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        if at.time >= self.t_s {
            T::one()
        } else {
            T::zero()
        }
    }
}
