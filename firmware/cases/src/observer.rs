//! The disturbance observer: with numbers that are loaded, and with numbers that lie in flash.

use crate::{Case, Output, Sample};
use bowden::constant;
use bowden::control::{DisturbanceObserver, NominalPlant, ObserverInput, ObserverState};
use bowden::Error;
use core::hint::black_box;

/// Q of 10 Hz on the reference rig's drive, 3 ms late.
const OBSERVER: DisturbanceObserver<f32> = constant!(DisturbanceObserver::<f32>::try_new(
    constant!(NominalPlant::<f32>::try_new(0.6, 25.5, 0.265)),
    0.0159,
    30.0,
    0.005,
)
.with_latency(0.003));

/// The reference stands for the command that went out.
fn step(
    observer: &DisturbanceObserver<f32>,
    state: &mut ObserverState<f32>,
    at: &Sample,
) -> Output {
    let sample = ObserverInput {
        dt: at.dt,
        sent: at.reference,
        measured: at.measured,
    };
    let out = observer.step(state, &sample);
    Output::commanded(out.command, out.status)
}

/// The compiler knows none of its numbers.
#[derive(Debug)]
pub struct Loaded {
    observer: DisturbanceObserver<f32>,
    state: ObserverState<f32>,
}

impl Case for Loaded {
    fn try_new() -> Result<Self, Error> {
        Ok(Self {
            observer: black_box(OBSERVER),
            state: ObserverState::new(),
        })
    }

    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        step(&self.observer, &mut self.state, at)
    }
}

/// A constant, which the compiler has checked.
#[derive(Debug)]
pub struct Constant(ObserverState<f32>);

impl Case for Constant {
    fn try_new() -> Result<Self, Error> {
        Ok(Self(ObserverState::new()))
    }

    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        step(&OBSERVER, &mut self.0, at)
    }
}
