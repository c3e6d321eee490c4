//! One step of a PID: the law on a good sample, and the response to a bad sample.

use super::state::Last;
use super::{AntiWindup, DerivativeSource, Pid, PidInput, PidState};
use crate::control::limits::around;
use crate::control::{Fault, Output, Status};
use crate::error::{is_usable, rarely};
use crate::signal::{clamp, gap_after, greatest, least, Compensated};
use crate::Real;

impl<T: Real> Pid<T> {
    /// The command of a good sample, which advances the state. `None` leaves the state
    /// unchanged: a number cannot be used, or the law overflows.
    ///
    /// One test at the end covers all numbers of the sample: a number that is not finite leaves
    /// no finite sum. A `velocity` that is NaN, which only PIV reads, becomes zero.
    #[inline(always)]
    pub(super) fn advance(
        &self,
        state: &mut PidState<T>,
        at: &PidInput<T>,
        velocity: &mut T,
    ) -> Option<T> {
        if !at.dt.positive_up_to(self.settings.longest_dt) {
            return None;
        }
        if self.plain {
            self.follow::<true>(state, Last::at(at), at.dt, velocity)
        } else {
            self.follow::<false>(state, self.sample(at), at.dt, velocity)
        }
    }

    /// The rest of [`advance`](Self::advance).
    ///
    /// It has two copies, because a test for each setting would make the usual step 20 instructions
    /// longer.
    #[inline(always)]
    fn follow<const PLAIN: bool>(
        &self,
        state: &mut PidState<T>,
        mut last: Last<T>,
        dt: T,
        velocity: &mut T,
    ) -> Option<T> {
        let (s, limits) = (&self.settings, &self.settings.limits);
        let error = last.measured - last.reference;
        let rate = self.rate::<PLAIN>(state, &last, dt);
        let rest = self.rest(&last, rate);
        let mut change = -s.k_i * error * dt;
        let mut before = state.integral;
        if !PLAIN {
            // Written so that an error that is NaN stays NaN.
            if error.abs() <= s.deadband {
                change = T::ZERO;
            }
            before = self.returned(state, dt);
        }
        let mut integral = before.plus(change);
        let wanted = rest + integral.value;
        let all = wanted + integral.carry;
        if !is_usable(all + last.velocity) {
            rarely();
            let read = match s.damping {
                DerivativeSource::Velocity => last.velocity,
                DerivativeSource::Rate { .. } => T::ZERO,
            };
            if !is_usable(all + read) {
                return None;
            }
            if !is_usable(last.velocity) {
                *velocity = T::ZERO;
            }
        }
        last.velocity = *velocity;
        last.change = change;
        last.unlimited = wanted;
        let inside = limits.contains(wanted);
        if PLAIN && inside {
            return Some(state.moved_on(wanted, last, integral, rate));
        }
        rarely();
        let end = clamp(wanted, limits.low(), limits.high());
        if !inside {
            integral = self.cut(before.value, integral, rest, end);
            last.change = integral.value - before.value;
        }
        // Exactly at the limit, for any rounding of the difference.
        let mut command = end;
        if !PLAIN {
            if let Some(limit) = s.integral_limit {
                let own = state.integral.value;
                let (low, high) = (least(-limit, own), greatest(limit, own));
                integral = integral.within(low, high);
                last.change = integral.value - before.value;
                command = rest + integral.value;
            }
            command = limits.apply(state.command(), command, dt);
        }
        last.unlimited = rest + integral.value;
        Some(state.moved_on(command, last, integral, rate))
    }

    /// The integral after its change, cut to the value that takes the command to the `end` of
    /// the range that the command has passed.
    ///
    /// The other terms leave `end − rest` to the integral. With [`AntiWindup::Clamp`] the
    /// integral may also take any value up to the end itself, and zero. A change beyond this
    /// value is cut to it. An integral beyond it, after a change of the other terms, stays or
    /// moves back. So the command reaches its limit, and leaves it at once.
    #[inline]
    pub(crate) fn cut(
        &self,
        before: T,
        integral: Compensated<T>,
        rest: T,
        end: T,
    ) -> Compensated<T> {
        let full = end - rest;
        let rises = rest + integral.value > end;
        match self.settings.anti_windup {
            AntiWindup::None | AntiWindup::BackCalculation { .. } => integral,
            AntiWindup::Conditional => stopped(integral, before, full, rises),
            AntiWindup::Clamp if rises => {
                let own = greatest(end, T::ZERO);
                stopped(integral, before, greatest(full, own), true)
            }
            AntiWindup::Clamp => {
                let own = least(end, T::ZERO);
                stopped(integral, before, least(full, own), false)
            }
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
                // It starts from the safe command.
                return self.restart(state, s.limits.clamp(state.command()), at, true);
            }
            state.gap = gap_after(state.gap, at.dt, s.longest_dt);
            state
                .held
                .bad_after_step(fault.unwrap_or(Fault::Overflow), &s.fallback)
        });
        Output {
            // A state may come from anywhere.
            command: s.limits.clamp(state.command()),
            status,
        }
    }

    /// Starts at a sample so that the command continues from `output`; a bad sample counts. In a
    /// step, a good one counts too.
    pub(super) fn restart(
        &self,
        state: &mut PidState<T>,
        output: T,
        at: &PidInput<T>,
        in_step: bool,
    ) -> Status {
        match self.started_at(output, at) {
            Ok((last, integral)) => {
                state.start(self.settings.limits.clamp(output), last, integral);
                if in_step {
                    state.held.good();
                }
                Status::Good
            }
            Err(fault) => state.held.bad(fault, &self.settings.fallback),
        }
    }

    /// The integral before its change: with the part that the limits cut off the last command
    /// or, in a law without `k_i`, with the return to zero.
    #[inline]
    pub(crate) fn returned(&self, state: &PidState<T>, dt: T) -> Compensated<T> {
        let s = &self.settings;
        if s.k_i == T::ZERO {
            // A lag of 1 s; the least normal number is added, so that it reaches zero.
            let integral = state.integral.value;
            let way = integral.abs() * (dt / (T::ONE + dt)) + T::min_positive_value();
            let (low, high) = around(integral, way);
            return Compensated::new(clamp(T::ZERO, low, high));
        }
        let Some(last) = &state.last else {
            return state.integral;
        };
        let share = match s.anti_windup {
            AntiWindup::BackCalculation { tracking_time } => {
                (state.command() - last.unlimited) * (dt / (tracking_time + dt))
            }
            // T_t = k_p/k_i, without a division by a gain that may be zero.
            AntiWindup::Conditional if s.limits.slew().is_some() => {
                let wanted = clamp(last.unlimited, s.limits.low(), s.limits.high());
                (state.command() - wanted) * (s.k_i * dt / (s.k_p + s.k_i * dt))
            }
            _ => return state.integral,
        };
        state.integral.plus(share)
    }
}

/// An integral that rises or falls at most to the value at a limit, or to its earlier value beyond
/// this limit.
#[inline]
pub(super) fn stopped<T: Real>(
    integral: Compensated<T>,
    before: T,
    full: T,
    rises: bool,
) -> Compensated<T> {
    if rises {
        let stop = greatest(full, before);
        if integral.value > stop {
            return Compensated::new(stop);
        }
    } else {
        let stop = least(full, before);
        if integral.value < stop {
            return Compensated::new(stop);
        }
    }
    integral
}
