//! Springs, gravity, ripple, saturation, curves, and effects on the shape of the loop.

use super::declare::effect;
use super::Dimension;
use crate::Real;

effect! {
    /// Linear stiffness.
    ///
    /// Formula: `x`.
    ///
    /// Source: G. Duffing, *Erzwungene Schwingungen bei veränderlicher Eigenfrequenz*, 1918; for
    /// [`Hinge`](super::Hinge), S. W. Shaw, P. J. Holmes, "A periodically forced piecewise linear
    /// oscillator", *Journal of Sound and Vibration* 90(1), 1983.
    StiffnessLinear;
    "stiffness-linear" in "stiffness": "x", Dimension::POSITION, reads Position;
    value(_, _, at) = at.motion.position;
}

effect! {
    /// Quadratic stiffness.
    ///
    /// Formula: `x²`. Source: see [`StiffnessLinear`](super::StiffnessLinear).
    StiffnessQuadratic;
    "stiffness-quadratic" in "stiffness": "x²", Dimension { channel: 2, ..Dimension::ONE }, reads Position;
    value(_, _, at) = at.motion.position * at.motion.position;
}

effect! {
    /// Cubic stiffness.
    ///
    /// Formula: `x³`. Source: see [`StiffnessLinear`](super::StiffnessLinear).
    StiffnessCubic;
    "stiffness-cubic" in "stiffness": "x³", Dimension { channel: 3, ..Dimension::ONE }, reads Position;
    value(_, _, at) = at.motion.position * at.motion.position * at.motion.position;
}

effect! {
    /// Progressive stiffness, the same in both directions.
    ///
    /// Formula: `x·|x|`. Source: see [`StiffnessLinear`](super::StiffnessLinear).
    StiffnessProgressive;
    "stiffness-progressive" in "stiffness": "x·|x|", Dimension { channel: 2, ..Dimension::ONE }, reads Position;
    value(_, _, at) = at.motion.position * at.motion.position.abs();
}

effect! {
    /// A second spring that engages at `x_h`.
    ///
    /// Formula: `max(0, x − x_h)`. Source: see [`StiffnessLinear`](super::StiffnessLinear).
    ///
    /// ```
    /// use bowden::{effect::Hinge, Error};
    /// assert!(Hinge::try_new(0.5).is_ok());
    /// assert_eq!(Hinge::try_new(f64::NAN), Err(Error::NonFinite("x_h")));
    /// ```
    Hinge {
        /// Position at which the spring engages \[channel unit\].
        x_h: Finite, Dimension::POSITION;
    }
    "hinge" in "stiffness": "max(0, x − x_h)", Dimension::POSITION, reads Position;
    value(it, _, at) = above(at.motion.position, it.x_h);
}

/// The excess of `x` above `limit`: `max(0, x − limit)`.
#[inline]
fn above<T: Real>(x: T, limit: T) -> T {
    if x > limit {
        x - limit
    } else {
        T::zero()
    }
}

effect! {
    /// Linear elasticity of a cable between its two ends.
    ///
    /// Formula: `s`, where the channel `s` is the stretch of the cable: the difference
    /// `phi_p − phi_d` between the angles at its ends. The caller computes this channel, with the
    /// signs and the gear ratio of the rig. If the ends rotate in opposite directions, the stretch
    /// is the sum of the angles.
    ///
    /// Source: M. W. Spong, "Modeling and Control of Elastic Joint Robots", *Journal of Dynamic
    /// Systems, Measurement, and Control* 109(4), 1987, where the torque is `k·(q₁ − q₂)`; for
    /// [`StretchCubic`](super::StretchCubic), T. D. Tuttle, W. P. Seering, "A Nonlinear Model of a
    /// Harmonic Drive Gear Transmission", *IEEE Transactions on Robotics and Automation* 12(3),
    /// 1996.
    StretchLinear;
    "stretch-linear" in "stretch": "s", Dimension::POSITION, reads Position;
    value(_, _, at) = at.motion.position;
}

effect! {
    /// Cubic elasticity of a cable that hardens.
    ///
    /// Formula: `s³`. Source: see [`StretchLinear`](super::StretchLinear).
    StretchCubic;
    "stretch-cubic" in "stretch": "s³", Dimension { channel: 3, ..Dimension::ONE }, reads Position;
    value(_, _, at) = at.motion.position * at.motion.position * at.motion.position;
}

