//! A first-order lag of the output.

use super::bounds::saturate;
use super::info::{Info, Regressor};
use super::shaped::shaped;
use super::Parity::{Neither, Odd};
use super::{Dimension, EffectState, Family, Inputs, Quantity, Symmetry};
use crate::Real;

shaped! {
    /// The low-pass of the output minus the output; its state starts at the first output.
    ///
    /// Formula: `lowpass(output; tau) − output`; a gain of 1 is the full lag. The low-pass holds
    /// each sample over its dt, so it is exact for steps at any dt. Rounding limits the increment
    /// of a step, so the memory stops at a distance from its target of up to tau/dt times half an
    /// epsilon. In `f32` this distance is 0.06 % at a tau/dt of 10^4 and 6 % at 10^6. The lag is an
    /// output stage: it reads the sum of all terms before it.
    ///
    /// Source: K. J. Åström, R. M. Murray, *Feedback Systems*, 2008, chapter 8.
    ///
    /// ```
    /// use bowden::{effect::Lag, Error};
    /// assert_eq!(Lag::try_new(0.5)?.tau(), 0.5);
    /// assert_eq!(Lag::try_new(0.0), Err(Error::OutOfRange("tau")));
    /// # Ok::<(), Error>(())
    /// ```
    Lag {
        /// Time constant \[s\].
        tau: Positive, Dimension::TIME;
    }
}

impl<T: Real> Regressor<T> for Lag<T> {
    const INFO: &'static Info = &Info {
        name: "lag",
        family: Family::Lag,
        formula: "lowpass(output; tau) − output",
        dimension: Dimension::OUTPUT,
        parity: Symmetry::new(Odd, Neither),
        reads: &[Quantity::Output, Quantity::Dt],
        memory: true,
    };

    #[inline]
    fn value(&self, state: &mut EffectState<T>, at: &Inputs<T>) -> T {
        low_pass(state, at.output, || self.share(at.dt)) - at.output
    }

    #[inline]
    fn share(&self, dt: T) -> T {
        held_share(self.tau, dt)
    }

    #[inline]
    fn value_knowing(&self, state: &mut EffectState<T>, at: &Inputs<T>, share: T) -> T {
        low_pass(state, at.output, || share) - at.output
    }
}

/// Fraction of the distance to a held input that a first-order low-pass covers in one step:
/// `1 − exp(−dt/tau)`.
#[inline]
pub(super) fn held_share<T: Real>(tau: T, dt: T) -> T {
    -(-dt / tau).exp_m1()
}

/// First-order low-pass with held samples: `level += share·(input − level)`.
#[inline]
pub(super) fn low_pass<T: Real>(
    state: &mut EffectState<T>,
    input: T,
    share: impl FnOnce() -> T,
) -> T {
    let level = match state.memory {
        None => input,
        Some([level, ..]) => saturate(level + share() * saturate(input - level)),
    };
    state.memory = Some([level, T::zero(), T::zero(), T::zero()]);
    level
}
