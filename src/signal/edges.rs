//! Velocity of a slow encoder from the time between its counts.

use super::{clamp, RateStatus};
use crate::error::above_zero;
use crate::fault::{fault_of_dt, Fault};
use crate::{Error, Real};

crate::checked::stored! {
    /// Velocity from the time between counts (period measurement or M/T method).
    ///
    /// If a counter changes less than once per sample, its difference quotient is either zero or
    /// one count per `dt`. Instead, this type divides the number M of counts by the time T between
    /// two samples with counts. T is known to within one `dt`:
    ///
    /// ```text
    /// v⁺ = v + (1 − e^(−T/tau))·(M·count/T − v)   at a sample with counts
    /// |v| ≤ count/(time since the last count)     at every other sample
    /// ```
    /// * **Error**: at a constant speed of `f` counts per second, the relative error is at most
    ///   `f·dt/(1 − f·dt)` if `f·dt < 1` (at least one sample per count). At any speed, it is at
    ///   most `dt/tau·min(1, 1/(f·dt))`.
    /// * **Delay**: at a count, the velocity follows slow changes with a delay of
    ///   `T·(1/2 + q/(1 − q))`, where `q = e^(−T/tau)`. This delay is about `T/2` at low speed and
    ///   tau at high speed. The velocity is held until the next count, which adds `T/2` on average.
    /// * **Stop**: without a count, the bound on the velocity falls with time. After `longest_gap`
    ///   without a count, the velocity is zero and the status is [`RateStatus::Stopped`]. A speed
    ///   below `count/longest_gap` is therefore reported as a stop. In `f32`, `longest_gap` must be
    ///   less than 2²⁴ samples, because a longer time no longer grows by `dt`.
    /// * **Reversal**: after a reversal, the first count passes the same encoder line as the
    ///   previous count. The axis has therefore moved by one count less. Dither of one count gives
    ///   zero velocity.
    /// * **Start**: the first count only locates an encoder line. The second count gives the first
    ///   velocity.
    /// * **Bad samples**: a bad sample does not change the velocity, but T includes its `dt`. After
    ///   a `dt` that is negative or not finite, the time is unknown, and the next count starts a
    ///   new interval.
    ///
    /// Source: T. Ohmae et al., *A microprocessor-controlled high-accuracy wide-range speed
    /// regulator for motor drives*, IEEE Trans. Ind. Electron. 29 (1982) 207-211 (M/T method).
    ///
    /// Use [`Rates`](super::Rates) for positions that change in every sample.
    ///
    /// ```
    /// use bowden::signal::{RateStatus, EdgeVelocity, EdgeVelocityState};
    /// // A 12-bit counter, averaged over 10 ms; stopped after 0.2 s: speeds above 5 counts/s.
    /// let velocity = EdgeVelocity::try_new(1.0, 0.01, 0.2)?.with_period(4096.0)?;
    /// let mut state = EdgeVelocityState::new();
    /// for k in 0..1000_u32 {
    ///     let counter = (4090 + k / 50) % 4096; // 20 counts/s in a loop of 1 kHz
    ///     velocity.step(&mut state, counter as f32, 0.001);
    /// }
    /// assert!((state.velocity() - 20.0).abs() < 0.001);
    /// for _ in 0..201 {
    ///     velocity.step(&mut state, 13.0, 0.001);
    /// }
    /// let out = velocity.step(&mut state, 13.0, 0.001);
    /// assert_eq!((out.velocity, out.status), (0.0, RateStatus::Stopped));
    /// # Ok::<(), bowden::Error>(())
    /// ```
    pub struct EdgeVelocity<T> {
        count: T,
        time_constant: T,
        longest_gap: T,
        period: Option<T>,
    }
    => {
        let edges = Self::try_new(count, time_constant, longest_gap)?;
        period.map_or(Ok(edges), |period| edges.with_period(period))
    }
}

crate::data! {
    /// Output of an [`EdgeVelocity`]'s step.
    pub struct EdgeVelocityOutput<T> {
        /// The velocity \[channel unit/s\]: finite, and zero until the position has changed twice.
        pub velocity: T,
        /// Validity of the velocity.
        pub status: RateStatus,
    }
}

crate::checked::stored! {
    /// State of an [`EdgeVelocity`]: the last position, the last count and the velocity.
    #[derive(Default)]
    pub struct EdgeVelocityState<T> {
        last: Option<T>,
        /// Whether the last count increased the position; `None` before the first count.
        went_up: Option<bool>,
        /// Known time since the last count.
        gap: T,
        /// Whether an additional unknown time has passed.
        time_unknown: bool,
        velocity: Option<T>,
    }
}

