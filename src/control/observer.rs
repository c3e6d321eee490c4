//! Disturbance observer: estimates and compensates friction, load and a gain error.
//!
//! ```text
//! P(s)  = alpha/(s²/wn² + 2·zeta·s/wn + 1)      the nominal plant, without friction
//! Q(s)  = 1/(tau·s + 1)²
//! d_hat = Q·u_sent − Q·P⁻¹·y                    added to the next command
//! ```
//!
//! The observer compares the applied command with the command that the nominal plant needs for the
//! measured output. The difference, filtered through Q, is added to the next command. At
//! frequencies below `1/tau`, the loop then behaves as if it contained the nominal plant, unless a
//! limit is active.
//!
//! Take alpha, wn and zeta from the drive's specification or from a bench record.
//!
//! Add the estimate to a controller's `feed_forward`. For any input, the estimate stays within the
//! limit of the observer. You can also add the command of the nominal plant for the reference
//! ([`NominalPlant::feed_forward`]). Do not also add the command of a
//! [`Compensator`](super::Compensator). Otherwise the friction is compensated twice.
//!
//! Source: T. Umeno, Y. Hori, "Robust speed control of DC servomotors using modern two
//! degrees-of-freedom controller design", *IEEE Trans. Industrial Electronics* 38(5), 1991.

use super::{Fault, Output, Status};
use crate::error::{above_zero, is_usable, not_below_zero, rarely};
use crate::fault::{fault_of_dt, unless_finite};
use crate::signal::{clamp, confined, gap_after};
use crate::{Error, Real};

mod plant;
mod state;

pub use plant::NominalPlant;
pub use state::ObserverState;
use state::{lag, Lags};

#[cfg(kani)]
#[path = "../../proofs/observer.rs"]
mod proofs;

crate::checked::stored! {
    /// A disturbance observer: nominal plant, filter, latency, and limit of the estimate.
    ///
    /// Both lags of Q have the implicit form of [`Derivative`](crate::signal::Derivative), with
    /// `s = h/(tau + h)`. The lag for the latency L has the factor `min(h/L, 1)`. Here h is the
    /// time since the last good sample:
    ///
    /// ```text
    /// w0⁺ = w0 + min(h/L, 1)·(u_sent − w0)    w1⁺ = w1 + s·(w0⁺ − w1)    w2⁺ = w2 + s·(w1⁺ − w2)
    ///                                         z1⁺ = z1 + s·(y − z1)      z2⁺ = z2 + s·(z1⁺ − z2)
    /// d_hat = w2⁺ − (z2⁺ + 2·zeta/(wn·tau)·(z1⁺ − z2⁺) + (y − 2·z1⁺ + z2⁺)/(wn·tau)²)/alpha
    /// ```
    /// The lags are stable for any `dt`, and `dt` may vary. However, the closed loop requires a
    /// `dt` well below tau. Even with zero latency, the command affects the output only at the next
    /// sample. At frequencies above `1/tau`, white noise on y appears in the command, multiplied by
    /// about `1/(alpha·(wn·tau)²)`.
    ///
    /// ```
    /// use bowden::control::{
    ///     DisturbanceObserver, Fallback, Limits, NominalPlant, ObserverInput, ObserverState, Pid,
    ///     PidInput, PidSettings, PidState,
    /// };
    /// # fn main() -> Result<(), bowden::Error> {
    /// let plant = NominalPlant::try_new(0.6_f32, 25.5, 0.265)?;
    /// // Q of 10 Hz; at most 30 units; a sample within 5 ms; a latency of 3 ms.
    /// let observer = DisturbanceObserver::try_new(plant, 0.0159, 30.0, 0.005)?.with_latency(0.003)?;
    /// let (limits, fallback) = (Limits::try_new(-20.0, 90.0)?, Fallback::try_new(20, 0.0)?);
    /// let pi = Pid::try_new(PidSettings::new(12.0, 60.0, limits, 0.005, fallback))?;
    ///
    /// let (mut observed, mut state) = (ObserverState::new(), PidState::new());
    /// let (dt, measured) = (0.001, 3.0); // [s], [N·m]: each tick, from the clock and the sensor
    /// let sent = state.command(); // the applied command of the last tick
    /// let seen = observer.step(&mut observed, &ObserverInput { dt, sent, measured });
    /// let sample = PidInput { feed_forward: seen.command, ..PidInput::new(dt, 5.0, measured) };
    /// let out = pi.step(&mut state, &sample);
    /// assert!(limits.contains(out.command));
    /// # Ok(())
    /// # }
    /// ```
    pub struct DisturbanceObserver<T> {
        plant: NominalPlant<T>,
        time_constant: T,
        limit: T,
        longest_dt: T,
        #[serde(default = "T::zero")]
        latency: T,
        /// Q·P⁻¹ of z2, of z1 − z2 and of y − 2·z1 + z2.
        #[serde(skip)]
        inverse: [T; 3],
    }
    => {
        Self::try_new(plant, time_constant, limit, longest_dt)?
            .with_latency(latency)
    }
}

