//! Friction that varies along the stroke: the width of the loop depends on x.

use super::coulomb::sign;
use super::info::{Info, Regressor};
use super::shaped::{plain, shaped};
use super::Parity::{Even, Odd};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

shaped! {
    /// Dry friction proportional to the position.
    ///
    /// Formulas: `x·tanh(v/v_e)` for dry friction, `eta·x` for hysteresis.
    ///
    /// Source: B. Armstrong-Hélouvry, *Control of Machines with Friction*, 1991,
    /// chapter 4 (position-dependent friction).
    ///
    /// ```
    /// use bowden::{effect::PositionFriction, Error};
    /// assert_eq!(PositionFriction::try_new(0.5)?.v_e(), 0.5);
    /// assert_eq!(PositionFriction::try_new(0.0), Err(Error::OutOfRange("v_e")));
    /// # Ok::<(), Error>(())
    /// ```
    PositionFriction {
        /// Velocity at which friction reaches 76 % \[channel unit/s\].
        v_e: Positive, Dimension::VELOCITY;
    }
}

impl<T: Real> Regressor<T> for PositionFriction<T> {
    const INFO: &'static Info = &Info {
        name: "position-friction",
        family: Family::PositionFriction,
        formula: "x·tanh(v/v_e)",
        dimension: Dimension::POSITION,
        parity: Symmetry::new(Even, Odd),
        reads: &[Quantity::Position, Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.motion.position * sign(at.motion.velocity, self.v_e)
    }
}

plain! {
    /// Hysteresis proportional to the position.
    ///
    /// Formula: `eta·x`; source: [`PositionFriction`](super::PositionFriction).
    PositionHysteresis
}

impl<T: Real> Regressor<T> for PositionHysteresis {
    const INFO: &'static Info = &Info {
        name: "position-hysteresis",
        family: Family::PositionFriction,
        formula: "eta·x",
        dimension: Dimension::POSITION,
        parity: Symmetry::new(Even, Even),
        reads: &[Quantity::Eta, Quantity::Position],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.eta * at.motion.position
    }
}
