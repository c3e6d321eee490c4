//! Stribeck friction: odd in the velocity, and decreasing from standstill.

use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Parity::Odd;
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

shaped! {
    /// The excess friction at low speed.
    ///
    /// Formula: `tanh(v/(0.1·v_s))·exp(−|v/v_s|^a)`, with a = 2 for the usual bell curve and a = 1
    /// for the exponential. The friction at high speed is Coulomb friction.
    ///
    /// Source: R. Stribeck, *Zeitschrift des VDI* 46, 1902; the exponential form is
    /// L. C. Bo, D. Pavelescu, "The friction-speed relation and its influence on the
    /// critical velocity of stick-slip motion", *Wear* 82(3), 1982.
    ///
    /// ```
    /// use bowden::{effect::Stribeck, Error};
    /// assert_eq!(Stribeck::try_new(0.5, 2.0)?.v_s(), 0.5);
    /// assert_eq!(Stribeck::try_new(0.0, 2.0), Err(Error::OutOfRange("v_s")));
    /// # Ok::<(), Error>(())
    /// ```
    Stribeck {
        /// Stribeck velocity \[channel unit/s\].
        v_s: Positive, Dimension::VELOCITY;
        /// Exponent.
        a: Positive, Dimension::ONE;
    }
}

impl<T: Real> Regressor<T> for Stribeck<T> {
    const INFO: &'static Info = &Info {
        name: "stribeck",
        family: Family::Stribeck,
        formula: "tanh(v/(0.1·v_s))·exp(−|v/v_s|^a)",
        dimension: Dimension::ONE,
        parity: Symmetry::new(Odd, Odd),
        reads: &[Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        let ratio = at.motion.velocity / self.v_s;
        (T::from_f64(10.0) * ratio).short_tanh() * (-ratio.abs().short_pow(self.a)).short_exp()
    }
}
