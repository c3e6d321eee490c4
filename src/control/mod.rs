//! Torque controllers that a bad sample cannot poison.
//!
//! Configuration and state are apart: a controller is checked once, in `try_new`, may
//! live in flash and never changes; its state is `Copy` and can be saved and restored.
//! One call a sample, with the time since the last one, which may vary.
//!
//! **Bad samples.** A NaN or an infinity in a measurement, in the reference or in `dt`, or
//! a `dt` that is not positive or longer than the longest that was stated, leaves the state
//! as it was and holds the last good command; the [`Status`] says which input it was. After
//! too many the [`Fallback`]'s safe command goes out **and stays out** until
//! [`acknowledge`](Controller::acknowledge). The command is finite and within the
//! [`Limits`] in every case, whatever the state is. Finite numbers that cannot be true are
//! for [`signal::Plausible`](crate::signal::Plausible), in front of a controller.
//!
//! **In flash.** Every configuration has a `const` constructor for `f32` and `f64`, which
//! the compiler checks: see [`constant!`](crate::constant).
//!
//! | controller | what it is | equations |
//! |---|---|---|
//! | [`Pid`] | PI, PID, PIV | (14)-(16) |
//! | [`Adaptive`] | the robust adaptive law over any number of regressors | (17)-(26) |
//! | [`Compensator`] | the identified model turned round, as a feed-forward | (5)-(7) |
//! | [`DisturbanceObserver`] | what friction and load take, given back through a feed-forward | |
//! | [`Learning`] | what a task that repeats has lacked so far, through a feed-forward | |
//!
//! [`Controller`] is what the first two have in common: a loop can be written once.

mod adaptive;
mod compensator;
mod controller;
mod learning;
pub(crate) mod limits;
mod observer;
pub(crate) mod pid;
pub(crate) mod status;

pub use adaptive::{
    Adaptive, AdaptiveInput, AdaptiveOutput, AdaptiveSettings, AdaptiveState, AdaptiveTerms,
    Disturbance, ErrorState, Estimator, Form, LagRecursion, Leakage, Missing, SmoothSign,
};
pub use compensator::{
    BenchRange, Changed, Compensator, CompensatorInput, CompensatorOutput, CompensatorState,
    Lowered,
};
pub use controller::{Controller, LoopSample, Output};
pub use learning::{Learning, LearningInput, LearningOutput, LearningState};
pub use limits::Limits;
pub use observer::{
    DisturbanceObserver, NominalPlant, ObserverInput, ObserverOutput, ObserverState,
};
pub use pid::{AntiWindup, Damping, Pid, PidInput, PidOutput, PidSettings, PidState, PidTerms};
pub use status::{Fallback, Fault, Status};
