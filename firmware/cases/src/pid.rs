//! PI, PID and PIV.

use crate::{Case, Output, Sample};
use bowden::control::{
    AntiWindup, Damping, Fallback, Limits, Pid as Controller, PidInput, PidSettings, PidState,
};
use bowden::Error;
use core::hint::black_box;

/// A PI with limits, conditional anti-windup and a safe command.
#[derive(Debug)]
pub struct Pi(Law);

/// The PI with a derivative over 10 ms.
#[derive(Debug)]
pub struct Pid(Law);

/// The PI with damping by the measured velocity.
#[derive(Debug)]
pub struct Piv(Law);

#[derive(Debug)]
struct Law {
    controller: Controller<f32>,
    state: PidState<f32>,
}

impl Law {
    fn try_new(settings: PidSettings<f32>) -> Result<Self, Error> {
        Ok(Self {
            controller: Controller::try_new(black_box(settings))?,
            state: PidState::new(),
        })
    }

    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        let sample = PidInput {
            velocity: at.velocity,
            ..PidInput::new(at.dt, at.reference, at.measured)
        };
        let out = self.controller.step(&mut self.state, &sample);
        Output::commanded(out.command, out.status)
    }
}

fn pi() -> Result<PidSettings<f32>, Error> {
    Ok(PidSettings {
        anti_windup: AntiWindup::Conditional,
        ..PidSettings::new(
            3.0,
            18.0,
            Limits::try_new(-20.0, 60.0)?,
            0.005,
            Fallback::try_new(20, 0.0)?,
        )
    })
}

impl Case for Pi {
    fn try_new() -> Result<Self, Error> {
        Law::try_new(pi()?).map(Self)
    }

    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        self.0.step(at)
    }
}

impl Case for Pid {
    fn try_new() -> Result<Self, Error> {
        Law::try_new(PidSettings {
            k_d: 0.02,
            derivative_time: 0.01,
            damping: Damping::on_measurement(),
            ..pi()?
        })
        .map(Self)
    }

    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        self.0.step(at)
    }
}

impl Case for Piv {
    fn try_new() -> Result<Self, Error> {
        Law::try_new(PidSettings {
            k_d: 1.0,
            damping: Damping::Velocity,
            ..pi()?
        })
        .map(Self)
    }

    #[inline]
    fn step(&mut self, at: &Sample) -> Output {
        self.0.step(at)
    }
}
