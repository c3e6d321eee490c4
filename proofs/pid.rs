//! K1 and K10 of PI, PID and PIV.

use super::any::{fallback, finite, limits};
use super::properties::control::{
    a_pid_start_keeps_the_command, follows, pid_commands_within_its_limits,
    pid_commands_within_its_limits_from_any_state, the_score_keeps_up,
};
use super::{limited, stubs};
use bowden::control::pid::state::Last;
use bowden::control::status::{Held, Latch};
use bowden::control::{
    AntiWindup, Applied, DerivativeSource, Fault, Limits, Pid, PidInput, PidSettings, PidState,
};
use bowden::signal::{wrapped, Compensated};

/// Any settings that the constructor accepts, with this anti-windup.
fn pid(anti_windup: AntiWindup<f32>, damping: DerivativeSource<f32>) -> Pid<f32> {
    let settings = PidSettings {
        k_p: kani::any(),
        k_i: kani::any(),
        k_d: kani::any(),
        damping,
        derivative_time: kani::any(),
        setpoint_weight: kani::any(),
        anti_windup,
        integral_limit: kani::any::<bool>().then(|| kani::any()),
        deadband: kani::any(),
        period: kani::any::<bool>().then(|| kani::any()),
        limits: limits(),
        longest_dt: kani::any(),
        fallback: fallback(),
    };
    let pid = Pid::try_new(settings);
    kani::assume(pid.is_ok());
    pid.unwrap_or(Pid::paper_pi())
}

/// The loop closed, with bad samples remembered or not, the safe command out for any fault, or
/// the way back.
pub(crate) fn latch() -> Latch {
    match kani::any::<u8>() {
        0 => Latch::Closed,
        1 => Latch::Returning,
        2 => Latch::Counting,
        4 => Latch::Told,
        fault => Latch::Safe(if fault == 3 {
            Fault::Dt
        } else {
            Fault::Measured
        }),
    }
}

/// Any numbers in the fields of a state.
fn raw() -> PidState<f32> {
    let last = Last {
        reference: kani::any(),
        measured: kani::any(),
        velocity: kani::any(),
        feed_forward: kani::any(),
        unlimited: kani::any(),
        change: kani::any(),
    };
    PidState {
        integral: Compensated {
            value: kani::any(),
            carry: kani::any(),
        },
        rate: kani::any(),
        last: kani::any::<bool>().then_some(last),
        held: Held {
            command: kani::any(),
            score: kani::any(),
            latch: latch(),
        },
        gap: kani::any(),
    }
}

/// Any state that steps can lead to.
fn state() -> PidState<f32> {
    let state = PidState::try_from(raw());
    kani::assume(state.is_ok());
    state.unwrap_or_default()
}

/// All bit patterns.
fn input() -> PidInput<f32> {
    PidInput {
        dt: kani::any(),
        reference: kani::any(),
        measured: kani::any(),
        velocity: kani::any(),
        feed_forward: kani::any(),
    }
}

fn any_sample(anti_windup: AntiWindup<f32>, damping: DerivativeSource<f32>) {
    let (pid, mut state, input) = (pid(anti_windup, damping), state(), input());
    let before = state;
    let kept = pid_commands_within_its_limits(&pid, &mut state, &input);
    kani::cover!(!before.is_latched() && state.integral() != before.integral());
    kani::cover!(input.measured.is_nan() && state.command() != before.command());
    assert!(kept && state.is_valid());
}

fn rate() -> DerivativeSource<f32> {
    DerivativeSource::Rate {
        weight: kani::any(),
    }
}

/// K1. PID without anti-windup: for any sample the command is finite and within its limits and its
/// slew-rate limit, and the state stays valid. A bad sample leaves the state unchanged, and either
/// the last command or the safe command is applied. No sample counts as good if dt ≤ 0 or a number
/// is not finite.
///
/// Assumes: nothing about gains, sample or valid state; the limits as proved by
/// slew_limit_any_rate.
#[kani::proof]
#[kani::stub(libm::expm1f, stubs::expm1f)]
#[kani::stub(wrapped, stubs::any_turn)]
#[kani::stub(Limits::apply, limited::apply)]
#[kani::stub(follows, limited::follows)]
fn pid_any_sample_none() {
    any_sample(AntiWindup::None, rate());
}

/// K1. The same with the integral clamped to the range.
///
/// Assumes: the same as pid_any_sample_none.
#[kani::proof]
#[kani::stub(libm::expm1f, stubs::expm1f)]
#[kani::stub(wrapped, stubs::any_turn)]
#[kani::stub(Limits::apply, limited::apply)]
#[kani::stub(follows, limited::follows)]
fn pid_any_sample_clamp() {
    any_sample(AntiWindup::Clamp, rate());
}

