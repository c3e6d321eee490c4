//! Asymmetry: the difference between the two directions.

use super::info::{Info, Regressor};
use super::shaped::plain;
use super::Parity::Even;
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

plain! {
    /// Asymmetry: the difference between the two directions.
    ///
    /// Formulas: `|v|` and `v²`, `|eta|` and `eta²`. All four are even in their argument, while
    /// friction is odd. Together with `viscous` and `drag`, the first two give one coefficient for
    /// each sign of v. The last two give a loop that is higher on one side.
    ///
    /// Source: A. Janot, M. Gautier, M. Brunot, "Data set and reference models of
    /// EMPS", *Workshop on Nonlinear System Identification Benchmarks*, 2019; for the
    /// loop, J. Song, A. Der Kiureghian, "Generalized Bouc-Wen model for highly
    /// asymmetric hysteresis", *Journal of Engineering Mechanics* 132(6), 2006.
    AsymmetryViscous
}

impl<T: Real> Regressor<T> for AsymmetryViscous {
    const INFO: &'static Info = &Info {
        name: "asymmetry-viscous",
        family: Family::Asymmetry,
        formula: "|v|",
        dimension: Dimension::VELOCITY,
        parity: Symmetry::new(Even, Even),
        reads: &[Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.motion.velocity.abs()
    }
}

plain! {
    /// Quadratic asymmetry in the velocity.
    ///
    /// Formula: `v²`; source: [`AsymmetryViscous`](super::AsymmetryViscous).
    AsymmetryDrag
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
        parity: Symmetry::new(Even, Even),
        reads: &[Quantity::Velocity],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.motion.velocity * at.motion.velocity
    }
}

plain! {
    /// Asymmetry of the hysteresis loop.
    ///
    /// Formula: `|eta|`; source: [`AsymmetryViscous`](super::AsymmetryViscous).
    AsymmetryEta
}

impl<T: Real> Regressor<T> for AsymmetryEta {
    const INFO: &'static Info = &Info {
        name: "asymmetry-eta",
        family: Family::Asymmetry,
        formula: "|eta|",
        dimension: Dimension::ONE,
        parity: Symmetry::new(Even, Even),
        reads: &[Quantity::Eta],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.eta.abs()
    }
}

plain! {
    /// Quadratic asymmetry of the hysteresis loop.
    ///
    /// Formula: `eta²`; source: [`AsymmetryViscous`](super::AsymmetryViscous).
    AsymmetryEtaSquared
}

impl<T: Real> Regressor<T> for AsymmetryEtaSquared {
    const INFO: &'static Info = &Info {
        name: "asymmetry-eta-squared",
        family: Family::Asymmetry,
        formula: "eta²",
        dimension: Dimension::ONE,
        parity: Symmetry::new(Even, Even),
        reads: &[Quantity::Eta],
        memory: false,
    };

    #[inline]
    fn value(&self, _: &mut EffectState<T>, at: &Inputs<T>) -> T {
        at.eta * at.eta
    }
}
