//! K6, K7, K8, K10, K11: saturation, smooth sign, derivative, limits, play.

use super::any::{finite, limits, within};
use super::properties::control::limits_are_kept;
use super::properties::signal::*;
use super::stubs;
use bowden::control::SmoothSign;
use bowden::signal::{Derivative, DerivativeState, Play, PlayState};

/// K6. Any two floats, any box.
#[kani::proof]
fn projection() {
    let (p, truth, low, high): (f32, _, _, _) = (kani::any(), finite(), finite(), finite());
    kani::assume(!p.is_nan());
    kani::cover!(low < truth && truth < high && high < p);
    assert!(projection_moves_towards_the_truth(p, truth, low, high));
}

/// K7. All bit patterns.
#[kani::proof]
fn smooth_sign_clamp() {
    let x: f32 = kani::any();
    kani::cover!(x > 0.5 && x < 1.0);
    assert!(smooth_sign_is_a_sign(SmoothSign::Clamp, x));
}

/// K7. All bit patterns.
#[kani::proof]
fn smooth_sign_clamp_residue() {
    let x: f32 = kani::any();
    kani::cover!(x > 0.49 && x < 0.51);
    assert!(smooth_sign_leaves_at_most_its_residue(SmoothSign::Clamp, x));
}

/// K8. Samples within ±1, 1/1024 s apart, any rate that such samples can lead to, any time
/// constant; e^x - 1 by its contract.
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

/// K10. Any limits, any command before and wanted, any `dt` above zero.
#[kani::proof]
fn slew_limit() {
    let (limits, last, wanted, dt) = (limits(), finite(), finite(), finite());
    kani::assume(dt > 0.0);
    kani::cover!(limits.slew().is_some() && limits.apply(last, wanted, dt) != wanted);
    assert!(limits_are_kept(&limits, last, wanted, dt));
}

/// K11. Any half-width, any state, all bit patterns of the input.
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
