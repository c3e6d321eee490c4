//! The first-order low-pass.

use super::Compensated;
use crate::error::not_below_zero;
use crate::{Error, Real};

crate::checked::stored! {
    /// First-order low-pass filter.
    ///
    /// The output `y⁺ = y + dt/(tau + dt)·(x − y)` is the lag `tau·y' = x − y` in its backward
    /// Euler form. This form is stable for any `dt`, and `dt` may vary. The corner is at
    /// `1/(2π·tau)` \[Hz\], with a relative error of the order of `dt/tau`. For slow signals, the
    /// delay is tau and the gain is 1.
    ///
    /// The filter starts at rest at the first good sample, and the output then equals this sample.
    /// Except for rounding errors, the output stays within the range of the samples. The output is
    /// a compensated sum, so it reaches a constant input even in `f32`.
    ///
    /// For a second-order filter, see [`Biquad`](super::Biquad).
    ///
    /// ```
    /// use bowden::signal::{LowPass, LowPassState};
    /// let low_pass = LowPass::try_new(0.01_f32)?; // corner at 15.9 Hz
    /// let mut state = LowPassState::new();
    /// assert_eq!(low_pass.step(&mut state, 2.0, 0.001), 2.0); // no transient at the start
    /// assert_eq!(low_pass.step(&mut state, f32::NAN, 0.001), 2.0); // held
    /// for _ in 0..500 {
    ///     low_pass.step(&mut state, 5.0, 0.001);
    /// }
    /// assert_eq!(state.value(), 5.0);
    /// # Ok::<(), bowden::Error>(())
    /// ```
    pub struct LowPass<T> {
        time_constant: T,
    }
    => {
        Self::try_new(time_constant)
    }
}

crate::checked::stored! {
    /// State of a [`LowPass`]: its output, if there was a good sample.
    #[derive(Default)]
    pub struct LowPassState<T> {
        sum: Option<Compensated<T>>,
    }
}

crate::checked! {
    LowPass<T>;

    /// A low-pass with `time_constant >= 0` \[s\]. With a time constant of zero, the output equals
    /// the sample.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"time_constant"`.
    pub fn try_new(time_constant: T) {
        not_below_zero!(time_constant, "time_constant");
        Ok(LowPass { time_constant })
    }
}

impl<T: Real> LowPass<T> {
    /// The output \[signal unit\] for a sample taken `dt` \[s\] after the last one.
    ///
    /// A sample is bad if it is not finite, or if `dt` is not positive and finite. A bad sample
    /// leaves the state unchanged and returns the last output, or zero before the first good
    /// sample. If the difference between a sample and the output overflows, the filter restarts at
    /// rest at this sample.
    #[inline]
    pub fn step(&self, state: &mut LowPassState<T>, sample: T, dt: T) -> T {
        if sample.is_finite() && dt.is_finite() && dt > T::ZERO {
            *state = self.after(state, sample, dt);
        }
        state.value()
    }

    #[inline]
    fn after(&self, state: &LowPassState<T>, sample: T, dt: T) -> LowPassState<T> {
        let Some(sum) = state.sum else {
            return LowPassState::at(sample);
        };
        // The share is at most 1; two times whose sum overflows have one of zero.
        let share = dt / (self.time_constant + dt);
        let next = sum.plus(share * ((sample - sum.value) - sum.carry));
        if !(next.value.is_finite() && next.carry.is_finite()) {
            return LowPassState::at(sample);
        }
        LowPassState { sum: Some(next) }
    }
}

impl<T: Real> LowPassState<T> {
    /// A state that starts at rest at the first good sample.
    #[inline]
    pub const fn new() -> Self {
        Self { sum: None }
    }

    /// A state at rest at the given value \[signal unit\].
    #[inline]
    pub const fn at(value: T) -> Self {
        Self {
            sum: Some(Compensated::new(value)),
        }
    }

    /// A state with any numbers.
    #[cfg(kani)]
    pub(crate) fn of(value: Option<T>, carry: T) -> Self {
        Self {
            sum: value.map(|value| Compensated { value, carry }),
        }
    }

    /// The output \[signal unit\]; zero before the first good sample.
    pub fn value(&self) -> T {
        self.sum.map_or(T::ZERO, |sum| sum.value)
    }
}
