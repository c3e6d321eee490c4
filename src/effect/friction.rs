//! Friction, drag and asymmetry.

use super::bounds::saturate;
use super::declare::effect;
use super::{Dimension, Inputs};
use crate::Real;

effect! {
    /// Viscous friction, proportional to the velocity.
    ///
    /// Formula: `v`.
    ///
    /// Source: B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit, "A survey of
    /// models, analysis tools and compensation methods for the control of machines
    /// with friction", *Automatica* 30(7), 1994.
    Viscous;
    "viscous" in "viscous": "v", Dimension::VELOCITY, reads Velocity;
    value(_, _, at) = at.motion.velocity;
}

effect! {
    /// Quadratic drag, as in turbulent flow.
    ///
    /// Formula: `v·|v|`.
    ///
    /// Source: K. Worden, G. R. Tomlinson, *Nonlinearity in Structural Dynamics*,
    /// 2001, chapter 2.
    DragQuadratic;
    "drag-quadratic" in "drag": "v·|v|", Dimension { channel: 2, time: -2, ..Dimension::ONE }, reads Velocity;
    value(_, _, at) = at.motion.velocity * at.motion.velocity.abs();
}

effect! {
    /// Cubic drag.
    ///
    /// Formula: `v³`. Source: see [`DragQuadratic`](super::DragQuadratic).
    DragCubic;
    "drag-cubic" in "drag": "v³", Dimension { channel: 3, time: -3, ..Dimension::ONE }, reads Velocity;
    value(_, _, at) = at.motion.velocity * at.motion.velocity * at.motion.velocity;
}

effect! {
    /// Drag proportional to a power of the speed.
    ///
    /// Formula: `sgn(v)·|v/v_1|^a` with `v_1` = 1 channel unit/s. The regressor is dimensionless.
    /// The gain is the output at 1 channel unit/s, in the output unit. Another channel unit changes
    /// the gain but not the exponent.
    ///
    /// For `0 < a < 1`, the regressor is continuous, and its slope falls from infinity at v = 0
    /// towards zero. The regressor lies between Coulomb friction (the limit a → 0) and
    /// [`Viscous`](super::Viscous) (a = 1).
    ///
    /// An exponent below 1 describes shear-thinning fluids, such as greases, oils with additives,
    /// and magnetorheological fluids beyond their yield point. An exponent above 1 describes
    /// shear-thickening fluids.
    ///
    /// Source: W. Ostwald, "Über die Geschwindigkeitsfunktion der Viskosität disperser Systeme. I",
    /// *Kolloid-Zeitschrift* 36, 1925, pp. 99–117; for dampers with `F = C·|v|^a·sgn(v)`, N.
    /// Makris, M. C. Constantinou, "Fractional-derivative Maxwell model for viscous dampers",
    /// *Journal of Structural Engineering* 117(9), 1991, and D. Lee, D. P. Taylor, "Viscous damper
    /// development and future trends", *The Structural Design of Tall Buildings* 10(5), 2001.
    ///
    /// ```
    /// use bowden::{effect::PowerLaw, Error};
    /// assert!(PowerLaw::try_new(0.4).is_ok());
    /// assert_eq!(PowerLaw::try_new(0.0), Err(Error::OutOfRange("a")));
    /// ```
    PowerLaw {
        /// Exponent.
        a: Positive, Dimension::ONE;
    }
    "power-law" in "power-law": "sgn(v)·|v|^a", Dimension::ONE, reads Velocity;
    value(it, _, at) = {
        let v = at.motion.velocity;
        let size = v.abs().short_pow(it.a);
        if v < T::zero() {
            -size
        } else {
            size
        }
    };
}

