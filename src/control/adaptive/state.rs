//! What goes into a step, what comes out, and what is kept between.

use super::Adaptive;
use crate::control::status::Held;
use crate::control::Status;
use crate::signal::{gap_after, Compensated, DerivativeState};
use crate::Real;

/// One sample for an [`Adaptive`] law.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AdaptiveInput<T, const N: usize> {
    /// Time since the last sample \[s\].
    pub dt: T,
    /// Reference y_r \[N·m\].
    pub reference: T,
    /// Reference at the next sample \[N·m\]; only the lag form reads it.
    pub next_reference: T,
    /// Measured output torque y \[N·m\].
    pub measured: T,
    /// Regressors x_i \[their own units\]: velocity and acceleration in the paper.
    pub regressors: [T; N],
    /// Added to the law's command \[command unit\].
    pub feed_forward: T,
}

impl<T: Real, const N: usize> AdaptiveInput<T, N> {
    /// A sample with a constant reference and no feed-forward.
    ///
    /// ```
    /// use bowden::control::AdaptiveInput;
    /// let input = AdaptiveInput::new(0.001, 25.0, 24.8, [0.1, 0.0]); // \[s\], [N·m], [N·m]
    /// assert_eq!((input.next_reference, input.feed_forward), (25.0, 0.0));
    /// ```
    #[must_use]
    pub const fn new(dt: T, reference: T, measured: T, regressors: [T; N]) -> Self {
        Self {
            dt,
            reference,
            next_reference: reference,
            measured,
            regressors,
            feed_forward: T::ZERO,
        }
    }
}

/// What [`Adaptive::step_with_terms`] gives: the command, and why.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AdaptiveOutput<T, const N: usize> {
    /// The command \[command unit\], finite and within the limits.
    pub command: T,
    /// Whether the sample was good.
    pub status: Status,
    /// Every term of the law.
    pub terms: AdaptiveTerms<T, N>,
}

/// Every term of the law in one step, with the estimates that the step used.
///
/// After a bad sample, and where a regressor is left out ([`Status::Degraded`]), `z` and the
/// estimates are those of the state; the rest is zero.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AdaptiveTerms<T, const N: usize> {
    /// e = y - y_r \[N·m\], (13).
    pub error: T,
    /// Accumulated error z before this sample \[N·m·s\], (17).
    pub z: T,
    /// s = e + lambda·z \[N·m\], (18).
    pub s: T,
    /// Filtered rate of the error \[N·m/s\]; zero in the lag form.
    pub error_rate: T,
    /// Smooth sign of s/epsilon.
    pub smooth_sign: T,
    /// Virtual command ubar \[N·m\], (23).
    pub virtual_command: T,
    /// The law's own share of the command before limits \[command unit\].
    pub law: T,
    /// Feed-forward \[command unit\].
    pub feed_forward: T,
    /// Command before limits \[command unit\].
    pub unlimited: T,
    /// Whether a limit has changed the command.
    pub limited: bool,
    /// beta_hat \[command unit/(N·m)\].
    pub beta_hat: T,
    /// delta_hat \[N·m\].
    pub delta_hat: T,
    /// theta_hat_i \[N·m/unit of the regressor\].
    #[cfg_attr(
        feature = "serde",
        serde(with = "super::list", bound(serialize = "T: Real + serde::Serialize"))
    )]
    pub theta_hat: [T; N],
}

/// State of an [`Adaptive`] law: accumulated error, estimates, last good command.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        try_from = "Unchecked<T, N>",
        bound(
            serialize = "T: Real + serde::Serialize",
            deserialize = "T: Real + serde::Deserialize<'de>"
        )
    )
)]
pub struct AdaptiveState<T, const N: usize> {
    pub(super) z: Compensated<T>,
    pub(super) error_rate: DerivativeState<T>,
    /// The law's share of the last command, which the lag form moves on from.
    pub(super) lag: Compensated<T>,
    pub(super) beta: Compensated<T>,
    pub(super) delta: Compensated<T>,
    #[cfg_attr(feature = "serde", serde(with = "super::list"))]
    pub(super) theta: [Compensated<T>; N],
    pub(super) held: Held<T>,
    /// Time of the bad samples since the last good one \[s\]; the highest float where nobody
    /// knows it: the error's rate then stays as it is for a sample.
    pub(super) gap: T,
}

impl<T: Real, const N: usize> AdaptiveState<T, N> {
    /// The start: initial estimates, no accumulated error, the command nearest to zero.
    #[must_use]
    pub fn new(law: &Adaptive<T, N>) -> Self {
        let settings = law.settings();
        let command = settings.limits.confine(T::ZERO);
        Self {
            z: Compensated::new(T::ZERO),
            error_rate: DerivativeState::new(),
            lag: Compensated::new(command),
            beta: Compensated::new(settings.beta.initial),
            delta: Compensated::new(settings.delta.initial),
            theta: settings.theta.map(|theta| Compensated::new(theta.initial)),
            held: Held::new(command),
            gap: T::ZERO,
        }
    }