effect! {
    /// Gravity: the torque due to the weight of a lever at the angle x.
    ///
    /// Formula: `sin(x + psi)`. The channel must be an angle in radians.
    ///
    /// Source: M. W. Spong, S. Hutchinson, M. Vidyasagar, *Robot Modeling and
    /// Control*, 2006, chapter 7.
    ///
    /// ```
    /// use bowden::{effect::Gravity, Error};
    /// assert!(Gravity::try_new(0.5).is_ok());
    /// assert_eq!(Gravity::try_new(f64::NAN), Err(Error::NonFinite("psi")));
    /// ```
    Gravity {
        /// Angle of the lever from the vertical at x = 0 \[rad\].
        psi: Finite, Dimension::ONE;
    }
    "gravity" in "gravity": "sin(x + psi)", Dimension::ONE, reads Position;
    value(it, _, at) = (at.motion.position + it.psi).sin();
}

effect! {
    /// A ripple with `k` periods per turn.
    ///
    /// Formula: `sin(k·x + psi)`, where k is a number of teeth or lobes, or follows from a gear
    /// ratio.
    ///
    /// Source: T. D. Tuttle, W. P. Seering, "A nonlinear model of a harmonic drive
    /// gear transmission", *IEEE Transactions on Robotics and Automation* 12(3), 1996.
    ///
    /// ```
    /// use bowden::{effect::Ripple, Error};
    /// assert!(Ripple::try_new(0.5, 2.0).is_ok());
    /// assert_eq!(Ripple::try_new(0.0, 2.0), Err(Error::OutOfRange("k")));
    /// ```
    Ripple {
        /// Angular order \[1/channel unit\].
        k: Positive, Dimension { channel: -1, ..Dimension::ONE };
        /// Phase at x = 0 \[rad\].
        psi: Finite, Dimension::ONE;
    }
    "ripple" in "ripple": "sin(k·x + psi)", Dimension::ONE, reads Position;
    value(it, _, at) = (it.k * at.motion.position + it.psi).sin();
}

effect! {
    /// Upper saturation: the excess of x above `x_s`.
    ///
    /// Formula: `max(0, x − x_s)`.
    ///
    /// Source: J. H. Friedman, "Multivariate adaptive regression splines", *Annals of Statistics*
    /// 19(1), 1991 (hinge functions).
    ///
    /// ```
    /// use bowden::{effect::SaturationUpper, Error};
    /// assert!(SaturationUpper::try_new(0.5).is_ok());
    /// assert_eq!(SaturationUpper::try_new(f64::NAN), Err(Error::NonFinite("x_s")));
    /// ```
    SaturationUpper {
        /// Start of the saturation \[channel unit\].
        x_s: Finite, Dimension::POSITION;
    }
    "saturation-upper" in "saturation": "max(0, x − x_s)", Dimension::POSITION, reads Position;
    value(it, _, at) = above(at.motion.position, it.x_s);
}

effect! {
    /// Lower saturation: the excess of x below `x_s`, which is negative.
    ///
    /// Formula: `min(0, x − x_s)`. Source: see [`SaturationUpper`](super::SaturationUpper).
    ///
    /// ```
    /// use bowden::{effect::SaturationLower, Error};
    /// assert!(SaturationLower::try_new(0.5).is_ok());
    /// assert_eq!(SaturationLower::try_new(f64::NAN), Err(Error::NonFinite("x_s")));
    /// ```
    SaturationLower {
        /// Start of the saturation \[channel unit\].
        x_s: Finite, Dimension::POSITION;
    }
    "saturation-lower" in "saturation": "min(0, x − x_s)", Dimension::POSITION, reads Position;
    value(it, _, at) = -above(-at.motion.position, -it.x_s);
}

