//! PID, PI and PIV controllers, equations (14) to (16), with anti-windup and fault handling.
//!
//! ```text
//! e = y − y_r
//! u = −k_p·(y − b·y_r) − k_i·∫e − k_d·d/dt(y − c·y_r) + u_ff      PI (15), PID (14)
//! u = −k_p·(y − b·y_r) − k_i·∫e − k_d·v_d             + u_ff      PIV (16)
//! command = u within the range and the slew-rate limit
//! ```
//!
//! - `dt` may vary from call to call, up to the longest `dt`. The derivative uses an implicit
//!   first-order lag, which is stable for any `dt`; see [`Derivative`].
//! - The integral is stored in command units, so a new `k_i` does not change the present command.
//!   Compensated summation prevents the loss of small increments in `f32`.
//! - [`AntiWindup`] lists the anti-windup methods.
//! - A bad sample leaves the state unchanged and holds the command; see [`Status`]. At the first
//!   good sample after bad samples, the derivative uses the time since the last good sample. The
//!   integral uses only the `dt` of this sample.
//!
//! Source: section 3.1 of Nguyen et al. (2018); Åström & Hägglund, *Advanced PID Control*, 2006.

mod settings;
mod signals;
pub(crate) mod state;
mod step;

pub use settings::{AntiWindup, DerivativeSource, PidSettings};
pub use signals::{PidInput, PidTerms};
pub use state::PidState;

use super::{Applied, Fault, Output, Status, Telemetry};
use crate::error::is_usable;
use crate::fault::{fault_of_dt, unless_finite};
use crate::signal::{clamp, greatest, least, wrapped, Compensated, Derivative};
use crate::Real;
use state::Last;
use step::stopped;

/// A PID, PI or PIV controller, equations (14) to (16).
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
pub struct Pid<T> {
    settings: PidSettings<T>,
    /// [`PidSettings::is_plain`], cached so that a step tests it once.
    plain: bool,
}

impl<T: Real> Pid<T> {
    fn assumed(settings: PidSettings<T>) -> Self {
        Self {
            plain: settings::is_plain(&settings),
            settings,
        }
    }

    /// The PI of Nguyen et al. (2018), Table 1: `k_p` = 30, `k_i` = 18, without command limits.
    pub fn paper_pi() -> Self {
        Self::assumed(PidSettings::unlimited(T::from_f64(30.0), T::from_f64(18.0)))
    }

    /// The PID of Nguyen et al. (2018), Table 1: `k_d` = 2, without command limits.
    ///
    /// The paper does not specify a derivative filter. Here, the time constant is 0.1 s. On the
    /// reference rig at 1 kHz, the loop may diverge with a time constant below 15 ms.
    pub fn paper_pid() -> Self {
        Self::assumed(PidSettings {
            k_d: T::from_f64(2.0),
            damping: DerivativeSource::on_error(),
            derivative_time: T::from_f64(0.1),
            ..Self::paper_pi().settings
        })
    }

    /// The PIV of Nguyen et al. (2018), Table 1: `k_d` = 10 on the distal velocity, without command
    /// limits.
    pub fn paper_piv() -> Self {
        Self::assumed(PidSettings {
            k_d: T::from_f64(10.0),
            damping: DerivativeSource::Velocity,
            ..Self::paper_pi().settings
        })
    }

    /// The settings of this controller.
    pub fn settings(&self) -> &PidSettings<T> {
        &self.settings
    }

    /// Processes one sample and returns the command \[command unit\] and the status.
    ///
    /// The command is finite and within the limits for any input **and any state**, including a
    /// stored state and a state from a controller with other settings. A bad sample leaves the
    /// state unchanged, except for the fault counter and the accumulated time of the bad samples.
    #[inline]
    pub fn step(&self, state: &mut PidState<T>, at: &PidInput<T>) -> Output<T> {
        let mut velocity = at.velocity;
        if state.held.may_step() {
            if let Some(command) = self.advance(state, at, &mut velocity) {
                let status = Status::Good;
                return Output { command, status };
            }
        }
        // Passed field by field, so that the sample of a good step stays in registers.
        let sample = PidInput {
            dt: at.dt,
            reference: at.reference,
            measured: at.measured,
            velocity,
            feed_forward: at.feed_forward,
        };
        self.exception(state, &sample)
    }

    /// The same step, which also returns all terms for telemetry. They are the
    /// [`terms`](Self::terms) after the step.
    pub fn step_with_terms(
        &self,
        state: &mut PidState<T>,
        at: &PidInput<T>,
    ) -> Telemetry<T, PidTerms<T>> {
        self.step(state, at).with(self.terms(state))
    }

