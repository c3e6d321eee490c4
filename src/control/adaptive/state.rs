//! Input, terms and state of a step of the adaptive law.

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
    /// Reference at the next sample \[N·m\]. Only the first-order form uses the value, but both
    /// forms reject a value that is not finite.
    pub next_reference: T,
    /// Measured output torque y \[N·m\].
    pub measured: T,
    /// Regressors x_i \[their own units\]: velocity and acceleration in Nguyen et al. (2018).
    pub regressors: [T; N],
    /// Feed-forward, added to the command of the adaptive law \[command unit\].
    pub feed_forward: T,
}

impl<T: Real, const N: usize> AdaptiveInput<T, N> {
    /// A sample with a constant reference and no feed-forward.
    ///
    /// ```
    /// use bowden::control::AdaptiveInput;
    /// let input = AdaptiveInput::new(0.001, 25.0, 24.8, [0.1, 0.0]); // [s], [N·m], [N·m]
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

/// All terms of the adaptive law in one step, and the estimates used in this step.
///
/// If the status is not [`Good`](crate::control::Status::Good), `z` and the estimates are the
/// values in the state. The other terms are then zero.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AdaptiveTerms<T, const N: usize> {
    /// Tracking error `e = y - y_r` \[N·m\].
    pub error: T,
    /// Accumulated error z before this sample \[N·m·s\].
    pub z: T,
    /// Filtered error `s = e + lambda·z` \[N·m\].
    pub s: T,
    /// Filtered error rate e' \[N·m/s\]; zero in the first-order form.
    pub error_rate: T,
    /// Smoothed sign function of s/epsilon.
    pub smooth_sign: T,
    /// Virtual command ubar of (23) \[N·m\].
    pub virtual_command: T,
    /// Command of the adaptive law without feed-forward, before the limits \[command unit\].
    pub law: T,
    /// Feed-forward \[command unit\].
    pub feed_forward: T,
    /// Command with feed-forward, before the limits \[command unit\].
    pub unlimited: T,
    /// Whether a limit has changed the command; always `false` in [`Adaptive::terms`].
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
    /// State of an [`Adaptive`] law: accumulated error, estimates and last good command.
    pub struct AdaptiveState<T, const N: usize> {
        pub(super) z: Compensated<T>,
        pub(super) error_rate: DerivativeState<T>,
        /// The last command without feed-forward, from which the first-order form continues.
        pub(super) lag: Compensated<T>,
        pub(super) beta: Compensated<T>,
        pub(super) delta: Compensated<T>,
        #[serde(with = "crate::list")]
        pub(super) theta: [Compensated<T>; N],
        pub(super) held: Held<T>,
        /// Time of the bad samples since the last good one \[s\]. The highest float means an
        /// unknown time: the error rate then stays unchanged for a sample.
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

impl<T: Real, const N: usize> AdaptiveState<T, N> {
    /// Initial state with the initial estimates and zero accumulated error. The command is the
    /// value nearest to zero within the limits.
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

    /// Resets the state like [`new`](Self::new), but keeps the applied command, the fault counter
    /// and a latched safe command.
    ///
    /// To discard the applied command as well, assign [`AdaptiveState::new`].
    pub fn reset(&mut self, law: &Adaptive<T, N>) {
        *self = Self {
            held: self.held,
            lag: Compensated::new(self.held.command),
            ..Self::new(law)
        };
    }

    /// Prepares a stored state for a restart after a power-off, when no command is applied.
    ///
    /// This is a [`reset`](Self::reset) that keeps the estimates and sets the command to the value
    /// nearest to zero within the limits. A latched safe command stays latched, and the fault
    /// counter is kept. The first good sample starts from the new command. Without this call, a
    /// step on a stored state continues from the stored command.
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
    /// The next good sample continues from the safe command with the same estimates.
    pub fn acknowledge(&mut self) {
        self.held.acknowledge();
    }

    /// Reports the drive's response to the last command if the drive did not apply the command.
    ///
    /// Call this method between two steps. The slew-rate limit and the first-order form then
    /// continue from the applied command, if it is known. At the next good sample, z does not move
    /// further towards the limit of the drive. At this sample, the estimates do not change if s
    /// requires more than the limit allows. See [`Applied`].
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

    /// Accumulated error z of (17) \[N·m·s\].
    pub fn accumulated_error(&self) -> T {
        self.z.value
    }

    /// Estimate beta_hat of (24) \[command unit/(N·m)\].
    pub fn beta_hat(&self) -> T {
        self.beta.value
    }

    /// Estimate delta_hat of (25) \[N·m\].
    pub fn delta_hat(&self) -> T {
        self.delta.value
    }

    /// Estimates theta_hat_i of (26) \[N·m/unit of the regressor\].
    pub fn theta_hat(&self) -> [T; N] {
        self.theta.map(|theta| theta.value)
    }

    /// The applied command \[command unit\].
    pub fn command(&self) -> T {
        self.held.command
    }

    /// The fault counter of the [`Fallback`](crate::control::Fallback).
    pub fn fault_counter(&self) -> u32 {
        self.held.score
    }

    /// Whether the safe command is latched.
    pub fn is_latched(&self) -> bool {
        self.held.is_latched()
    }
}
