//! Saturation, play, derivative, smooth sign.

use bowden::control::SmoothSign;
use bowden::signal::{clamp, Derivative, DerivativeState, Play, PlayState};

/// Projection onto a box ends between the point and any truth that the box holds.
///
/// So its exact distance from the truth does not grow, nor does the rounded one.
pub fn projection_moves_towards_the_truth(p: f32, truth: f32, low: f32, high: f32) -> bool {
    let held = low <= truth && truth <= high;
    let there = clamp(p, low, high);
    !held || (p <= there && there <= truth) || (truth <= there && there <= p)
}

/// After a good input the play's output lies in the band around it, and moves only as far
/// as it must; a bad input moves nothing.
pub fn play_holds_its_band(play: &Play<f32>, state: PlayState<f32>, input: f32) -> bool {
    let mut next = state;
    let output = play.step(&mut next, input);
    let (low, high) = (input - play.half_width(), input + play.half_width());
    if !input.is_finite() {
        return next == state && output == state.output().unwrap_or(0.0);
    }
    let inside = low <= output && output <= high && output.is_finite();
    let moved = match state.output() {
        Some(before) if low <= before && before <= high => output == before,
        Some(before) => output == low || output == high || output == before,
        None => output == input,
    };
    inside && moved && next.output() == Some(output)
}

/// The filtered rate exceeds neither the rate before nor the difference quotient, but for
/// the rounding of two products and a sum, which near zero is an absolute one.
pub fn rate_exceeds_nothing(
    derivative: &Derivative<f32>,
    state: DerivativeState<f32>,
    change: f32,
    sample: f32,
    dt: f32,
) -> bool {
    let before = state.rate().abs();
    let quotient = (change / dt).abs();
    let mut next = state;
    let rate = derivative.step(&mut next, sample, dt);
    let most = if before > quotient { before } else { quotient };
    rate.abs() <= most * (1.0 + 2.0 * f32::EPSILON) + f32::MIN_POSITIVE && next.rate() == rate
}

/// The filtered rate of a signal within ±1, sampled at 1024 Hz, stays within
/// `share/dt·(x ± (1 + slack))`, where x is the sample: what rounding adds in a step, the
/// share of the old rate that is lost makes good.
pub fn rate_stays_by_its_signal(
    derivative: &Derivative<f32>,
    state: DerivativeState<f32>,
    last: f32,
    sample: f32,
    slack: f32,
) -> bool {
    let dt = 1.0 / 1024.0;
    // What a step of one gives from rest is share/dt.
    let mut at_rest = DerivativeState::new();
    derivative.step(&mut at_rest, 0.0, dt);
    let slope = derivative.step(&mut at_rest, 1.0, dt);
    let by = |rate: f32, x: f32| (rate - slope * x).abs() <= slope * (1.0 + slack);
    let mut next = state;
    let rate = derivative.step(&mut next, sample, dt);
    !by(state.rate(), last) || (by(rate, sample) && next.rate() == rate)
}

/// A smooth sign lies within ±1, is odd to the bit and never points the other way.
pub fn smooth_sign_is_a_sign(sign: SmoothSign, x: f32) -> bool {
    let (here, there) = (sign.of(x), sign.of(-x));
    if x.is_nan() {
        return here.is_nan();
    }
    here.abs() <= 1.0 && here.to_bits() == (-there).to_bits() && x * here >= 0.0
}

/// What smoothing the sign costs: `|x|·(1 - |T|)` is at most `residue`, to two ulps.
pub fn smooth_sign_leaves_at_most_its_residue(sign: SmoothSign, x: f32) -> bool {
    if !x.is_finite() {
        return true;
    }
    let left = x.abs() * (1.0 - sign.of(x).abs());
    left <= sign.residue::<f32>() * (1.0 + 2.0 * f32::EPSILON)
}
