//! K6, K7, K8, K10, K11: saturation, smooth sign, derivative, limits, play.

use super::any::{finite, limits, within};
use super::properties::control::limits_are_kept;
use super::properties::signal::*;
use super::stubs;
use bowden::control::SmoothSign;
use bowden::signal::{Derivative, DerivativeState, Play, PlayState};

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

/// K7. The clamped line leaves |x|·(1 - |T|) ≤ 1/4, to two ulps. (tanh: all 2³² inputs,
/// `tests/exhaustive.rs`.)
#[kani::proof]
fn smooth_sign_clamp_residue() {
    let x: f32 = kani::any();
    kani::cover!(x > 0.49 && x < 0.51);
    assert!(smooth_sign_leaves_at_most_its_residue(SmoothSign::Clamp, x));
}

/// K8. The filtered rate exceeds neither the rate before nor the difference quotient, but
/// for rounding.
///
/// Assumes: samples within ±1, 1/1024 s apart, a rate within ±2048, any time constant.
#[kani::proof]
#[kani::stub(libm::expm1f, stubs::expm1f)]
fn derivative() {
    let filter = Derivative::try_new(kani::any());
    kani::assume(filter.is_ok());
    let dt = 1.0 / 1024.0;
    let (last, sample) = (within(-1.0, 1.0), within(-1.0, 1.0));
    let state = DerivativeState::at(last, within(-2048.0, 2048.0));
    kani::cover!(sample - last > 1.5 && state.rate() < -1000.0);
    if let Ok(filter) = filter {
        assert!(rate_exceeds_nothing(
            &filter,
            state,
            sample - last,
            sample,
            dt
        ));
    }
}

/// K10. A command lies within the range, and within slew·dt of the one before wherever that
/// lay in the range; so after a hand-over or a change of gains, too.
///
/// Assumes: any limits, finite commands, a finite dt above zero.
#[kani::proof]
fn slew_limit() {
    let (limits, last, wanted, dt) = (limits(), finite(), finite(), finite());
    kani::assume(dt > 0.0);
    kani::cover!(limits.slew().is_some() && limits.apply(last, wanted, dt) != wanted);
    assert!(limits_are_kept(&limits, last, wanted, dt));
}

/// K11. A play stays in the band around its input and moves only as far as it must.
#[kani::proof]
fn play() {
    let (play, input): (_, f32) = (Play::try_new(kani::any()), kani::any());
    kani::assume(play.is_ok());
    let mut state = PlayState::new();
    if let Ok(play) = play {
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
