//! PI, PID and PIV: with settings that are loaded, and with settings that lie in flash.

use crate::{Case, Output, Sample};
use bowden::constant;
use bowden::control::{
    AntiWindup, DerivativeSource, Fallback, Limits, Pid as Controller, PidInput, PidSettings,
    PidState,
};
use bowden::Error;
use core::hint::black_box;

/// A PI with limits, conditional anti-windup and a safe command.
const PI: PidSettings<f32> = PidSettings {
    anti_windup: AntiWindup::Conditional,
    ..PidSettings::new(
        3.0,
        18.0,
        constant!(Limits::<f32>::try_new(-20.0, 60.0)),
        0.005,
        constant!(Fallback::<f32>::try_new(20, 0.0)),
    )
};

/// The PI with a derivative over 10 ms.
const PID: PidSettings<f32> = PidSettings {
    k_d: 0.02,
    derivative_time: 0.01,
    damping: DerivativeSource::on_measurement(),
    ..PI
};

/// The PI with damping by the measured velocity.
const PIV: PidSettings<f32> = PidSettings {
    k_d: 1.0,
    damping: DerivativeSource::Velocity,
    ..PI
};

fn step(controller: &Controller<f32>, state: &mut PidState<f32>, at: &Sample) -> Output {
    let sample = PidInput {
        velocity: at.velocity,
        ..PidInput::new(at.dt, at.reference, at.measured)
    };
    let out = controller.step(state, &sample);
    Output::commanded(out.command, out.status)
}

macro_rules! cases {
    ($($settings:ident, $loaded:ident, $constant:ident: $text:literal;)+) => {$(
        #[doc = concat!($text, "; the compiler knows none of its settings.")]
        #[derive(Debug)]
        pub struct $loaded {
            controller: Controller<f32>,
            state: PidState<f32>,
        }

        impl Case for $loaded {
            fn try_new() -> Result<Self, Error> {
                Ok(Self {
                    controller: Controller::try_new(black_box($settings))?,
                    state: PidState::new(),
                })
            }

            #[inline]
            fn step(&mut self, at: &Sample) -> Output {
                step(&self.controller, &mut self.state, at)
            }
        }

        #[doc = concat!($text, "; a constant, which the compiler has checked.")]
        #[derive(Debug)]
        pub struct $constant(PidState<f32>);

        impl $constant {
            const CONTROLLER: Controller<f32> = constant!(Controller::<f32>::try_new($settings));
        }

        impl Case for $constant {
            fn try_new() -> Result<Self, Error> {
                Ok(Self(PidState::new()))
            }

            #[inline]
            fn step(&mut self, at: &Sample) -> Output {
                step(&Self::CONTROLLER, &mut self.0, at)
            }
        }
    )+};
}

cases! {
    PI, Pi, PiConstant: "A PI with limits, conditional anti-windup and a safe command";
    PID, Pid, PidConstant: "The PI with a derivative over 10 ms";
    PIV, Piv, PivConstant: "The PI with damping by the measured velocity";
}
