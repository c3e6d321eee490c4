//! Signal conditioning that a bad sample cannot poison.
//!
//! One concept a file: [`clamp`], the [`Compensated`] sum, the bad-sample [`Guard`],
//! [`Plausible`] for numbers that are finite and wrong, the play operator [`Play`], the
//! filtered [`Derivative`], the reference [`Ramp`] and [`Rates`], which turns the positions
//! of a sensor into the [`Motion`] that effects read. Configuration and state are apart; after
//! construction nothing returns an error and nothing panics.

mod clamp;
mod compensated;
mod derivative;
mod gap;
mod guard;
mod motion;
mod plausible;
mod play;
mod ramp;
mod rates;
#[cfg(feature = "serde")]
mod stored;

pub use clamp::clamp;
pub(crate) use clamp::confined;
pub(crate) use compensated::two_sum;
pub use compensated::Compensated;
pub use derivative::{Derivative, DerivativeState};
pub(crate) use gap::gap_after;
pub use guard::{Guard, GuardState};
pub use motion::Motion;
pub use plausible::{Implausible, Plausible, PlausibleOutput, PlausibleState};
pub use play::{Play, PlayState};
pub use ramp::{Ramp, RampState};
pub use rates::{Rates, RatesFault, RatesOutput, RatesState, RatesStatus};
