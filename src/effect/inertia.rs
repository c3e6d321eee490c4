//! Inertia: an output proportional to the acceleration, and even in the velocity.

use super::info::{Info, Regressor};
use super::shaped::plain;
use super::Parity::{Even, Odd};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

plain! {
    /// Inertia: an output proportional to the acceleration, and even in the velocity.
    ///
    /// Formula: `a`.
    ///
    /// Source: I. Newton, *Principia*, 1687; as an identification regressor,
    /// W. Khalil, E. Dombre, *Modeling, Identification and Control of Robots*, 2002.
    Inertia
}

impl<T: Real> Regressor<T> for Inertia {
    const INFO: &'static Info = &Info {
        name: "inertia",
        family: Family::Inertia,
        formula: "a",
        dimension: Dimension {
            channel: 1,
            time: -2,
            ..Dimension::ONE
        },
        parity: Symmetry::new(Odd, Even),
        reads: &[Quantity::Acceleration],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.motion.acceleration
    }
}
