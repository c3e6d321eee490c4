//! PI, PID and PIV: equations (14)-(16), with what a real actuator needs beside them.
//!
//! ```text
//! e = y − y_r
//! u = −k_p·(y − b·y_r) − k_i·∫e − k_d·d/dt(y − c·y_r) + u_ff      PI (15), PID (14)
//! u = −k_p·(y − b·y_r) − k_i·∫e − k_d·v_d             + u_ff      PIV (16)
//! command = u within the range and the slew rate
//! ```
//!
//! - `dt` may vary from call to call, up to a longest one. The derivative goes through the
//!   implicit first-order lag, stable for any `dt`: see [`Derivative`].
//! - The integral is kept as a command, so that another `k_i` moves nothing, and as a
//!   compensated sum: in `f32` a plain one stops once its steps are below half an ulp.
//! - The anti-windup knows the slew rate from the range, see [`AntiWindup`].
//! - A bad sample leaves the memory as it was and holds the command, see [`Status`]. The
//!   derivative bridges the gap that it leaves; the integral does not count it. After too
//!   many the safe command is out until [`PidState::acknowledge`].
//!
//! Source: the paper's section 3.1; Åström & Hägglund, *Advanced PID Control*, 2006.

mod settings;
mod signals;
pub(crate) mod state;
mod step;

pub use settings::{AntiWindup, Damping, PidSettings};
pub use signals::{PidInput, PidOutput, PidTerms};
pub use state::PidState;

use super::status::{fault_of_dt, unless_finite};
use super::{Fault, Output, Status};
use crate::error::is_usable;
use crate::signal::{clamp, Compensated, Derivative};
use crate::{Error, Real};
use state::Last;

/// A PI, PID or PIV controller, equations (14)-(16); checked, immutable.
///
/// ```
/// use bowden::control::{Fallback, Limits, Pid, PidInput, PidSettings, PidState, Status};
/// let pid = Pid::try_new(PidSettings::new(
///     30.0,
///     18.0,
///     Limits::try_new(-20.0, 60.0)?, // [N·m]
///     0.005,                         // longest dt [s]
///     Fallback::try_new(20, 0.0)?,   // after 20 bad samples: [N·m]
/// ))?;
/// let mut state = PidState::new();
///
/// let out = pid.step(&mut state, &PidInput::new(0.001, 1.0, 0.5_f32));
/// let terms = pid.terms(&state);
/// assert_eq!(terms.proportional, 15.0); // -k_p·e
/// assert!((terms.integral - 0.009).abs() < 1e-7); // -k_i·e·dt
///
/// let held = pid.step(&mut state, &PidInput::new(0.001, 1.0, f32::NAN));
/// assert_eq!(held.command, out.command);
/// assert_ne!(held.status, Status::Good);
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        try_from = "PidSettings<T>",
        into = "PidSettings<T>",
        bound(
            serialize = "T: Real + serde::Serialize",
            deserialize = "T: Real + serde::Deserialize<'de>"
        )
    )
)]
pub struct Pid<T> {
    settings: PidSettings<T>,
}

impl<T: Real> Pid<T> {
    /// Checks the settings.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with the setting's name, or
    /// [`Error::Inadmissible`] with the condition that two of them break together; the
    /// fields of [`PidSettings`] state both.
    pub fn try_new(settings: PidSettings<T>) -> Result<Self, Error> {
        settings.check()?;
        Ok(Self { settings })
    }

    /// The paper's PI (15), Table 1: `k_p` = 30, `k_i` = 18. No limits.
    #[must_use]
    pub fn paper_pi() -> Self {
        Self {
            settings: PidSettings::unlimited(T::of(30.0), T::of(18.0)),
        }
    }

    /// The paper's PID (14), Table 1: `k_d` = 2; filtered over 0.1 s. No limits.
    ///
    /// The paper does not say how it takes the derivative. On the reference rig a filter
    /// below 20 ms makes the loop diverge.
    #[must_use]
    pub fn paper_pid() -> Self {
        Self {
            settings: PidSettings {
                k_d: T::of(2.0),
                derivative_time: T::of(0.1),
                ..Self::paper_pi().settings
            },
        }
    }

    /// The paper's PIV (16), Table 1: `k_d` = 10 on the distal velocity. No limits.
    #[must_use]
    pub fn paper_piv() -> Self {
        Self {
            settings: PidSettings {
                k_d: T::of(10.0),
                damping: Damping::Velocity,
                ..Self::paper_pi().settings
            },
        }
    }

