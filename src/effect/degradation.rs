//! Degradation: the loop shrinks, or grows, with the work done.
//!
//! Formula: `eta·W`, `W = ∫|eta|·|dx|` along the transmission's input (trapezoids, from
//! the first sample on), whatever the channel.
//!
//! Source: T. T. Baber, Y.-K. Wen, "Random vibration of hysteretic, degrading
//! systems", *Journal of the Engineering Mechanics Division* 107(6), 1981.

use super::bounds::saturate;
use super::info::{Info, Regressor};
use super::Symmetry::{Neither, Odd};
use super::{Dimension, EffectState, Family, Parity, Quantity, Situation};
use crate::Real;

#[derive(Clone, Copy)]
pub(super) struct Degradation;

impl<T: Real> Regressor<T> for Degradation {
    const INFO: &'static Info = &Info {
        name: "degradation",
        family: Family::Degradation,
        formula: "eta·∫|eta|·|dx|",
        dimension: Dimension {
            input: 1,
            ..Dimension::ONE
        },
        parity: Parity::new(Odd, Neither),
        reads: &[Quantity::Eta, Quantity::Input],
        memory: true,
    };

    #[inline]
    fn value(&self, state: &mut EffectState<T>, at: &Situation<T>) -> T {
        let (x, eta) = (at.input.position, at.eta);
        let [x_before, eta_before, work] = state.memory.unwrap_or([x, eta, T::zero()]);
        let path = (x - x_before).abs();
        let mean = eta.abs() * T::of(0.5) + eta_before.abs() * T::of(0.5);
        let work = saturate(work + saturate(mean * path));
        state.memory = Some([x, eta, work]);
        eta * work
    }
}