effect! {
    /// Coulomb friction, smoothed at speeds below about `v_e`.
    ///
    /// Formula: `tanh(v/v_e)`. The width v_e is a shape parameter, because a fixed width that is
    /// too small would produce a spurious Stribeck effect in a fit.
    ///
    /// Source: S. Andersson, A. Söderberg, S. Björklund, "Friction models for sliding
    /// dry, boundary and mixed lubricated contacts", *Tribology International* 40(4),
    /// 2007.
    ///
    /// ```
    /// use bowden::{effect::Coulomb, Error};
    /// assert!(Coulomb::try_new(0.5).is_ok());
    /// assert_eq!(Coulomb::try_new(0.0), Err(Error::OutOfRange("v_e")));
    /// ```
    Coulomb {
        /// Velocity at which the friction reaches 76 % of its high-speed value \[channel unit/s\].
        v_e: Positive, Dimension::VELOCITY;
    }
    "coulomb" in "coulomb": "tanh(v/v_e)", Dimension::ONE, reads Velocity;
    value(it, _, at) = sign(at.motion.velocity, it.v_e);
}

/// Smoothed sign function `tanh(v/v_e)`, used by the dry-friction effects.
#[inline]
fn sign<T: Real>(v: T, v_e: T) -> T {
    (v / v_e).short_tanh()
}

effect! {
    /// Stribeck effect: the additional friction at low speed.
    ///
    /// Formula: `tanh(v/(0.1·v_s))·exp(−|v/v_s|^a)`, with a = 2 for the usual bell curve and a = 1
    /// for the exponential. A separate [`Coulomb`](super::Coulomb) term describes the friction at
    /// high speed.
    ///
    /// Source: R. Stribeck, *Zeitschrift des VDI* 46, 1902; the exponential form is
    /// L. C. Bo, D. Pavelescu, "The friction-speed relation and its influence on the
    /// critical velocity of stick-slip motion", *Wear* 82(3), 1982.
    ///
    /// ```
    /// use bowden::{effect::Stribeck, Error};
    /// assert!(Stribeck::try_new(0.5, 2.0).is_ok());
    /// assert_eq!(Stribeck::try_new(0.0, 2.0), Err(Error::OutOfRange("v_s")));
    /// ```
    Stribeck {
        /// Stribeck velocity \[channel unit/s\].
        v_s: Positive, Dimension::VELOCITY;
        /// Exponent.
        a: Positive, Dimension::ONE;
    }
    "stribeck" in "stribeck": "tanh(v/(0.1·v_s))·exp(−|v/v_s|^a)", Dimension::ONE, reads Velocity;
    value(it, _, at) = {
        let ratio = at.motion.velocity / it.v_s;
        (T::from_f64(10.0) * ratio).short_tanh() * (-ratio.abs().short_pow(it.a)).short_exp()
    };
}

effect! {
    /// Dry friction proportional to the magnitude of the load.
    ///
    /// Formula: `|load|·tanh(v/v_e)`.
    ///
    /// Source: P. Hamon, M. Gautier, P. Garrec, "Dynamic identification of robots with
    /// a dry friction model depending on load and velocity", *IROS*, 2010.
    ///
    /// ```
    /// use bowden::{effect::LoadFriction, Error};
    /// assert!(LoadFriction::try_new(0.5).is_ok());
    /// assert_eq!(LoadFriction::try_new(0.0), Err(Error::OutOfRange("v_e")));
    /// ```
    LoadFriction {
        /// Velocity at which the friction reaches 76 % of its high-speed value \[channel unit/s\].
        v_e: Positive, Dimension::VELOCITY;
    }
    "load-friction" in "load-friction": "|load|·tanh(v/v_e)", Dimension::LOAD, reads Load Velocity;
    value(it, _, at) = at.load.abs() * sign(at.motion.velocity, it.v_e);
}

