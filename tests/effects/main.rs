//! The effects: closed forms, parity, units, memory, and inputs of any kind.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod constructed;
mod curve;
mod declared;
mod hardening;
mod late;
mod memory;
mod names;
mod robust;

use bowden::effect::{Effect, EffectState, Inputs, Motion, CATALOGUE};
use bowden::Real;
use proptest::prelude::*;

/// An effect with plausible shapes, none of them round.
fn make<T: Real>(name: &str) -> Effect<T> {
    let shapes: &[f64] = match name {
        "stribeck" => &[0.6, 1.7],
        "capstan" => &[0.7, 0.3],
        "ripple" => &[3.3, 0.4],
        "tone" => &[1.9, 0.8],
        "hardening" | "curve-position" | "curve-velocity" => &[0.7, 0.4],
        _ => &[0.7],
    };
    let shapes: Vec<T> = shapes.iter().map(|&shape| T::from_f64(shape)).collect();
    Effect::try_from_name(name, &shapes)
        .or_else(|_| Effect::try_from_name(name, &[]))
        .unwrap()
}

fn names() -> impl Iterator<Item = &'static str> {
    CATALOGUE.iter().map(|info| info.name)
}

/// The numbers of a situation in one order, for the strategies.
fn situation<T: Real>(numbers: [T; 11]) -> Inputs<T> {
    let [dt, time, x, v, a, input, input_v, input_a, load, eta, output] = numbers;
    Inputs {
        dt,
        time,
        motion: Motion {
            position: x,
            velocity: v,
            acceleration: a,
        },
        input: Motion {
            position: input,
            velocity: input_v,
            acceleration: input_a,
        },
        load,
        eta,
        output,
    }
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
