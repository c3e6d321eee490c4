//! A pure delay: the loop opens with frequency.

use super::bounds::saturate;
use super::info::{Info, Regressor};
use super::shaped::plain;
use super::Parity::{Neither, Odd};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

plain! {
    /// A pure delay: the loop opens with frequency.
    ///
    /// The gain is the delay T \[s\]. The output passes through a first-order all-pass,
    /// `z_k = y_{k−1} + c·(y_k − z_{k−1})` with `c = (dt − T)/(dt + T)`. The all-pass has magnitude
    /// 1 at every frequency, and is exact for `T = dt`. Its delay is T with a relative error of
    /// `(w·T)²/12` or, for a T below dt, of `(w·dt)²/12`. The first sample is not delayed. A
    /// negative T advances the output by the first-order term of its Taylor series.
    ///
    /// The regressor is the slope at T = 0: `−d(output)/dt`, computed as the backward difference. The
    /// delay is an output stage: it reads the sum of all terms before it.
    ///
    /// Source: J. P. Thiran, "Recursive digital filters with maximally flat group delay", *IEEE
    /// Transactions on Circuit Theory* 18(6), 1971 (order 1); for the regressor, the Taylor
    /// expansion `y(t − T) = y − T·dy/dt`, K. J. Åström, R. M. Murray, *Feedback Systems*, 2008,
    /// chapter 9.
    Delay
}

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
        parity: Symmetry::new(Odd, Neither),
        reads: &[Quantity::Output, Quantity::Dt],
        memory: true,
    };

    #[inline]
    fn value(&self, state: &mut EffectState<T>, at: &Inputs<T>) -> T {
        let Some([before, ..]) = state.memory else {
            state.memory = Some([at.output, at.output, T::zero(), T::zero()]);
            return T::zero();
        };
        if at.dt == T::zero() {
            return T::zero();
        }
        state.memory = Some([at.output, at.output, T::zero(), T::zero()]);
        (before - at.output) / at.dt
    }

    /// The delayed output minus the output.
    #[inline]
    fn contribution(&self, gain: T, state: &mut EffectState<T>, at: &Inputs<T>) -> T {
        let late = match state.memory {
            Some([before, late, ..]) if gain > T::zero() => {
                if at.dt == T::zero() {
                    return late - before;
                }
                let c = (at.dt - gain) / (at.dt + gain);
                saturate(before + c * saturate(at.output - late))
            }
            _ => return gain * saturate(self.value(state, at)),
        };
        state.memory = Some([at.output, late, T::zero(), T::zero()]);
        late - at.output
    }
}