    /// Back to the start, as [`new`](Self::new), but the command that is out stays known, and
    /// with it the score of the bad samples and whether the safe command is out.
    ///
    /// A slew rate goes on from there, a bad sample holds it, and the next good one after an
    /// acknowledged fault starts from it. For a state that knows of no command, assign
    /// [`AdaptiveState::new`].
    pub fn reset(&mut self, law: &Adaptive<T, N>) {
        *self = Self {
            held: self.held,
            ..Self::new(law)
        };
    }

    /// Makes a state that was stored fit for a start: the power was off, nothing is out.
    ///
    /// As [`reset`](Self::reset), but the estimates stay and the command is the one nearest to zero
    /// that the limits allow. A safe command that was latched stays so, and so does the score of the
    /// bad samples. The first good sample starts from that command, as after
    /// [`acknowledge`](Self::acknowledge). A step on a stored state *without* this goes on with the
    /// command of then.
    pub fn power_up(&mut self, law: &Adaptive<T, N>) {
        let fresh = Self::new(law);
        *self = Self {
            beta: self.beta,
            delta: self.delta,
            theta: self.theta,
            held: self.held.after_power_off(fresh.held.command),
            ..fresh
        };
    }

    /// Takes note that somebody has seen the fault: the loop may be closed again.
    ///
    /// While the safe command is latched ([`Status::Safe`]) nothing else closes it. The next
    /// good sample then goes on from the safe command, with the estimates as they were.
    pub fn acknowledge(&mut self) {
        self.held.acknowledge();
    }

    /// Accumulated error z \[N·m·s\], (17).
    #[must_use]
    pub fn accumulated_error(&self) -> T {
        self.z.value
    }

    /// beta_hat \[command unit/(N·m)\], (24).
    #[must_use]
    pub fn beta_hat(&self) -> T {
        self.beta.value
    }

    /// delta_hat \[N·m\], (25).
    #[must_use]
    pub fn delta_hat(&self) -> T {
        self.delta.value
    }

    /// theta_hat_i \[N·m/unit of the regressor\], (26).
    #[must_use]
    pub fn theta_hat(&self) -> [T; N] {
        self.theta.map(|theta| theta.value)
    }

    /// The command that is out \[command unit\].
    #[must_use]
    pub fn command(&self) -> T {
        self.held.command
    }

    /// Score of the bad samples, see [`Fallback`](crate::control::Fallback).
    #[must_use]
    pub fn bad_score(&self) -> u32 {
        self.held.score
    }

    /// Whether the safe command is latched.
    #[must_use]
    pub fn is_latched(&self) -> bool {
        self.held.is_latched()
    }

    /// Counts the time of a bad sample.
    pub(super) fn wait(&mut self, dt: T, longest: T) {
        self.gap = gap_after(self.gap, dt, longest);
    }
}

/// What is read before it is checked.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields, bound = "T: Real + serde::Deserialize<'de>")]
struct Unchecked<T, const N: usize> {
    z: Compensated<T>,
    error_rate: DerivativeState<T>,
    lag: Compensated<T>,
    beta: Compensated<T>,
    delta: Compensated<T>,
    #[serde(with = "super::list")]
    theta: [Compensated<T>; N],
    held: Held<T>,
    gap: T,
}

#[cfg(feature = "serde")]
impl<T: Real, const N: usize> TryFrom<Unchecked<T, N>> for AdaptiveState<T, N> {
    type Error = crate::Error;

    /// Refuses numbers that are not finite; [`Adaptive::is_valid`] says more, of one law.
    fn try_from(raw: Unchecked<T, N>) -> Result<Self, crate::Error> {
        let sums = [raw.z, raw.lag, raw.beta, raw.delta];
        let finite = sums.iter().chain(&raw.theta).all(Compensated::is_finite)
            && raw.error_rate.is_finite()
            && raw.held.command.is_finite()
            && raw.gap.is_finite()
            && raw.gap >= T::ZERO;
        if !finite {
            return Err(crate::Error::Inadmissible(
                "a state has finite numbers and no negative gap",
            ));
        }
        Ok(Self {
            z: raw.z,
            error_rate: raw.error_rate,
            lag: raw.lag,
            beta: raw.beta,
            delta: raw.delta,
            theta: raw.theta,
            held: raw.held.remembering(),
            gap: raw.gap,
        })
    }
}
