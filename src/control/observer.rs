//! A disturbance observer: what friction, load and a wrong gain take from the command.
//!
//! ```text
//! P(s)  = alpha/(s²/wn² + 2·zeta·s/wn + 1)      the nominal plant, without friction
//! Q(s)  = 1/(tau·s + 1)²
//! d_hat = Q·u_sent − Q·P⁻¹·y                    added to the next command
//! ```
//!
//! What the nominal plant would have needed for the measured output is compared with the
//! command that went out; the difference, through Q, is what something else took, and is
//! added to the next command. Below `1/tau` the loop around it then meets the nominal plant in
//! place of the one with friction, as long as no limit is met. It needs no model of the friction; it
//! does need alpha, wn and zeta, from a data sheet or a bench record. The adaptive law needs none of
//! these.
//!
//! It is a block in front of a controller's `feed_forward`, and bounded by its own limit
//! whatever comes in. Beside it belongs the nominal plant's own inverse along the
//! reference ([`NominalPlant::feed_forward`]), not an identified model's
//! ([`Compensator`](super::Compensator)): both would compensate the friction.
//!
//! Source: T. Umeno, Y. Hori, "Robust speed control of DC servomotors using modern two
//! degrees-of-freedom controller design", *IEEE Trans. Industrial Electronics* 38(5), 1991.

use super::status::{fault_of_dt, unless_finite};
use super::{Fault, Status};
use crate::error::{above_zero, is_usable, not_below_zero, rarely};
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

/// The observer: nominal plant, filter, latency, and the limit of what it may add.
///
/// With `s = dt/(tau + dt)` for both lags of Q, in the implicit form of
/// [`Derivative`](crate::signal::Derivative), and `h/L` for the latency L:
///
/// ```text
/// w0⁺ = w0 + min(h/L, 1)·(u_sent − w0)    w1⁺ = w1 + s·(w0⁺ − w1)    w2⁺ = w2 + s·(w1⁺ − w2)
///                                         z1⁺ = z1 + s·(y − z1)      z2⁺ = z2 + s·(z1⁺ − z2)
/// d_hat = w2⁺ − (z2⁺ + 2·zeta/(wn·tau)·(z1⁺ − z2⁺) + (y − 2·z1⁺ + z2⁺)/(wn·tau)²)/alpha
/// ```
/// The lags are stable at any `dt`, which may vary; the loop around them needs one well below tau.
/// Without a latency the command still shows a sample later. White noise of y reaches the command
/// as about `1/(alpha·(wn·tau)²)` of itself, above `1/tau`.
///
/// ```
/// use bowden::control::{
///     Controller, DisturbanceObserver, Fallback, Limits, LoopSample, NominalPlant, ObserverInput,
///     ObserverState, Pid, PidSettings,
/// };
/// # fn main() -> Result<(), bowden::Error> {
/// let plant = NominalPlant::try_new(0.6_f32, 25.5, 0.265)?;
/// // Q of 10 Hz; at most 30 units; a sample within 5 ms; a command shows 3 ms later.
/// let observer = DisturbanceObserver::try_new(plant, 0.0159, 30.0, 0.005)?.with_latency(0.003)?;
/// let (limits, fallback) = (Limits::try_new(-20.0, 90.0)?, Fallback::try_new(20, 0.0)?);
/// let pi = Pid::try_new(PidSettings::new(12.0, 60.0, limits, 0.005, fallback))?;
///
/// let (mut observed, mut state) = (ObserverState::new(), pi.start());
/// let (dt, measured) = (0.001, 3.0); // [s], [N·m]: each tick, from the clock and the sensor
/// let sent = Controller::command(&pi, &state); // what went out at the last tick
/// let seen = observer.step(&mut observed, &ObserverInput { dt, sent, measured });
/// let sample = LoopSample { feed_forward: seen.estimate, ..LoopSample::new(dt, 5.0, measured) };
/// let out = Controller::step(&pi, &mut state, &sample);
/// assert!(limits.contains(out.command));
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        try_from = "Unchecked<T>",
        bound(
            serialize = "T: Real + serde::Serialize",
            deserialize = "T: Real + serde::Deserialize<'de>"
        )
    )
)]
pub struct DisturbanceObserver<T> {
    plant: NominalPlant<T>,
    time_constant: T,
    limit: T,
    longest_dt: T,
    latency: T,
    /// Q·P⁻¹ of z2, of z1 − z2 and of y − 2·z1 + z2.
    #[cfg_attr(feature = "serde", serde(skip))]
    inverse: [T; 3],
}

/// The observer's numbers after their checks, for any float and for constants.
macro_rules! observer {
    ($plant:ident, $tau:ident, $limit:ident, $longest:ident, $zero:expr, $one:expr) => {{
        above_zero!($tau, $zero, "time_constant");
        let product = $plant.natural_frequency() * $tau;
        let position = $one / $plant.gain();
        let curvature = (position / product) / product;
        let rate = ($plant.damping_ratio() + $plant.damping_ratio()) * (position / product);
        if !(rate + curvature).is_finite() {
            return Err(Error::OutOfRange("time_constant"));
        }
        above_zero!($limit, $zero, "limit");
        above_zero!($longest, $zero, "longest_dt");
        Ok(Self {
            plant: $plant,
            time_constant: $tau,
            limit: $limit,
            longest_dt: $longest,
            latency: $zero,
            inverse: [position, rate, curvature],
        })
    }};
}

/// A latency after its check, likewise.
macro_rules! latency {
    ($observer:ident, $latency:ident, $zero:expr) => {{
        not_below_zero!($latency, $zero, "latency");
        Ok(Self {
            latency: $latency,
            ..$observer
        })
    }};
}

