//! The effects: closed forms, units, memory, and inputs of any kind.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod curve;
mod declared;
mod late;
mod memory;
mod names;
mod robust;
#[path = "../shared/mod.rs"]
mod shared;

use approx::assert_relative_eq;
use bowden::effect::*;
use bowden::{Error, Real};
use proptest::prelude::*;
use proptest::sample::select;
use shared::*;

fn names() -> impl Iterator<Item = &'static str> {
    CATALOGUE.iter().map(|info| info.name)
}

/// The numbers of a situation in one order, for the strategies.
fn situation<T: Real>(numbers: [T; 11]) -> Inputs<T> {
    let [dt, time, x, v, a, input, input_v, input_a, load, eta, output] = numbers;
    let (motion, input) = (moving(x, v, a), moving(input, input_v, input_a));
    Inputs {
        dt,
        time,
        motion,
        input,
        load,
        eta,
        output,
    }
}

fn moving<T>(position: T, velocity: T, acceleration: T) -> Motion<T> {
    Motion {
        position,
        velocity,
        acceleration,
    }
}

/// Quiet but for the position of the channel.
fn at<T: Real>(position: T, dt: T) -> Inputs<T> {
    with(Inputs::default(), |at| {
        (at.motion.position, at.dt) = (position, dt)
    })
}

/// Samples of one channel, all other numbers quiet.
fn stroke(positions: impl IntoIterator<Item = f64>, dt: f64) -> Vec<Inputs<f64>> {
    positions
        .into_iter()
        .map(|position| at(position, dt))
        .collect()
}

/// Quiet but for the output before the stages.
fn out(output: f64, dt: f64) -> Inputs<f64> {
    with(Inputs::default(), |at| (at.output, at.dt) = (output, dt))
}

/// The same with one of its numbers.
fn spoilt(at: &Inputs<f64>, quantity: Quantity, value: f64) -> Inputs<f64> {
    let mut at = *at;
    *match quantity {
        Quantity::Dt => &mut at.dt,
        Quantity::Time => &mut at.time,
        Quantity::Position => &mut at.motion.position,
        Quantity::Velocity => &mut at.motion.velocity,
        Quantity::Acceleration => &mut at.motion.acceleration,
        Quantity::Input => &mut at.input.position,
        Quantity::Load => &mut at.load,
        Quantity::Eta => &mut at.eta,
        Quantity::Output => &mut at.output,
        other => panic!("{other:?} is new"),
    } = value;
    at
}

prop_compose! {
    fn plausible()(
        clocks in [0.001..0.1_f64, 0.0..10.0],
        signals in [-3.0..3.0_f64, -3.0..3.0, -3.0..3.0, -3.0..3.0, -3.0..3.0, -3.0..3.0, -3.0..3.0],
        eta in -1.0..1.0_f64,
        output in -3.0..3.0_f64,
    ) -> Inputs<f64> {
        let ([dt, time], [x, v, a, input, input_v, input_a, load]) = (clocks, signals);
        situation([dt, time, x, v, a, input, input_v, input_a, load, eta, output])
    }
}

/// The regressor along a path, from a fresh state.
fn along<T: Real>(effect: &Effect<T>, path: &[Inputs<T>]) -> Vec<T> {
    let mut state = EffectState::default();
    path.iter()
        .map(|at| effect.regressor(&mut state, at))
        .collect()
}
