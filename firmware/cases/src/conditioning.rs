//! Signal conditioning: filters of the measured torque, and the velocity of a slow encoder.

use crate::{Case, Output, Sample};
use bowden::constant;
use bowden::signal::{Biquad, BiquadState, EdgeVelocity, EdgeVelocityState, RateStatus};
use bowden::signal::{LowPass, LowPassState};
use bowden::Error;
use core::hint::black_box;

/// The corner at 80 Hz.
const SMOOTH: LowPass<f32> = constant!(LowPass::<f32>::try_new(0.002));
/// A resonance at 35 Hz, 7 Hz wide, at 1 kHz.
const NOTCH: Biquad<f32> = constant!(Biquad::<f32>::notch(35.0, 5.0, 0.001));
/// An encoder of 1024 counts a turn \[rad\].
const EDGES: EdgeVelocity<f32> = constant!(EdgeVelocity::<f32>::try_new(COUNT, 0.01, 0.5));
const COUNT: f32 = core::f32::consts::TAU / 1024.0;

/// The first-order low-pass.
#[derive(Debug)]
pub struct Smooth(LowPass<f32>, LowPassState<f32>);

impl Case for Smooth {
    fn try_new() -> Result<Self, Error> {
        Ok(Self(black_box(SMOOTH), LowPassState::new()))
    }

    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        Output::of(self.0.step(&mut self.1, at.measured, at.dt))
    }
}

/// The second-order notch.
#[derive(Debug)]
pub struct Notch(Biquad<f32>, BiquadState<f32>);

impl Case for Notch {
    fn try_new() -> Result<Self, Error> {
        Ok(Self(black_box(NOTCH), BiquadState::new()))
    }

    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        Output::of(self.0.step(&mut self.1, at.measured, at.dt))
    }
}

/// The velocity between counts, of the position in whole counts.
#[derive(Debug)]
pub struct Slow(EdgeVelocity<f32>, EdgeVelocityState<f32>);

impl Case for Slow {
    fn try_new() -> Result<Self, Error> {
        Ok(Self(black_box(EDGES), EdgeVelocityState::new()))
    }

    #[inline]
    #[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss)]
    fn step(&mut self, at: &Sample) -> Output {
        let position = (at.position / COUNT) as i32 as f32 * COUNT;
        let out = self.0.step(&mut self.1, position, at.dt);
        Output {
            value: out.velocity,
            status: u32::from(matches!(out.status, RateStatus::Held(_))),
        }
    }
}