/// K1. The same with conditional integration.
///
/// Assumes: the same as pid_any_sample_none.
#[kani::proof]
#[kani::stub(libm::expm1f, stubs::expm1f)]
#[kani::stub(wrapped, stubs::any_turn)]
#[kani::stub(Limits::apply, limited::apply)]
#[kani::stub(follows, limited::follows)]
fn pid_any_sample_conditional() {
    any_sample(AntiWindup::Conditional, rate());
}

/// K1. The same with back-calculation.
///
/// Assumes: the same as pid_any_sample_none.
#[kani::proof]
#[kani::stub(libm::expm1f, stubs::expm1f)]
#[kani::stub(wrapped, stubs::any_turn)]
#[kani::stub(Limits::apply, limited::apply)]
#[kani::stub(follows, limited::follows)]
fn pid_any_sample_back_calculation() {
    let tracking_time = kani::any();
    any_sample(AntiWindup::BackCalculation { tracking_time }, rate());
}

/// K1. The same for PIV with conditional integration.
///
/// Assumes: the same as pid_any_sample_none.
#[kani::proof]
#[kani::stub(wrapped, stubs::any_turn)]
#[kani::stub(Limits::apply, limited::apply)]
#[kani::stub(follows, limited::follows)]
fn piv_any_sample() {
    any_sample(AntiWindup::Conditional, DerivativeSource::Velocity);
}

/// K1. A difference that is not finite stays so when it is wrapped, for any period: the rows above
/// replace `wrapped` by any float for a finite difference, and by NaN otherwise.
///
/// Assumes: nothing
#[kani::proof]
fn wrapped_of_no_number_is_none() {
    let (difference, period): (f32, f32) = (kani::any(), kani::any());
    kani::assume(!difference.is_finite());
    kani::cover!(difference.is_nan() && period > 0.0);
    kani::cover!(!difference.is_nan() && period > 0.0);
    assert!(!wrapped(difference, period).is_finite());
}

/// K15. From any state with any bits: the command is finite and within the limits, and a latched
/// safe command stays applied.
///
/// Assumes: nothing about gains, sample or state; the limits as proved by slew_limit_any_rate.
#[kani::proof]
#[kani::stub(wrapped, stubs::garbage_of_two_real)]
#[kani::stub(Limits::apply, limited::apply)]
fn pid_from_any_state() {
    let (pid, at) = (pid(AntiWindup::Conditional, rate()), input());
    let mut state = raw();
    let before = state;
    let kept = pid_commands_within_its_limits_from_any_state(&pid, &mut state, &at);
    kani::cover!(before.integral().is_nan() && at.measured == 1.0);
    kani::cover!(before.command().is_nan() && at.dt == 0.001);
    kani::cover!(before.is_latched());
    assert!(kept);
}

/// K16. The score of bad samples is never below that of the worst stretch of samples, so the safe
/// command is applied once `(weight + 1)·B - n` of any stretch reaches `after·weight`. One step of
/// an induction: the margin of the worst stretch that ends here changes by the weight or by -1.
#[kani::proof]
fn score_keeps_up() {
    let fallback = fallback();
    let (score, margin, is_bad) = (kani::any(), kani::any(), kani::any());
    let latch = if kani::any() {
        Latch::Counting
    } else {
        Latch::Closed
    };
    let raw = Held {
        command: 1.0,
        score,
        latch,
    };
    let mut held = raw.remembering();
    assert!(held.may_step());
    if is_bad {
        held.bad_after_step(Fault::Measured, &fallback);
    }
    kani::cover!(score < fallback.most() && score >= margin && margin > 3 && is_bad);
    assert!(the_score_keeps_up(
        &fallback,
        (score, held.score),
        margin,
        is_bad
    ));
    let out = held.score >= fallback.most() && fallback.command().is_some() && is_bad;
    assert!(out == held.is_latched());
}

