//! Stretch: the elasticity of a cable between its two ends.

use super::info::{Info, Regressor};
use super::shaped::plain;
use super::Parity::{Even, Odd};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

plain! {
    /// Stretch: the elasticity of a cable between its two ends.
    ///
    /// Formulas: `s` and `s³` (hardening), where the channel `s` is the stretch: the difference
    /// between the angles at the two ends, `phi_p − phi_d`. The caller computes this channel, with
    /// the signs and the gear ratio of the rig. If the ends rotate in opposite directions, the
    /// stretch is the sum of the two angles.
    ///
    /// Source: M. W. Spong, "Modeling and Control of Elastic Joint Robots", *Journal of Dynamic
    /// Systems, Measurement, and Control* 109(4), 1987, where the torque is `k·(q₁ − q₂)`; for the
    /// cubic, T. D. Tuttle, W. P. Seering, "A Nonlinear Model of a Harmonic Drive Gear
    /// Transmission", *IEEE Transactions on Robotics and Automation* 12(3), 1996.
    StretchLinear
}

impl<T: Real> Regressor<T> for StretchLinear {
    const INFO: &'static Info = &Info {
        name: "stretch-linear",
        family: Family::Stretch,
        formula: "s",
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
    /// Cubic stretch: a cable that hardens.
    ///
    /// Formula: `s³`; source: [`StretchLinear`](super::StretchLinear).
    StretchCubic
}

impl<T: Real> Regressor<T> for StretchCubic {
    const INFO: &'static Info = &Info {
        name: "stretch-cubic",
        family: Family::Stretch,
        formula: "s³",
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
