//! A tone: a sine in time, unrelated to the measured signals.

use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Parity::Even;
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;
use core::f64::consts::TAU;

shaped! {
    /// A sine in time, unrelated to the measured signals.
    ///
    /// Formula: `sin(2·pi·f·t + psi)`.
    ///
    /// Source: J. S. Bendat, A. G. Piersol, *Random Data*, 2010, chapter 5.
    ///
    /// ```
    /// use bowden::{effect::Tone, Error};
    /// assert_eq!(Tone::try_new(0.5, 2.0)?.f(), 0.5);
    /// assert_eq!(Tone::try_new(0.0, 2.0), Err(Error::OutOfRange("f")));
    /// # Ok::<(), Error>(())
    /// ```
    Tone {
        /// Frequency \[Hz\].
        f: Positive, Dimension { time: -1, ..Dimension::ONE };
        /// Phase at t = 0 \[rad\].
        psi: Finite, Dimension::ONE;
    }
}

impl<T: Real> Regressor<T> for Tone<T> {
    const INFO: &'static Info = &Info {
        name: "tone",
        family: Family::Tone,
        formula: "sin(2·pi·f·t + psi)",
        dimension: Dimension::ONE,
        parity: Symmetry::new(Even, Even),
        reads: &[Quantity::Time],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        let turns = self.f * at.time;
        (T::from_f64(TAU) * turns + self.psi).sin()
    }
}
