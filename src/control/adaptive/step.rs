//! One step of the adaptive law, in the order that the theorems assume. [`law`] contains the
//! equations.

use super::state::End;
use super::{Adaptive, AdaptiveInput, AdaptiveState, AdaptiveTerms};
use super::{Form, OnMissing};
use crate::control::status::Latch;
use crate::control::{law, Fault, Output, Status, Telemetry};
use crate::error::{is_usable, rarely};
use crate::fault::{fault_of_dt, unless_finite};
use crate::signal::{gap_after, Compensated, Derivative, DerivativeState};
use crate::Real;

impl<T: Real, const N: usize> Adaptive<T, N> {
    /// Processes one sample and returns the command \[command unit\]; call this method once per
    /// sample.
    ///
    /// A step computes, in this order:
    /// 1. `e = y - y_r`, and `s = e + lambda·z` with z from the previous sample;
    /// 2. the command, from the estimates of the previous sample;
    /// 3. `z⁺ = z + dt·e`, and the estimates from (s, ubar, x), each clamped to its bounds.
    ///
    /// The box theorem requires that s is computed from z of the previous sample.
    ///
    /// If a command limit is active, or if the drive is at a limit (see
    /// [`AdaptiveState::applied`]), z does not move further towards this limit. The estimates do
    /// not change while s requires more than the limit allows.
    ///
    /// A bad sample leaves the state unchanged and holds the last good command; see
    /// [`control`](crate::control). A sample is also bad if `dt` is longer than
    /// [`longest_dt`](Self::longest_dt), or if its numbers are so large that the arithmetic
    /// overflows ([`Fault::Overflow`]). The command is within the limits **for any state**,
    /// including a stored state and a state from a law with other settings.
    #[inline]
    pub fn step(&self, state: &mut AdaptiveState<T, N>, input: &AdaptiveInput<T, N>) -> Output<T> {
        if state.held.may_step() {
            if let Some(command) = self.advance(state, input, self.settings.frozen, None) {
                let status = Status::Good;
                return Output { command, status };
            }
        }
        // Passed field by field, so that the sample of a good step stays in registers.
        let mut sample = AdaptiveInput {
            dt: input.dt,
            reference: input.reference,
            next_reference: input.next_reference,
            measured: input.measured,
            regressors: input.regressors,
            feed_forward: input.feed_forward,
        };
        self.exception(state, &mut sample)
    }

    /// The same step, which also returns all terms for telemetry. They are the
    /// [`terms`](Self::terms) before the step.
    ///
    /// In these terms, `limited` reports whether a limit has changed the command of this step.
    pub fn step_with_terms(
        &self,
        state: &mut AdaptiveState<T, N>,
        input: &AdaptiveInput<T, N>,
    ) -> Telemetry<T, AdaptiveTerms<T, N>> {
        let mut before = *state;
        if state.held.is_returning() {
            self.go_back(&mut before, input);
        }
        let terms = self.terms(&before, input);
        let output = self.step(state, input);
        output.with(if output.status == Status::Good {
            let limited = output.command != terms.unlimited;
            AdaptiveTerms { limited, ..terms }
        } else {
            AdaptiveTerms::at_rest(state)
        })
    }

    /// All terms of a step on a good sample, computed from the state before the step.
    #[must_use]
    pub fn terms(
        &self,
        state: &AdaptiveState<T, N>,
        input: &AdaptiveInput<T, N>,
    ) -> AdaptiveTerms<T, N> {
        self.evaluated(state, input).terms
    }

