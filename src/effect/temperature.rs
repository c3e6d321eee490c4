//! Temperature: an output proportional to the temperature. The channel must be a temperature.

use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Parity::{Even, Neither};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

shaped! {
    /// The difference between the temperature and `t_ref`.
    ///
    /// Formula: `x − t_ref`, where the channel x must be a temperature.
    ///
    /// Source: L. Simoni, M. Beschi, G. Legnani, A. Visioli, "Friction modeling with
    /// temperature effects for industrial robot manipulators", *IROS*, 2015.
    ///
    /// ```
    /// use bowden::{effect::Temperature, Error};
    /// assert_eq!(Temperature::try_new(0.5)?.t_ref(), 0.5);
    /// assert_eq!(Temperature::try_new(f64::NAN), Err(Error::NonFinite("t_ref")));
    /// # Ok::<(), Error>(())
    /// ```
    Temperature {
        /// Reference temperature \[channel unit\].
        t_ref: Finite, Dimension::POSITION;
    }
}

impl<T: Real> Regressor<T> for Temperature<T> {
    const INFO: &'static Info = &Info {
        name: "temperature",
        family: Family::Temperature,
        formula: "x − t_ref",
        dimension: Dimension::POSITION,
        parity: Symmetry::new(Neither, Even),
        reads: &[Quantity::Position],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.motion.position - self.t_ref
    }
}