    /// All terms of the last good sample; zero before the first good sample.
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
            saturated: last.unlimited != state.command(),
        }
    }

    /// The limit that the command has reached (range or slew-rate limit), for the outer loop of a
    /// cascade.
    ///
    /// Pass the result to [`applied`](Self::applied) of the outer loop. If the inner loop has
    /// positive gains and its command is at the upper limit, a larger output of the outer loop has
    /// no effect. A command that equals a limit of the range is treated as limited.
    #[must_use]
    pub fn saturation(&self, state: &PidState<T>) -> Applied<T> {
        let (command, limits) = (state.command(), &self.settings.limits);
        match &state.last {
            Some(last) if last.unlimited > command || command >= limits.high() => {
                Applied::AtUpperLimit
            }
            Some(last) if last.unlimited < command || command <= limits.low() => {
                Applied::AtLowerLimit
            }
            _ => Applied::AsCommanded,
        }
    }

    /// Reports the drive's response to the last command if the drive did not apply the command.
    ///
    /// Call this method between two steps. If the applied command is known, the slew-rate limit,
    /// back-calculation and a bumpless start continue from this command. The effect on the integral
    /// depends on the anti-windup method:
    /// - With back-calculation and a known applied command, the integral is corrected at the next
    ///   sample by the part that the drive cut off. The same applies to [`AntiWindup::Conditional`]
    ///   with a slew-rate limit.
    /// - With [`AntiWindup::None`], the integral does not change.
    /// - In all other cases, the last change of the integral is reversed to the extent that it
    ///   exceeds the drive's limit. If the applied command is unknown, the whole change is
    ///   reversed.
    ///
    /// The next command still contains the full demand, so the loop recovers as soon as the drive
    /// does. See [`Applied`].
    pub fn applied(&self, state: &mut PidState<T>, applied: Applied<T>) {
        let out = state.command();
        let (less, sent) = match applied {
            Applied::AtUpperLimit => (true, None),
            Applied::AtLowerLimit => (false, None),
            Applied::Command(sent) if sent.is_finite() && sent != out => (sent < out, Some(sent)),
            Applied::AsCommanded | Applied::Command(_) => return,
        };
        state.held.command = sent.unwrap_or(out);
        let Some(last) = &mut state.last else {
            return;
        };
        let flows_back = match self.settings.anti_windup {
            AntiWindup::None => true,
            AntiWindup::BackCalculation { .. } => sent.is_some(),
            AntiWindup::Conditional => sent.is_some() && self.settings.limits.slew().is_some(),
            AntiWindup::Clamp => false,
        };
        let asked = (last.change > T::ZERO) == less && last.change != T::ZERO;
        if asked && !flows_back {
            let before = state.integral.value - last.change;
            let rest = last.unlimited - state.integral.value;
            // The whole change, if the applied command is unknown.
            let full = sent.map_or(before, |sent| sent - rest);
            state.integral = stopped(state.integral, before, full, less);
            last.change = T::ZERO;
            let sum = rest + state.integral.value;
            // Beyond an unknown limit, back-calculation has nothing to correct.
            last.unlimited = match (sent, less) {
                (Some(_), _) => sum,
                (None, true) => greatest(sum, out),
                (None, false) => least(sum, out),
            };
        }
    }

    /// Continues a running state with other settings, without a jump in the command.
    ///
    /// All settings may change. The integral is adjusted so that, at the last good sample, the new
    /// terms add up to the applied command. If the same limit clamps the old sum and the new sum,
    /// the integral is not adjusted. The new sum may then lie beyond this limit. The next command
    /// differs from the applied command only by one increment of the integral. If the new limits
    /// exclude the command, the limits take priority. If the new settings have a slew-rate limit and
    /// the old sum lies beyond the command, the command continues towards this sum at the slew rate.
    /// If the new settings have no [`period`](super::PidSettings::period) but the old settings had
    /// one, the command jumps when the reference is a turn away.
    ///
    /// With `k_i` = 0, the integral then returns to zero; see [`PidSettings::k_i`]. Before you
    /// change to PIV, pass samples that contain the velocity. Without an earlier good sample, or if
    /// the sum overflows, the state does not change.
    ///
    /// ```
    /// use bowden::control::{Pid, PidInput, PidSettings, PidState};
    /// let quiet = Pid::try_new(PidSettings::unlimited(3.0, 1.0))?;
    /// let mut state = PidState::new();
    /// let sample = PidInput::new(0.001, 2.0, 1.5_f64);
    /// let before = quiet.step(&mut state, &sample).command;
    ///
    /// let firm = Pid::try_new(PidSettings::unlimited(30.0, 1.0))?;
    /// firm.bumpless_transfer(&mut state);
    /// let after = firm.step(&mut state, &sample).command;
    /// assert!((after - before - 0.0005).abs() < 1e-12); // k_i·0.5·dt, not 13.5
    /// # Ok::<(), bowden::Error>(())
    /// ```
    pub fn bumpless_transfer(&self, state: &mut PidState<T>) {
        let Some(mut last) = state.last else {
            return;
        };
        if let Some(period) = self.settings.period {
            last.reference = last.measured - wrapped(last.measured - last.reference, period);
        }
        let rest = self.rest(&last, state.rate);
        let (command, limits) = (state.command(), &self.settings.limits);
        let (even, ramps) = (command - rest, limits.slew().is_some());
        let above = last.unlimited > command && (ramps || command >= limits.high());
        let below = last.unlimited < command && (ramps || command <= limits.low());
        let low = if below { T::neg_infinity() } else { even };
        let high = if above { T::infinity() } else { even };
        let integral = clamp(state.integral.value, low, high);
        let unlimited = rest + integral;
        if integral.is_finite() && unlimited.is_finite() {
            state.last = Some(Last { unlimited, ..last });
            state.integral = Compensated::new(integral);
        }
    }

    /// The sample and the integral for which the terms give `output` at rest.
    fn started_at(&self, output: T, at: &PidInput<T>) -> Result<(Last<T>, T), Fault> {
        // No time passes here: `at.dt` is ignored, as after an hour with the drive off.
        let fault = unless_finite(output, Fault::Command).or_else(|| self.fault_of_numbers(at));
        if let Some(fault) = fault {
            return Err(fault);
        }
        let mut last = self.sample(at).with_known_velocity();
        let rest = self.rest(&last, T::ZERO);
        let integral = self.settings.limits.clamp(output) - rest;
        last.unlimited = rest + integral;
        if is_usable(integral) && is_usable(last.unlimited) {
            Ok((last, integral))
        } else {
            Err(Fault::Overflow)
        }
    }

    /// The velocity that the law reads, which may be NaN; zero if the law reads none.
    fn velocity(&self, at: &PidInput<T>) -> T {
        match self.settings.damping {
            DerivativeSource::Velocity => at.velocity,
            DerivativeSource::Rate { .. } => T::ZERO,
        }
    }

    /// The fault of a sample, if there is one; an overflow of the law is not included.
    fn fault(&self, at: &PidInput<T>) -> Option<Fault> {
        fault_of_dt(at.dt, self.settings.longest_dt).or_else(|| self.fault_of_numbers(at))
    }

    /// The fault of the numbers of a sample, without a test of `dt`.
    fn fault_of_numbers(&self, at: &PidInput<T>) -> Option<Fault> {
        unless_finite(at.reference, Fault::Reference)
            .or_else(|| unless_finite(at.measured, Fault::Measured))
            .or_else(|| unless_finite(self.velocity(at), Fault::Velocity))
            .or_else(|| unless_finite(at.feed_forward, Fault::FeedForward))
            .or_else(|| unless_finite(at.measured - at.reference, Fault::Overflow))
    }

    /// Filtered rate of `y - c·y_r`, zero if it is not used.
    #[inline]
    fn rate<const PLAIN: bool>(&self, state: &PidState<T>, now: &Last<T>, dt: T) -> T {
        let DerivativeSource::Rate { weight } = self.settings.damping else {
            return T::ZERO;
        };
        if self.settings.k_d == T::ZERO {
            return T::ZERO;
        }
        let Some(before) = &state.last else {
            return T::ZERO;
        };
        // Computed from the samples themselves: correct after a change of the weight, too.
        let sample = |at: &Last<T>| at.measured - weight * at.reference;
        let mut change = sample(now) - sample(before);
        if let (false, Some(period)) = (PLAIN, self.settings.period) {
            change = wrapped(change, period);
        }
        let filter = Derivative::assumed(self.settings.derivative_time);
        filter.after(state.rate, change, dt + state.gap)
    }

    /// A sample before the law has processed it. With a period, the reference is the turn that
    /// is nearest to the measurement.
    fn sample(&self, at: &PidInput<T>) -> Last<T> {
        let mut last = Last::at(at);
        if let Some(period) = self.settings.period {
            last.reference = at.measured - wrapped(at.measured - at.reference, period);
        }
        last
    }

    #[inline]
    fn proportional(&self, at: &Last<T>) -> T {
        -self.settings.k_p * (at.measured - self.settings.setpoint_weight * at.reference)
    }

    /// The damping terms: of the filtered rate, and of the measured velocity.
    #[inline]
    fn damping(&self, at: &Last<T>, rate: T) -> (T, T) {
        match self.settings.damping {
            DerivativeSource::Rate { .. } => (-self.settings.k_d * rate, T::zero()),
            DerivativeSource::Velocity => (T::zero(), -self.settings.k_d * at.velocity),
        }
    }

    /// The command without limits and without the integral.
    #[inline]
    fn rest(&self, at: &Last<T>, rate: T) -> T {
        let damped = match self.settings.damping {
            DerivativeSource::Rate { .. } => rate,
            DerivativeSource::Velocity => at.velocity,
        };
        self.proportional(at) - self.settings.k_d * damped + at.feed_forward
    }
}

crate::checked::stored_as! { Pid<T> as PidSettings<T>: |pid| pid.settings, Pid::try_new }
