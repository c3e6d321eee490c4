//! Ripple: periodic in the angle, k times per turn.

use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Parity::{Even, Neither};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

shaped! {
    /// A ripple with `k` periods per turn.
    ///
    /// Formula: `sin(k·x + psi)`, where k follows from the teeth, the lobes or a gear ratio.
    ///
    /// Source: T. D. Tuttle, W. P. Seering, "A nonlinear model of a harmonic drive
    /// gear transmission", *IEEE Transactions on Robotics and Automation* 12(3), 1996.
    ///
    /// ```
    /// use bowden::{effect::Ripple, Error};
    /// assert_eq!(Ripple::try_new(0.5, 2.0)?.k(), 0.5);
    /// assert_eq!(Ripple::try_new(0.0, 2.0), Err(Error::OutOfRange("k")));
    /// # Ok::<(), Error>(())
    /// ```
    Ripple {
        /// Angular order \[1/channel unit\].
        k: Positive, Dimension { channel: -1, ..Dimension::ONE };
        /// Phase at x = 0 \[rad\].
        psi: Finite, Dimension::ONE;
    }
}

impl<T: Real> Regressor<T> for Ripple<T> {
    const INFO: &'static Info = &Info {
        name: "ripple",
        family: Family::Ripple,
        formula: "sin(k·x + psi)",
        dimension: Dimension::ONE,
        parity: Symmetry::new(Neither, Even),
        reads: &[Quantity::Position],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        (self.k * at.motion.position + self.psi).sin()
    }
}
