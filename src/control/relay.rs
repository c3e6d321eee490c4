//! Relay experiment: measures the ultimate gain and period of a loop to tune a PI.
//!
//! ```text
//! command = centre + d   from y < y_r − eps on, until y > y_r + eps
//! command = centre − d   from y > y_r + eps on, until y < y_r − eps
//!
//! k_u = 4·d·sin(pi·D)/(pi·sqrt(a² − eps²))      T_u = period of the limit cycle
//! ```
//! A relay with hysteresis eps makes the loop oscillate near its ultimate frequency, with an
//! amplitude that depends on the level d. The amplitude a is half the distance from the lowest to
//! the highest output of a cycle. D is the share of the period in which the command is
//! `centre + d`. [`Ultimate::pi`] computes the gains of a [`Pid`](super::Pid) from k_u and T_u.
//!
//! - **Describing function.** The formula uses only the first harmonic of the command. Compared
//!   with the exact limit cycle, k_u has an error of −2 % for 1/(s + 1)³. For a first-order lag
//!   with delay, the error is between −19 % (short delay) and +27 % (long delay). If the delay
//!   equals the time constant, the error is −11 %.
//! - **Hysteresis.** The hysteresis makes T_u too long and k_u too low, so the gains are
//!   conservative. With eps = 0.1·a, k_u of 1/(s + 1)³ is 17.5 % too low. Choose d so that a is
//!   several times eps.
//! - **Asymmetric cycles.** A load or a bias makes the half-periods unequal. The first harmonic of
//!   an asymmetric command is `4·d/pi·sin(pi·D)`. The even harmonics increase a, so k_u is too low:
//!   by 5 % for 1/(s + 1)³ and D = 0.62. To make the half-periods equal, use the mean command
//!   `centre + d·(2·D − 1)` as the next centre.
//! - **Sampling.** The relay switches up to one `dt` after the crossing. The measured period is
//!   therefore longer than with a continuous relay: by two `dt` on average, and by at most four
//!   `dt`. A sampled controller has the same average delay, so no correction is necessary.
//! - **Sign.** The amplitude d, k_u and the gains have the sign of the plant's gain. With the wrong
//!   sign, the experiment fails with `OutputOutOfRange` or `NoOscillation`.
//! - **Duration.** The experiment ends within `longest_time` even if samples are bad, because the
//!   time of bad samples is included. A sample without a usable `dt` adds `longest_dt`. A failure
//!   latches the safe command until [`RelayState::acknowledge`] is called.
//!
//! Source: K. Åström, T. Hägglund, "Automatic tuning of simple regulators with specifications on
//! phase and amplitude margins", *Automatica* 20(5), 1984; the first harmonic of an asymmetric
//! relay in Ya. Tsypkin, *Relay Control Systems*, 1984.

mod settings;
mod state;
mod ultimate;

pub use settings::RelaySettings;
pub use state::RelayState;
pub use ultimate::{PiGains, PiRule, Ultimate};

use super::{Fault, Output, Status};
use crate::error::is_usable;
use crate::fault::{fault_of_dt, unless_finite};
use crate::Real;
use state::{Cycle, Mean};

#[cfg(kani)]
#[path = "../../proofs/relay.rs"]
mod proofs;

/// A relay experiment for tuning a PI.
///
/// Start with the output near the reference: at the mean command of the previous controller, or at
/// rest. Afterwards, resume a [`Pid`](super::Pid) from the applied command.
///
/// ```
/// use bowden::control::{Fallback, Limits, Pid, PidInput, PidSettings, PidState, PiRule};
/// use bowden::control::{Relay, RelaySettings, RelayState};
/// let (limits, fallback) = (Limits::try_new(-20.0, 60.0)?, Fallback::try_new(20, 0.0)?);
/// let relay = Relay::try_new(RelaySettings {
///     reference: 5.0,      // [N·m]
///     centre: 10.0,        // [command unit]
///     amplitude: 8.0,      // [command unit], with the sign of the plant's gain
///     hysteresis: 0.05,    // [N·m], at least the noise
///     most_deviation: 8.0, // [N·m]
///     cycles: 4,
///     agreement: 0.05,
///     longest_time: 20.0, // [s]
///     longest_dt: 0.05,   // [s]
///     limits,
///     fallback,
/// })?;
///
/// let (mut state, mut lags) = (RelayState::new(), [5.0_f64; 3]);
/// let dt = 0.01;
/// let ended = loop {
///     let out = relay.step(&mut state, dt, lags[2]);
///     if !state.is_running() {
///         break out;
///     }
///     // A plant of three lags of 0.1 s and gain 0.5.
///     let input = [0.5 * out.command, lags[0], lags[1]];
///     for (lag, input) in lags.iter_mut().zip(input) {
///         *lag += (input - *lag) * dt / 0.1;
///     }
/// };
/// let Some(ultimate) = state.result() else {
///     panic!("{:?}", ended.status)
/// };
///
/// // A PI with these gains, which continues from the applied command.
/// let gains = ultimate.pi(PiRule::default());
/// let pi = Pid::try_new(PidSettings::new(gains.k_p, gains.k_i, limits, 0.05, fallback))?;
/// let (mut loop_state, at) = (PidState::new(), PidInput::new(dt, 5.0, lags[2]));
/// loop_state.resume_from(&pi, ended.command, &at);
/// let next = pi.step(&mut loop_state, &at).command;
/// assert!((next - ended.command).abs() <= gains.k_i * (5.0 - lags[2]).abs() * dt + 1e-12);
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Relay<T> {
    settings: RelaySettings<T>,
}

