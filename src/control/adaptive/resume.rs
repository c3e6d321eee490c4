//! Bumpless transfer from another controller or to other gains.

use super::{Adaptive, AdaptiveInput, AdaptiveState, AdaptiveTerms};
use crate::control::status::Held;
use crate::control::{law, Fault, Form, Status};
use crate::signal::{clamp, Compensated, DerivativeState};
use crate::Real;

/// Halvings for `f32` and `f64`: more than the float has digits, so the remaining bracket is below
/// the rounding error.
const HALVINGS: (u32, u32) = (26, 56);

impl<T: Real, const N: usize> AdaptiveState<T, N> {
    /// State whose first step on `input` gives the command `output` \[command unit\].
    ///
    /// The estimates have their initial values. The accumulated error z is chosen so that the
    /// adaptive law and the feed-forward together give `output`. No such z exists if
    /// - beta_hat is zero,
    /// - the required z exceeds its limit,
    /// - the command limits exclude `output`, or
    /// - the sample is bad.
    ///
    /// In these cases, the command jumps, unless the slew-rate limit or the lag of the first-order
    /// form limits its rate.
    ///
    /// This state has no fault. For a running state, use [`Adaptive::resume`].
    ///
    /// ```
    /// use bowden::control::{Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState};
    /// use bowden::control::{Estimator, Form};
    /// let literal = Form::AsPublished { time_constant: 0.005 }; // [s]
    /// let law = Adaptive::try_new(AdaptiveSettings {
    ///     beta: Estimator::fixed(1.2).within(0.5, 2.0),
    ///     delta: Estimator::fixed(7.0).within(0.0, 7.0),
    ///     ..AdaptiveSettings::<f64, 1>::unlimited(literal, 24.0, 8.0, 0.05)
    /// })?;
    /// let input = AdaptiveInput::new(0.001, 25.0, 24.0, [0.3]);
    /// let mut state = AdaptiveState::resume_from(&law, 31.0, &input);
    /// assert!((law.step(&mut state, &input).command - 31.0).abs() < 1e-9);
    /// # Ok::<(), bowden::Error>(())
    /// ```
    pub fn resume_from(law: &Adaptive<T, N>, output: T, input: &AdaptiveInput<T, N>) -> Self {
        let mut state = Self::new(law);
        if output.is_finite() {
            state.held = Held::new(law.settings().limits.clamp(output));
            law.settle(&mut state, input);
        }
        state
    }
}

impl<T: Real, const N: usize> Adaptive<T, N> {
    /// Continues a running state with other settings, without a jump in the command.
    ///
    /// The estimates are clamped to their new bounds. The accumulated error is chosen so that the
    /// next step on `input` gives the applied command, as in [`AdaptiveState::resume_from`].
    ///
    /// ```
    /// use bowden::control::{Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState};
    /// let quiet = Adaptive::<f64, 2>::paper();
    /// let mut state = AdaptiveState::new(&quiet);
    /// let input = AdaptiveInput::new(0.001, 25.0, 20.0, [0.1, 0.0]);
    /// for _ in 0..100 {
    ///     quiet.step(&mut state, &input);
    /// }
    /// let before = state.command();
    /// let eager = Adaptive::try_new(AdaptiveSettings { gain: 30.0, ..*quiet.settings() })?;
    /// eager.bumpless_transfer(&mut state, &input);
    /// assert!((eager.step(&mut state, &input).command - before).abs() < 1e-9);
    /// # Ok::<(), bowden::Error>(())
    /// ```
    pub fn bumpless_transfer(&self, state: &mut AdaptiveState<T, N>, input: &AdaptiveInput<T, N>) {
        let settings = &self.settings;
        let into = |value: T, low: T, high: T| Compensated::new(clamp(value, low, high));
        state.beta = into(state.beta.value, settings.beta.low, settings.beta.high);
        state.delta = into(state.delta.value, settings.delta.low, settings.delta.high);
        for (estimate, theta) in state.theta.iter_mut().zip(&settings.theta) {
            *estimate = into(estimate.value, theta.low, theta.high);
        }
        state.held.command = settings.limits.clamp(state.held.command);
        self.settle(state, input);
    }

