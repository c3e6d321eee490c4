//! K6, K7, K8, K10, K11: saturation, smooth sign, derivative, limits, play.

use super::any::{finite, within};
use super::properties::control::limits_are_kept;
use super::properties::signal::*;
use super::stubs;
use bowden::control::limits::around;
use bowden::control::{Limits, SmoothSign};
use bowden::signal::{Biquad, BiquadState, EdgeVelocity, EdgeVelocityState, RateStatus};
use bowden::signal::{Derivative, DerivativeState, LowPass, LowPassState, Play, PlayState};
use bowden::signal::{Implausible, Plausible, PlausibleState};
use bowden::Real;
use core::sync::atomic::{AtomicU32, Ordering};

/// K6. Clamping an estimate to its bounds moves it towards any true value within the bounds.
#[kani::proof]
fn projection() {
    let (p, truth, low, high): (f32, _, _, _) = (kani::any(), finite(), finite(), finite());
    kani::assume(!p.is_nan());
    kani::cover!(low < truth && truth < high && high < p);
    assert!(projection_moves_towards_the_truth(p, truth, low, high));
}

/// K7. The clamped line lies within ±1, is odd to the bit and never has the opposite sign.
#[kani::proof]
fn smooth_sign_clamp() {
    let x: f32 = kani::any();
    kani::cover!(x > 0.5 && x < 1.0);
    assert!(smooth_sign_is_a_sign(SmoothSign::Clamp, x));
}

/// K7. For the clamped line, x·(1 - T) ≤ 1/4 for x ≥ 0, to two ulps. (tanh: all 2³² inputs,
/// `tests/exhaustive.rs`.)
#[kani::proof]
fn smooth_sign_clamp_residue() {
    let x: f32 = kani::any();
    kani::cover!(x > 0.49 && x < 0.51);
    assert!(smooth_sign_leaves_at_most_its_residue(SmoothSign::Clamp, x));
}

/// K8. Starting from rate zero, the rate of a signal within ±E never exceeds 2·E/tau: it stays
/// within share/dt·(x ± 1.1·E) around the signal x, and 2.1·share/dt is less.
///
/// Assumes: E = 1, tau = 5 ms, dt = 1/1024 s.
#[kani::proof]
fn derivative_of_a_bounded_signal() {
    if let Ok(filter) = Derivative::try_new(0.005) {
        let (last, sample) = (within(-1.0, 1.0), within(-1.0, 1.0));
        let state = DerivativeState::at(last, within(-400.0, 400.0));
        kani::cover!(state.rate() > 300.0 && sample < -0.9);
        assert!(rate_stays_by_its_signal(&filter, state, last, sample, 0.1));
    }
}

/// K10. A command lies within the range, and within slew·dt of the previous command if that lay in
/// the range; this includes a transfer or a change of gains.
///
/// Assumes: any range, 1024 units/s, dt = 1/1024 s, commands within ±1000.
#[kani::proof]
fn slew_limit() {
    let range = Limits::try_new(kani::any(), kani::any());
    let limits = range.and_then(|range| range.with_slew(1024.0));
    kani::assume(limits.is_ok());
    if let Ok(limits) = limits {
        let (last, wanted) = (within(-1000.0, 1000.0), within(-1000.0, 1000.0));
        let dt = 1.0 / 1024.0;
        kani::cover!(limits.contains(last) && limits.apply(last, wanted, dt) < wanted - 1.0);
        assert!(limits_are_kept(&limits, last, wanted, dt));
    }
}

/// K11. A play stays within the band around its input and moves by the smallest necessary amount; a
/// bad input does not move it.
///
/// Assumes: half-width 0.5, any finite previous output, any input.
#[kani::proof]
fn play() {
    let input: f32 = kani::any();
    if let Ok(play) = Play::try_new(0.5) {
        let mut state = PlayState::new();
        if kani::any() {
            // The first sample is taken over as it is: any output that there can be.
            play.step(&mut state, finite());
        }
        kani::cover!(state
            .output()
            .is_some_and(|y| y < input - play.half_width()));
        assert!(play_holds_its_band(&play, state, input));
    }
}

/// Where the slew limit lets a command get to; the bits, for a stub has no other memory.
static LOW: AtomicU32 = AtomicU32::new(0);
static HIGH: AtomicU32 = AtomicU32::new(0);

/// What `slew_reaches_around` proves of the limit's ends, and no more; they are kept.
fn any_ends<T: Real>(last: T, _: T) -> (T, T) {
    let (low, high): (f32, f32) = (kani::any(), kani::any());
    let (there, back) = (T::from_f64(low.into()), T::from_f64(high.into()));
    kani::assume(there <= last && last <= back);
    LOW.store(low.to_bits(), Ordering::Relaxed);
    HIGH.store(high.to_bits(), Ordering::Relaxed);
    (there, back)
}