impl<T: Real> Relay<T> {
    /// The settings of this relay.
    pub const fn settings(&self) -> &RelaySettings<T> {
        &self.settings
    }

    /// Processes one sample: the time `dt` since the last call \[s\], and the measured output
    /// \[output unit\].
    ///
    /// The status is [`Status::Held`] for a bad sample, and [`Status::Safe`] after a failure. After
    /// a success, the relay applies the command `centre`, and [`RelayState::result`] returns the
    /// result.
    ///
    /// The command is finite and within the limits for any input **and any state**. A bad sample
    /// holds the command. If the `dt` of a bad sample is not usable, the cycle that contains this
    /// sample is not averaged.
    pub fn step(&self, state: &mut RelayState<T>, dt: T, measured: T) -> Output<T> {
        let s = &self.settings;
        let status = match state.held.latched(&s.fallback) {
            Some(safe) => safe,
            None if state.result.is_none() => self.advance(state, dt, measured),
            None => {
                state.held.command = s.centre;
                Status::Good
            }
        };
        // The state may come from any source.
        let command = s.limits.clamp(state.held.command);
        state.held.command = command;
        Output { command, status }
    }

    /// The step of an experiment that is still running.
    fn advance(&self, state: &mut RelayState<T>, dt: T, measured: T) -> Status {
        let s = &self.settings;
        let of_dt = fault_of_dt(dt, s.longest_dt);
        let passed = if of_dt.is_none() { dt } else { s.longest_dt };
        state.remaining = state.remaining.saturating_sub(self.ticks(passed));
        if state.remaining == 0 {
            let reason = match state.cycles {
                0 => Fault::NoOscillation,
                _ => Fault::TimeOut,
            };
            return self.fail(state, reason);
        }
        match (of_dt, &mut state.cycle) {
            (Some(_), cycle) => *cycle = None,
            (None, Some(cycle)) => cycle.time = cycle.time.plus(dt),
            (None, None) => {}
        }
        if let Some(fault) = of_dt.or_else(|| unless_finite(measured, Fault::Measured)) {
            return state.held.bad(fault, &s.fallback);
        }
        if !state.held.may_step() {
            state.held.good();
        }
        let deviation = measured - s.reference;
        if deviation.abs() > s.most_deviation {
            return self.fail(state, Fault::OutputOutOfRange);
        }
        self.switch(state, deviation);
        Status::Good
    }

    #[inline]
    fn fail(&self, state: &mut RelayState<T>, reason: Fault) -> Status {
        let fallback = &self.settings.fallback;
        let safe = fallback.command().unwrap_or(self.settings.centre);
        state.held.fail(reason, safe)
    }

    /// The ticks of a positive time: at least one, so the remaining time decreases at every sample.
    fn ticks(&self, time: T) -> u32 {
        let share = time / self.settings.longest_time;
        let ticks = (share * T::from_f64(f64::from(u32::MAX))).to_u32();
        ticks.map_or(u32::MAX, |ticks| ticks.saturating_add(1))
    }

    /// Switches the relay at a good sample, and ends a cycle where it switches to `centre + d`.
    fn switch(&self, state: &mut RelayState<T>, deviation: T) {
        let s = &self.settings;
        let upper = match state.upper {
            Some(true) => deviation <= s.hysteresis,
            Some(false) => deviation < -s.hysteresis,
            None => deviation < T::ZERO,
        };
        if let Some(cycle) = &mut state.cycle {
            cycle.sees(deviation);
        }
        state.held.command = match upper {
            true => s.centre + s.amplitude,
            false => s.centre - s.amplitude,
        };
        match (state.upper.replace(upper), upper, &mut state.cycle) {
            (Some(true), false, Some(cycle)) => cycle.upper_time = cycle.time.value,
            (Some(false), true, cycle) => {
                let ended = cycle.replace(Cycle::starting_at(deviation));
                state.result = ended.and_then(|cycle| self.averaged(state, &cycle));
                if state.result.is_some() {
                    state.held.command = s.centre;
                }
            }
            _ => {}
        }
    }

    /// Adds a complete cycle to the average; returns the result after the last one.
    fn averaged(&self, state: &mut RelayState<T>, cycle: &Cycle<T>) -> Option<Ultimate<T>> {
        let s = &self.settings;
        state.cycles = state.cycles.saturating_add(1);
        // The times of two switches are known to one sample each.
        let resolved = s.agreement * T::from_f64(f64::from(cycle.samples)) >= T::from_f64(2.0);
        let seen = Mean::of(cycle);
        if !(resolved && seen.amplitude > s.hysteresis) {
            state.mean = Mean::default();
            return None;
        }
        state.mean = state.mean.joined_by(&seen, s.agreement);
        if state.mean.count < s.cycles {
            return None;
        }
        let result = self.ultimate(&state.mean);
        if !is_usable(result.gain + result.period + result.amplitude + result.duty) {
            state.mean = Mean::default();
            return None;
        }
        Some(result)
    }

    /// k_u and T_u of the averaged cycle.
    fn ultimate(&self, mean: &Mean<T>) -> Ultimate<T> {
        let (s, pi) = (&self.settings, T::from_f64(core::f64::consts::PI));
        let (a, eps) = (mean.amplitude, s.hysteresis);
        let harmonic = T::from_f64(4.0) * s.amplitude * (pi * mean.duty).sin() / pi;
        Ultimate {
            gain: harmonic / ((a - eps).sqrt() * (a + eps).sqrt()),
            period: mean.period,
            amplitude: a,
            duty: mean.duty,
        }
    }
}

crate::checked::stored_as! { Relay<T> as RelaySettings<T>: |relay| relay.settings, Relay::try_new }
