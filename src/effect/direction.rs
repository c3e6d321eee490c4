//! Load friction that differs between driving and back-driving.

use super::coulomb::sign;
use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Parity::{Neither, Odd};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

shaped! {
    /// Load friction while the load drives the motion.
    ///
    /// Formula: `|load|·tanh(v/v_e)` if `load·v > 0` (drive), or if `load·v < 0` (back-drive),
    /// otherwise 0. The two sum to `load-friction`.
    ///
    /// Source: A. Wang, S. Kim, "Directional efficiency in geared transmissions:
    /// characterization of backdrivability towards improved proprioceptive control",
    /// *ICRA*, 2015.
    ///
    /// ```
    /// use bowden::{effect::DriveFriction, Error};
    /// assert_eq!(DriveFriction::try_new(0.5)?.v_e(), 0.5);
    /// assert_eq!(DriveFriction::try_new(0.0), Err(Error::OutOfRange("v_e")));
    /// # Ok::<(), Error>(())
    /// ```
    DriveFriction {
        /// Velocity at which friction reaches 76 % \[channel unit/s\].
        v_e: Positive, Dimension::VELOCITY;
    }
}

impl<T: Real> Regressor<T> for DriveFriction<T> {
    const INFO: &'static Info = &Info {
        name: "drive-friction",
        family: Family::Direction,
        formula: "|load|·tanh(v/v_e) where load·v > 0",
        dimension: Dimension::LOAD,
        parity: Symmetry::new(Odd, Neither),
        reads: &[Quantity::Load, Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        if sense(at) > 0 {
            at.load.abs() * sign(at.motion.velocity, self.v_e)
        } else {
            T::zero()
        }
    }
}

shaped! {
    /// Load friction while the motion opposes the load.
    ///
    /// Formula: `|load|·tanh(v/v_e) where load·v < 0`; source: [`DriveFriction`](super::DriveFriction).
    ///
    /// ```
    /// use bowden::{effect::BackDriveFriction, Error};
    /// assert_eq!(BackDriveFriction::try_new(0.5)?.v_e(), 0.5);
    /// assert_eq!(BackDriveFriction::try_new(0.0), Err(Error::OutOfRange("v_e")));
    /// # Ok::<(), Error>(())
    /// ```
    BackDriveFriction {
        /// Velocity at which friction reaches 76 % \[channel unit/s\].
        v_e: Positive, Dimension::VELOCITY;
    }
}

impl<T: Real> Regressor<T> for BackDriveFriction<T> {
    const INFO: &'static Info = &Info {
        name: "back-drive-friction",
        family: Family::Direction,
        formula: "|load|·tanh(v/v_e) where load·v < 0",
        dimension: Dimension::LOAD,
        parity: Symmetry::new(Odd, Neither),
        reads: &[Quantity::Load, Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        if sense(at) < 0 {
            at.load.abs() * sign(at.motion.velocity, self.v_e)
        } else {
            T::zero()
        }
    }
}

/// The sign of load·v, computed without the product, which could underflow.
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