/// K10. The ends of a slew-rate limit lie on either side of the previous command, for any rate and
/// dt.
///
/// Assumes: a finite slew rate, a finite dt above zero, a finite previous command.
#[kani::proof]
fn slew_reaches_around() {
    let (slew, dt, last) = (finite(), finite(), finite());
    kani::assume(slew > 0.0 && dt > 0.0);
    let (low, high) = around(last, slew * dt);
    kani::cover!(low < last && last < high && high < 1000.0);
    assert!(low <= last && last <= high);
}

/// K15. For any previous command, slew rate and dt, NaN included: a wanted command, even an
/// infinite one, ends within the range.
///
/// Assumes: any limits, any ends of the slew-rate limit.
#[kani::proof]
#[kani::stub(around, all_ends)]
fn slew_limit_from_any_command() {
    let limits =
        Limits::try_new(kani::any(), kani::any()).and_then(|range| range.with_slew(kani::any()));
    kani::assume(limits.is_ok());
    if let Ok(limits) = limits {
        let (last, wanted, dt): (f32, f32, f32) = (kani::any(), kani::any(), kani::any());
        kani::assume(!wanted.is_nan());
        let command = limits.apply(last, wanted, dt);
        kani::cover!(last.is_nan() && command == 1.0);
        kani::cover!(wanted.is_infinite());
        assert!(limits.contains(command));
    }
}

/// Any two numbers, NaN included.
fn all_ends<T: Real>(_: T, _: T) -> (T, T) {
    (T::from_f64(kani::any()), T::from_f64(kani::any()))
}

/// K10. The same as slew_limit for any slew rate, any finite dt above zero and any command: within
/// the range, and within the ends of the slew-rate limit if the previous command lay in the range.
///
/// Assumes: any limits, a finite dt above zero (controllers refuse any other), a finite previous
/// and wanted command; the ends as proved by slew_reaches_around.
#[kani::proof]
#[kani::stub(around, any_ends)]
fn slew_limit_any_rate() {
    let limits =
        Limits::try_new(kani::any(), kani::any()).and_then(|range| range.with_slew(kani::any()));
    kani::assume(limits.is_ok());
    if let Ok(limits) = limits {
        let (last, wanted, dt) = (finite(), finite(), finite());
        kani::assume(dt > 0.0);
        let command = limits.apply(last, wanted, dt);
        let (low, high) = (LOW.load(Ordering::Relaxed), HIGH.load(Ordering::Relaxed));
        let (low, high) = (f32::from_bits(low), f32::from_bits(high));
        kani::cover!(limits.contains(last) && command < wanted - 1.0 && high > last);
        let slewed = low <= command && command <= high;
        assert!(limits.contains(command) && (slewed || !limits.contains(last)));
    }
}

/// A number that may be missing; a finite one where it is there.
fn maybe_finite() -> Option<f32> {
    kani::any::<bool>().then(finite)
}

fn is_usable(sample: f32, dt: f32) -> bool {
    sample.is_finite() && dt.is_finite() && dt > 0.0
}

/// K15. The first-order low-pass: for any sample the output is finite, so the next step starts from
/// such a state again; a bad sample leaves the state unchanged.
///
/// Assumes: any filter, any finite numbers in the state.
#[kani::proof]
fn low_pass_any_sample() {
    if let Ok(filter) = LowPass::try_new(kani::any()) {
        let before = LowPassState::of(maybe_finite(), finite());
        let (sample, dt): (f32, f32) = (kani::any(), kani::any());
        let mut state = before;
        let output = filter.step(&mut state, sample, dt);
        kani::cover!(is_usable(sample, dt) && output > before.value());
        assert!(output.is_finite() && output == state.value());
        assert!(is_usable(sample, dt) || state == before);
    }
}

/// Any number above zero, infinity included, for the tangent of the prewarping.
fn any_slope(_: f64, _: f64) -> f64 {
    kani::any_where(|slope: &f64| *slope > 0.0)
}

/// Any filter that its constructors accept.
fn biquad() -> Biquad<f32> {
    let design = if kani::any() {
        Biquad::low_pass
    } else {
        Biquad::notch
    };
    let filter = design(kani::any(), kani::any(), kani::any());
    kani::assume(filter.is_ok());
    match filter {
        Ok(filter) => filter,
        Err(_) => unreachable!(),
    }
}

/// K15. The same for the second-order section: for any sample the output is finite; a bad sample
/// leaves the state unchanged.
///
/// Assumes: any filter, any finite numbers in the state.
#[kani::proof]
#[kani::stub(crate::signal::biquad::prewarped::slope, any_slope)]
fn biquad_any_sample() {
    let filter = biquad();
    let before = BiquadState::of(maybe_finite(), [finite(), finite(), finite(), finite()]);
    let (sample, dt): (f32, f32) = (kani::any(), kani::any());
    let mut state = before;
    let output = filter.step(&mut state, sample, dt);
    kani::cover!(is_usable(sample, dt) && output > before.value());
    assert!(output.is_finite() && output == state.value());
    assert!(is_usable(sample, dt) || state == before);
}