    /// The command of a good sample, which advances the state. `None` leaves the state
    /// unchanged: a number cannot be used, or the law overflows.
    ///
    /// Inlined where the usual step calls it; the exceptions have their own copy.
    #[inline(always)]
    pub(super) fn advance(
        &self,
        state: &mut AdaptiveState<T, N>,
        input: &AdaptiveInput<T, N>,
        frozen: bool,
        drive: Option<End>,
    ) -> Option<T> {
        let dt = input.dt;
        let mut given = (input.measured - input.reference) + input.next_reference;
        given += input.feed_forward;
        for x in &input.regressors {
            given += *x;
        }
        if !(dt.positive_up_to(self.longest) && is_usable(given)) {
            return None;
        }
        let settings = &self.settings;
        let Evaluated {
            terms,
            error_rate,
            mut lag,
        } = self.evaluated(state, input);
        // The numbers that stay; the carry of a sum that overflows is none.
        let mut all = terms.unlimited + lag.carry;
        let limits = &settings.limits;
        let mut command = terms.unlimited;
        let (mut z_waits, mut estimates_wait) = (false, frozen);
        if limits.slew().is_some() || !limits.contains(command) || drive.is_some() {
            rarely();
            command = limits.apply(state.held.command, terms.unlimited, dt);
            let mut upper = command < terms.unlimited || drive == Some(End::Upper);
            let mut lower = command > terms.unlimited || drive == Some(End::Lower);
            if terms.beta_hat < T::ZERO {
                // A higher command lowers the output.
                (upper, lower) = (lower, upper);
            }
            // An error of this sign requires more than the limit gives.
            let asks_more = |error: T| (upper && error < T::ZERO) || (lower && error > T::ZERO);
            z_waits = asks_more(terms.error);
            estimates_wait |= asks_more(terms.s);
            if command != terms.unlimited {
                lag = Compensated::new(command - input.feed_forward);
                all += lag.value;
            }
        }
        let mut z = state.z;
        if !z_waits {
            let limit = settings.z_limit;
            let increment = law::z_increment(dt, terms.error);
            z = z.plus(increment).within(-limit, limit);
            all += z.carry;
        }
        let mut estimates = (state.beta, state.delta, state.theta);
        if !estimates_wait {
            estimates = self.adapted(state, input, &terms);
            let (beta, delta, theta) = &estimates;
            all += beta.carry;
            all += delta.carry;
            for theta in theta {
                all += theta.carry;
            }
        }
        if !is_usable(all) {
            return None;
        }
        state.z = z;
        state.error_rate = error_rate;
        state.lag = lag;
        (state.beta, state.delta, state.theta) = estimates;
        state.gap = T::ZERO;
        state.held.command = command;
        Some(command)
    }

    /// [`advance`](Self::advance) for the exceptions: one copy for all of them.
    #[cold]
    #[inline(never)]
    fn advance_again(
        &self,
        state: &mut AdaptiveState<T, N>,
        input: &AdaptiveInput<T, N>,
        frozen: bool,
    ) -> Option<T> {
        let told = state.held.latch == Latch::Told;
        self.advance(state, input, frozen, state.drive.filter(|_| told))
    }

    /// A bad sample, a dropped regressor, a latched safe command, or the first good sample
    /// after one. The droppable parts of the sample become zero.
    #[cold]
    #[inline(never)]
    fn exception(
        &self,
        state: &mut AdaptiveState<T, N>,
        input: &mut AdaptiveInput<T, N>,
    ) -> Output<T> {
        let fallback = &self.settings.fallback;
        let status = match state.held.latched(fallback) {
            Some(safe) => safe,
            None => match self.live(state, input) {
                Ok(dropped) => {
                    if matches!(state.held.latch, Latch::Returning | Latch::Told) {
                        state.held.good();
                    }
                    dropped.map_or(Status::Good, Status::Degraded)
                }
                Err(fault) => {
                    state.gap = gap_after(state.gap, input.dt, self.longest);
                    state.held.bad_after_step(fault, fallback)
                }
            },
        };
        Output {
            // The state may come from any source.
            command: self.settings.limits.clamp(state.held.command),
            status,
        }
    }

