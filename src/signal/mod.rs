//! Signal conditioning that a bad sample cannot poison.
//!
//! One concept a file: [`clamp`], the bad-sample [`Guard`], the play operator
//! [`Play`] and the filtered [`Derivative`]. Configuration and state are apart;
//! after construction nothing returns an error and nothing panics.

mod clamp;
mod derivative;
mod guard;
mod play;

pub use clamp::clamp;
pub use derivative::{Derivative, DerivativeState};
pub use guard::{Guard, GuardState};
pub use play::{Play, PlayState};