/// K15. The velocity from counts: for any sample it is finite, a bad sample leaves it unchanged,
/// and at a reported stop the velocity is zero.
///
/// Assumes: any settings, any finite numbers in the state.
#[kani::proof]
#[kani::stub(libm::expm1f, stubs::expm1f)]
fn edge_velocity_any_sample() {
    let edges = EdgeVelocity::try_new(kani::any(), kani::any(), kani::any());
    let wrapping = edges.and_then(|edges| edges.with_period(kani::any()));
    let chosen = if kani::any() { edges } else { wrapping };
    if let Ok(edges) = chosen {
        let before = EdgeVelocityState::of(
            [maybe_finite(), maybe_finite()],
            kani::any(),
            (finite(), kani::any()),
        );
        let (position, dt): (f32, f32) = (kani::any(), kani::any());
        let mut state = before;
        let out = edges.step(&mut state, position, dt);
        kani::cover!(out.status == RateStatus::Good && out.velocity > before.velocity());
        kani::cover!(out.status == RateStatus::Stopped && before.velocity() > 1.0);
        assert!(out.velocity.is_finite());
        assert!(is_usable(position, dt) || out.velocity == before.velocity());
        assert!(out.status != RateStatus::Stopped || out.velocity == 0.0);
    }
}

/// K15. Plausibility: for any sample and any state, NaN included, the result is either the sample,
/// finite and within the range, or NaN with a fault; a repeated number is never too fast.
///
/// Assumes: a range of ±100, any rate, sample period, longest dt and count of stuck samples.
#[kani::proof]
fn plausible_any_sample() {
    let (rate, period) = (kani::any::<bool>(), kani::any::<bool>());
    let sensor = Plausible::try_new(-100.0_f32, 100.0)
        .and_then(|it| {
            if rate {
                it.with_rate(kani::any())
            } else {
                Ok(it)
            }
        })
        .and_then(|it| {
            if period {
                it.with_sample_period(kani::any())
            } else {
                Ok(it)
            }
        })
        .and_then(|it| it.with_longest_dt(kani::any()));
    if let Ok(sensor) = sensor {
        let sensor = sensor.with_stuck_after(kani::any());
        let last = kani::any::<bool>().then(kani::any);
        let mut state = PlausibleState::of(last, finite(), kani::any());
        let (sample, dt, moves): (f32, f32, bool) = (kani::any(), kani::any(), kani::any());
        let out = sensor.step(&mut state, sample, dt, moves);
        kani::cover!(out.fault == Some(Implausible::TooFast) && rate && period);
        kani::cover!(out.fault.is_none() && last.is_some_and(|last| sample > last + 1.0));
        let is_sample = out.value == sample && (-100.0..=100.0).contains(&out.value);
        assert!(if out.fault.is_none() {
            is_sample
        } else {
            out.value.is_nan()
        });
        let repeats = last == Some(sample);
        assert!(!repeats || out.fault != Some(Implausible::TooFast));
    }
}

/// K13. Filters, the velocity from counts and the sample period: any bit pattern is accepted
/// exactly as documented, without a panic.
///
/// Assumes: a finite slope of the second-order section.
#[kani::proof]
#[kani::stub(crate::signal::biquad::prewarped::slope, any_finite_slope)]
fn filters_of_any_argument() {
    let (a, b, c): (f32, f32, f32) = (kani::any(), kani::any(), kani::any());
    let is_positive = |x: f32| x.is_finite() && x > 0.0;
    let low_pass = LowPass::try_new(a);
    kani::cover!(low_pass.is_ok());
    assert!(low_pass.is_ok() == (a.is_finite() && a >= 0.0));
    let edges = EdgeVelocity::try_new(a, b, c);
    kani::cover!(edges.is_ok());
    assert!(edges.is_ok() == (is_positive(a) && is_positive(b) && is_positive(c)));
    let wrapping = edges.and_then(|edges| edges.with_period(a));
    assert!(wrapping.is_ok() == edges.is_ok());
    let sensor = Plausible::try_new(-1.0_f32, 1.0).and_then(|it| it.with_sample_period(a));
    kani::cover!(sensor.is_ok());
    assert!(sensor.is_ok() == is_positive(a));
    // A sample time of a power of two, and a frequency and a quality of one: the products that
    // decide are exact, and no second multiplier has to be proved equal to the first.
    let notch = Biquad::notch(a, b, 1.0 / 1024.0);
    kani::cover!(notch.is_ok());
    let is_below_nyquist = is_positive(a) && a < 512.0;
    assert!(notch.is_err() || is_below_nyquist && is_positive(b));
    assert!(notch.is_ok() || !(is_below_nyquist && b.is_normal() && b > 0.0));
    let sampled = Biquad::notch(1.0, 1.0, c);
    assert!(sampled.is_ok() == (is_positive(c) && c < 0.5));
}

/// Any number above zero that is finite in `f32` too.
fn any_finite_slope(_: f64, _: f64) -> f64 {
    kani::any_where(|slope: &f64| *slope > 0.0 && *slope < 1e38)
}
