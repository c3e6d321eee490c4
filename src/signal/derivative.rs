//! A derivative that tolerates noise, jitter and bad samples.

use crate::error::{not_below_zero, rarely};
use crate::{Error, Real};

crate::checked::stored! {
    /// Derivative with a first-order filter.
    ///
    /// The rate `v⁺ = (tau·v + x - x_last)/(tau + dt)` is the difference quotient through a
    /// first-order lag in its backward Euler form. This form is stable for any `dt`, and `dt` may
    /// vary. The rate is zero at the first sample, so there is no derivative kick.
    ///
    /// ```
    /// use bowden::signal::{Derivative, DerivativeState};
    /// # fn main() -> Result<(), bowden::Error> {
    /// let derivative = Derivative::try_new(0.01)?; // [s]
    /// let mut state = DerivativeState::new();
    /// for k in 0..200 {
    ///     derivative.step(&mut state, 3.0 * 1e-3 * f64::from(k), 1e-3);
    /// }
    /// assert!((state.rate() - 3.0).abs() < 1e-6); // after 20 time constants
    /// # Ok(())
    /// # }
    /// ```
    pub struct Derivative<T> {
        time_constant: T,
    }
    => {
        Self::try_new(time_constant)
    }
}

crate::checked::stored! {
    /// State of a [`Derivative`]: the last good sample and the filtered rate.
    #[derive(Default)]
    pub struct DerivativeState<T> {
        last: Option<T>,
        rate: T,
    }
}

crate::checked! {
    Derivative<T>;

    /// A derivative with `time_constant >= 0` \[s\]. With a time constant of zero, there is no
    /// filter.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"time_constant"`.
    pub fn try_new(time_constant: T) {
        not_below_zero!(time_constant, "time_constant");
        Ok(Derivative { time_constant })
    }
}

impl<T: Real> Derivative<T> {
    /// The same as [`try_new`](Self::try_new), for a time constant that is already checked.
    #[inline]
    pub(crate) const fn assumed(time_constant: T) -> Self {
        Self { time_constant }
    }

    /// The filtered rate [signal unit/s] at a sample taken `dt` \[s\] after the last one.
    ///
    /// The first finite sample only starts the filter, whatever its `dt`. After that, a sample is
    /// bad if it is not finite, if `dt` is not positive and finite, or if the result overflows. A
    /// bad sample leaves the state unchanged and returns the last rate. The state does not store
    /// the time of a bad sample. Add this time to the `dt` of the next good sample, as
    /// [`Rates`](crate::signal::Rates) does. Otherwise, the computed rate of a moving signal is too
    /// large.
    #[inline]
    pub fn step(&self, state: &mut DerivativeState<T>, sample: T, dt: T) -> T {
        if sample.is_finite() {
            self.follow(state, sample, dt);
        }
        state.rate
    }

    /// The same as [`step`](Self::step), for a finite sample.
    #[inline]
    pub(crate) fn follow(&self, state: &mut DerivativeState<T>, sample: T, dt: T) {
        let Some(last) = state.last else {
            state.last = Some(sample);
            return;
        };
        if dt.positive_below_highest() {
            let rate = self.quotient(state.rate, sample - last, dt);
            if rate.is_finite() {
                state.rate = rate;
                state.last = Some(sample);
            }
        } else if dt == T::HIGHEST && state.rate.is_finite() {
            rarely();
            state.last = Some(sample);
        }
    }

    /// The filtered rate after a change of the signal by `change` in `dt > 0`. If `dt` is the
    /// highest float, which means an unknown time, the rate does not change.
    #[inline]
    pub(crate) fn after(&self, rate: T, change: T, dt: T) -> T {
        if dt < T::HIGHEST {
            self.quotient(rate, change, dt)
        } else {
            rate
        }
    }

    #[inline]
    fn quotient(&self, rate: T, change: T, dt: T) -> T {
        (self.time_constant * rate + change) / (self.time_constant + dt)
    }
}

impl<T: Real> DerivativeState<T> {
    /// Initial state, before the first sample.
    #[inline]
    pub const fn new() -> Self {
        Self {
            last: None,
            rate: T::ZERO,
        }
    }

    /// A state with the last sample `last` and the rate `rate`.
    #[cfg(kani)]
    #[inline]
    pub(crate) fn at(last: T, rate: T) -> Self {
        Self {
            last: Some(last),
            rate,
        }
    }

    /// Whether steps can lead to this state. A last sample that is not finite would hold the rate
    /// indefinitely.
    pub(crate) fn is_finite(&self) -> bool {
        self.rate.is_finite() && self.last.is_none_or(T::is_finite)
    }

    /// The filtered rate [signal unit/s].
    pub fn rate(&self) -> T {
        self.rate
    }
}
