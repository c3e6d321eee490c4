//! Gravity on a lever: periodic in the angle, once per turn.

use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Parity::{Even, Neither};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

shaped! {
    /// The weight of a lever at the angle x.
    ///
    /// Formula: `sin(x + psi)`. The channel must be an angle in radians.
    ///
    /// Source: M. W. Spong, S. Hutchinson, M. Vidyasagar, *Robot Modeling and
    /// Control*, 2006, chapter 7.
    ///
    /// ```
    /// use bowden::{effect::Gravity, Error};
    /// assert_eq!(Gravity::try_new(0.5)?.psi(), 0.5);
    /// assert_eq!(Gravity::try_new(f64::NAN), Err(Error::NonFinite("psi")));
    /// # Ok::<(), Error>(())
    /// ```
    Gravity {
        /// Angle of the lever at x = 0, against the vertical \[rad\].
        psi: Finite, Dimension::ONE;
    }
}

impl<T: Real> Regressor<T> for Gravity<T> {
    const INFO: &'static Info = &Info {
        name: "gravity",
        family: Family::Gravity,
        formula: "sin(x + psi)",
        dimension: Dimension::ONE,
        parity: Symmetry::new(Neither, Even),
        reads: &[Quantity::Position],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        (at.motion.position + self.psi).sin()
    }
}
