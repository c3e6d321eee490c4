//! States that were stored: what reading accepts, a step can use.

use crate::adaptive;
use crate::blocks;
use crate::numbers::Numbers;
use crate::pid;
use crate::properties::control::{
    adaptive_commands_within_its_limits_from_any_state,
    pid_commands_within_its_limits_from_any_state,
};
use bowden::control::{AdaptiveState, PidState, RelayState};
use bowden::effect::EffectState;
use bowden::hysteresis::BoucWenState;
use bowden::signal::{BiquadState, EdgeVelocityState, LowPassState, Rates, RatesState};
use serde::{de::DeserializeOwned, Serialize};
use std::fmt::Debug;

/// Whatever the bytes: a state that is read has finite numbers and reads back as it was
/// written; from it, under any settings, the commands are finite and within the limits, eta
/// is within ±1, a rate and a filter's output are finite.
pub fn check(data: &[u8]) {
    let _ = run(data);
}

/// The state at the beginning of the bytes, where reading accepts it, and the other bytes.
fn read<S: DeserializeOwned + Serialize + PartialEq + Debug>(
    data: &[u8],
) -> Option<(S, Numbers<'_>)> {
    let (state, rest) = postcard::take_from_bytes::<S>(data).ok()?;
    let written = postcard::to_allocvec(&state).expect("a state that was read is written");
    let again = postcard::from_bytes::<S>(&written).expect("what was written is read");
    assert!(again == state, "{state:?}");
    Some((state, Numbers::new(rest)))
}

fn run(data: &[u8]) -> Option<()> {
    let (kind, data) = data.split_first()?;
    match kind % 9 {
        0 => {
            let (mut state, mut from) = read::<PidState<f32>>(data)?;
            assert!(state.integral().is_finite() && state.rate().is_finite());
            let pid = pid::pid(&mut from)?;
            loop {
                let at = pid::sample(&mut from)?;
                assert!(pid_commands_within_its_limits_from_any_state(
                    &pid, &mut state, &at
                ));
            }
        }
        1 => {
            let (mut state, mut from) = read::<AdaptiveState<f32, 2>>(data)?;
            let estimates = [state.beta_hat(), state.delta_hat(), state.command()];
            assert!(estimates
                .iter()
                .chain(&state.theta_hat())
                .all(|x| x.is_finite()));
            let law = adaptive::law(&mut from)?;
            loop {
                let at = adaptive::sample(&mut from)?;
                assert!(adaptive_commands_within_its_limits_from_any_state(
                    &law, &mut state, &at
                ));
            }
        }
        2 => {
            let (mut state, mut from) = read::<BoucWenState<f32>>(data)?;
            let shape = from.shape::<f32>()?;
            loop {
                assert!(state.eta().abs() <= 1.0);
                shape.step(&mut state, from.any()?);
            }
        }
        3 => {
            let (mut state, mut from) = read::<RatesState<f32>>(data)?;
            let rates = Rates::try_new(from.any()?).ok()?;
            loop {
                let position = from.any()?;
                let motion = rates.step(&mut state, position, from.dt()?).motion;
                assert!(motion.position.is_finite());
                assert!(motion.velocity.is_finite() && motion.acceleration.is_finite());
            }
        }
        4 => {
            let (mut state, mut from) = read::<EffectState<f32>>(data)?;
            let effect = from.effect::<f32>()?;
            loop {
                let at = crate::model::situation(&mut from)?;
                assert!(
                    effect.regressor(&mut state, &at).is_finite(),
                    "{}",
                    effect.name()
                );
            }
        }
        5 => {
            let (mut state, mut from) = read::<LowPassState<f32>>(data)?;
            let filter = blocks::low_pass(&mut from)?;
            loop {
                blocks::low_pass_steps(&filter, &mut state, from.any()?, from.dt()?);
            }
        }
        6 => {
            let (mut state, mut from) = read::<BiquadState<f32>>(data)?;
            let filter = blocks::biquad(&mut from)?;
            loop {
                blocks::biquad_steps(&filter, &mut state, from.any()?, from.dt()?);
            }
        }
        7 => {
            let (mut state, mut from) = read::<EdgeVelocityState<f32>>(data)?;
            let (edges, _) = blocks::edges(&mut from)?;
            loop {
                blocks::edges_step(&edges, &mut state, from.any()?, from.dt()?);
            }
        }
        _ => {
            let (mut state, mut from) = read::<RelayState<f32>>(data)?;
            let relay = blocks::relay(&mut from)?;
            loop {
                blocks::relay_steps(&relay, &mut state, &mut from)?;
            }
        }
    }
}
