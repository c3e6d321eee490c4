//! K6, K7, K8, K10, K11: saturation, smooth sign, derivative, limits, play.

use super::any::{finite, within};
use super::properties::control::limits_are_kept;
use super::properties::signal::*;
use bowden::control::limits::around;
use bowden::control::{Limits, SmoothSign};
use bowden::signal::{Derivative, DerivativeState, Play, PlayState};
use bowden::Real;
use core::sync::atomic::{AtomicU32, Ordering};

/// K6. Clamping an estimate onto a box moves it towards any truth that the box holds.
#[kani::proof]
fn projection() {
    let (p, truth, low, high): (f32, _, _, _) = (kani::any(), finite(), finite(), finite());
    kani::assume(!p.is_nan());
    kani::cover!(low < truth && truth < high && high < p);
    assert!(projection_moves_towards_the_truth(p, truth, low, high));
}

/// K7. The clamped line lies within ±1, is odd to the bit and never points the other way.
#[kani::proof]
fn smooth_sign_clamp() {
    let x: f32 = kani::any();
    kani::cover!(x > 0.5 && x < 1.0);
    assert!(smooth_sign_is_a_sign(SmoothSign::Clamp, x));
}

/// K7. The clamped line leaves x·(1 - T) ≤ 1/4 for x ≥ 0, to two ulps. (tanh: all 2³² inputs,
/// `tests/exhaustive.rs`.)
#[kani::proof]
fn smooth_sign_clamp_residue() {
    let x: f32 = kani::any();
    kani::cover!(x > 0.49 && x < 0.51);
    assert!(smooth_sign_leaves_at_most_its_residue(SmoothSign::Clamp, x));
}

/// K8. From rate zero on, the rate of a signal within ±E never exceeds 2·E/tau: it stays
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

/// K10. A command lies within the range, and within slew·dt of the one before wherever that
/// lay in the range; so after a hand-over or a change of gains, too.
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

/// K11. A play stays in the band around its input and moves only as far as it must; a bad
/// input moves nothing.
///
/// Assumes: half-width 0.5, any finite output before, any input.
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
    let (there, back) = (T::of(low.into()), T::of(high.into()));
    kani::assume(there <= last && last <= back);
    LOW.store(low.to_bits(), Ordering::Relaxed);
    HIGH.store(high.to_bits(), Ordering::Relaxed);
    (there, back)
}

/// K10. A slew limit's ends lie on either side of the command before, whatever rate and dt.
///
/// Assumes: a finite slew rate and a finite dt above zero, a finite command before.
#[kani::proof]
fn slew_reaches_around() {
    let (slew, dt, last) = (finite(), finite(), finite());
    kani::assume(slew > 0.0 && dt > 0.0);
    let (low, high) = around(last, slew * dt);
    kani::cover!(low < last && last < high && high < 1000.0);
    assert!(low <= last && last <= high);
}

/// K15. Whatever the command before, the slew rate and dt are, NaN included: a command that is
/// wanted, infinite or not, ends within the range.
///
/// Assumes: any limits, any ends of the slew rate's reach.
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
    (T::of(kani::any()), T::of(kani::any()))
}

/// K10. The same as slew_limit for any slew rate, any finite dt above zero and any command:
/// within the range, and within the limit's ends wherever the command before lay in the range.
///
/// Assumes: any limits, a finite dt above zero (controllers refuse any other), a finite command
/// before and wanted; the ends as proved by slew_reaches_around.
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
