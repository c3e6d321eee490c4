//! Plausibility check of a sensor: range, rate of change and stuck value.

use super::gap::gap_after;
use crate::error::{above_zero, ordered};
use crate::{Error, Real};

crate::checked::stored! {
    /// Plausibility check of a sensor: range, rate of change and stuck value.
    ///
    /// A controller rejects NaN, but cannot detect a finite reading that is wrong. Examples are an
    /// encoder that was reset, a shorted strain-gauge bridge, and a bus that repeats its last
    /// frame. Use a `Plausible` upstream of each input of the controller. It replaces an
    /// implausible sample with NaN, so the controller holds its command and counts a bad sample.
    ///
    /// ```
    /// use bowden::signal::{Implausible, Plausible, PlausibleState};
    /// // Acceleration of the pulley [rad/s²]: ±500, and at most 2e5 rad/s³.
    /// let plausible = Plausible::try_new(-500.0, 500.0)?.with_rate(2e5)?.with_stuck_after(50);
    /// let mut state = PlausibleState::new();
    /// assert_eq!(plausible.step(&mut state, 3.0, 0.001, true).value, 3.0);
    ///
    /// let spike = plausible.step(&mut state, 6e5_f32, 0.001, true); // the encoder was reset
    /// assert_eq!(spike.fault, Some(Implausible::OutOfRange));
    /// assert!(spike.value.is_nan());
    /// # Ok::<(), bowden::Error>(())
    /// ```
    pub struct Plausible<T> {
        low: T,
        high: T,
        rate: Option<T>,
        sample_period: Option<T>,
        #[serde(default)]
        stuck_after: u32,
        #[serde(default = "crate::checked::any_dt")]
        longest_dt: T,
    }
    => {
        let range = Self::try_new(low, high)?
            .with_stuck_after(stuck_after)
            .with_longest_dt(longest_dt)?;
        let rated = rate.map_or(Ok(range), |rate| range.with_rate(rate))?;
        let period = sample_period;
        period.map_or(Ok(rated), |period| rated.with_sample_period(period))
    }
}

crate::data! {
    /// The reason why a sample is implausible.
    #[derive(Eq, Hash)]
    #[non_exhaustive]
    pub enum Implausible {
        /// The sample is NaN or infinite.
        NotFinite,
        /// The sample lies outside the range.
        OutOfRange,
        /// The difference from the last plausible sample is larger than the rate allows.
        TooFast,
        /// The value has been the same for too long while the machine moved.
        Stuck,
    }
}

/// Result of the check of a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PlausibleOutput<T> {
    /// The sample if it is plausible, otherwise NaN.
    pub value: T,
    /// The reason, if the sample is implausible.
    pub fault: Option<Implausible>,
}

crate::checked::stored! {
    /// State of a [`Plausible`]: the last plausible sample and its age.
    #[derive(Default)]
    pub struct PlausibleState<T> {
        last: Option<T>,
        /// Time from the measurement of `last` to the last checked sample \[s\].
        gap: T,
        same: u32,
    }
}

crate::checked! {
    Plausible<T>;

    /// A check that accepts samples within `low..=high` \[signal unit\], at any rate of change.
    ///
    /// # Errors
    /// [`Error::NonFinite`] with `"low"` or `"high"`; [`Error::Inadmissible`] unless
    /// `low < high`.
    pub fn try_new(low: T, high: T) {
        ordered!(low, high);
        let (rate, sample_period, stuck_after, longest_dt) = (None, None, 0, T::HIGHEST);
        Ok(Plausible { low, high, rate, sample_period, stuck_after, longest_dt })
    }

    /// Sets the largest rate of change `rate` \[signal unit/s\], which must be positive.
    ///
    /// For an angle that wraps around, a rate limit would reject each wrap. Instead, check the
    /// range of the velocity from [`Rates`](crate::signal::Rates) with its period.
    ///
    /// A sensor may be slower than the loop, so a repeated reading is treated as the same
    /// measurement. The next reading may differ by `rate` times the time since the last *change*.
    ///
    /// After a reading has repeated for `t` seconds, the check also accepts a spike of up to
    /// `rate·(t + dt)`. It then rejects the true reading for the time `distance/rate`, where
    /// `distance` is the height of the spike. [`with_sample_period`](Self::with_sample_period)
    /// bounds the spike and this time. Use this setting for a sensor that is not synchronous with
    /// the loop, or whose readings repeat while the signal is constant, such as an encoder.
    ///
    /// While the check rejects samples, the permitted difference grows with time. If the signal has
    /// in fact jumped, the check accepts the new value after the time `distance/rate`, rounded up
    /// to the next sample. Here, `distance` is the height of the jump. The same applies to the new
    /// position of an encoder that was reset. [`Rates`](crate::signal::Rates) downstream of the
    /// check then gives a velocity of up to `rate`.
    /// [`Compensator::with_ranges`](crate::control::Compensator::with_ranges) prevents a
    /// feed-forward from using this velocity.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"rate"`.
    pub fn with_rate[self sensor](rate: T) {
        above_zero!(rate, "rate");
        let rate = Some(rate);
        Ok(Plausible { rate, ..sensor })
    }

    /// Sets the longest sampling period of the sensor, `sample_period` \[s\].
    ///
    /// Include the jitter of the sensor and its bus in this period. The check then assumes that
    /// every reading is at most this old, and the next reading may differ by
    /// `rate·(sample_period + dt)`. The same difference is the largest spike that the check accepts
    /// directly after a plausible sample. This difference depends neither on the number of
    /// repetitions nor on the phase between sensor and loop. Without a rate limit, this setting has
    /// no effect.
    ///
    /// ```
    /// use bowden::signal::{Implausible, Plausible, PlausibleState};
    /// // 50 N·m/s, read at 1 kHz from a sensor of 100 Hz.
    /// let plausible = Plausible::try_new(-100.0, 100.0)?.with_rate(50.0)?.with_sample_period(0.01)?;
    /// let mut state = PlausibleState::new();
    /// for _ in 0..1000 {
    ///     plausible.step(&mut state, 3.0_f64, 0.001, false); // at rest for a second
    /// }
    /// let spike = plausible.step(&mut state, 4.0, 0.001, false);
    /// assert_eq!(spike.fault, Some(Implausible::TooFast)); // more than 50·0.011
    /// # Ok::<(), bowden::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"sample_period"`.
    pub fn with_sample_period[self sensor](sample_period: T) {
        above_zero!(sample_period, "sample_period");
        let sample_period = Some(sample_period);
        Ok(Plausible { sample_period, ..sensor })
    }

    /// Sets the longest `dt` \[s\], which replaces a longer or unusable `dt`.
    ///
    /// A timer that wraps may report a negative `dt`, or a `dt` of an hour. Without this setting,
    /// the check would then accept one spike anywhere in the range, and reject the true samples
    /// after it.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"longest_dt"`.
    pub fn with_longest_dt[self sensor](longest_dt: T) {
        above_zero!(longest_dt, "longest_dt");
        Ok(Plausible { longest_dt, ..sensor })
    }
}

