//! Controllers: the command, the state, the limits.

use bowden::control::{Adaptive, AdaptiveInput, AdaptiveOutput, AdaptiveState, Limits};
use bowden::control::{Compensator, CompensatorInput, CompensatorState};
use bowden::control::{Damping, Fallback, Fault, Pid, PidInput, PidState, Status};
use bowden::signal::clamp;

/// The command nearest to what is wanted: within the range, and within the slew rate of
/// what was out where the range allows it.
pub fn limits_are_kept(limits: &Limits<f32>, last: f32, wanted: f32, dt: f32) -> bool {
    follows(limits, last, limits.apply(last, wanted, dt), dt)
}

/// Whether a command lies within the range and, where the one before it did, within the slew
/// rate of that one.
pub fn follows(limits: &Limits<f32>, last: f32, command: f32, dt: f32) -> bool {
    let reach = limits.slew().map_or(f32::INFINITY, |slew| slew * dt);
    let slewed = last - reach <= command && command <= last + reach;
    limits.contains(command) && (slewed || !limits.contains(last))
}

/// What a step of a controller did, whatever its law.
struct Answer<'a> {
    limits: &'a Limits<f32>,
    fallback: &'a Fallback<f32>,
    dt: f32,
    /// Whether every number that the step reads can be used.
    usable: bool,
    status: Status,
    /// The command that was out, and how many samples in a row had been bad.
    before: (f32, u32),
    /// The same after the step.
    after: (f32, u32),
}

impl Answer<'_> {
    /// The command is finite and within the limits. After a good sample, and that is one
    /// whose numbers can be used and whose `dt` is above zero, it keeps the slew rate; after a
    /// bad one it is the command before or, from the stated sample on, the safe command.
    fn is_as_promised(&self) -> bool {
        let ((last, bad), (command, count)) = (self.before, self.after);
        let safe = self.fallback.command();
        let usable = self.usable && self.dt > 0.0 && self.dt.is_finite();
        let late = count >= self.fallback.after();
        let counted = count == bad.saturating_add(1);
        let told = |fault| (fault == Fault::Overflow) == usable;
        command.is_finite()
            && self.limits.contains(command)
            && match self.status {
                Status::Good => {
                    usable && count == 0 && follows(self.limits, last, command, self.dt)
                }
                Status::Held(fault) => {
                    let held = clamp(last, self.limits.low(), self.limits.high());
                    told(fault) && command == held && counted && !(late && safe.is_some())
                }
                Status::Safe(fault) => told(fault) && safe == Some(command) && counted && late,
            }
    }
}

/// Whatever the sample, the command is as promised; a bad sample leaves the state but for its
/// count.
pub fn pid_commands_within_its_limits(
    pid: &Pid<f32>,
    state: &mut PidState<f32>,
    at: &PidInput<f32>,
) -> bool {
    let (before, settings) = (*state, pid.settings());
    let out = pid.step(state, at);
    let untouched = state.integral() == before.integral() && state.rate() == before.rate();
    let velocity = settings.damping != Damping::Velocity || at.velocity.is_finite();
    let numbers = at.reference.is_finite() && at.measured.is_finite();
    let answer = Answer {
        limits: &settings.limits,
        fallback: &settings.fallback,
        dt: at.dt,
        usable: velocity && numbers && at.feed_forward.is_finite(),
        status: out.status,
        before: (before.command(), before.consecutive_bad()),
        after: (out.command, state.consecutive_bad()),
    };
    answer.is_as_promised()
        && (out.status == Status::Good || untouched)
        && state.integral().is_finite()
        && state.rate().is_finite()
}

/// Whatever the sample, the command is as promised and the state stays valid: finite, every
/// estimate in its box, z in its own.
pub fn adaptive_commands_within_its_limits<const N: usize>(
    law: &Adaptive<f32, N>,
    state: &mut AdaptiveState<f32, N>,
    input: &AdaptiveInput<f32, N>,
) -> bool {
    let (before, settings) = (*state, law.settings());
    let out = law.step(state, input);
    let untouched = state.accumulated_error() == before.accumulated_error()
        && state.beta_hat() == before.beta_hat()
        && state.delta_hat() == before.delta_hat()
        && state.theta_hat() == before.theta_hat();
    let in_time = law.largest_step().is_none_or(|longest| input.dt <= longest);
    let answer = Answer {
        limits: &settings.limits,
        fallback: &settings.fallback,
        dt: input.dt,
        usable: in_time
            && input.feed_forward.is_finite()
            && input.reference.is_finite()
            && input.next_reference.is_finite()
            && input.measured.is_finite()
            && input.regressors.iter().all(|x| x.is_finite()),
        status: out.status,
        before: (before.command(), before.consecutive_bad()),
        after: (out.command, state.consecutive_bad()),
    };
    answer.is_as_promised()
        && out.command == state.command()
        && (out.status == Status::Good || untouched)
        && law.is_valid(state)
}

