//! Curve: a measured, piecewise linear characteristic without a formula.

use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Parity::{Even, Neither};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

shaped! {
    /// One segment of a curve over the position.
    ///
    /// Formulas: `clip((x − from)/width, 0, 1)`, and the same for v: one segment, which rises from
    /// 0 to 1 and stays there. A curve through the points `(x_1, f_1)` to `(x_N, f_N)`, constant
    /// beyond its ends, is an offset and N − 1 segments:
    /// `f_1 + Σ (f_(k+1) − f_k)·clip((x − x_k)/(x_(k+1) − x_k), 0, 1)`.
    /// [`Term::curve`](crate::model::Term::curve) gives these N terms. For a curve over the load,
    /// the channel of the source is the load.
    ///
    /// A segment lies between 0 and 1 for any input, so it can be a regressor of the
    /// [adaptive law](crate::control::Adaptive), which then learns the curve point by point.
    ///
    /// Source: C. de Boor, *A Practical Guide to Splines*, 1978, chapter III (piecewise linear
    /// interpolation), with the hat functions summed from the right.
    ///
    /// ```
    /// use bowden::{effect::CurvePosition, Error};
    /// assert_eq!(CurvePosition::try_new(-0.5, 2.0)?.width(), 2.0);
    /// assert_eq!(CurvePosition::try_new(-0.5, 0.0), Err(Error::OutOfRange("width")));
    /// # Ok::<(), Error>(())
    /// ```
    CurvePosition {
        /// Position at which the segment begins \[channel unit\].
        from: Finite, Dimension::POSITION;
        /// Length of the segment \[channel unit\].
        width: Positive, Dimension::POSITION;
    }
}

shaped! {
    /// One segment of a curve over the velocity.
    ///
    /// Formula: `clip((v − from)/width, 0, 1)`; source: [`CurvePosition`](super::CurvePosition).
    ///
    /// ```
    /// use bowden::{effect::CurveVelocity, Error};
    /// assert_eq!(CurveVelocity::try_new(-0.5, 2.0)?.from(), -0.5);
    /// assert_eq!(CurveVelocity::try_new(f64::NAN, 2.0), Err(Error::NonFinite("from")));
    /// # Ok::<(), Error>(())
    /// ```
    CurveVelocity {
        /// Velocity at which the segment begins \[channel unit/s\].
        from: Finite, Dimension::VELOCITY;
        /// Length of the segment \[channel unit/s\].
        width: Positive, Dimension::VELOCITY;
    }
}

/// The fraction of a segment below a value: one copy in a firmware image, not one per segment.
#[inline(never)]
fn share<T: Real>(value: T, from: T, width: T) -> T {
    let along = value - from;
    if along <= T::zero() {
        T::zero()
    } else if along < width {
        along / width
    } else {
        T::one()
    }
}

impl<T: Real> Regressor<T> for CurvePosition<T> {
    const INFO: &'static Info = &Info {
        name: "curve-position",
        family: Family::Curve,
        formula: "clip((x − from)/width, 0, 1)",
        dimension: Dimension::ONE,
        parity: Symmetry::new(Neither, Even),
        reads: &[Quantity::Position],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        share(at.motion.position, self.from, self.width)
    }
}

impl<T: Real> Regressor<T> for CurveVelocity<T> {
    const INFO: &'static Info = &Info {
        name: "curve-velocity",
        family: Family::Curve,
        formula: "clip((v − from)/width, 0, 1)",
        dimension: Dimension::ONE,
        parity: Symmetry::new(Neither, Neither),
        reads: &[Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        share(at.motion.velocity, self.from, self.width)
    }
}
