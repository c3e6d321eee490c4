//! Torque controllers that reject bad samples.
//!
//! Configuration and state are separate types. `try_new` checks a configuration once; the
//! configuration never changes afterwards and can be stored in flash. A state is `Copy` and can be
//! saved and restored. Call `step` once per sample with the time since the last call; this time may
//! vary.
//!
//! **Bad samples.** A sample is bad if
//! - a measurement, the reference or `dt` is NaN or infinite, or
//! - `dt` is not positive or exceeds the longest `dt` of the configuration.
//!
//! A bad sample leaves the state unchanged and holds the last good command; the [`Status`]
//! names the bad input. After too many bad samples the [`Fallback`] applies its safe command
//! and latches it until [`acknowledge`](Controller::acknowledge). The command is finite and
//! within the [`Limits`] for any state. Use [`signal::Plausible`](crate::signal::Plausible) in
//! front of a controller to reject finite but implausible numbers.
//!
//! **In flash.** [`constant!`](crate::constant) makes a checked `static` or `const` of every
//! configuration, for `f32` and `f64`. Only a [`Compensator`] is built at run time, because it
//! holds a [`Model`](crate::model::Model).
//!
//! | controller | description | equations |
//! |---|---|---|
//! | [`Pid`] | PI, PID, PIV | (14)-(16) |
//! | [`Adaptive`] | robust adaptive law with any number of regressors | (17)-(26) |
//! | [`Compensator`] | inverse of the identified model as a feed-forward | (5)-(7) |
//! | [`DisturbanceObserver`] | estimate of friction and load, added through a feed-forward | |
//! | [`IterativeLearning`] | feed-forward learned from the error of earlier cycles | |
//! | [`Relay`] | relay experiment that measures ultimate gain and period, for PI gains | |
//!
//! [`Controller`] is the common interface of the first two rows. [`law`] contains the equations of the
//! adaptive law, one function each.

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