effect! {
    /// Capstan friction, proportional to the tension and exponential in the wrap angle.
    ///
    /// Formula: `load·(exp(mu·x) − 1)/mu·tanh(v/v_e)`, where x is the wrap angle relative to the
    /// origin of the term. A gain of mu gives the Euler-Eytelwein equation: along the wrap,
    /// friction adds the tension `load·(exp(mu·x) − 1)`. As mu tends to zero, the regressor tends
    /// to `load·x·tanh(v/v_e)`. If the wrap angle at the origin is x_0, the gain is
    /// `mu·exp(mu·x_0)`, and there is additional load friction,
    /// `load·(exp(mu·x_0) − 1)·tanh(v/v_e)`. The position x must increase with the wrap angle,
    /// because mu is positive.
    ///
    /// Source: L. Euler, 1762; J. A. Eytelwein, 1808; for tendons, M. Kaneko,
    /// T. Yamashita, K. Tanie, "Basic considerations on transmission characteristics
    /// for tendon drive robots", *ICAR*, 1991.
    ///
    /// ```
    /// use bowden::{effect::Capstan, Error};
    /// assert!(Capstan::try_new(0.5, 0.2).is_ok());
    /// assert_eq!(Capstan::try_new(0.0, 0.2), Err(Error::OutOfRange("v_e")));
    /// assert_eq!(Capstan::try_new(0.5, 0.0), Err(Error::OutOfRange("mu")));
    /// ```
    Capstan {
        /// Velocity at which the friction reaches 76 % of its high-speed value \[channel unit/s\].
        v_e: Positive, Dimension::VELOCITY;
        /// Friction coefficient of the wrap \[1/channel unit\].
        mu: Positive, Dimension { channel: -1, ..Dimension::ONE };
    }
    "capstan" in "capstan": "load·(exp(mu·x)−1)/mu·tanh(v/v_e)", Dimension { channel: 1, load: 1, ..Dimension::ONE }, reads Load Position Velocity;
    value(it, _, at) = at.load * sign(at.motion.velocity, it.v_e) * growth(at.motion.position, it.mu);
}

/// `(exp(mu·x) − 1)/mu`. If `|mu·x|` is below the machine epsilon the result is x, because the
/// product may be subnormal or zero.
#[inline]
fn growth<T: Real>(x: T, mu: T) -> T {
    let exponent = mu * x;
    if exponent.abs() < T::epsilon() {
        x
    } else {
        saturate(exponent.exp_m1() / mu)
    }
}

effect! {
    /// Load-dependent friction while the motion is in the direction of the load (`load·v > 0`).
    ///
    /// Formula: `|load|·tanh(v/v_e)` if `load·v > 0`, otherwise 0. This effect and
    /// [`BackDriveFriction`](super::BackDriveFriction) add up to
    /// [`LoadFriction`](super::LoadFriction).
    ///
    /// Source: A. Wang, S. Kim, "Directional efficiency in geared transmissions:
    /// characterization of backdrivability towards improved proprioceptive control",
    /// *ICRA*, 2015.
    ///
    /// ```
    /// use bowden::{effect::DriveFriction, Error};
    /// assert!(DriveFriction::try_new(0.5).is_ok());
    /// assert_eq!(DriveFriction::try_new(0.0), Err(Error::OutOfRange("v_e")));
    /// ```
    DriveFriction {
        /// Velocity at which the friction reaches 76 % of its high-speed value \[channel unit/s\].
        v_e: Positive, Dimension::VELOCITY;
    }
    "drive-friction" in "direction": "|load|·tanh(v/v_e) where load·v > 0", Dimension::LOAD, reads Load Velocity;
    value(it, _, at) = {
        if sense(at) > 0 {
            at.load.abs() * sign(at.motion.velocity, it.v_e)
        } else {
            T::zero()
        }
    };
}

effect! {
    /// Load-dependent friction while the motion opposes the load (`load·v < 0`).
    ///
    /// Formula: `|load|·tanh(v/v_e)` if `load·v < 0`, otherwise 0. Source: see
    /// [`DriveFriction`](super::DriveFriction).
    ///
    /// ```
    /// use bowden::{effect::BackDriveFriction, Error};
    /// assert!(BackDriveFriction::try_new(0.5).is_ok());
    /// assert_eq!(BackDriveFriction::try_new(0.0), Err(Error::OutOfRange("v_e")));
    /// ```
    BackDriveFriction {
        /// Velocity at which the friction reaches 76 % of its high-speed value \[channel unit/s\].
        v_e: Positive, Dimension::VELOCITY;
    }
    "back-drive-friction" in "direction": "|load|·tanh(v/v_e) where load·v < 0", Dimension::LOAD, reads Load Velocity;
    value(it, _, at) = {
        if sense(at) < 0 {
            at.load.abs() * sign(at.motion.velocity, it.v_e)
        } else {
            T::zero()
        }
    };
}

