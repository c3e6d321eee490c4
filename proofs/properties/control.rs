//! Controllers: the command, the state, the limits.

use bowden::control::{Adaptive, AdaptiveInput, AdaptiveOutput, AdaptiveState, Limits};
use bowden::control::{Compensator, CompensatorInput, CompensatorState};
use bowden::control::{Pid, PidInput, PidState, Status};
use bowden::signal::clamp;

/// The command nearest to what is wanted: within the range, and within the slew rate of
/// what was out where the range allows it.
pub fn limits_are_kept(limits: &Limits<f32>, last: f32, wanted: f32, dt: f32) -> bool {
    let command = limits.apply(last, wanted, dt);
    let reach = limits.slew().map_or(f32::INFINITY, |slew| slew * dt);
    let slewed = last - reach <= command && command <= last + reach;
    limits.contains(command) && (slewed || !limits.contains(last))
}

/// Whatever the sample, the command is finite and within the limits; a bad one leaves the
/// state but for its count.
pub fn pid_commands_within_its_limits(
    pid: &Pid<f32>,
    state: &mut PidState<f32>,
    at: &PidInput<f32>,
) -> bool {
    let before = *state;
    let out = pid.step(state, at);
    let untouched = state.integral() == before.integral() && state.rate() == before.rate();
    out.command.is_finite()
        && pid.settings().limits.contains(out.command)
        && (out.status == Status::Good || untouched)
        && state.integral().is_finite()
        && state.rate().is_finite()
}

/// Whatever the sample, the command is finite and within the limits and the state stays
/// valid: finite, every estimate in its box, z in its own.
pub fn adaptive_commands_within_its_limits<const N: usize>(
    law: &Adaptive<f32, N>,
    state: &mut AdaptiveState<f32, N>,
    input: &AdaptiveInput<f32, N>,
) -> bool {
    let before = *state;
    let out = law.step(state, input);
    let untouched = state.accumulated_error() == before.accumulated_error()
        && state.beta_hat() == before.beta_hat()
        && state.delta_hat() == before.delta_hat()
        && state.theta_hat() == before.theta_hat();
    out.command.is_finite()
        && law.settings().limits.contains(out.command)
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

/// Whatever the sample, the compensator's command and the share of the effects are finite
/// and eta lies within ±1; a bad sample leaves command and eta.
pub fn compensator_commands_are_finite<const N: usize>(
    compensator: &Compensator<f32, N>,
    state: &mut CompensatorState<f32, N>,
    at: &CompensatorInput<f32>,
) -> bool {
    let before = *state;
    let out = compensator.step(state, at);
    let untouched = state.command() == before.command() && state.eta() == before.eta();
    out.command.is_finite()
        && out.effects.is_finite()
        && out.eta.abs() <= 1.0
        && out.command == state.command()
        && (out.status == Status::Good || untouched)
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
