//! What a [`Pid`] remembers between samples.

use super::{Pid, PidInput};
use crate::control::status::Held;
use crate::control::Status;
use crate::error::is_usable;
use crate::signal::{gap_after, Compensated};
use crate::Real;

/// State of a [`Pid`]: the integral, the filtered rate, the last good sample.
///
/// `Copy`: it can be saved and restored. Any state works with any [`Pid`]; to change
/// the gains of a running one without a jump see [`Pid::take_over`].
///
/// ```
/// use bowden::control::{Pid, PidInput, PidState};
/// let pid = Pid::paper_pi();
/// let mut state = PidState::new();
/// pid.step(&mut state, &PidInput::new(0.001, 1.0, 0.5_f64));
/// assert!(state.integral() > 0.0);
/// state.reset();
/// assert_eq!(state.integral(), 0.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
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
pub struct PidState<T> {
    /// The integral term \[command unit\].
    pub(super) integral: Compensated<T>,
    /// Filtered rate of y − c·y_r, zero where that is not used.
    pub(super) rate: T,
    pub(super) last: Option<Last<T>>,
    pub(super) held: Held<T>,
    /// Time of the bad samples since the last good one \[s\]; the highest float where
    /// nobody knows it: the rate then stays as it is for a sample.
    pub(super) gap: T,
}

/// The last good sample, and what came of it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Last<T> {
    pub(crate) reference: T,
    pub(crate) measured: T,
    /// Zero where it was no number, which only PIV minds.
    pub(crate) velocity: T,
    pub(crate) feed_forward: T,
    pub(crate) command: T,
    pub(crate) unlimited: T,
}

impl<T: Real> Last<T> {
    /// A sample before the law has seen it.
    #[inline]
    pub(super) fn at(at: &PidInput<T>) -> Self {
        Self {
            reference: at.reference,
            measured: at.measured,
            velocity: at.velocity,
            feed_forward: at.feed_forward,
            command: T::ZERO,
            unlimited: T::ZERO,
        }
    }

    /// The same, with zero for a velocity that is no number.
    pub(super) fn with_known_velocity(self) -> Self {
        if is_usable(self.velocity) {
            return self;
        }
        Self {
            velocity: T::ZERO,
            ..self
        }
    }
}

