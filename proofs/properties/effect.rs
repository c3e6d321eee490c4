//! Effects: finite for any sample.

use bowden::effect::{Delay, Effect, EffectState, Inputs};

/// Whatever the sample, the regressor is finite; where a number that it reads is not, it is
/// zero and the memory stays.
pub fn a_regressor_is_finite(
    effect: &Effect<f32>,
    state: &mut EffectState<f32>,
    at: &Inputs<f32>,
) -> bool {
    let before = *state;
    let value = effect.regressor(state, at);
    let usable = at.is_usable(effect.info().reads);
    value.is_finite() && (usable || (value == 0.0 && *state == before))
}

/// Whatever the sample and the delay, what it adds to the output is finite; where a number that
/// it reads is not, it adds zero and the memory stays.
pub fn a_late_output_is_finite(gain: f32, state: &mut EffectState<f32>, at: &Inputs<f32>) -> bool {
    let before = *state;
    let part = Effect::from(Delay).contribution(gain, state, at);
    let usable = at.is_usable(Effect::<f32>::from(Delay).info().reads);
    part.is_finite() && (usable || (part == 0.0 && *state == before))
}
