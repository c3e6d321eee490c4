//! The sensors: torque through an A/D converter, and angles through an encoder.

use super::{Noise, RigConfig};
use bowden::effect::Motion;
use bowden::signal::clamp;
use bowden::Real;

/// A torque sensor: first-order lag, white noise and A/D converter.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct TorqueSensor<T> {
    noise: T,
    range: T,
    /// One count \[N·m\].
    count: T,
}

/// The lagged torque \[N·m\].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct TorqueSensorState<T> {
    pub(super) level: T,
}

impl<T: Real> TorqueSensor<T> {
    pub(super) fn new(config: &RigConfig<T>, noise: T, range: T) -> Self {
        Self {
            noise,
            range,
            count: T::from_f64(2.0) * range / config.converter_counts,
        }
    }

    pub(super) fn read(&self, state: &TorqueSensorState<T>, noise: &mut Noise) -> T {
        let analogue = state.level + self.noise * noise.normal();
        clamp(
            (analogue / self.count).round() * self.count,
            -self.range,
            self.range,
        )
    }
}

impl<T: Real> TorqueSensorState<T> {
    pub(super) fn new() -> Self {
        Self { level: T::zero() }
    }

    #[inline]
    pub(super) fn follow(&mut self, torque: T, share: T) {
        self.level += share * (torque - self.level);
    }
}

/// An encoder, and the velocity and acceleration that firmware computes from its counts.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Encoder<T> {
    /// One count \[rad\].
    count: T,
    lag: T,
}

/// Last count, filtered velocity and filtered acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct EncoderState<T> {
    motion: Motion<T>,
}

impl<T: Real> Encoder<T> {
    pub(super) fn new(config: &RigConfig<T>) -> Self {
        Self {
            count: T::from_f64(2.0 * core::f64::consts::PI) / config.encoder_counts,
            lag: config.velocity_lag,
        }
    }

    /// Rounds the angle to whole counts and filters the differences with the factor dt/(lag + dt).
    pub(super) fn read(&self, state: &mut EncoderState<T>, angle: T, dt: T) -> Motion<T> {
        let position = (angle / self.count).round() * self.count;
        let share = dt / (self.lag + dt);
        let last = state.motion;
        let velocity = last.velocity + share * ((position - last.position) / dt - last.velocity);
        let acceleration =
            last.acceleration + share * ((velocity - last.velocity) / dt - last.acceleration);
        state.motion = Motion {
            position,
            velocity,
            acceleration,
        };
        state.motion
    }
}

impl<T: Real> EncoderState<T> {
    pub(super) fn new() -> Self {
        Self {
            motion: Motion {
                position: T::zero(),
                velocity: T::zero(),
                acceleration: T::zero(),
            },
        }
    }
}