impl<T: Real> PidState<T> {
    /// A state that has seen no sample; its command is zero.
    ///
    /// A slew rate starts from that zero; start with [`PidState::resume_from`] where
    /// something else is out.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            integral: Compensated::new(T::ZERO),
            rate: T::ZERO,
            last: None,
            held: Held::new(T::ZERO),
            gap: T::ZERO,
        }
    }

    /// Starts anew so that the command goes on from `output` \[command unit\].
    ///
    /// At the sample `at`, with its feed-forward, the terms add up to `output` (which is
    /// taken within the limits): for a start at a command that is already out, for the
    /// hand-over from a human or from another controller. The rate starts at zero. The
    /// next step at the same sample adds one step of the integral, nothing else. `at.dt`
    /// is not read. Where [`AntiWindup::Clamp`](super::AntiWindup::Clamp) does not let
    /// the integral go that far, it goes as far as it may.
    ///
    /// A number that is not finite, or an overflow, leaves the state as it was, but for
    /// the count of bad samples, and is told. Where the safe command is latched it stays. The
    /// score of the bad samples stays too: whoever starts anew after each of them still gets the
    /// safe command.
    ///
    /// What the terms lack at `at` goes into the integral. Without an integral gain nothing moves
    /// it again, so that a P, PD or PIV law keeps the difference for ever: there, a new state
    /// starts at the terms themselves.
    ///
    /// ```
    /// use bowden::control::{Pid, PidInput, PidState, Status};
    /// let pid = Pid::paper_pi();
    /// let mut state = PidState::new();
    /// let at = PidInput { feed_forward: 20.0, ..PidInput::new(0.001, 25.0, 25.0_f64) };
    /// assert_eq!(state.resume_from(&pid, 42.0, &at), Status::Good);
    /// assert_eq!(pid.step(&mut state, &at).command, 42.0);
    /// ```
    pub fn resume_from(&mut self, pid: &Pid<T>, output: T, at: &PidInput<T>) -> Status {
        let fallback = &pid.settings().fallback;
        if let Some(safe) = self.held.latched(fallback) {
            return safe;
        }
        match pid.started_at(output, at) {
            Ok((last, integral)) => {
                self.start(last, integral);
                Status::Good
            }
            Err(fault) => self.held.bad(fault, fallback),
        }
    }

    /// Stands at a sample with this integral, at rest.
    pub(super) fn start(&mut self, last: Last<T>, integral: T) {
        *self = Self {
            integral: Compensated::new(integral),
            last: Some(last),
            held: self.held.going_on_from(last.command),
            ..Self::new()
        };
    }

    /// Takes note that somebody has seen the fault: the loop may be closed again.
    ///
    /// While the safe command is latched ([`Status::Safe`]) nothing else closes it. The next
    /// good sample then starts from the safe command, without a jump, as
    /// [`resume_from`](Self::resume_from) does; without an integral gain it starts from the
    /// terms themselves, through the slew rate.
    pub fn acknowledge(&mut self) {
        self.held.acknowledge();
    }

    /// Forgets integral, rate and samples; the command that is out stays known.
    ///
    /// A slew rate goes on from there, and a safe command that is latched stays so. So does the
    /// score of the bad samples: whoever resets at each of them still gets the safe command. For
    /// a state that knows of no command, assign [`PidState::new`].
    pub fn reset(&mut self) {
        *self = Self {
            held: self.held,
            ..Self::new()
        };
    }

    /// Makes a state that was stored fit for a start: the power was off, nothing is out.
    ///
    /// Integral, rate and samples are forgotten, and the command is the one nearest to zero that
    /// the limits allow. A safe command that was latched stays so, and so does the score of the bad
    /// samples. The first good sample starts from that command without a jump, as after
    /// [`acknowledge`](Self::acknowledge). A step on a stored state *without* this
    /// goes on with the command of then.
    ///
    /// ```
    /// use bowden::control::{Pid, PidInput, PidState};
    /// let pi = Pid::paper_pi();
    /// let mut state = PidState::new();
    /// pi.step(&mut state, &PidInput::new(0.001, 2.0, 0.0_f64));
    /// let stored = state; // 60 units are out; then the power fails
    /// let mut state = stored;
    /// state.power_up(&pi);
    /// assert_eq!(pi.step(&mut state, &PidInput::new(0.001, 2.0, 0.0)).command, 0.0);
    /// ```
    pub fn power_up(&mut self, pid: &Pid<T>) {
        let command = pid.settings().limits.confine(T::ZERO);
        *self = Self {
            held: self.held.after_power_off(command),
            ..Self::new()
        };
    }

    /// The command that is out \[command unit\].
    #[inline]
    #[must_use]
    pub fn command(&self) -> T {
        self.held.command
    }

    /// The integral term \[command unit\].
    #[inline]
    #[must_use]
    pub fn integral(&self) -> T {
        self.integral.value
    }

    /// The filtered rate of `y − c·y_r` \[output unit/s\]; zero where it is not used.
    #[inline]
    #[must_use]
    pub fn rate(&self) -> T {
        self.rate
    }

    /// Score of the bad samples, see [`Fallback`](crate::control::Fallback).
    #[inline]
    #[must_use]
    pub fn bad_score(&self) -> u32 {
        self.held.score
    }

    /// Whether the safe command is latched.
    #[inline]
    #[must_use]
    pub fn is_latched(&self) -> bool {
        self.held.is_latched()
    }

    /// Whether this is a state that steps can lead to: every number is finite.
    #[cfg(any(feature = "serde", kani))]
    pub(crate) fn is_valid(&self) -> bool {
        self.integral.is_finite()
            && self.rate.is_finite()
            && self.gap.is_finite()
            && self.gap >= T::zero()
            && self.held.command.is_finite()
            && self.last.is_none_or(|last| last.is_valid())
    }

    /// Takes note of a good sample; its command.
    #[inline(always)]
    pub(super) fn moved_on(&mut self, last: Last<T>, integral: Compensated<T>, rate: T) -> T {
        self.integral = integral;
        self.rate = rate;
        self.gap = T::ZERO;
        self.last = Some(last);
        self.held.command = last.command;
        last.command
    }

    /// Counts the time of a bad sample.
    pub(super) fn wait(&mut self, dt: T, longest: T) {
        self.gap = gap_after(self.gap, dt, longest);
    }
}

#[cfg(any(feature = "serde", kani))]
impl<T: Real> Last<T> {
    fn is_valid(&self) -> bool {
        let samples = [self.reference, self.measured, self.velocity];
        let commands = [self.feed_forward, self.command, self.unlimited];
        samples.iter().chain(&commands).all(|x| x.is_finite())
            && (self.measured - self.reference).is_finite()
    }
}

/// What is read, or made by a proof, before it is checked.
#[cfg(any(feature = "serde", kani))]
#[cfg_attr(feature = "serde", derive(serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub(crate) struct Unchecked<T> {
    pub(crate) integral: Compensated<T>,
    pub(crate) rate: T,
    pub(crate) last: Option<Last<T>>,
    pub(crate) held: Held<T>,
    pub(crate) gap: T,
}

#[cfg(any(feature = "serde", kani))]
impl<T: Real> PidState<T> {
    /// These fields, whatever they are.
    pub(crate) fn assumed(raw: Unchecked<T>) -> Self {
        Self {
            integral: raw.integral,
            rate: raw.rate,
            last: raw.last,
            held: raw.held,
            gap: raw.gap,
        }
    }
}

#[cfg(any(feature = "serde", kani))]
impl<T: Real> TryFrom<Unchecked<T>> for PidState<T> {
    type Error = crate::Error;
    fn try_from(raw: Unchecked<T>) -> Result<Self, crate::Error> {
        let state = Self::assumed(Unchecked {
            held: raw.held.remembering(),
            ..raw
        });
        if state.is_valid() {
            Ok(state)
        } else {
            Err(crate::Error::Inadmissible(
                "a state has finite numbers and no negative gap",
            ))
        }
    }
}