/// K17. A change of the integral that takes the command beyond its range acts in full if it points
/// away from that limit. Otherwise it is cut to the value that fills the range or, for an integral
/// beyond the range, to its previous value.
///
/// Assumes: any law with conditional integration or a clamp, any numbers with a finite sum.
#[kani::proof]
fn a_change_is_whole_or_fills_the_limit() {
    let clamps = kani::any();
    let anti_windup = match clamps {
        true => AntiWindup::Clamp,
        false => AntiWindup::Conditional,
    };
    let pid = pid(anti_windup, rate());
    let (before, value, carry, rest) = (finite(), finite(), finite(), finite());
    let (limits, wanted) = (pid.settings().limits, rest + value);
    kani::assume(wanted.is_finite() && !limits.contains(wanted));
    let above = wanted > limits.high();
    let end = if above { limits.high() } else { limits.low() };
    let kept = pid
        .cut(before, Compensated { value, carry }, rest, end)
        .value;
    let towards = if above {
        value > before
    } else {
        value < before
    };
    kani::cover!(towards && kept == before);
    kani::cover!(towards && kept == end - rest && kept > before);
    kani::cover!(!towards && value < before && kept == value);
    assert!(towards || kept == value);
    assert!(!towards || (before.min(value) <= kept && kept <= before.max(value)));
    let own = if above { end.max(0.0) } else { end.min(0.0) };
    let fills = kept == end - rest || kept == before || (clamps && kept == own);
    assert!(kept == value || fills);
}

/// K17. Without `k_i` the integral moves closer to zero with every sample, keeps its sign, and
/// finally is zero, because there are finitely many floats in between.
///
/// Assumes: any law without `k_i`, any valid state, a finite dt of 1 µs or more (a dt in seconds
/// below the epsilon of the float is too short to change the integral).
#[kani::proof]
fn without_k_i_the_integral_returns_to_zero() {
    let pid = pid(AntiWindup::Conditional, rate());
    kani::assume(pid.settings().k_i == 0.0);
    let (state, dt) = (state(), finite());
    kani::assume(dt >= 1e-6);
    let (before, after) = (state.integral(), pid.returned(&state, dt).value);
    kani::cover!(after > 1.0 && after < before);
    kani::cover!(before > 0.0 && after == 0.0);
    assert!(after == 0.0 || (after.abs() < before.abs() && (after > 0.0) == (before > 0.0)));
}

/// K17. After a report of the drive's response, the next step continues from the reported command.
/// The integral moves towards its value before the last change and not beyond it, and a second
/// report changes nothing.
///
/// Assumes: nothing about law and valid state.
#[kani::proof]
fn what_the_drive_did_takes_a_change_back_once() {
    let (pid, mut state) = (pid(AntiWindup::Conditional, rate()), state());
    let (before, sent) = (state, kani::any());
    let told = match kani::any::<u8>() {
        0 => Applied::AtUpperLimit,
        1 => Applied::AtLowerLimit,
        _ => Applied::Command(sent),
    };
    pid.applied(&mut state, told);
    let known = matches!(told, Applied::Command(_)) && sent.is_finite();
    let out = if known { sent } else { before.command() };
    let (was, is) = (before.integral(), state.integral());
    kani::cover!(is < was && known);
    kani::cover!(is > was && told == Applied::AtLowerLimit);
    assert!(state.command() == out);
    let change = before.last.map_or(0.0, |last| last.change);
    let last = was - change;
    assert!(is == was || (last.min(was) <= is && is <= last.max(was)));
    let once = state.integral();
    pid.applied(&mut state, Applied::AtUpperLimit);
    pid.applied(&mut state, Applied::AtUpperLimit);
    let twice = state.integral();
    pid.applied(&mut state, Applied::AtUpperLimit);
    assert!(state.integral() == twice && (twice == once || is == was));
}

/// K10. Bumpless transfer of a running PID to other settings: the applied command is kept, and a
/// slew-rate limit continues from it; the state stays valid, and only the integral changes.
#[kani::proof]
#[kani::stub(wrapped, stubs::garbage_of_two_real)]
fn pid_take_over() {
    let (pid, mut state) = (pid(AntiWindup::Conditional, rate()), state());
    let before = state;
    pid.bumpless_transfer(&mut state);
    kani::cover!(state.integral() != before.integral());
    let kept = state.command().to_bits() == before.command().to_bits();
    assert!(kept && state.rate() == before.rate() && state.is_valid());
}

/// K10. A PID that resumes from an output: for any output and sample, either the command is that
/// output within the range and the state is valid, or integral, rate and command do not change.
#[kani::proof]
#[kani::stub(wrapped, stubs::garbage_of_two_real)]
fn pid_resume_from() {
    let (pid, mut state, at) = (pid(AntiWindup::Clamp, rate()), state(), input());
    let output = kani::any();
    let kept = a_pid_start_keeps_the_command(&pid, &mut state, output, &at);
    kani::cover!(state.command() == output && output > 1.0 && state.integral() < -1.0);
    kani::cover!(state.is_latched());
    assert!(kept && state.is_valid());
}
