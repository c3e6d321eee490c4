//! Controllers: the command, the state, the limits.

use bowden::control::{Adaptive, AdaptiveInput, AdaptiveState, AdaptiveTerms, Limits, Telemetry};
use bowden::control::{AntiWindup, DerivativeSource, Fallback, Fault, OnMissing, Status};
use bowden::control::{Compensator, CompensatorInput, CompensatorState};
use bowden::control::{DisturbanceObserver, ObserverInput, ObserverState};
use bowden::control::{IterativeLearning, IterativeLearningInput, IterativeLearningState};
use bowden::control::{Pid, PidInput, PidSettings, PidState};
use bowden::control::{Relay, RelayState};
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
    /// The sample's, and the longest that is one.
    dt: [f32; 2],
    /// Whether every other number that the step reads can be used.
    usable: bool,
    /// The same but for those that may be dropped.
    needed: bool,
    status: Status,
    before: Out,
    after: Out,
}

/// The command that is out, the score of the bad samples, and whether the safe command is
/// latched.
#[derive(Clone, Copy)]
struct Out {
    command: f32,
    score: u32,
    latched: bool,
}

impl Answer<'_> {
    /// The command is finite and within the limits. After a good sample, and that is one
    /// whose numbers can be used and whose `dt` is above zero and not too long, it keeps the
    /// slew rate; after a bad one it is the command before or, once the score is full, the
    /// safe command, which stays.
    fn is_as_promised(&self) -> bool {
        let (before, after) = (self.before, self.after);
        let safe = self.fallback.command();
        let [dt, longest] = self.dt;
        let usable = self.usable && dt > 0.0 && dt <= longest;
        let most = self.fallback.most();
        let counted = after.score == most.min(before.score.saturating_add(self.fallback.weight()));
        // A sample that lacks what may be dropped can overflow as a whole one can.
        let complete = self.needed && dt > 0.0 && dt <= longest;
        let told = |fault| (fault == Fault::Overflow) == complete;
        after.command.is_finite()
            && self.limits.contains(after.command)
            && match self.status {
                Status::Good | Status::Degraded(_) => {
                    let dropped = matches!(self.status, Status::Degraded(Fault::Regressor(_)));
                    (usable || dropped)
                        && !before.latched
                        && !after.latched
                        && after.score <= before.score
                        && follows(self.limits, before.command, after.command, dt)
                }
                Status::Held(fault) => {
                    told(fault)
                        && after.command == self.limits.clamp(before.command)
                        && counted
                        && !before.latched
                        && !after.latched
                        && !(after.score >= most && safe.is_some())
                }
                Status::Safe(fault) => {
                    let full = counted && after.score >= most && told(fault);
                    after.latched
                        && safe.is_none_or(|safe| after.command == safe)
                        && (before.latched || full)
                }
            }
    }
}

fn pid_out(command: f32, state: &PidState<f32>) -> Out {
    Out {
        command,
        score: state.fault_counter(),
        latched: state.is_latched(),
    }
}

fn adaptive_out<const N: usize>(command: f32, state: &AdaptiveState<f32, N>) -> Out {
    Out {
        command,
        score: state.fault_counter(),
        latched: state.is_latched(),
    }
}

/// Whatever the sample, the command is as promised; a bad sample leaves the state but for its
/// score.
pub fn pid_commands_within_its_limits(
    pid: &Pid<f32>,
    state: &mut PidState<f32>,
    at: &PidInput<f32>,
) -> bool {
    let (before, settings) = (*state, pid.settings());
    let out = pid.step(state, at);
    let untouched = state.integral() == before.integral() && state.rate() == before.rate();
    let velocity = settings.damping != DerivativeSource::Velocity || at.velocity.is_finite();
    let numbers = at.reference.is_finite() && at.measured.is_finite();
    let usable = velocity && numbers && at.feed_forward.is_finite();
    let answer = Answer {
        limits: &settings.limits,
        fallback: &settings.fallback,
        dt: [at.dt, settings.longest_dt],
        usable,
        needed: usable,
        status: out.status,
        before: pid_out(before.command(), &before),
        after: pid_out(out.command, state),
    };
    answer.is_as_promised()
        && (out.status == Status::Good || untouched)
        && state.integral().is_finite()
        && state.rate().is_finite()
}

