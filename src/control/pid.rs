//! PI, PID and PIV: equations (14)-(16), with what a real actuator needs beside them.
//!
//! ```text
//! e = y − y_r
//! u = −k_p·(y − b·y_r) − k_i·∫e − k_d·d/dt(y − c·y_r) + u_ff      PI (15), PID (14)
//! u = −k_p·(y − b·y_r) − k_i·∫e − k_d·v_d             + u_ff      PIV (16)
//! command = u within the range and the slew rate
//! ```
//!
//! - `dt` may vary from call to call. The derivative goes through the exact discrete
//!   first-order lag: its time constant means the same at every rate.
//! - The integral is kept as a command, so that another `k_i` moves nothing, and as a
//!   compensated sum: in `f32` a plain one stops once its steps are below half an ulp.
//! - The anti-windup sees the slew rate as it sees the range, see [`AntiWindup`].
//! - A bad sample leaves the memory as it was and holds the command, see [`Status`]. The
//!   derivative bridges the gap that it leaves; the integral does not count it.
//!
//! Source: the paper's section 3.1; Åström & Hägglund, *Advanced PID Control*, 2006.

mod settings;
mod signals;
pub(crate) mod state;

pub use settings::{AntiWindup, Damping, PidSettings};
pub use signals::{PidInput, PidOutput, PidTerms};
pub use state::PidState;

use super::status::{usable, usable_dt};
use super::{Fault, Status};
use crate::signal::{clamp, Derivative, DerivativeState};
use crate::{Error, Real};
use state::Last;

