//! K6, K7, K10, K11: saturation, smooth sign, limits, play.

use super::any::{finite, within};
use super::properties::control::limits_are_kept;
use super::properties::signal::*;
use bowden::control::{Limits, SmoothSign};
use bowden::signal::{Play, PlayState};

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