    /// Processes a sample without its droppable parts; returns the first fault that was dropped.
    fn live(
        &self,
        state: &mut AdaptiveState<T, N>,
        input: &mut AdaptiveInput<T, N>,
    ) -> Result<Option<Fault>, Fault> {
        let dropped = self.drop_missing(input)?;
        let frozen = self.settings.frozen || dropped.is_some();
        let command = if state.held.is_returning() {
            self.close(state, input, frozen)
        } else {
            self.advance_again(state, input, frozen)
        };
        command.map(|_| dropped).ok_or(Fault::Overflow)
    }

    /// The first good sample after an acknowledged safe command.
    ///
    /// The lag continues from the safe command. The form as published starts at the z that gives
    /// this command. The estimates are unchanged.
    fn close(
        &self,
        state: &mut AdaptiveState<T, N>,
        live: &AdaptiveInput<T, N>,
        frozen: bool,
    ) -> Option<T> {
        let (z, error_rate) = (state.z, state.error_rate);
        let (lag, gap, command) = (state.lag, state.gap, state.held.command);
        self.go_back(state, live);
        let next = self.advance_again(state, live, frozen);
        if next.is_none() {
            (state.z, state.error_rate) = (z, error_rate);
            (state.lag, state.gap, state.held.command) = (lag, gap, command);
        }
        next
    }

    /// Moves z, error rate, lag, gap and command to where the first good sample after a safe
    /// command continues. Not inlined, because its bisection needs a stack frame of its own.
    #[inline(never)]
    fn go_back(&self, state: &mut AdaptiveState<T, N>, live: &AdaptiveInput<T, N>) {
        state.held.command = self.settings.limits.clamp(state.held.command);
        match self.settings.form {
            Form::AsPublished { .. } => self.settle(state, live),
            Form::FirstOrder { .. } => {
                state.gap = T::ZERO;
                state.lag = Compensated::new(state.held.command - live.feed_forward);
            }
        }
    }

    /// Removes the droppable regressors from a sample; returns the first fault.
    ///
    /// The method changes the sample itself, because a copy would be on the stack of the deepest
    /// call.
    fn drop_missing(&self, input: &mut AdaptiveInput<T, N>) -> Result<Option<Fault>, Fault> {
        let mut dropped = None;
        let policies = &self.settings.missing;
        for ((i, x), missing) in input.regressors.iter_mut().enumerate().zip(policies) {
            if !x.is_finite() && *missing == OnMissing::DropRegressor {
                *x = T::ZERO;
                dropped = dropped.or(Some(Fault::of_regressor(i)));
            }
        }
        match self.fault(input) {
            Some(fault) => Err(fault),
            None => Ok(dropped),
        }
    }

    /// The fault of a sample, if there is one; an overflow of the law is not included.
    pub(super) fn fault(&self, input: &AdaptiveInput<T, N>) -> Option<Fault> {
        fault_of_dt(input.dt, self.longest).or_else(|| self.fault_of_numbers(input))
    }

    /// The fault of the numbers of a sample, without a test of `dt`.
    pub(super) fn fault_of_numbers(&self, input: &AdaptiveInput<T, N>) -> Option<Fault> {
        let bad = |x: &T| !x.is_finite();
        unless_finite(input.reference, Fault::Reference)
            .or_else(|| unless_finite(input.next_reference, Fault::Reference))
            .or_else(|| unless_finite(input.measured, Fault::Measured))
            .or_else(|| {
                let first = input.regressors.iter().position(bad)?;
                Some(Fault::of_regressor(first))
            })
            .or_else(|| unless_finite(input.feed_forward, Fault::FeedForward))
    }