impl<T: Real> Plausible<T> {
    /// Sets the number of repetitions `samples` after which a reading is rejected, because the
    /// sensor may be stuck. A value of 0 disables this rule.
    ///
    /// The check then rejects each sample until the reading changes. If this prevents the machine
    /// from moving, start with a new [`PlausibleState`].
    ///
    /// The check counts repetitions only while the machine moves. A coarse encoder repeats its
    /// reading at low speed, so `samples` must be larger than the number of samples per count at
    /// that speed.
    #[must_use]
    pub const fn with_stuck_after(self, samples: u32) -> Self {
        Self {
            stuck_after: samples,
            ..self
        }
    }

    /// Checks a sample taken `dt` \[s\] after the previous one.
    ///
    /// Set `moves` to `true` if the machine moves, so that the signal must change. Indications are
    /// a change in the command or in another sensor.
    ///
    /// A `dt` of zero adds no time. With a rate limit and without a sample period, the sample after
    /// a change must then have the same value. The longest `dt` (see
    /// [`with_longest_dt`](Self::with_longest_dt)) replaces a `dt` that is negative, NaN or
    /// infinite. Without that setting, the time is unknown, and any sample in the range is
    /// plausible until the reading changes. A sample that is not finite is never plausible.
    #[inline]
    pub fn step(
        &self,
        state: &mut PlausibleState<T>,
        sample: T,
        dt: T,
        moves: bool,
    ) -> PlausibleOutput<T> {
        // Written so that NaN is not within the range.
        let dt = if dt >= T::ZERO && dt <= self.longest_dt {
            dt
        } else {
            self.longest_dt
        };
        let mut elapsed = gap_after(state.gap, dt, T::HIGHEST);
        if elapsed == state.gap && dt > T::ZERO {
            // So long that `dt` no longer changes it, in `f32` after 2²⁴ samples: long enough.
            elapsed = T::HIGHEST;
        }
        let fault = self.fault(state, sample, elapsed, moves);
        match fault {
            None => {
                let repeats = state.last == Some(sample);
                state.gap = match self.sample_period {
                    Some(longest) => longest,
                    None if repeats => elapsed,
                    None => T::ZERO,
                };
                state.last = Some(sample);
                let value = sample;
                PlausibleOutput { value, fault }
            }
            Some(_) => {
                state.gap = elapsed;
                let value = T::nan();
                PlausibleOutput { value, fault }
            }
        }
    }

    #[inline]
    fn fault(
        &self,
        state: &mut PlausibleState<T>,
        sample: T,
        elapsed: T,
        moves: bool,
    ) -> Option<Implausible> {
        if !sample.is_finite() {
            return Some(Implausible::NotFinite);
        }
        if sample < self.low || sample > self.high {
            return Some(Implausible::OutOfRange);
        }
        let last = state.last?;
        if let Some(rate) = self.rate {
            // Written so that an overflow of the distance is too fast.
            if (sample - last).abs() > rate * elapsed {
                return Some(Implausible::TooFast);
            }
        }
        if sample != last {
            state.same = 0;
        } else if moves {
            state.same = state.same.saturating_add(1);
        }
        let stuck = self.stuck_after > 0 && state.same >= self.stuck_after;
        stuck.then_some(Implausible::Stuck)
    }
}

impl<T: Real> PlausibleState<T> {
    /// Initial state. The first sample may lie anywhere in the range.
    pub const fn new() -> Self {
        Self {
            last: None,
            gap: T::ZERO,
            same: 0,
        }
    }

    /// A state with any numbers.
    #[cfg(kani)]
    pub(crate) const fn of(last: Option<T>, gap: T, same: u32) -> Self {
        Self { last, gap, same }
    }

    /// The last plausible sample \[signal unit\], or `None` before the first one.
    pub const fn last(&self) -> Option<T> {
        self.last
    }
}
