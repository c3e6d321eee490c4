//! A pure delay, to first order: the loop opens with frequency.
//!
//! Formula: `−d(output)/dt`, the backward difference; the gain is the delay \[s\]. 0 at
//! the first sample. An output stage: it reads the sum of everything before it.
//!
//! Source: the Taylor expansion `y(t − T) = y − T·dy/dt`; K. J. Åström, R. M. Murray,
//! *Feedback Systems*, 2008, chapter 9.

use super::info::{Info, Regressor};
use super::Symmetry::{Neither, Odd};
use super::{Delay, Dimension, EffectState, Family, Parity, Quantity, Situation};
use crate::Real;

impl<T: Real> Regressor<T> for Delay {
    const INFO: &'static Info = &Info {
        name: "delay",
        family: Family::Delay,
        formula: "−d(output)/dt",
        dimension: Dimension {
            output: 1,
            time: -1,
            ..Dimension::ONE
        },
        parity: Parity::new(Odd, Neither),
        reads: &[Quantity::Output, Quantity::Dt],
        memory: true,
    };

    #[inline]
    fn value(&self, state: &mut EffectState<T>, at: &Situation<T>) -> T {
        let Some([before, ..]) = state.memory else {
            state.memory = Some([at.output, T::zero(), T::zero(), T::zero()]);
            return T::zero();
        };
        if at.dt == T::zero() {
            return T::zero();
        }
        state.memory = Some([at.output, T::zero(), T::zero(), T::zero()]);
        (before - at.output) / at.dt
    }
}