    /// Equations (18), (19) and (23), or the first-order form, and the new values of the two
    /// memories.
    #[inline]
    pub(super) fn evaluated(
        &self,
        state: &AdaptiveState<T, N>,
        input: &AdaptiveInput<T, N>,
    ) -> Evaluated<T, N> {
        let settings = &self.settings;
        let error = law::error(input.measured, input.reference);
        let mut rate = state.error_rate;
        if let Form::AsPublished { time_constant } = settings.form {
            let filter = Derivative::assumed(time_constant);
            filter.follow(&mut rate, error, input.dt + state.gap);
        }
        let mut terms = AdaptiveTerms {
            error,
            feed_forward: input.feed_forward,
            ..AdaptiveTerms::at_rest(state)
        };
        if let Form::AsPublished { .. } = settings.form {
            terms.error_rate = rate.rate();
        }
        terms.s = law::filtered_error(error, settings.lambda, terms.z);
        terms.smooth_sign = settings.smooth_sign.of(terms.s / settings.epsilon);
        terms.virtual_command = self.virtual_command(&terms, input);
        let wanted = law::command(terms.beta_hat, terms.virtual_command);
        let lag = match settings.form {
            Form::AsPublished { .. } => Compensated::new(wanted),
            Form::FirstOrder { .. } => {
                let way = wanted - state.lag.value;
                let increment = law::first_order_increment(input.dt, settings.lambda, way);
                state.lag.plus(increment)
            }
        };
        terms.law = lag.value;
        terms.unlimited = terms.law + input.feed_forward;
        Evaluated {
            terms,
            error_rate: rate,
            lag,
        }
    }

    /// ubar of (23). The first-order form replaces the error rate by the negative rate of the
    /// reference.
    #[inline]
    pub(super) fn virtual_command(
        &self,
        terms: &AdaptiveTerms<T, N>,
        input: &AdaptiveInput<T, N>,
    ) -> T {
        let (settings, y_r) = (&self.settings, input.reference);
        let mut theta_x = T::zero();
        for (theta, x) in terms.theta_hat.iter().zip(&input.regressors) {
            theta_x += *theta * *x;
        }
        let (z, lambda) = (terms.z, settings.lambda);
        let proportional = law::proportional(settings.gain, terms.s, y_r);
        let damped = match settings.form {
            Form::AsPublished { .. } => law::damped(proportional, z, terms.error_rate, lambda),
            Form::FirstOrder { .. } => {
                let y_r_rate = (input.next_reference - y_r) / input.dt;
                law::first_order_damped(proportional, z, y_r_rate, lambda)
            }
        };
        law::virtual_command(damped, theta_x, terms.delta_hat, terms.smooth_sign)
    }

    /// Equations (24) to (26).
    #[inline]
    pub(super) fn adapted(
        &self,
        state: &AdaptiveState<T, N>,
        input: &AdaptiveInput<T, N>,
        terms: &AdaptiveTerms<T, N>,
    ) -> Estimates<T, N> {
        let settings = &self.settings;
        let (dt, lambda_s) = (input.dt, settings.lambda * terms.s);
        let v = law::beta_excitation(lambda_s, terms.virtual_command);
        let beta = settings.beta.update(state.beta, dt, v);
        let v = law::delta_excitation(lambda_s, terms.smooth_sign);
        let delta = settings.delta.update(state.delta, dt, v);
        let mut theta = state.theta;
        let each = theta.iter_mut().zip(&settings.theta);
        for ((estimate, estimator), x) in each.zip(&input.regressors) {
            *estimate = estimator.update(*estimate, dt, law::theta_excitation(lambda_s, *x));
        }
        (beta, delta, theta)
    }
}

/// beta_hat, delta_hat and theta_hat.
pub(super) type Estimates<T, const N: usize> =
    (Compensated<T>, Compensated<T>, [Compensated<T>; N]);

/// The terms of one sample, and the new values of the memories.
pub(super) struct Evaluated<T, const N: usize> {
    pub(super) terms: AdaptiveTerms<T, N>,
    pub(super) error_rate: DerivativeState<T>,
    pub(super) lag: Compensated<T>,
}

impl<T: Real, const N: usize> AdaptiveTerms<T, N> {
    /// The terms that a state itself provides: z and the estimates.
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
