//! Stiffness: single-valued in the position.

use super::info::{Info, Regressor};
use super::shaped::{plain, shaped};
use super::Parity::{Even, Neither, Odd};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

plain! {
    /// Stiffness: single-valued in the position.
    ///
    /// Formulas: `x`, `x²`, `x³`, `x·|x|` (progressive), and the hinge `max(0, x − x_h)`, which is
    /// a second spring that engages at x_h.
    ///
    /// Source: G. Duffing, *Erzwungene Schwingungen bei veränderlicher
    /// Eigenfrequenz*, 1918; for the hinge, S. W. Shaw, P. J. Holmes, "A periodically
    /// forced piecewise linear oscillator", *Journal of Sound and Vibration* 90(1), 1983.
    StiffnessLinear
}

impl<T: Real> Regressor<T> for StiffnessLinear {
    const INFO: &'static Info = &Info {
        name: "stiffness-linear",
        family: Family::Stiffness,
        formula: "x",
        dimension: Dimension::POSITION,
        parity: Symmetry::new(Odd, Even),
        reads: &[Quantity::Position],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.motion.position
    }
}

plain! {
    /// Quadratic stiffness.
    ///
    /// Formula: `x²`; source: [`StiffnessLinear`](super::StiffnessLinear).
    StiffnessQuadratic
}

impl<T: Real> Regressor<T> for StiffnessQuadratic {
    const INFO: &'static Info = &Info {
        name: "stiffness-quadratic",
        family: Family::Stiffness,
        formula: "x²",
        dimension: Dimension {
            channel: 2,
            ..Dimension::ONE
        },
        parity: Symmetry::new(Even, Even),
        reads: &[Quantity::Position],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.motion.position * at.motion.position
    }
}

plain! {
    /// Cubic stiffness.
    ///
    /// Formula: `x³`; source: [`StiffnessLinear`](super::StiffnessLinear).
    StiffnessCubic
}

impl<T: Real> Regressor<T> for StiffnessCubic {
    const INFO: &'static Info = &Info {
        name: "stiffness-cubic",
        family: Family::Stiffness,
        formula: "x³",
        dimension: Dimension {
            channel: 3,
            ..Dimension::ONE
        },
        parity: Symmetry::new(Odd, Even),
        reads: &[Quantity::Position],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.motion.position * at.motion.position * at.motion.position
    }
}

plain! {
    /// Progressive stiffness.
    ///
    /// Formula: `x·|x|`; source: [`StiffnessLinear`](super::StiffnessLinear).
    StiffnessProgressive
}

impl<T: Real> Regressor<T> for StiffnessProgressive {
    const INFO: &'static Info = &Info {
        name: "stiffness-progressive",
        family: Family::Stiffness,
        formula: "x·|x|",
        dimension: Dimension {
            channel: 2,
            ..Dimension::ONE
        },
        parity: Symmetry::new(Odd, Even),
        reads: &[Quantity::Position],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.motion.position * at.motion.position.abs()
    }
}

shaped! {
    /// A spring that engages at `x_h`.
    ///
    /// Formula: `max(0, x − x_h)`; source: [`StiffnessLinear`](super::StiffnessLinear).
    ///
    /// ```
    /// use bowden::{effect::Hinge, Error};
    /// assert_eq!(Hinge::try_new(0.5)?.x_h(), 0.5);
    /// assert_eq!(Hinge::try_new(f64::NAN), Err(Error::NonFinite("x_h")));
    /// # Ok::<(), Error>(())
    /// ```
    Hinge {
        /// Position at which the spring engages \[channel unit\].
        x_h: Finite, Dimension::POSITION;
    }
}

impl<T: Real> Regressor<T> for Hinge<T> {
    const INFO: &'static Info = &Info {
        name: "hinge",
        family: Family::Stiffness,
        formula: "max(0, x − x_h)",
        dimension: Dimension::POSITION,
        parity: Symmetry::new(Neither, Even),
        reads: &[Quantity::Position],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        above(at.motion.position, self.x_h)
    }
}

/// The excess of `x` above `limit`: `max(0, x − limit)`.
#[inline]
pub(super) fn above<T: Real>(x: T, limit: T) -> T {
    if x > limit {
        x - limit
    } else {
        T::zero()
    }
}
