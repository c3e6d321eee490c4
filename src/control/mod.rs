//! Torque controllers that reject bad samples.
//!
//! Configuration and state are separate types. `try_new` checks a configuration once. The
//! configuration never changes, so it can be stored in flash. A state can be saved and restored.
//! Call `step` once per sample with the time since the last call; this time may vary.
//!
//! **Bad samples.** A sample is bad if
//! - a number that the controller reads is NaN or infinite,
//! - `dt` is not positive or exceeds the longest `dt` of the configuration, or
//! - the command overflows.
//!
//! A bad sample holds the last good command. It leaves the state unchanged, except for the fault
//! counter and the accumulated time of the bad samples. The [`Status`] reports the bad input. After
//! too many bad samples, a [`Pid`], [`Adaptive`] or [`Relay`] applies the safe command of its
//! [`Fallback`] until [`acknowledge`](PidState::acknowledge) is called. For any state, the
//! command of these three controllers is finite and within the [`Limits`]. To reject finite but
//! implausible numbers, pass each input through [`signal::Plausible`](crate::signal::Plausible).
//!
//! **In flash.** [`constant!`](crate::constant) makes a checked `static` or `const` of every
//! configuration except a [`Compensator`], which contains a [`Model`](crate::model::Model).
//!
//! | controller | description | equations |
//! |---|---|---|
//! | [`Pid`] | PI, PID, PIV | (14)-(16) |
//! | [`Adaptive`] | robust adaptive law with any number of regressors | (17)-(26) |
//! | [`Compensator`] | inverse of the identified model as a feed-forward | (1)-(2), (5)-(7) |
//! | [`DisturbanceObserver`] | estimate and compensation of friction and load | |
//! | [`IterativeLearning`] | feed-forward from the error of earlier cycles of a repeating task | |
//! | [`Relay`] | relay experiment that measures the ultimate gain and period, for PI gains | |
//!
//! [`Controller`] is the common interface of [`Pid`] and [`Adaptive`]. [`law`] contains the
//! equations of the adaptive law, one function for each term.

mod adaptive;
mod compensator;
mod controller;
pub mod law;
mod learning;
pub(crate) mod limits;
mod observer;
pub(crate) mod pid;
mod relay;
pub(crate) mod status;

pub use crate::fault::Fault;
pub(crate) use adaptive::End;
pub use adaptive::{
    Adaptive, AdaptiveInput, AdaptiveSettings, AdaptiveState, AdaptiveTerms, Disturbance,
    ErrorState, Estimator, Form, LagRecursion, Leakage, OnMissing, SmoothSign,
};
pub use compensator::{
    BenchRange, Changed, Compensator, CompensatorInput, CompensatorOutput, CompensatorState,
};
pub use controller::{Controller, LoopSample, Output, Telemetry};
pub use learning::{IterativeLearning, IterativeLearningInput, IterativeLearningState};
pub use limits::Limits;
pub use observer::{DisturbanceObserver, NominalPlant, ObserverInput, ObserverState};
pub use pid::{AntiWindup, DerivativeSource, Pid, PidInput, PidSettings, PidState, PidTerms};
pub use relay::{PiGains, PiRule, Relay, RelaySettings, RelayState, Ultimate};
pub use status::{Applied, Fallback, Status};