macro_rules! constant {
    ($float:ty) => {
        impl DisturbanceObserver<$float> {
            /// [`try_new`](Self::try_new) at compile time, see [`constant!`](crate::constant).
            ///
            /// # Errors
            /// As [`try_new`](Self::try_new).
            pub const fn const_new(
                plant: NominalPlant<$float>,
                time_constant: $float,
                limit: $float,
                longest_dt: $float,
            ) -> Result<Self, Error> {
                observer!(plant, time_constant, limit, longest_dt, 0.0, 1.0)
            }

            /// [`with_latency`](Self::with_latency) at compile time.
            ///
            /// # Errors
            /// As [`with_latency`](Self::with_latency).
            pub const fn const_with_latency(self, latency: $float) -> Result<Self, Error> {
                latency!(self, latency, 0.0)
            }
        }
    };
}
constant!(f32);
constant!(f64);

/// One sample for a [`DisturbanceObserver`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ObserverInput<T> {
    /// Since the last call, also where that was a bad sample \[s\].
    pub dt: T,
    /// The command that went out at the last call \[command unit\]: behind all limits, also
    /// where it was a held or a safe one.
    pub sent: T,
    /// Measured output y \[output unit\], such as \[N·m\].
    pub measured: T,
}

/// What a step of a [`DisturbanceObserver`] gives.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ObserverOutput<T> {
    /// d_hat \[command unit\], to be added to the command: finite and within ±limit in any case.
    pub estimate: T,
    /// A good sample, or what was wrong; the estimate is held then.
    pub status: Status,
}

impl<T: Real> DisturbanceObserver<T> {
    /// An observer without latency: `time_constant > 0`, tau of Q \[s\]; `limit > 0` of the
    /// estimate \[command unit\]; `longest_dt > 0` \[s\], beyond which a sample is bad.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"time_constant"`, also where
    /// `1/(alpha·(wn·tau)²)` or `2·zeta/(alpha·wn·tau)` is not finite, `"limit"` or `"longest_dt"`.
    pub fn try_new(
        plant: NominalPlant<T>,
        time_constant: T,
        limit: T,
        longest_dt: T,
    ) -> Result<Self, Error> {
        observer!(plant, time_constant, limit, longest_dt, T::ZERO, T::ONE)
    }

    /// The same where a command shows in the measured output `latency ≥ 0` \[s\] after it was
    /// given, beside what the nominal plant takes: whole samples of delay, half a sample of hold,
    /// the lags of drive and sensor.
    ///
    /// The command is compared that much later, through a lag of this time.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"latency"`.
    pub fn with_latency(self, latency: T) -> Result<Self, Error> {
        latency!(self, latency, T::ZERO)
    }

    /// The nominal plant.
    #[inline]
    #[must_use]
    pub const fn plant(&self) -> &NominalPlant<T> {
        &self.plant
    }

    /// tau of Q \[s\].
    #[inline]
    #[must_use]
    pub const fn time_constant(&self) -> T {
        self.time_constant
    }

    /// Greatest magnitude of the estimate \[command unit\].
    #[inline]
    #[must_use]
    pub const fn limit(&self) -> T {
        self.limit
    }

    /// Longest `dt` that is a sample \[s\].
    #[inline]
    #[must_use]
    pub const fn longest_dt(&self) -> T {
        self.longest_dt
    }

    /// How long a command takes to show in the measured output \[s\].
    #[inline]
    #[must_use]
    pub const fn latency(&self) -> T {
        self.latency
    }

    /// One sample: what is to be added to the next command.
    ///
    /// Call it at every sample, before the controller. A bad sample (a `dt` that is not positive
    /// or too long, a command or an output that is not finite) moves nothing; the estimate is
    /// held, and the next good sample makes up for the time. Where nobody knows that time, because a
    /// `dt` was bad, it counts as one more of the next `dt`. Whatever the state is, the estimate is
    /// finite and within ±limit.
    #[inline]
    pub fn step(&self, state: &mut ObserverState<T>, at: &ObserverInput<T>) -> ObserverOutput<T> {
        let status = if self.advance(state, at) {
            Status::Good
        } else {
            rarely();
            Status::Held(self.refused(state, at))
        };
        state.estimate = confined(state.estimate, -self.limit, self.limit);
        ObserverOutput {
            estimate: state.estimate,
            status,
        }
    }

    /// Moves the state by a good sample; `false`, and nothing has moved, where a number cannot be
    /// used or the estimate overflows.
    #[inline]
    #[allow(clippy::eq_op)]
    fn advance(&self, state: &mut ObserverState<T>, at: &ObserverInput<T>) -> bool {
        // A number less itself is zero, or NaN where it is not finite.
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

    /// What was wrong with a sample. Where nothing was, the lags overflow, or did before: they begin
    /// anew with the next one.
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

/// What is read before it is checked.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
#[serde(bound(deserialize = "T: Real + serde::Deserialize<'de>"))]
struct Unchecked<T> {
    plant: NominalPlant<T>,
    time_constant: T,
    limit: T,
    longest_dt: T,
    #[serde(default = "T::zero")]
    latency: T,
}

#[cfg(feature = "serde")]
impl<T: Real> TryFrom<Unchecked<T>> for DisturbanceObserver<T> {
    type Error = Error;
    fn try_from(raw: Unchecked<T>) -> Result<Self, Error> {
        Self::try_new(raw.plant, raw.time_constant, raw.limit, raw.longest_dt)?
            .with_latency(raw.latency)
    }
}