/// Other settings that take a running law over leave the command that is out, as far as
/// their range allows it, and make the state one of theirs.
pub fn a_hand_over_keeps_the_command<const N: usize>(
    law: &Adaptive<f32, N>,
    state: &mut AdaptiveState<f32, N>,
    input: &AdaptiveInput<f32, N>,
) -> bool {
    let limits = &law.settings().limits;
    let before = clamp(state.command(), limits.low(), limits.high());
    law.take_over(state, input);
    state.command() == before && law.is_valid(state)
}

/// A law that starts from an output has that as its command, as far as its range allows it,
/// and a state that is valid; from an output that is no number it starts anew.
pub fn a_start_keeps_the_command<const N: usize>(
    law: &Adaptive<f32, N>,
    output: f32,
    input: &AdaptiveInput<f32, N>,
) -> bool {
    let limits = &law.settings().limits;
    let state = AdaptiveState::resume_from(law, output, input);
    let start = if output.is_finite() { output } else { 0.0 };
    let command = clamp(start, limits.low(), limits.high());
    state.command() == command && state.consecutive_bad() == 0 && law.is_valid(&state)
}

/// A PID that starts from an output has that as its command, as far as its range allows it;
/// where a number is not finite, or overflows, integral, rate and command stay.
pub fn a_pid_start_keeps_the_command(
    pid: &Pid<f32>,
    state: &mut PidState<f32>,
    output: f32,
    at: &PidInput<f32>,
) -> bool {
    let (before, limits) = (*state, &pid.settings().limits);
    let status = state.resume_from(pid, output, at);
    let integral = state.integral();
    match status {
        Status::Good => {
            let command = clamp(output, limits.low(), limits.high());
            output.is_finite()
                && state.command() == command
                && integral.is_finite()
                && state.rate() == 0.0
                && state.consecutive_bad() == 0
        }
        Status::Held(_) => {
            state.command() == before.command()
                && integral == before.integral()
                && state.rate() == before.rate()
        }
        Status::Safe(_) => {
            Some(state.command()) == pid.settings().fallback.command()
                && integral == before.integral()
                && state.rate() == before.rate()
        }
    }
}

/// Whatever the sample, the compensator's command and the share of the effects are finite
/// and eta lies within ±1; a bad sample leaves command and eta, and one without a finite
/// `dt` above zero or a finite desired output is bad.
pub fn compensator_commands_are_finite<const N: usize>(
    compensator: &Compensator<f32, N>,
    state: &mut CompensatorState<f32, N>,
    at: &CompensatorInput<f32>,
) -> bool {
    let before = *state;
    let out = compensator.step(state, at);
    let untouched = state.command() == before.command() && state.eta() == before.eta();
    let usable = at.dt > 0.0 && at.dt.is_finite() && at.desired.is_finite();
    let counted = state.consecutive_bad() == before.consecutive_bad().saturating_add(1);
    out.command.is_finite()
        && out.effects.is_finite()
        && out.eta.abs() <= 1.0
        && out.command == state.command()
        && match out.status {
            Status::Good => usable && state.consecutive_bad() == 0,
            _ => untouched && counted,
        }
}

/// After a good sample the lag form's command lies between the one `before` and its target
/// `beta_hat·ubar`, as far as their difference can be written.
pub fn the_lag_does_not_pass_its_target<const N: usize>(
    before: f32,
    out: &AdaptiveOutput<f32, N>,
) -> bool {
    let wanted = out.terms.beta_hat * out.terms.virtual_command;
    let farthest = before + (wanted - before);
    let law = out.terms.law;
    out.status != Status::Good
        || (before <= law && law <= farthest)
        || (farthest <= law && law <= before)
}