/// The sign of `load·v`, computed without the product, which could underflow.
fn sense<T: Real>(at: &Inputs<T>) -> i8 {
    let (load, v) = (at.load, at.motion.velocity);
    if load == T::zero() || v == T::zero() {
        0
    } else if (load > T::zero()) == (v > T::zero()) {
        1
    } else {
        -1
    }
}

effect! {
    /// Dry friction proportional to the position.
    ///
    /// Formula: `x·tanh(v/v_e)`.
    ///
    /// Source: B. Armstrong-Hélouvry, *Control of Machines with Friction*, 1991,
    /// chapter 4 (position-dependent friction).
    ///
    /// ```
    /// use bowden::{effect::PositionFriction, Error};
    /// assert!(PositionFriction::try_new(0.5).is_ok());
    /// assert_eq!(PositionFriction::try_new(0.0), Err(Error::OutOfRange("v_e")));
    /// ```
    PositionFriction {
        /// Velocity at which the friction reaches 76 % of its high-speed value \[channel unit/s\].
        v_e: Positive, Dimension::VELOCITY;
    }
    "position-friction" in "position-friction": "x·tanh(v/v_e)", Dimension::POSITION, reads Position Velocity;
    value(it, _, at) = at.motion.position * sign(at.motion.velocity, it.v_e);
}

effect! {
    /// Hysteresis proportional to the position.
    ///
    /// Formula: `eta·x`. Source: see [`PositionFriction`](super::PositionFriction).
    PositionHysteresis;
    "position-hysteresis" in "position-friction": "eta·x", Dimension::POSITION, reads Eta Position;
    value(_, _, at) = at.eta * at.motion.position;
}

effect! {
    /// Viscous friction that differs between the two directions of motion.
    ///
    /// Formula: `|v|`. Together with [`Viscous`](super::Viscous), this effect gives a separate
    /// coefficient for each direction.
    ///
    /// Source: A. Janot, M. Gautier, M. Brunot, "Data set and reference models of
    /// EMPS", *Workshop on Nonlinear System Identification Benchmarks*, 2019; for the
    /// loop, J. Song, A. Der Kiureghian, "Generalized Bouc-Wen model for highly
    /// asymmetric hysteresis", *Journal of Engineering Mechanics* 132(6), 2006.
    AsymmetryViscous;
    "asymmetry-viscous" in "asymmetry": "|v|", Dimension::VELOCITY, reads Velocity;
    value(_, _, at) = at.motion.velocity.abs();
}

effect! {
    /// Quadratic drag that differs between the two directions of motion.
    ///
    /// Formula: `v²`. Source: see [`AsymmetryViscous`](super::AsymmetryViscous).
    AsymmetryDrag;
    "asymmetry-drag" in "asymmetry": "v²", Dimension { channel: 2, time: -2, ..Dimension::ONE }, reads Velocity;
    value(_, _, at) = at.motion.velocity * at.motion.velocity;
}

effect! {
    /// Asymmetry of the hysteresis loop: the loop is higher on one side.
    ///
    /// Formula: `|eta|`. Source: see [`AsymmetryViscous`](super::AsymmetryViscous).
    AsymmetryEta;
    "asymmetry-eta" in "asymmetry": "|eta|", Dimension::ONE, reads Eta;
    value(_, _, at) = at.eta.abs();
}

effect! {
    /// Quadratic asymmetry of the hysteresis loop.
    ///
    /// Formula: `eta²`. Source: see [`AsymmetryViscous`](super::AsymmetryViscous).
    AsymmetryEtaSquared;
    "asymmetry-eta-squared" in "asymmetry": "eta²", Dimension::ONE, reads Eta;
    value(_, _, at) = at.eta * at.eta;
}
