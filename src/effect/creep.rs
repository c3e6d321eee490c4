//! Creep: the response continues to change at constant input.

use super::info::{Info, Regressor};
use super::lag::{held_share, low_pass};
use super::shaped::shaped;
use super::Parity::{Neither, Odd};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

shaped! {
    /// A first-order low-pass of x.
    ///
    /// Formula: `lowpass(x; tau)`, a Kelvin-Voigt element. Several elements with time constants a
    /// decade apart give the logarithmic creep of polymers and piezo stacks. The state starts at
    /// the first x.
    ///
    /// Source: P. Krejčí, K. Kuhnen, "Inverse control of systems with hysteresis and
    /// creep", *IEE Proceedings — Control Theory and Applications* 148(3), 2001.
    ///
    /// ```
    /// use bowden::{effect::Creep, Error};
    /// assert_eq!(Creep::try_new(0.5)?.tau(), 0.5);
    /// assert_eq!(Creep::try_new(0.0), Err(Error::OutOfRange("tau")));
    /// # Ok::<(), Error>(())
    /// ```
    Creep {
        /// Time constant \[s\].
        tau: Positive, Dimension::TIME;
    }
}

impl<T: Real> Regressor<T> for Creep<T> {
    const INFO: &'static Info = &Info {
        name: "creep",
        family: Family::Creep,
        formula: "lowpass(x; tau)",
        dimension: Dimension::POSITION,
        parity: Symmetry::new(Odd, Neither),
        reads: &[Quantity::Position, Quantity::Dt],
        memory: true,
    };

    #[inline]
    fn value(&self, state: &mut EffectState<T>, at: &Inputs<T>) -> T {
        low_pass(state, at.motion.position, || self.share(at.dt))
    }

    #[inline]
    fn share(&self, dt: T) -> T {
        held_share(self.tau, dt)
    }

    #[inline]
    fn value_knowing(&self, state: &mut EffectState<T>, at: &Inputs<T>, share: T) -> T {
        low_pass(state, at.motion.position, || share)
    }
}