/// One sample for a [`DisturbanceObserver`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ObserverInput<T> {
    /// Time since the last call \[s\], even if the sample of that call was bad.
    pub dt: T,
    /// The applied command of the last call \[command unit\], after all limits. It may be a held or
    /// safe command.
    pub sent: T,
    /// Measured output y \[output unit\], such as \[N·m\].
    pub measured: T,
}

crate::checked! {
    DisturbanceObserver<T>;

    /// An observer without latency. `time_constant > 0` is tau of Q \[s\], and `limit > 0` bounds
    /// the magnitude of the estimate \[command unit\]. A `dt` above `longest_dt > 0` \[s\] is a bad
    /// sample.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"time_constant"`, `"limit"` or
    /// `"longest_dt"`. A `time_constant` is also out of range if `1/(alpha·(wn·tau)²)` or
    /// `2·zeta/(alpha·wn·tau)` is not finite.
    pub fn try_new(plant: NominalPlant<T>, time_constant: T, limit: T, longest_dt: T) {
        above_zero!(time_constant, "time_constant");
        let product = plant.natural_frequency() * time_constant;
        let position = T::ONE / plant.gain();
        let curvature = (position / product) / product;
        let rate = (plant.damping_ratio() + plant.damping_ratio()) * (position / product);
        if !(rate + curvature).is_finite() {
            return Err(Error::OutOfRange("time_constant"));
        }
        above_zero!(limit, "limit");
        above_zero!(longest_dt, "longest_dt");
        let (latency, inverse) = (T::ZERO, [position, rate, curvature]);
        Ok(DisturbanceObserver { plant, time_constant, limit, longest_dt, latency, inverse })
    }

    /// Sets the latency \[s\] from a command to its effect on the measured output. The latency must
    /// not be negative.
    ///
    /// The latency is the sum of the whole-sample delays, half a sample for the zero-order hold,
    /// and the lags of drive and sensor. The response of the nominal plant is not included.
    ///
    /// Before the comparison, the observer passes the command through a first-order lag whose time
    /// constant is the latency.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"latency"`.
    pub fn with_latency[self observer](latency: T) {
        not_below_zero!(latency, "latency");
        Ok(DisturbanceObserver { latency, ..observer })
    }
}

impl<T: Real> DisturbanceObserver<T> {
    /// The nominal plant.
    pub const fn plant(&self) -> &NominalPlant<T> {
        &self.plant
    }

    /// tau of Q \[s\].
    pub const fn time_constant(&self) -> T {
        self.time_constant
    }

    /// Largest magnitude of the estimate \[command unit\].
    pub const fn limit(&self) -> T {
        self.limit
    }

    /// Longest `dt` of a good sample \[s\].
    pub const fn longest_dt(&self) -> T {
        self.longest_dt
    }