/// A PI, PID or PIV controller, equations (14)-(16); checked, immutable.
///
/// ```
/// use bowden::control::{AntiWindup, Limits, Pid, PidInput, PidSettings, PidState, Status};
/// let pid = Pid::try_new(PidSettings {
///     limits: Limits::try_new(-20.0, 60.0)?, // [N·m]
///     anti_windup: AntiWindup::Conditional,
///     ..PidSettings::new(30.0, 18.0)
/// })?;
/// let mut state = PidState::new();
///
/// let out = pid.step(&mut state, &PidInput::new(0.001, 1.0, 0.5_f32));
/// assert_eq!(out.terms.proportional, 15.0); // -k_p·e
/// assert!((out.terms.integral - 0.009).abs() < 1e-7); // -k_i·e·dt
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
            settings: PidSettings::new(T::of(30.0), T::of(18.0)),
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
            settings: PidSettings::new(T::of(30.0), T::of(320.0)),
        }
    }

    /// The settings as they were given.
    #[inline]
    #[must_use]
    pub fn settings(&self) -> &PidSettings<T> {
        &self.settings
    }

    /// One sample: the command \[command unit\], what happened, and every term.
    ///
    /// The command is finite and within the limits for any input. A bad sample leaves
    /// the state as it was, but for the count of bad ones and their time.
    #[inline]
    pub fn step(&self, state: &mut PidState<T>, at: &PidInput<T>) -> PidOutput<T> {
        let status = match self.advance(state, at) {
            Ok(next) => {
                *state = next;
                Status::Good
            }
            Err(fault) => {
                state.wait(at.dt);
                state.held.bad(fault, &self.settings.fallback)
            }
        };
        let limits = &self.settings.limits;
        PidOutput {
            // A state that comes from another controller may hold what this one must not.
            command: clamp(state.command(), limits.low(), limits.high()),
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
            integral: state.integral,
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
    /// let quiet = Pid::try_new(PidSettings::new(3.0, 1.0))?;
    /// let mut state = PidState::new();
    /// let sample = PidInput::new(0.001, 2.0, 1.5_f64);
    /// let before = quiet.step(&mut state, &sample).command;
    ///
    /// let firm = Pid::try_new(PidSettings::new(30.0, 1.0))?;
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
        let integral = self.confine(clamp(state.integral, low, high));
        let unlimited = rest + integral;
        if integral.is_finite() && unlimited.is_finite() {
            state.last = Some(Last { unlimited, ..last });
            state.set_integral(integral);
        }
    }

    /// The integral with which the terms give `output` at a sample, from rest.
    fn started_at(&self, output: T, at: &PidInput<T>) -> Result<(Last<T>, T), Fault> {
        let command = usable(output, Fault::Command)?;
        let limits = &self.settings.limits;
        let command = clamp(command, limits.low(), limits.high());
        let mut last = self.usable(at)?;
        let rest = self.rest(&last, T::zero());
        let integral = self.confine(command - rest);
        last.command = command;
        last.unlimited = rest + integral;
        usable(integral, Fault::Overflow)?;
        usable(last.unlimited, Fault::Overflow)?;
        Ok((last, integral))
    }

    /// The state after a good sample, or what is wrong with the sample.
    #[inline]
    fn advance(&self, state: &PidState<T>, at: &PidInput<T>) -> Result<PidState<T>, Fault> {
        let dt = usable_dt(at.dt)?;
        let mut last = self.usable(at)?;
        let rate = self.rate(state, &last, dt);
        let rest = self.rest(&last, rate);

        let mut next = *state;
        next.rate = rate;
        let change = self.change(state, &last, dt);
        next.add(change);
        next.confine(self.confine(next.integral));
        let limits = &self.settings.limits;
        last.unlimited = rest + next.integral;
        last.command = limits.apply(state.command(), last.unlimited, dt);
        if matches!(self.settings.anti_windup, AntiWindup::Conditional) {
            let excess = last.unlimited - last.command;
            let (up, down) = (change > T::zero(), change < T::zero());
            if (excess > T::zero() && up) || (excess < T::zero() && down) {
                next.restore_sum(state);
                last.unlimited = rest + next.integral;
                last.command = limits.apply(state.command(), last.unlimited, dt);
            }
        }
        usable(next.sum(), Fault::Overflow)?;
        usable(last.unlimited, Fault::Overflow)?;
        next.take(last);
        Ok(next)
    }

    /// The sample, where all that is read of it is finite and its error too.
    #[inline]
    fn usable(&self, at: &PidInput<T>) -> Result<Last<T>, Fault> {
        let reference = usable(at.reference, Fault::Reference)?;
        let measured = usable(at.measured, Fault::Measured)?;
        let velocity = match self.settings.damping {
            Damping::Velocity => usable(at.velocity, Fault::Velocity)?,
            // Not read here; kept for a PIV that may take over.
            Damping::Rate { .. } => usable(at.velocity, Fault::Velocity).unwrap_or(T::zero()),
        };
        let feed_forward = usable(at.feed_forward, Fault::FeedForward)?;
        usable(measured - reference, Fault::Overflow)?;
        Ok(Last {
            reference,
            measured,
            velocity,
            feed_forward,
            command: T::zero(),
            unlimited: T::zero(),
        })
    }

    /// Change of the integral term over one sample.
    #[inline]
    fn change(&self, state: &PidState<T>, last: &Last<T>, dt: T) -> T {
        let change = -self.settings.k_i * (last.measured - last.reference) * dt;
        match (self.settings.anti_windup, &state.last) {
            (AntiWindup::BackCalculation { tracking_time }, Some(before))
                if before.unlimited != before.command =>
            {
                let share = -(-dt / tracking_time).exp_m1();
                change - share * (before.unlimited - before.command)
            }
            _ => change,
        }
    }

    /// Filtered rate of `y - c·y_r`, zero where it is not used.
    #[inline]
    fn rate(&self, state: &PidState<T>, now: &Last<T>, dt: T) -> T {
        match (self.settings.damping, &state.last) {
            (Damping::Rate { weight }, Some(before)) if self.settings.k_d != T::zero() => {
                // From the samples themselves: right also where the weight has changed.
                let sample = |at: &Last<T>| at.measured - weight * at.reference;
                let mut filter = DerivativeState::at(sample(before), state.rate);
                let derivative = Derivative::assumed(self.settings.derivative_time);
                derivative.step(&mut filter, sample(now), dt + state.gap)
            }
            _ => T::zero(),
        }
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
        let (derivative, velocity) = self.damping(at, rate);
        self.proportional(at) + derivative + velocity + at.feed_forward
    }

    /// The integral within the range of [`AntiWindup::Clamp`], where that was chosen.
    #[inline]
    fn confine(&self, integral: T) -> T {
        let (zero, limits) = (T::zero(), &self.settings.limits);
        match self.settings.anti_windup {
            AntiWindup::Clamp => clamp(
                integral,
                clamp(limits.low(), T::min_value(), zero),
                clamp(limits.high(), zero, T::max_value()),
            ),
            _ => integral,
        }
    }
}
