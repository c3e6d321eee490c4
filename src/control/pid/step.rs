//! One step: what a good sample moves, and what happens on any other.

use super::state::Last;
use super::{AntiWindup, Pid, PidInput, PidState};
use crate::control::{Fault, Output, Status};
use crate::error::{is_usable, rarely};
use crate::signal::clamp;
use crate::Real;

impl<T: Real> Pid<T> {
    /// The command of a good sample, which moves the state; `None`, and nothing has moved,
    /// where a number cannot be used or the law overflows.
    ///
    /// One test at the end for all numbers of the sample: one that is not finite leaves no finite
    /// sum. [`AntiWindup::Clamp`] would hide an infinite error. A `velocity` that is none, which
    /// only PIV reads, becomes zero.
    #[inline(always)]
    pub(super) fn advance(
        &self,
        state: &mut PidState<T>,
        at: &PidInput<T>,
        velocity: &mut T,
    ) -> Option<T> {
        let s = &self.settings;
        if !at.dt.positive_up_to(s.longest_dt) {
            return None;
        }
        let last = Last::at(at);
        let error = at.measured - at.reference;
        let rate = self.rate(state, &last, at.dt);
        let moving = Moving {
            error,
            rate,
            rest: self.rest(&last, rate),
            change: -s.k_i * error * at.dt,
        };
        if self.is_plain() {
            self.integrated::<true>(state, at, velocity, &moving)
        } else {
            self.integrated::<false>(state, at, velocity, &moving)
        }
    }

    /// The rest of [`advance`](Self::advance): the integral, the limits, and what stays.
    ///
    /// Two copies of it: with a test for each of the settings, the usual step is 20 instructions
    /// longer.
    #[inline(always)]
    fn integrated<const PLAIN: bool>(
        &self,
        state: &mut PidState<T>,
        at: &PidInput<T>,
        velocity: &mut T,
        moving: &Moving<T>,
    ) -> Option<T> {
        let s = &self.settings;
        let (error, rest, change) = (moving.error, moving.rest, moving.change);
        let mut last = Last::at(at);
        let returned = if PLAIN {
            None
        } else {
            self.returned(state, at.dt)
        };
        let moved = returned.map_or(change, |returned| change + returned);
        let mut integral = state.integral.plus(moved);
        if !PLAIN {
            integral = self.confined(integral);
        }
        last.unlimited = rest + integral.value;
        let mut all = last.unlimited + integral.carry;
        if !PLAIN && s.anti_windup == AntiWindup::Clamp {
            all += error;
        }
        if !is_usable(all + at.velocity) {
            rarely();
            if !is_usable(all + self.velocity(at)) {
                return None;
            }
            if !is_usable(at.velocity) {
                *velocity = T::ZERO;
            }
        }
        last.velocity = *velocity;
        let inside = s.limits.contains(last.unlimited);
        if inside && (PLAIN || s.limits.slew().is_none()) {
            last.command = last.unlimited;
            return Some(state.moved_on(last, integral, moving.rate));
        }
        rarely();
        if !inside && self.asks_for_more(last.unlimited, change) {
            integral = state.integral.plus(returned.unwrap_or(T::ZERO));
            last.unlimited = rest + integral.value;
            if !is_usable(last.unlimited + integral.carry + error) {
                return None;
            }
        }
        last.command = s.limits.apply(state.command(), last.unlimited, at.dt);
        Some(state.moved_on(last, integral, moving.rate))
    }

    /// Whether nothing but the range changes what the terms add up to: no slew rate, and an
    /// anti-windup that looks at the range only.
    #[inline(always)]
    fn is_plain(&self) -> bool {
        self.settings.limits.slew().is_none()
            && matches!(
                self.settings.anti_windup,
                AntiWindup::None | AntiWindup::Conditional
            )
    }

    /// Whether conditional integration leaves a change out: the limits are passed already, and
    /// it would go further.
    #[inline]
    fn asks_for_more(&self, unlimited: T, change: T) -> bool {
        let s = &self.settings;
        if !matches!(s.anti_windup, AntiWindup::Conditional) {
            return false;
        }
        if unlimited > s.limits.high() {
            change > T::ZERO
        } else {
            unlimited < s.limits.low() && change < T::ZERO
        }
    }

    /// A bad sample, a latched safe command, or the first good sample after one.
    #[cold]
    #[inline(never)]
    pub(super) fn exception(&self, state: &mut PidState<T>, at: &PidInput<T>) -> Output<T> {
        let s = &self.settings;
        let status = state.held.latched(&s.fallback).unwrap_or_else(|| {
            let fault = self.fault(at);
            if fault.is_none() && state.held.is_returning() {
                return self.close(state, at);
            }
            state.wait(at.dt, s.longest_dt);
            state
                .held
                .bad_after_step(fault.unwrap_or(Fault::Overflow), &s.fallback)
        });
        Output {
            // A state may come from anywhere.
            command: s.limits.confine(state.command()),
            status,
        }
    }

    /// The first good sample after a safe command that was acknowledged.
    fn close(&self, state: &mut PidState<T>, at: &PidInput<T>) -> Status {
        let started = if self.settings.k_i == T::ZERO {
            // An integral that nothing moves would stay in the command for ever. The rate is that
            // of a motion before the fault.
            let at_rest = PidState {
                rate: T::ZERO,
                ..*state
            };
            self.without_integrating(&at_rest, at).map(|last| {
                state.moved_on(last, state.integral, T::ZERO);
            })
        } else {
            let started = self.started_at(state.command(), at);
            started.map(|(last, integral)| state.start(last, integral))
        };
        match started {
            Ok(()) => {
                state.held.close();
                Status::Good
            }
            Err(fault) => state.held.bad(fault, &self.settings.fallback),
        }
    }

    /// What the limits cut off the last command, as far as it flows back into the integral.
    #[inline]
    fn returned(&self, state: &PidState<T>, dt: T) -> Option<T> {
        let (before, s) = (state.last.as_ref()?, &self.settings);
        match s.anti_windup {
            AntiWindup::BackCalculation { tracking_time } => {
                Some((before.command - before.unlimited) * (dt / (tracking_time + dt)))
            }
            // T_t = k_p/k_i, without dividing by a gain that may be zero.
            AntiWindup::Conditional if s.limits.slew().is_some() && s.k_i != T::ZERO => {
                let wanted = clamp(before.unlimited, s.limits.low(), s.limits.high());
                let share = s.k_i * dt / (s.k_p + s.k_i * dt);
                Some((before.command - wanted) * share)
            }
            _ => None,
        }
    }
}

/// What a sample asks for, before the integral has moved.
struct Moving<T> {
    error: T,
    rate: T,
    /// The command without limits and without the integral.
    rest: T,
    /// What the integral gains.
    change: T,
}