/// A good sample moves the integral by its whole change, or the command is at the limit on the side
/// of that change and the integral between where it was and where it was sent.
///
/// The whole change is that of a twin which has no limits. Not for what the drive was told to have
/// done, nor for a law that back-calculates or has a limit of its own for the integral.
pub fn the_integral_makes_progress(
    pid: &Pid<f32>,
    state: &PidState<f32>,
    at: &PidInput<f32>,
) -> bool {
    let settings = pid.settings();
    let returns = matches!(settings.anti_windup, AntiWindup::BackCalculation { .. });
    if returns || settings.limits.slew().is_some() || settings.integral_limit.is_some() {
        return true;
    }
    let free = Pid::try_new(PidSettings {
        anti_windup: AntiWindup::None,
        limits: Limits::unlimited(),
        fallback: Fallback::hold_indefinitely(),
        ..*settings
    });
    let Ok(free) = free else {
        return false;
    };
    let (before, mut own, mut whole) = (state.integral(), *state, *state);
    let out = pid.step(&mut own, at);
    if out.status != Status::Good || free.step(&mut whole, at).status != Status::Good {
        return true;
    }
    let (own, whole, limits) = (own.integral(), whole.integral(), &settings.limits);
    let up = whole > before && out.command == limits.high() && before <= own && own <= whole;
    let down = whole < before && out.command == limits.low() && whole <= own && own <= before;
    own == whole || up || down
}

/// From **any** state, one of another controller or of broken memory too, the command is
/// finite and within the limits, and a safe command that is latched stays out.
pub fn pid_commands_within_its_limits_from_any_state(
    pid: &Pid<f32>,
    state: &mut PidState<f32>,
    at: &PidInput<f32>,
) -> bool {
    let (limits, fallback) = (&pid.settings().limits, &pid.settings().fallback);
    let latched = state.is_latched();
    let out = pid.step(state, at);
    limits.contains(out.command)
        && (!latched || (state.is_latched() && matches!(out.status, Status::Safe(_))))
        && (!state.is_latched() || fallback.command().is_none_or(|safe| out.command == safe))
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
    let waits = state.beta_hat() == before.beta_hat()
        && state.delta_hat() == before.delta_hat()
        && state.theta_hat() == before.theta_hat();
    let untouched = waits && state.accumulated_error() == before.accumulated_error();
    let numbers = input.feed_forward.is_finite()
        && input.reference.is_finite()
        && input.next_reference.is_finite()
        && input.measured.is_finite();
    let mut regressors = input.regressors.iter().zip(&settings.missing);
    let answer = Answer {
        limits: &settings.limits,
        fallback: &settings.fallback,
        dt: [input.dt, law.longest_dt()],
        usable: numbers && input.regressors.iter().all(|x| x.is_finite()),
        needed: numbers
            && regressors.all(|(x, to)| x.is_finite() || *to == OnMissing::DropRegressor),
        status: out.status,
        before: adaptive_out(before.command(), &before),
        after: adaptive_out(out.command, state),
    };
    answer.is_as_promised()
        && out.command == state.command()
        && match out.status {
            Status::Good => true,
            Status::Degraded(_) => waits,
            Status::Held(_) | Status::Safe(_) => untouched,
        }
        && law.is_valid(state)
}

/// From **any** state, one of another law or of broken memory too, the command is finite and
/// within the limits, and a safe command that is latched stays out.
pub fn adaptive_commands_within_its_limits_from_any_state<const N: usize>(
    law: &Adaptive<f32, N>,
    state: &mut AdaptiveState<f32, N>,
    input: &AdaptiveInput<f32, N>,
) -> bool {
    let (limits, fallback) = (&law.settings().limits, &law.settings().fallback);
    let latched = state.is_latched();
    let out = law.step(state, input);
    limits.contains(out.command)
        && (!latched || (state.is_latched() && matches!(out.status, Status::Safe(_))))
        && (!state.is_latched() || fallback.command().is_none_or(|safe| out.command == safe))
}

