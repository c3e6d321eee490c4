//! Drag: odd in the velocity, and growing faster than linearly.

use super::info::{Info, Regressor};
use super::shaped::plain;
use super::Parity::Odd;
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

plain! {
    /// Drag: odd in the velocity, and growing faster than linearly.
    ///
    /// Formulas: `v·|v|` (turbulent flow), `v³` (the next odd power).
    ///
    /// Source: K. Worden, G. R. Tomlinson, *Nonlinearity in Structural Dynamics*,
    /// 2001, chapter 2.
    DragQuadratic
}

impl<T: Real> Regressor<T> for DragQuadratic {
    const INFO: &'static Info = &Info {
        name: "drag-quadratic",
        family: Family::Drag,
        formula: "v·|v|",
        dimension: Dimension {
            channel: 2,
            time: -2,
            ..Dimension::ONE
        },
        parity: Symmetry::new(Odd, Odd),
        reads: &[Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.motion.velocity * at.motion.velocity.abs()
    }
}

plain! {
    /// Cubic drag, the next odd power.
    ///
    /// Formula: `v³`; source: [`DragQuadratic`](super::DragQuadratic).
    DragCubic
}

impl<T: Real> Regressor<T> for DragCubic {
    const INFO: &'static Info = &Info {
        name: "drag-cubic",
        family: Family::Drag,
        formula: "v³",
        dimension: Dimension {
            channel: 3,
            time: -3,
            ..Dimension::ONE
        },
        parity: Symmetry::new(Odd, Odd),
        reads: &[Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.motion.velocity * at.motion.velocity * at.motion.velocity
    }
}