crate::checked! {
    EdgeVelocity<T>;

    /// Velocity from positions that change by multiples of `count` \[channel unit\].
    ///
    /// The velocity is averaged over `time_constant` \[s\] if several counts occur in this time. If
    /// no count occurs for `longest_gap` \[s\], the axis is regarded as stopped. All three
    /// arguments must be positive.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"count"`, `"time_constant"` or
    /// `"longest_gap"`.
    pub fn try_new(count: T, time_constant: T, longest_gap: T) {
        above_zero!(count, "count");
        above_zero!(time_constant, "time_constant");
        above_zero!(longest_gap, "longest_gap");
        let period = None;
        Ok(EdgeVelocity { count, time_constant, longest_gap, period })
    }

    /// Sets the period \[channel unit\] of positions that wrap, such as counter readings. The
    /// period must be positive.
    ///
    /// Between two good samples, the axis must move by less than half a period.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"period"`.
    pub fn with_period[self edges](period: T) {
        above_zero!(period, "period");
        let period = Some(period);
        Ok(EdgeVelocity { period, ..edges })
    }
}

impl<T: Real> EdgeVelocity<T> {
    /// The velocity \[channel unit/s\] at a `position` \[channel unit\] measured `dt` \[s\] after
    /// the last call.
    ///
    /// `dt` is the time since the last call, even if the last sample was bad. If the difference
    /// from the last position overflows, the measurement restarts.
    #[inline]
    pub fn step(
        &self,
        state: &mut EdgeVelocityState<T>,
        position: T,
        dt: T,
    ) -> EdgeVelocityOutput<T> {
        let status = self.advance(state, position, dt);
        EdgeVelocityOutput {
            velocity: state.velocity(),
            status,
        }
    }

    #[inline]
    fn advance(&self, state: &mut EdgeVelocityState<T>, position: T, dt: T) -> RateStatus {
        if !dt.is_finite() || dt <= T::ZERO {
            state.time_unknown |= dt != T::ZERO;
            return RateStatus::Held(fault_of_dt(dt, T::HIGHEST).unwrap_or(Fault::Dt));
        }
        // At least dt, also where a stored gap was negative.
        state.gap = clamp(state.gap + dt, dt, T::HIGHEST);
        if !position.is_finite() {
            return RateStatus::Held(Fault::Position);
        }
        let moved = state.last.map(|last| self.moved(position - last));
        match moved {
            Some(moved) if moved == T::ZERO => self.without_count(state),
            Some(moved) if moved.is_finite() => {
                let known = self.at_count(state, moved);
                state.last = Some(position);
                known
            }
            _ => {
                *state = EdgeVelocityState {
                    last: Some(position),
                    ..EdgeVelocityState::new()
                };
                RateStatus::Settling
            }
        }
    }

    /// No count: the bound on the velocity falls until the axis counts as stopped.
    #[inline]
    fn without_count(&self, state: &mut EdgeVelocityState<T>) -> RateStatus {
        if state.gap > self.longest_gap {
            state.velocity = state.velocity.map(|_| T::ZERO);
            return RateStatus::Stopped;
        }
        let bound = self.count / state.gap;
        state.velocity = state
            .velocity
            .map(|velocity| clamp(velocity, -bound, bound));
        state.known()
    }

    /// One or more counts with the total change `moved`.
    #[inline]
    fn at_count(&self, state: &mut EdgeVelocityState<T>, moved: T) -> RateStatus {
        let goes_up = moved > T::ZERO;
        let (before, time) = (state.went_up, state.gap);
        let is_start = before.is_none() || state.time_unknown;
        state.went_up = Some(goes_up);
        state.gap = T::ZERO;
        state.time_unknown = false;
        if is_start {
            return RateStatus::Settling;
        }
        // Between the lines of the encoder: a reversal passes one of them twice.
        let way = if before == Some(goes_up) {
            moved
        } else {
            moved - clamp(moved, -self.count, self.count)
        };
        let quotient = clamp(way / time, T::LOWEST, T::HIGHEST);
        let share = -(-time / self.time_constant).exp_m1();
        state.velocity = Some(match state.velocity {
            // Two products instead of share·(quotient - velocity), which could overflow.
            Some(velocity) => clamp(
                (T::ONE - share) * velocity + share * quotient,
                T::LOWEST,
                T::HIGHEST,
            ),
            None => quotient,
        });
        RateStatus::Good
    }

    /// The shortest difference of two positions modulo the period.
    #[inline]
    fn moved(&self, difference: T) -> T {
        match self.period {
            Some(period) if difference.abs() > period * T::from_f64(0.5) => {
                difference - (difference / period).round() * period
            }
            _ => difference,
        }
    }
}

impl<T: Real> EdgeVelocityState<T> {
    /// Initial state, before the first sample.
    #[inline]
    pub const fn new() -> Self {
        Self {
            last: None,
            went_up: None,
            gap: T::ZERO,
            time_unknown: false,
            velocity: None,
        }
    }

    /// A state with any numbers.
    #[cfg(kani)]
    pub(crate) const fn of(
        [last, velocity]: [Option<T>; 2],
        went_up: Option<bool>,
        (gap, time_unknown): (T, bool),
    ) -> Self {
        Self {
            last,
            went_up,
            gap,
            time_unknown,
            velocity,
        }
    }

    /// The velocity \[channel unit/s\]; zero until the position has changed twice.
    pub fn velocity(&self) -> T {
        self.velocity.unwrap_or(T::ZERO)
    }

    #[inline]
    fn known(&self) -> RateStatus {
        if self.velocity.is_some() && !self.time_unknown {
            RateStatus::Good
        } else {
            RateStatus::Settling
        }
    }
}