/// However good and bad samples follow each other, the safe command is out at the latest
/// when a stretch of n samples has held B bad ones with `(weight + 1)·B - n >= most`.
///
/// `margin` is the greatest `(weight + 1)·B - n` of a stretch that ends here, by Kadane's
/// recursion. This is one step of it and of the controller's score, from `before` to `after`,
/// until the safe command is out.
pub fn the_score_keeps_up(
    fallback: &Fallback<f32>,
    (before, after): (u32, u32),
    margin: u32,
    is_bad: bool,
) -> bool {
    let most = fallback.most();
    before >= most || before < margin || after >= next_margin(fallback, margin, is_bad).min(most)
}

/// The margin one sample later.
pub fn next_margin(fallback: &Fallback<f32>, margin: u32, is_bad: bool) -> u32 {
    if is_bad {
        margin.saturating_add(fallback.weight())
    } else {
        margin.saturating_sub(1)
    }
}

/// Other settings that take a running law over leave the command that is out, as far as
/// their range allows it, and make the state one of theirs.
pub fn a_hand_over_keeps_the_command<const N: usize>(
    law: &Adaptive<f32, N>,
    state: &mut AdaptiveState<f32, N>,
    input: &AdaptiveInput<f32, N>,
) -> bool {
    let limits = &law.settings().limits;
    let (before, latched) = (limits.clamp(state.command()), state.is_latched());
    law.bumpless_transfer(state, input);
    state.command() == before && state.is_latched() == latched && law.is_valid(state)
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
    state.command() == command && state.fault_counter() == 0 && law.is_valid(&state)
}

/// A PID that starts from an output has that as its command, as far as its range allows it, and
/// the score of the bad samples that it had; where a number is not finite, or overflows, integral, rate and command stay; so they do
/// where the safe command is latched.
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
                && state.fault_counter() == before.fault_counter()
                && !before.is_latched()
        }
        Status::Degraded(_) => false,
        Status::Held(_) => {
            state.command() == before.command()
                && integral == before.integral()
                && state.rate() == before.rate()
        }
        Status::Safe(_) => {
            let safe = pid.settings().fallback.command();
            safe.is_none_or(|safe| state.command() == safe)
                && state.is_latched()
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
        && state.eta().abs() <= 1.0
        && out.command == state.command()
        && match out.status {
            Status::Good => usable && state.consecutive_bad() == 0,
            _ => untouched && counted,
        }
}

/// After a good sample the lag form's command lies between the one `before` and its target
/// `beta_hat·ubar`, as far as their difference can be written; `owed` is what the sum still
/// owes to rounding.
pub fn the_lag_does_not_pass_its_target<const N: usize>(
    before: f32,
    owed: f32,
    out: &Telemetry<f32, AdaptiveTerms<f32, N>>,
) -> bool {
    let wanted = out.terms.beta_hat * out.terms.virtual_command;
    let farthest = before + (wanted - before);
    let law = out.terms.law;
    out.status != Status::Good
        || (before - owed <= law && law <= farthest + owed)
        || (farthest - owed <= law && law <= before + owed)
}

/// The estimate of an observer is finite and within its limit. After a bad sample it is the one
/// before, if that was an estimate of this observer, and it is told; a good sample is told as good
/// unless its numbers overflow.
pub fn estimates_keep_their_limit(
    observer: &DisturbanceObserver<f32>,
    mut state: ObserverState<f32>,
    at: &ObserverInput<f32>,
) -> bool {
    let before = state.estimate();
    let out = observer.step(&mut state, at);
    let within = |x: f32| x.abs() <= observer.limit();
    let good = at.dt > 0.0
        && at.dt <= observer.longest_dt()
        && at.sent.is_finite()
        && at.measured.is_finite();
    let told = match out.status {
        Status::Good => good,
        Status::Held(fault) => good == (fault == Fault::Overflow),
        Status::Degraded(_) | Status::Safe(_) => false,
    };
    let held = out.status == Status::Good || !within(before) || out.command == before;
    within(out.command) && out.command == state.estimate() && told && held
}