    /// Restarts a state so that the next step on `input` gives the command `output` \[command
    /// unit\].
    ///
    /// This method applies [`AdaptiveState::resume_from`] to a running state. An invalid sample
    /// counts as a bad sample. A latched safe command stays latched, and the fault counter is kept.
    ///
    /// The first-order form needs a `dt` to compute the rate of the reference. It uses `input.dt`
    /// or, if `input.dt` is not positive and finite, the `step` of the form.
    pub fn resume(
        &self,
        state: &mut AdaptiveState<T, N>,
        output: T,
        input: &AdaptiveInput<T, N>,
    ) -> Status {
        let fallback = &self.settings.fallback;
        if let Some(safe) = state.held.latched(fallback) {
            return safe;
        }
        let fault = if output.is_finite() {
            self.fault_of_numbers(input)
        } else {
            Some(Fault::Command)
        };
        match fault {
            Some(fault) => state.held.bad(fault, fallback),
            None => {
                let held = state.held;
                *state = AdaptiveState::resume_from(self, output, input);
                state.held = held.going_on_from(state.held.command);
                Status::Good
            }
        }
    }

    /// Chooses z so that the law gives the held command on this input.
    pub(super) fn settle(&self, state: &mut AdaptiveState<T, N>, input: &AdaptiveInput<T, N>) {
        let settings = &self.settings;
        let limit = settings.z_limit;
        state.z = Compensated::new(clamp(state.z.value, -limit, limit));
        state.error_rate = DerivativeState::new();
        state.gap = T::ZERO;
        let share = state.held.command - input.feed_forward;
        // On an unusable sample too: the lag continues from the applied command.
        state.lag = Compensated::new(if share.is_finite() {
            share
        } else {
            state.held.command
        });
        let wanted = share / state.beta.value;
        if !wanted.is_finite() {
            return;
        }
        let z = self.z_that_gives(wanted, state, input);
        if z.is_finite() {
            state.z = Compensated::new(clamp(z, -limit, limit));
        }
    }

    /// The z for which the virtual command is `wanted`; not finite if the law overflows.
    pub(super) fn z_that_gives(
        &self,
        wanted: T,
        state: &AdaptiveState<T, N>,
        input: &AdaptiveInput<T, N>,
    ) -> T {
        let settings = &self.settings;
        let mut terms = AdaptiveTerms {
            error: law::error(input.measured, input.reference),
            ..AdaptiveTerms::at_rest(state)
        };
        // No time passes here: the sample may have no dt.
        let dt = match settings.form {
            Form::FirstOrder { step, .. } if !(input.dt > T::zero() && input.dt.is_finite()) => {
                step
            }
            _ => input.dt,
        };
        let input = &AdaptiveInput { dt, ..*input };
        // ubar falls with z, and is linear in z but for the smooth sign, which lies
        // within [-1, 1]: that brackets the answer.
        let slope = settings.gain * settings.lambda + T::one() / settings.lambda;
        terms.z = T::zero();
        terms.s = terms.error;
        let linear = (self.virtual_command(&terms, input) - wanted) / slope;
        let reach = terms.delta_hat.abs() / slope;
        if !(linear.is_finite() && reach.is_finite()) {
            return T::nan();
        }
        let (mut low, mut high) = (linear - reach, linear + reach);
        let (few, many) = HALVINGS;
        // A float of 24 digits, or one of 53.
        let halvings = if T::epsilon() > T::from_f64(1e-9) {
            few
        } else {
            many
        };
        let mut z = linear;
        for _ in 0..halvings {
            z = low + (high - low) * T::from_f64(0.5);
            let s = law::filtered_error(terms.error, settings.lambda, z);
            // (linear - z)·slope is the excess of the linear part over the wanted command.
            let sign = settings.smooth_sign.of(s / settings.epsilon);
            if (linear - z) * slope > terms.delta_hat * sign {
                low = z;
            } else {
                high = z;
            }
        }
        z
    }
}
