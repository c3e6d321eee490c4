//! Signal conditioning that a bad sample cannot poison.
//!
//! One concept a file: [`clamp`], the bad-sample [`Guard`], the play operator
//! [`Play`], the filtered [`Derivative`] and [`Rates`], which turns the positions of a
//! sensor into the [`Motion`] that effects read. Configuration and state are apart; after
//! construction nothing returns an error and nothing panics.

mod clamp;
mod derivative;
mod guard;
mod motion;
mod play;
mod rates;

pub use clamp::clamp;
pub use derivative::{Derivative, DerivativeState};
pub use guard::{Guard, GuardState};
pub use motion::Motion;
pub use play::{Play, PlayState};
pub use rates::{Rates, RatesFault, RatesOutput, RatesState, RatesStatus};