    /// Time from a command to its effect on the measured output \[s\].
    pub const fn latency(&self) -> T {
        self.latency
    }

    /// Processes one sample and returns the estimate to add to the next command.
    ///
    /// Call this method at every sample, before the controller. A sample is bad if `dt` is not
    /// positive or too long, or if the command or the output is not finite. After a bad sample, the
    /// estimate is held, and the `dt` of this sample is added to the next `dt`. If the `dt` of the
    /// bad sample is itself invalid, the next `dt` is counted twice. If the estimate overflows, it
    /// is held, and the lags restart at the next good sample. For any state, the estimate is finite
    /// and within ±limit.
    #[inline]
    pub fn step(&self, state: &mut ObserverState<T>, at: &ObserverInput<T>) -> Output<T> {
        let status = if self.advance(state, at) {
            Status::Good
        } else {
            rarely();
            Status::Held(self.refused(state, at))
        };
        state.estimate = confined(state.estimate, -self.limit, self.limit);
        let command = state.estimate;
        Output { command, status }
    }

    /// Advances the state by a good sample. `false` leaves the state unchanged: a number cannot
    /// be used, or the estimate overflows.
    #[inline]
    #[allow(clippy::eq_op)]
    fn advance(&self, state: &mut ObserverState<T>, at: &ObserverInput<T>) -> bool {
        // A number minus itself is zero, or NaN if it is not finite.
        let zero = (at.sent - at.sent) + (at.measured - at.measured);
        if !(at.dt.positive_up_to(self.longest_dt) && zero == T::ZERO) {
            return false;
        }
        let gap = match state.gap == T::HIGHEST {
            true => at.dt,
            false => state.gap,
        };
        let h = clamp(gap + at.dt, T::ZERO, T::HIGHEST);
        let now = state.lags.unwrap_or(Lags::at(at.sent, at.measured));
        let moved = self.moved(&now, at, h);
        let estimate = self.estimate(&moved, at.measured);
        if !is_usable(estimate + moved.sum()) {
            return false;
        }
        state.lags = Some(moved);
        state.estimate = estimate;
        state.gap = T::ZERO;
        true
    }

    /// The fault of a sample. If its numbers are good, the lags overflow and restart at the next
    /// sample.
    fn refused(&self, state: &mut ObserverState<T>, at: &ObserverInput<T>) -> Fault {
        let fault = fault_of_dt(at.dt, self.longest_dt)
            .or_else(|| unless_finite(at.sent, Fault::Command))
            .or_else(|| unless_finite(at.measured, Fault::Measured));
        match fault {
            Some(fault) => {
                state.gap = gap_after(state.gap, at.dt, self.longest_dt);
                fault
            }
            None => {
                *state = ObserverState {
                    estimate: state.estimate,
                    ..ObserverState::new()
                };
                Fault::Overflow
            }
        }
    }

    #[inline]
    fn moved(&self, now: &Lags<T>, at: &ObserverInput<T>, h: T) -> Lags<T> {
        let share = h / (self.time_constant + h);
        let at_once = match h < self.latency {
            true => h / self.latency,
            false => T::ONE,
        };
        let ([w0, w1, w2], [z1, z2]) = (now.sent, now.measured);
        let w0 = lag(w0, at.sent, at_once);
        let w1 = lag(w1, w0.value, share);
        let w2 = lag(w2, w1.value, share);
        let z1 = lag(z1, at.measured, share);
        let z2 = lag(z2, z1.value, share);
        Lags {
            sent: [w0, w1, w2],
            measured: [z1, z2],
        }
    }

    fn estimate(&self, lags: &Lags<T>, measured: T) -> T {
        let ([_, _, w2], [z1, z2]) = (lags.sent, lags.measured);
        let [position, rate, curvature] = self.inverse;
        let fall = z1.value - z2.value;
        let bend = (measured - z1.value) - fall;
        w2.value - (position * z2.value + rate * fall + curvature * bend)
    }
}
