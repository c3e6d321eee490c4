//! Input, output and state of a step.

use super::Adaptive;
use crate::control::status::Held;
#[cfg(feature = "serde")]
use crate::control::status::Latch;
use crate::control::Applied;
use crate::signal::{Compensated, DerivativeState};
use crate::Real;

/// One sample for an [`Adaptive`] law.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AdaptiveInput<T, const N: usize> {
    /// Time since the last sample \[s\].
    pub dt: T,
    /// Reference y_r \[N·m\].
    pub reference: T,
    /// Reference at the next sample \[N·m\]; only the first-order form reads it.
    pub next_reference: T,
    /// Measured output torque y \[N·m\].
    pub measured: T,
    /// Regressors x_i \[their own units\]: velocity and acceleration in Nguyen et al. (2018).
    pub regressors: [T; N],
    /// Feed-forward, added to the law's command \[command unit\].
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

/// Every term of the law in one step, with the estimates that the step used.
///
/// After a bad sample, or with a dropped regressor ([`Degraded`](crate::control::Status::Degraded)),
/// `z` and the estimates are the values in the state; the other terms are zero.
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
    /// Filtered rate of the error \[N·m/s\]; zero in the first-order form.
    pub error_rate: T,
    /// Smooth sign of s/epsilon.
    pub smooth_sign: T,
    /// Virtual command ubar \[N·m\], (23).
    pub virtual_command: T,
    /// The law's own part of the command before limits \[command unit\].
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
        serde(with = "crate::list", bound(serialize = "T: Real + serde::Serialize"))
    )]
    pub theta_hat: [T; N],
}

crate::checked::stored! {
    /// State of an [`Adaptive`] law: accumulated error, estimates, last good command.
    pub struct AdaptiveState<T, const N: usize> {
        pub(super) z: Compensated<T>,
        pub(super) error_rate: DerivativeState<T>,
        /// The law's share of the last command, from which the first-order form continues.
        pub(super) lag: Compensated<T>,
        pub(super) beta: Compensated<T>,
        pub(super) delta: Compensated<T>,
        #[serde(with = "crate::list")]
        pub(super) theta: [Compensated<T>; N],
        pub(super) held: Held<T>,
        /// Time of the bad samples since the last good one \[s\]. The highest float means an
        /// unknown time: the error's rate then stays unchanged for a sample.
        pub(super) gap: T,
        /// The limit of the drive at the last command; outdated if the latch is not set.
        pub(super) drive: Option<End>,
    }
    => {
        let mut restored = held.remembering();
        if held.latch == Latch::Told {
            restored.tell();
        }
        let state = Self { z, error_rate, lag, beta, delta, theta, held: restored, gap, drive };
        if gap < T::ZERO {
            return Err(crate::Error::Inadmissible("a state must have no negative gap"));
        }
        finite(state)
    }
}

crate::data! {
    /// A limit of the drive.
    #[derive(Eq)]
    pub(crate) enum End {
        Upper,
        Lower,
    }
}

impl End {
    /// Whether an error of this sign requires more than the drive gives.
    pub(super) fn is_asked_for_more<T: Real>(self, error: T) -> bool {
        match self {
            Self::Upper => error < T::ZERO,
            Self::Lower => error > T::ZERO,
        }
    }
}

impl<T: Real, const N: usize> AdaptiveState<T, N> {
    /// A new state: the initial estimates, no accumulated error, and the permitted command nearest
    /// to zero.
    pub fn new(law: &Adaptive<T, N>) -> Self {
        let settings = law.settings();
        let command = settings.limits.clamp(T::ZERO);
        Self {
            z: Compensated::new(T::ZERO),
            error_rate: DerivativeState::new(),
            lag: Compensated::new(command),
            beta: Compensated::new(settings.beta.initial),
            delta: Compensated::new(settings.delta.initial),
            theta: settings.theta.map(|theta| Compensated::new(theta.initial)),
            held: Held::new(command),
            gap: T::ZERO,
            drive: None,
        }
    }

    /// Resets to the start like [`new`](Self::new), but keeps the applied command, the fault
    /// counter, and a latched safe command.
    ///
    /// A slew-rate limit and the first-order form continue from the applied command, and a bad
    /// sample holds it. The next good sample after an acknowledged fault starts from it. For a
    /// state without a command, assign [`AdaptiveState::new`].
    pub fn reset(&mut self, law: &Adaptive<T, N>) {
        *self = Self {
            held: self.held,
            lag: Compensated::new(self.held.command),
            ..Self::new(law)
        };
    }

    /// Prepares a stored state for a restart after a power-off, when no command is applied.
    ///
    /// Like [`reset`](Self::reset), but the estimates are kept, and the command becomes the value
    /// nearest to zero within the limits. A latched safe command stays latched, and the fault
    /// counter is kept. The first good sample starts from this command, as after
    /// [`acknowledge`](Self::acknowledge). Without this call a step on a stored state continues
    /// with the stored command.
    pub fn restore(&mut self, law: &Adaptive<T, N>) {
        let fresh = Self::new(law);
        *self = Self {
            beta: self.beta,
            delta: self.delta,
            theta: self.theta,
            held: self.held.after_power_off(fresh.held.command),
            ..fresh
        };
    }

    /// Acknowledges the fault: the next good sample closes the loop again.
    ///
    /// Only this call ends a latched safe command ([`Safe`](crate::control::Status::Safe)). The next
    /// good sample continues from the safe command, with unchanged estimates.
    pub fn acknowledge(&mut self) {
        self.held.acknowledge();
    }

    /// Reports the drive's response to the last command if the drive did not apply the command.
    ///
    /// Call this method between two steps. The slew-rate limit and the first-order form then
    /// continue from the applied command. At the next good sample, z moves no further towards this
    /// limit of the drive, and the estimates do not change, as at a limit of the law itself. See
    /// [`Applied`].
    pub fn applied(&mut self, applied: Applied<T>) {
        let out = self.held.command;
        self.drive = match applied {
            Applied::AtUpperLimit => Some(End::Upper),
            Applied::AtLowerLimit => Some(End::Lower),
            Applied::Command(sent) if sent.is_finite() && sent != out => {
                let lag = self.lag.value + (sent - out);
                if lag.is_finite() {
                    self.lag = Compensated::new(lag);
                }
                self.held.command = sent;
                Some(if sent < out { End::Upper } else { End::Lower })
            }
            Applied::AsCommanded | Applied::Command(_) => return,
        };
        self.held.tell();
    }

    /// Accumulated error z \[N·m·s\], (17).
    pub fn accumulated_error(&self) -> T {
        self.z.value
    }

    /// beta_hat \[command unit/(N·m)\], (24).
    pub fn beta_hat(&self) -> T {
        self.beta.value
    }

    /// delta_hat \[N·m\], (25).
    pub fn delta_hat(&self) -> T {
        self.delta.value
    }

    /// theta_hat_i \[N·m/unit of the regressor\], (26).
    pub fn theta_hat(&self) -> [T; N] {
        self.theta.map(|theta| theta.value)
    }

    /// The applied command \[command unit\].
    pub fn command(&self) -> T {
        self.held.command
    }

    /// The fault counter, see [`Fallback`](crate::control::Fallback).
    pub fn fault_counter(&self) -> u32 {
        self.held.score
    }

    /// Whether the safe command is latched.
    pub fn is_latched(&self) -> bool {
        self.held.is_latched()
    }
}
