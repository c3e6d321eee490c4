//! The capstan: friction grows with the tension and with the wrap.
//!
//! Formula: `load·x·tanh(v/v_e)`, x the wrap angle. It is the first term of
//! Euler-Eytelwein's `load·(exp(mu·x·sgn v) − 1)`, and the gain is the friction
//! coefficient mu \[1/rad\].
//!
//! Source: L. Euler, 1762; J. A. Eytelwein, 1808; for tendons, M. Kaneko,
//! T. Yamashita, K. Tanie, "Basic considerations on transmission characteristics
//! for tendon drive robots", *ICAR*, 1991.

use super::coulomb::sign;
use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Symmetry::Odd;
use super::{Dimension, EffectState, Family, Parity, Quantity, Situation};
use crate::Real;

shaped! {
    /// Friction in proportion to tension and wrap.
    ///
    /// ```
    /// use bowden::{effect::capstan::Capstan, Error};
    /// assert_eq!(Capstan::try_new(0.5)?.v_e(), 0.5);
    /// assert_eq!(Capstan::try_new(0.0), Err(Error::OutOfRange("v_e")));
    /// # Ok::<(), Error>(())
    /// ```
    Capstan {
        /// Velocity at which friction reaches 76 % \[channel unit/s\].
        v_e: Positive, Dimension::VELOCITY;
    }
}

impl<T: Real> Regressor<T> for Capstan<T> {
    const INFO: &'static Info = &Info {
        name: "capstan",
        family: Family::Capstan,
        formula: "load·x·tanh(v/v_e)",
        dimension: Dimension {
            channel: 1,
            load: 1,
            ..Dimension::ONE
        },
        parity: Parity::new(Odd, Odd),
        reads: &[Quantity::Load, Quantity::Position, Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Situation<T>) -> T {
        at.load * sign(at.motion.velocity, self.v_e) * at.motion.position
    }
}