    /// The PI that an adaptive law must beat: `k_p` = 30, `k_i` = 320. No limits.
    ///
    /// 320 is the effective integral gain of the paper's adaptive law. A comparison
    /// without this one credits adaptation with what is gain.
    #[must_use]
    pub fn matched_pi() -> Self {
        Self {
            settings: PidSettings::unlimited(T::of(30.0), T::of(320.0)),
        }
    }

    /// The settings as they were given.
    #[inline]
    #[must_use]
    pub fn settings(&self) -> &PidSettings<T> {
        &self.settings
    }

    /// One sample: the command \[command unit\], and what happened.
    ///
    /// The command is finite and within the limits for any input **and any state**, one
    /// that was stored or that belongs to another controller included. A bad sample leaves
    /// the state as it was, but for the score of bad ones and their time.
    #[inline]
    pub fn step(&self, state: &mut PidState<T>, at: &PidInput<T>) -> Output<T> {
        let mut velocity = at.velocity;
        if state.held.may_step() {
            if let Some(command) = self.advance(state, at, &mut velocity) {
                let status = Status::Good;
                return Output { command, status };
            }
        }
        // Number by number, so that the sample of a good step stays in registers.
        let sample = PidInput {
            dt: at.dt,
            reference: at.reference,
            measured: at.measured,
            velocity,
            feed_forward: at.feed_forward,
        };
        self.exception(state, &sample)
    }

    /// The same, and every term for telemetry: [`terms`](Self::terms) after the step.
    pub fn step_with_terms(&self, state: &mut PidState<T>, at: &PidInput<T>) -> PidOutput<T> {
        let Output { command, status } = self.step(state, at);
        PidOutput {
            command,
            status,
            terms: self.terms(state),
        }
    }

    /// Every term of the last good sample; all zero before the first one.
    #[must_use]
    pub fn terms(&self, state: &PidState<T>) -> PidTerms<T> {
        let Some(last) = &state.last else {
            return PidTerms::default();
        };
        let (derivative, velocity) = self.damping(last, state.rate);
        PidTerms {
            error: last.measured - last.reference,
            proportional: self.proportional(last),
            integral: state.integral.value,
            derivative,
            velocity,
            feed_forward: last.feed_forward,
            unlimited: last.unlimited,
            saturated: last.unlimited != last.command,
        }
    }

    /// Takes a running state over from other settings, without a jump of the command.
    ///
    /// Every setting may differ. The integral moves, and only as far as it must: at the
    /// last good sample the new terms add up to the command that went out or, where a
    /// limit cut the old sum off and a limit still does, to something beyond it. What
    /// remains is one step of the integral with the next sample; limits that exclude the
    /// command and [`AntiWindup::Clamp`] come first. A PIV that takes over needs samples
    /// that had the velocity. Without a good sample nothing changes; where the sum
    /// overflows, the integral stays.
    ///
    /// ```
    /// use bowden::control::{Pid, PidInput, PidSettings, PidState};
    /// let quiet = Pid::try_new(PidSettings::unlimited(3.0, 1.0))?;
    /// let mut state = PidState::new();
    /// let sample = PidInput::new(0.001, 2.0, 1.5_f64);
    /// let before = quiet.step(&mut state, &sample).command;
    ///
    /// let firm = Pid::try_new(PidSettings::unlimited(30.0, 1.0))?;
    /// firm.take_over(&mut state);
    /// let after = firm.step(&mut state, &sample).command;
    /// assert!((after - before - 0.0005).abs() < 1e-12); // k_i·0.5·dt, not 13.5
    /// # Ok::<(), bowden::Error>(())
    /// ```
    pub fn take_over(&self, state: &mut PidState<T>) {
        let Some(last) = state.last else {
            return;
        };
        let rest = self.rest(&last, state.rate);
        let (even, limits) = (last.command - rest, &self.settings.limits);
        let ramps = limits.slew().is_some();
        let above = last.unlimited > last.command && (ramps || last.command >= limits.high());
        let below = last.unlimited < last.command && (ramps || last.command <= limits.low());
        let low = if below { T::neg_infinity() } else { even };
        let high = if above { T::infinity() } else { even };
        let integral = self.confine(clamp(state.integral.value, low, high));
        let unlimited = rest + integral;
        if integral.is_finite() && unlimited.is_finite() {
            state.last = Some(Last { unlimited, ..last });
            state.integral = Compensated::new(integral);
        }
    }