/// The feed-forward of a learning is finite and within its limit, and so is each cell that has
/// learned; every sample is told for what it is. Without a phase nothing moves, but for a feed-forward
/// that was none of this learning.
///
/// `before` is for a copy of what the cells had learned.
pub fn learning_keeps_its_limit<M: AsRef<[f32]> + AsMut<[f32]>>(
    learning: &IterativeLearning<f32>,
    state: &mut IterativeLearningState<f32, M>,
    at: &IterativeLearningInput<f32>,
    before: &mut [f32],
) -> bool {
    before.copy_from_slice(state.learned());
    let last = state.feed_forward();
    let out = learning.step(state, at);
    let within = |x: f32| x.abs() <= learning.limit();
    let same = |(now, was): (&f32, &f32)| now.to_bits() == was.to_bits();
    let mut cells = state.learned().iter().zip(before.iter());
    let phase = 0.0 <= at.phase && at.phase <= 1.0;
    let numbers = at.reference.is_finite() && at.measured.is_finite();
    let told = match out.status {
        Status::Good => phase && numbers,
        Status::Degraded(Fault::Phase | Fault::Overflow) => phase && numbers,
        Status::Degraded(Fault::Reference) => phase && !at.reference.is_finite(),
        Status::Degraded(Fault::Measured) => phase && !at.measured.is_finite(),
        Status::Held(Fault::Phase) => {
            !phase && cells.clone().all(same) && (!within(last) || out.command == last)
        }
        _ => false,
    };
    let learned = cells.all(|(now, was)| within(*now) || same((now, was)));
    within(out.command) && out.command == state.feed_forward() && told && learned
}

/// From **any** state, the command of a relay experiment is finite and within the limits: a level or
/// the command that was held while it runs, the centre after a result, the safe command after a
/// failure. What has ended stays so. While it runs, every sample, good or bad, takes from the time that
/// remains, and a sample is told for what it is.
pub fn a_relay_experiment_is_bounded_and_ends(
    relay: &Relay<f32>,
    state: &mut RelayState<f32>,
    dt: f32,
    measured: f32,
) -> bool {
    let (before, s) = (*state, relay.settings());
    let out = relay.step(state, dt, measured);
    let held = s.limits.clamp(before.command());
    let levels = [s.centre + s.amplitude, s.centre - s.amplitude];
    let good = dt > 0.0 && dt <= s.longest_dt && measured.is_finite();
    let over = state.remaining() == 0;
    let ran = before.is_running();
    let right = match (out.status, state.result()) {
        (Status::Good, None) => ran && good && levels.contains(&out.command),
        (Status::Good, Some(it)) => {
            // A result that this sample has completed is one of finite numbers.
            let finite = it.gain.is_finite() && it.period.is_finite();
            out.command == s.centre && (!ran || (good && finite))
        }
        (Status::Held(_), _) => ran && !good && out.command == held,
        (Status::Safe(reason), _) => {
            let told = match reason {
                Fault::OutputOutOfRange => good,
                Fault::NoOscillation | Fault::TimeOut => over,
                _ => !good,
            };
            s.fallback.command() == Some(out.command) && state.is_latched() && (!ran || told)
        }
        (Status::Degraded(_), _) => false,
    };
    let ends = !ran || state.remaining() < before.remaining() || over;
    let stays = ran || (!state.is_running() && state.remaining() == before.remaining());
    let goes_on = !state.is_running() || !over;
    right && ends && stays && goes_on && s.limits.contains(out.command)
}
