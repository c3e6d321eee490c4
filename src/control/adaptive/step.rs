//! One step of the law, in the order that the theorems assume.

use super::{Adaptive, AdaptiveInput, AdaptiveOutput, AdaptiveState, AdaptiveTerms, Form};
use crate::control::status::{usable, usable_dt};
use crate::control::Fault;
use crate::Real;

impl<T: Real, const N: usize> Adaptive<T, N> {
    /// The command \[command unit\] for one sample; call it once a sample.
    ///
    /// In order: `e = y - y_r`; `s = e + lambda·z`, with z as the samples before left it;
    /// the command from the estimates of the samples before; then `z⁺ = z + dt·e` and the
    /// estimates from (s, ubar, x), each into its box. Were z updated before s, the exact
    /// recursion of the lag form, and with it the box theorem, would not hold.
    ///
    /// Where a limit cuts the command, z does not move further against that limit, and the
    /// estimates wait while s asks for more than the limit gives; both unwind at once.
    ///
    /// A bad sample leaves the state and holds the last good command, see
    /// [`control`](crate::control). A `dt` longer than [`largest_step`](Self::largest_step)
    /// counts as one. So does a sample that is finite but so large that the law
    /// overflows ([`Fault::Overflow`]).
    #[inline]
    pub fn step(
        &self,
        state: &mut AdaptiveState<T, N>,
        input: &AdaptiveInput<T, N>,
    ) -> AdaptiveOutput<T, N> {
        let (status, terms) = match self.advance(state, input) {
            Ok((mut next, command, terms)) => {
                let status = next.held.good(command);
                *state = next;
                (status, terms)
            }
            Err(fault) => {
                let terms = AdaptiveTerms::at_rest(state);
                (state.held.bad(fault, &self.settings.fallback), terms)
            }
        };
        AdaptiveOutput {
            command: state.held.command,
            status,
            terms,
        }
    }

    /// The state, command and terms after a sample, or what was wrong with it.
    fn advance(
        &self,
        state: &AdaptiveState<T, N>,
        input: &AdaptiveInput<T, N>,
    ) -> Result<Advanced<T, N>, Fault> {
        self.check(input)?;
        let dt = input.dt;
        let mut next = *state;
        let terms = self.terms(state, &mut next, input);
        if !(terms.unlimited.is_finite() && terms.virtual_command.is_finite()) {
            return Err(Fault::Overflow);
        }
        let limits = &self.settings.limits;
        let command = limits.apply(state.held.command, terms.unlimited, dt);
        let limited = command != terms.unlimited;
        next.lag = if limited {
            command - input.feed_forward
        } else {
            terms.law
        };
        // An error of this sign asks for more than the limit gives.
        let asks_more = |error: T| {
            (command < terms.unlimited && error < T::zero())
                || (command > terms.unlimited && error > T::zero())
        };
        if !asks_more(terms.error) {
            let limit = self.settings.z_limit;
            let moved = state.z.add(dt * terms.error, -limit, limit);
            next.z = moved.ok_or(Fault::Overflow)?;
        }
        if !self.settings.frozen && !asks_more(terms.s) {
            self.adapt(&mut next, input, &terms)
                .ok_or(Fault::Overflow)?;
        }
        if !next.lag.is_finite() {
            return Err(Fault::Overflow);
        }
        Ok((next, command, AdaptiveTerms { limited, ..terms }))
    }

    /// Refuses what cannot be used, in the order of the fields.
    fn check(&self, input: &AdaptiveInput<T, N>) -> Result<(), Fault> {
        let dt = usable_dt(input.dt)?;
        if self.longest.is_some_and(|longest| dt > longest) {
            return Err(Fault::DtTooLong);
        }
        usable(input.reference, Fault::Reference)?;
        usable(input.next_reference, Fault::Reference)?;
        usable(input.measured, Fault::Measured)?;
        for (i, x) in input.regressors.iter().enumerate() {
            usable(*x, Fault::Regressor(u8::try_from(i).unwrap_or(u8::MAX)))?;
        }
        usable(input.feed_forward, Fault::FeedForward)?;
        Ok(())
    }

