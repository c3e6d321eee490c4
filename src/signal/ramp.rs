//! A reference with a limited rate.

use crate::error::{above_zero, not_below_zero};
use crate::signal::Compensated;
use crate::{Error, Real};

crate::checked::stored! {
    /// A reference ramp: a rate limit, followed by a first-order lag.
    ///
    /// The ramp is `r⁺ = r + clamp(wanted − r, ±rate·dt)`, and the reference is
    /// `y⁺ = y + dt/(tau + dt)·(r⁺ − y)`. With a suitable rate, a reference step does not saturate
    /// the drive.
    ///
    /// ```
    /// use bowden::signal::{Ramp, RampState};
    /// let ramp = Ramp::try_new(50.0, 0.02)?; // 50 N·m/s, corners of 20 ms
    /// let mut state = RampState::at(0.0_f32);
    /// for _ in 0..1000 {
    ///     ramp.step(&mut state, 25.0, 0.001);
    /// }
    /// assert!((state.value() - 25.0).abs() < 1e-4); // at the target after half a second
    /// # Ok::<(), bowden::Error>(())
    /// ```
    pub struct Ramp<T> {
        rate: T,
        time_constant: T,
        #[serde(default = "crate::checked::any_dt")]
        longest_dt: T,
    }
    => {
        Self::try_new(rate, time_constant)?.with_longest_dt(longest_dt)
    }
}

crate::checked::stored! {
    /// State of a [`Ramp`]: the ramp and the filtered value.
    #[derive(Default)]
    pub struct RampState<T> {
        /// A compensated sum. At 10 kHz, a plain `f32` ramp of 0.005/s would stay at 25.
        ramp: Compensated<T>,
        value: Compensated<T>,
    }
}

crate::checked! {
    Ramp<T>;

    /// A ramp of `rate > 0` \[signal unit/s\] with a lag of `time_constant >= 0` \[s\].
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"rate"` or `"time_constant"`.
    pub fn try_new(rate: T, time_constant: T) {
        above_zero!(rate, "rate");
        not_below_zero!(time_constant, "time_constant");
        let longest_dt = T::HIGHEST;
        Ok(Ramp { rate, time_constant, longest_dt })
    }

    /// Sets the longest `dt` \[s\] (default: any finite `dt`). A longer `dt` leaves the reference
    /// unchanged.
    ///
    /// Use the longest `dt` of the controller. Without this limit, a timer that wraps would move
    /// the reference to its target in one sample. The controller would reject this sample, and
    /// receive a step at the next sample.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"longest_dt"`.
    pub fn with_longest_dt[self ramp](longest_dt: T) {
        above_zero!(longest_dt, "longest_dt");
        Ok(Ramp { longest_dt, ..ramp })
    }
}

impl<T: Real> Ramp<T> {
    /// The reference \[signal unit\] `dt` \[s\] later, on its way to `wanted` \[signal unit\].
    ///
    /// The reference does not change if `wanted` is not finite, or if `dt` is not positive or is
    /// too long. The reference never overshoots a constant `wanted`. If `wanted` reverses during
    /// the ramp, the lag may overshoot it by up to `rate·time_constant`.
    #[inline]
    pub fn step(&self, state: &mut RampState<T>, wanted: T, dt: T) -> T {
        if wanted.is_finite() && dt > T::ZERO && dt <= self.longest_dt {
            let reach = self.rate * dt;
            let last = state.ramp;
            let ramp = if (wanted - last.value).abs() <= reach {
                Compensated::new(wanted)
            } else {
                let reach = if wanted > last.value { reach } else { -reach };
                towards(last, reach, wanted)
            };
            let way = dt * (ramp.value - state.value.value) / (self.time_constant + dt);
            let value = towards(state.value, way, ramp.value);
            if (ramp.carry + value.carry).is_finite() {
                *state = RampState { ramp, value };
            }
        }
        state.value()
    }
}

/// The sum plus `way`, but not past the target in spite of rounding errors.
#[inline]
fn towards<T: Real>(from: Compensated<T>, way: T, target: T) -> Compensated<T> {
    let moved = from.plus(way);
    if from.value < target {
        moved.within(from.value, target)
    } else {
        moved.within(target, from.value)
    }
}

impl<T: Real> RampState<T> {
    /// A state at rest at the given value \[signal unit\].
    pub const fn at(value: T) -> Self {
        let value = Compensated::new(value);
        Self { ramp: value, value }
    }

    /// The reference \[signal unit\].
    pub const fn value(&self) -> T {
        self.value.value
    }
}