effect! {
    /// One segment of a piecewise linear curve of the position.
    ///
    /// Formula: `clip((x − from)/width, 0, 1)`. A curve through the points `(x_1, f_1)` to
    /// `(x_N, f_N)` is the sum of an offset and N − 1 segments:
    /// `f_1 + Σ (f_(k+1) − f_k)·clip((x − x_k)/(x_(k+1) − x_k), 0, 1)`. The curve is constant
    /// beyond its ends. [`Term::curve`](crate::model::Term::curve) returns these N terms. For a
    /// function of the load, use the channel of the load as the source.
    ///
    /// The value of a segment is between 0 and 1 for any input. A segment can therefore be a
    /// regressor of the [adaptive law](crate::control::Adaptive), which then estimates the curve.
    ///
    /// Source: C. de Boor, *A Practical Guide to Splines*, 1978, chapter III (piecewise linear
    /// interpolation).
    ///
    /// ```
    /// use bowden::{effect::CurvePosition, Error};
    /// assert!(CurvePosition::try_new(-0.5, 2.0).is_ok());
    /// assert_eq!(CurvePosition::try_new(-0.5, 0.0), Err(Error::OutOfRange("width")));
    /// ```
    CurvePosition {
        /// Position at which the segment begins \[channel unit\].
        from: Finite, Dimension::POSITION;
        /// Length of the segment \[channel unit\].
        width: Positive, Dimension::POSITION;
    }
    "curve-position" in "curve": "clip((x − from)/width, 0, 1)", Dimension::ONE, reads Position;
    value(it, _, at) = share(at.motion.position, it.from, it.width);
}

effect! {
    /// One segment of a piecewise linear curve of the velocity.
    ///
    /// Formula: `clip((v − from)/width, 0, 1)`. Source: see
    /// [`CurvePosition`](super::CurvePosition).
    ///
    /// ```
    /// use bowden::{effect::CurveVelocity, Error};
    /// assert!(CurveVelocity::try_new(-0.5, 2.0).is_ok());
    /// assert_eq!(CurveVelocity::try_new(f64::NAN, 2.0), Err(Error::NonFinite("from")));
    /// ```
    CurveVelocity {
        /// Velocity at which the segment begins \[channel unit/s\].
        from: Finite, Dimension::VELOCITY;
        /// Length of the segment \[channel unit/s\].
        width: Positive, Dimension::VELOCITY;
    }
    "curve-velocity" in "curve": "clip((v − from)/width, 0, 1)", Dimension::ONE, reads Velocity;
    value(it, _, at) = share(at.motion.velocity, it.from, it.width);
}

/// The fraction of a segment that is below a value. A firmware image contains one copy of this
/// function, not one per segment.
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

effect! {
    /// Pinching: a change in the loop near eta = 0.
    ///
    /// Formula: `eta·exp(−(eta/w)²)`.
    ///
    /// Source: T. T. Baber, M. N. Noori, "Random vibration of degrading, pinching
    /// systems", *Journal of Engineering Mechanics* 111(8), 1985.
    ///
    /// ```
    /// use bowden::{effect::Pinching, Error};
    /// assert!(Pinching::try_new(0.5).is_ok());
    /// assert_eq!(Pinching::try_new(0.0), Err(Error::OutOfRange("w")));
    /// ```
    Pinching {
        /// Width in eta (dimensionless).
        w: Positive, Dimension::ONE;
    }
    "pinching" in "pinching": "eta·exp(−(eta/w)²)", Dimension::ONE, reads Eta;
    value(it, _, at) = {
        let ratio = at.eta / it.w;
        at.eta * (-(ratio * ratio)).short_exp()
    };
}

effect! {
    /// Rate dependence: the height of the loop changes with the velocity.
    ///
    /// Formula: `eta·v`.
    ///
    /// Source: M. Al Janaideh, P. Krejčí, "Inverse rate-dependent Prandtl-Ishlinskii
    /// model for feedforward compensation of hysteresis in a piezomicropositioning
    /// actuator", *IEEE/ASME Transactions on Mechatronics* 18(5), 2013.
    Rate;
    "rate" in "rate": "eta·v", Dimension::VELOCITY, reads Eta Velocity;
    value(_, _, at) = at.eta * at.motion.velocity;
}

effect! {
    /// Rate dependence: the height of the loop changes with the speed.
    ///
    /// Formula: `eta·|v|`. Source: see [`Rate`](super::Rate).
    RateSymmetric;
    "rate-symmetric" in "rate": "eta·|v|", Dimension::VELOCITY, reads Eta Velocity;
    value(_, _, at) = at.eta * at.motion.velocity.abs();
}