    /// The law (18), (19), (23), or its lag form. Only the error's rate moves in `next`.
    fn terms(
        &self,
        state: &AdaptiveState<T, N>,
        next: &mut AdaptiveState<T, N>,
        input: &AdaptiveInput<T, N>,
    ) -> AdaptiveTerms<T, N> {
        let settings = &self.settings;
        let error = input.measured - input.reference;
        let error_rate = match settings.form {
            Form::Literal { .. } => self.derivative.step(&mut next.error_rate, error, input.dt),
            Form::Lag { .. } => T::zero(),
        };
        let mut terms = AdaptiveTerms {
            error,
            error_rate,
            feed_forward: input.feed_forward,
            ..AdaptiveTerms::at_rest(state)
        };
        terms.s = error + settings.lambda * terms.z;
        terms.smooth_sign = settings.smooth_sign.of(terms.s / settings.epsilon);
        terms.virtual_command = self.virtual_command(&terms, input);
        let wanted = terms.beta_hat * terms.virtual_command;
        terms.law = match settings.form {
            Form::Literal { .. } => wanted,
            Form::Lag { .. } => {
                let start = self.lag_start(state, input);
                start + input.dt * settings.lambda * (wanted - start)
            }
        };
        terms.unlimited = terms.law + input.feed_forward;
        terms
    }

    /// ubar of (23), where the lag form has the reference's rate for the error's.
    #[inline]
    pub(super) fn virtual_command(
        &self,
        terms: &AdaptiveTerms<T, N>,
        input: &AdaptiveInput<T, N>,
    ) -> T {
        let settings = &self.settings;
        let rate = match settings.form {
            Form::Literal { .. } => -terms.error_rate,
            Form::Lag { .. } => (input.next_reference - input.reference) / input.dt,
        };
        let mut compensation = T::zero();
        for (theta, x) in terms.theta_hat.iter().zip(&input.regressors) {
            compensation += *theta * *x;
        }
        -settings.gain * terms.s
            + input.reference
            + (rate - terms.z) / settings.lambda
            + compensation
            - terms.delta_hat * terms.smooth_sign
    }

    /// Where the lag moves on from: from the safe command if that was out.
    fn lag_start(&self, state: &AdaptiveState<T, N>, input: &AdaptiveInput<T, N>) -> T {
        if state.held.is_safe(&self.settings.fallback) {
            state.held.command - input.feed_forward
        } else {
            state.lag
        }
    }

    /// (24)-(26); `None` where an estimate overflows.
    fn adapt(
        &self,
        next: &mut AdaptiveState<T, N>,
        input: &AdaptiveInput<T, N>,
        terms: &AdaptiveTerms<T, N>,
    ) -> Option<()> {
        let settings = &self.settings;
        let (dt, pull) = (input.dt, settings.lambda * terms.s);
        let beta = &settings.beta;
        next.beta = beta.update(next.beta, dt, -pull * terms.virtual_command)?;
        let delta = &settings.delta;
        next.delta = delta.update(next.delta, dt, pull * terms.smooth_sign)?;
        for i in 0..N {
            let (estimate, x) = (next.theta.get_mut(i)?, input.regressors.get(i)?);
            *estimate = settings.theta.get(i)?.update(*estimate, dt, -pull * *x)?;
        }
        Some(())
    }
}

type Advanced<T, const N: usize> = (AdaptiveState<T, N>, T, AdaptiveTerms<T, N>);

impl<T: Real, const N: usize> AdaptiveTerms<T, N> {
    /// What a state alone says: z and the estimates.
    pub(super) fn at_rest(state: &AdaptiveState<T, N>) -> Self {
        let zero = T::zero();
        Self {
            error: zero,
            z: state.z.value,
            s: zero,
            error_rate: zero,
            smooth_sign: zero,
            virtual_command: zero,
            law: zero,
            feed_forward: zero,
            unlimited: zero,
            limited: false,
            beta_hat: state.beta.value,
            delta_hat: state.delta.value,
            theta_hat: state.theta_hat(),
        }
    }
}
