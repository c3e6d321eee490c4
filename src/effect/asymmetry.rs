//! Asymmetry: what differs between the two directions.
//!
//! Formulas: `|v|` and `v²` (beside `viscous` and `drag`: a coefficient for each
//! sign of v), `|eta|` and `eta²` (a loop that is higher on one side). All are even
//! where friction is odd.
//!
//! Source: A. Janot, M. Gautier, M. Brunot, "Data set and reference models of
//! EMPS", *Workshop on Nonlinear System Identification Benchmarks*, 2019; for the
//! loop, J. Song, A. Der Kiureghian, "Generalized Bouc-Wen model for highly
//! asymmetric hysteresis", *Journal of Engineering Mechanics* 132(6), 2006.

use super::info::{Info, Regressor};
use super::Symmetry::Even;
use super::{
    AsymmetryDrag, AsymmetryEta, AsymmetryEtaSquared, AsymmetryViscous, Dimension, EffectState,
    Family, Parity, Quantity, Situation,
};
use crate::Real;

impl<T: Real> Regressor<T> for AsymmetryViscous {
    const INFO: &'static Info = &Info {
        name: "asymmetry-viscous",
        family: Family::Asymmetry,
        formula: "|v|",
        dimension: Dimension::VELOCITY,
        parity: Parity::new(Even, Even),
        reads: &[Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Situation<T>) -> T {
        at.motion.velocity.abs()
    }
}

impl<T: Real> Regressor<T> for AsymmetryDrag {
    const INFO: &'static Info = &Info {
        name: "asymmetry-drag",
        family: Family::Asymmetry,
        formula: "v²",
        dimension: Dimension {
            channel: 2,
            time: -2,
            ..Dimension::ONE
        },
        parity: Parity::new(Even, Even),
        reads: &[Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Situation<T>) -> T {
        at.motion.velocity * at.motion.velocity
    }
}

impl<T: Real> Regressor<T> for AsymmetryEta {
    const INFO: &'static Info = &Info {
        name: "asymmetry-eta",
        family: Family::Asymmetry,
        formula: "|eta|",
        dimension: Dimension::ONE,
        parity: Parity::new(Even, Even),
        reads: &[Quantity::Eta],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Situation<T>) -> T {
        at.eta.abs()
    }
}

impl<T: Real> Regressor<T> for AsymmetryEtaSquared {
    const INFO: &'static Info = &Info {
        name: "asymmetry-eta-squared",
        family: Family::Asymmetry,
        formula: "eta²",
        dimension: Dimension::ONE,
        parity: Parity::new(Even, Even),
        reads: &[Quantity::Eta],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Situation<T>) -> T {
        at.eta * at.eta
    }
}
