//! The steps whose cost on a chip is measured, and the samples that they are fed with.
//!
//! One source for both sides: an image of `bowden-image` runs a [`Case`] on the emulated
//! chip and prints every output, the host runs the same case and compares. So there is no
//! file of expected numbers that could be out of date; that the numbers themselves are
//! right is what the tests of `bowden` are for.
//!
//! A case is a controller, a model or a part of one, with settings as a user would choose
//! them. They go through `black_box`: what the optimiser must not see is what a firmware
//! that loads its model does not know either. The samples are tables that the compiler
//! computes, so that an image holds no arithmetic but that of its step.
#![no_std]
#![forbid(unsafe_code)]

pub mod adaptive;
pub mod cable;
pub mod closed_loop;
pub mod conditioning;
pub mod learning;
pub mod model;
pub mod observer;
pub mod pid;
pub mod relay;
mod signal;

pub use signal::{Sample, Signal, LENGTH, SIGNALS};

use bowden::control::Status;
use bowden::Error;

/// A step whose cost is measured, with its state.
pub trait Case: Sized {
    /// On how many samples of each signal it runs, at most [`LENGTH`].
    const SAMPLES: usize = LENGTH;
    /// Bytes of stack that are watched; one that uses all of them cannot be measured.
    const STACK: usize = 1024;

    /// The case at rest.
    ///
    /// # Errors
    /// Those of the constructor whose product is measured.
    fn try_new() -> Result<Self, Error>;

    /// One sample.
    fn step(&mut self, at: &Sample) -> Output;
}

/// What is compared between chip and host.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Output {
    /// Command, torque, hysteresis state or a result.
    pub value: f32,
    /// 0 for a good sample, 1 for a held command, 2 for a safe command, 3 for a dropped
    /// term, 4 for the result of an experiment.
    pub status: u32,
}

impl Output {
    /// A number of something that has no status.
    #[must_use]
    pub fn of(value: f32) -> Self {
        Self { value, status: 0 }
    }

    /// The command of a controller with its status.
    #[must_use]
    pub fn commanded(command: f32, status: Status) -> Self {
        let status = match status {
            Status::Good => 0,
            Status::Held(_) => 1,
            Status::Safe(_) => 2,
            Status::Degraded(_) => 3,
        };
        Self {
            value: command,
            status,
        }
    }
}

/// Nothing at all: what the measurement itself costs.
#[derive(Debug)]
pub struct Empty;

impl Case for Empty {
    fn try_new() -> Result<Self, Error> {
        Ok(Self)
    }

    #[inline]
    fn step(&mut self, _: &Sample) -> Output {
        Output::default()
    }
}

/// Runs a case on a signal and hands every output over.
fn outputs<C: Case>(signal: Signal, take: &mut dyn FnMut(Output)) -> Result<(), Error> {
    let mut case = C::try_new()?;
    for sample in signal.samples().iter().take(C::SAMPLES) {
        take(case.step(sample));
    }
    Ok(())
}

macro_rules! cases {
    ($($name:literal: $case:ty;)+) => {
        /// The names of all cases, in the order of the table; the first is [`Empty`].
        pub const NAMES: &[&str] = &[$($name),+];

        /// Runs the case of that name on a signal; `None` if there is no such case.
        ///
        /// # Errors
        /// Those of the constructor.
        pub fn run(name: &str, signal: Signal, take: &mut dyn FnMut(Output)) -> Option<Result<(), Error>> {
            match name {
                $($name => Some(outputs::<$case>(signal, take)),)+
                _ => None,
            }
        }
    };
}

cases! {
    "empty": Empty;
    "pi": pid::Pi;
    "pid": pid::Pid;
    "piv": pid::Piv;
    "pi-constant": pid::PiConstant;
    "pid-constant": pid::PidConstant;
    "piv-constant": pid::PivConstant;
    "adaptive-2-lag-clamp": adaptive::LagClamp2;
    "adaptive-2-literal-clamp": adaptive::LiteralClamp2;
    "adaptive-2-lag-tanh": adaptive::LagTanh2;
    "adaptive-2-literal-tanh": adaptive::LiteralTanh2;
    "adaptive-3-lag-clamp": adaptive::LagClamp3;
    "adaptive-3-literal-clamp": adaptive::LiteralClamp3;
    "adaptive-3-lag-tanh": adaptive::LagTanh3;
    "adaptive-3-literal-tanh": adaptive::LiteralTanh3;
    "adaptive-2-lag-clamp-constant": adaptive::LagClamp2Constant;
    "adaptive-2-lag-tanh-constant": adaptive::LagTanh2Constant;
    "adaptive-2-literal-clamp-constant": adaptive::LiteralClamp2Constant;
    "adaptive-2-literal-tanh-constant": adaptive::LiteralTanh2Constant;
    "hysteresis": cable::Hysteresis;
    "transmission": cable::Forward;
    "inverse": cable::Inverse;
    "compensator": model::Compensated;
    "observer": observer::Loaded;
    "observer-constant": observer::Constant;
    "learning": learning::Loaded;
    "learning-constant": learning::Constant;
    "relay": relay::Relay;
    "low-pass": conditioning::Smooth;
    "notch": conditioning::Notch;
    "edge-velocity": conditioning::Slow;
    "model-2": model::TwoEffects;
    "model-8": model::EightEffects;
    "model-2-constant": model::TwoConstant;
    "model-8-constant": model::EightConstant;
    "model-8-loaded": model::EightLoaded;
    "model-curve": model::CurveConstant;
    "closed-loop": closed_loop::ClosedLoop;
}