    /// The sample and the integral with which the terms give `output` there, from rest.
    fn started_at(&self, output: T, at: &PidInput<T>) -> Result<(Last<T>, T), Fault> {
        // No time passes here: whatever `at.dt` is, as after an hour with the drive off.
        let fault = unless_finite(output, Fault::Command).or_else(|| self.fault_of_numbers(at));
        if let Some(fault) = fault {
            return Err(fault);
        }
        let mut last = Last::at(at).with_known_velocity();
        let rest = self.rest(&last, T::ZERO);
        let command = self.settings.limits.confine(output);
        let integral = self.confine(command - rest);
        last.command = command;
        last.unlimited = rest + integral;
        if is_usable(integral) && is_usable(last.unlimited) {
            Ok((last, integral))
        } else {
            Err(Fault::Overflow)
        }
    }

    /// A good sample with rate and integral as they are.
    fn without_integrating(&self, state: &PidState<T>, at: &PidInput<T>) -> Result<Last<T>, Fault> {
        let mut last = Last::at(at).with_known_velocity();
        last.unlimited = self.rest(&last, state.rate) + state.integral.value;
        last.command = self
            .settings
            .limits
            .apply(state.command(), last.unlimited, at.dt);
        if is_usable(last.unlimited) {
            Ok(last)
        } else {
            Err(Fault::Overflow)
        }
    }

    /// The velocity that the law reads; zero where it reads none, and it may be no number.
    fn velocity(&self, at: &PidInput<T>) -> T {
        match self.settings.damping {
            Damping::Velocity => at.velocity,
            Damping::Rate { .. } => T::ZERO,
        }
    }

    /// What is wrong with a sample, where something is; not whether the law overflows on it.
    fn fault(&self, at: &PidInput<T>) -> Option<Fault> {
        fault_of_dt(at.dt, self.settings.longest_dt).or_else(|| self.fault_of_numbers(at))
    }

    /// The same of its numbers, whatever its `dt`.
    fn fault_of_numbers(&self, at: &PidInput<T>) -> Option<Fault> {
        unless_finite(at.reference, Fault::Reference)
            .or_else(|| unless_finite(at.measured, Fault::Measured))
            .or_else(|| unless_finite(self.velocity(at), Fault::Velocity))
            .or_else(|| unless_finite(at.feed_forward, Fault::FeedForward))
            .or_else(|| unless_finite(at.measured - at.reference, Fault::Overflow))
    }

    /// Filtered rate of `y - c·y_r`, zero where it is not used.
    #[inline]
    fn rate(&self, state: &PidState<T>, now: &Last<T>, dt: T) -> T {
        let Damping::Rate { weight } = self.settings.damping else {
            return T::ZERO;
        };
        if self.settings.k_d == T::ZERO {
            return T::ZERO;
        }
        let Some(before) = &state.last else {
            return T::ZERO;
        };
        // From the samples themselves: right also where the weight has changed.
        let sample = |at: &Last<T>| at.measured - weight * at.reference;
        let filter = Derivative::assumed(self.settings.derivative_time);
        filter.after(state.rate, sample(now) - sample(before), dt + state.gap)
    }

    #[inline]
    fn proportional(&self, at: &Last<T>) -> T {
        -self.settings.k_p * (at.measured - self.settings.setpoint_weight * at.reference)
    }

    /// The damping terms: of the filtered rate, and of the measured velocity.
    #[inline]
    fn damping(&self, at: &Last<T>, rate: T) -> (T, T) {
        match self.settings.damping {
            Damping::Rate { .. } => (-self.settings.k_d * rate, T::zero()),
            Damping::Velocity => (T::zero(), -self.settings.k_d * at.velocity),
        }
    }

    /// The command without limits and without the integral.
    #[inline]
    fn rest(&self, at: &Last<T>, rate: T) -> T {
        let damped = match self.settings.damping {
            Damping::Rate { .. } => rate,
            Damping::Velocity => at.velocity,
        };
        self.proportional(at) - self.settings.k_d * damped + at.feed_forward
    }

    /// The integral within the range of [`AntiWindup::Clamp`], where that was chosen.
    #[inline]
    fn confine(&self, integral: T) -> T {
        let (zero, limits) = (T::ZERO, &self.settings.limits);
        match self.settings.anti_windup {
            AntiWindup::Clamp => clamp(
                integral,
                clamp(limits.low(), T::LOWEST, zero),
                clamp(limits.high(), zero, T::HIGHEST),
            ),
            _ => integral,
        }
    }

    /// The same of the sum: at an edge of the range it owes nothing.
    #[inline]
    fn confined(&self, integral: Compensated<T>) -> Compensated<T> {
        if !matches!(self.settings.anti_windup, AntiWindup::Clamp) {
            return integral;
        }
        let value = self.confine(integral.value);
        if value == integral.value {
            integral
        } else {
            Compensated::new(value)
        }
    }
}
