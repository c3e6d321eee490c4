//! Signal conditioning that rejects bad samples.
//!
//! | item | purpose |
//! |---|---|
//! | [`clamp`] | clamp to a range |
//! | [`Plausible`] | reject finite but implausible numbers |
//! | [`Play`] | play operator |
//! | [`LowPass`], [`Biquad`] | first-order and second-order filters, notch |
//! | [`Derivative`] | filtered derivative |
//! | [`Ramp`] | reference with limited rate |
//! | [`Rates`] | [`Motion`](crate::effect::Motion) (position, velocity, acceleration) from the positions of a sensor |
//! | [`EdgeVelocity`] | velocity from an encoder with few counts per sample |
//!
//! Configuration and state are separate types. Only constructors return errors, and no function
//! panics. [`constant!`](crate::constant) makes a `static` of any configuration.

mod biquad;
mod clamp;
mod compensated;
mod derivative;
mod edges;
mod gap;
mod low_pass;
mod plausible;
mod play;
mod ramp;
mod rates;

pub use biquad::{Biquad, BiquadState};
pub use clamp::clamp;
pub(crate) use clamp::{confined, greatest, least, wrapped};
pub(crate) use compensated::{two_sum, Compensated};
pub use derivative::{Derivative, DerivativeState};
pub use edges::{EdgeVelocity, EdgeVelocityOutput, EdgeVelocityState};
pub(crate) use gap::gap_after;
pub use low_pass::{LowPass, LowPassState};
pub use plausible::{Implausible, Plausible, PlausibleOutput, PlausibleState};
pub use play::{Play, PlayState};
pub use ramp::{Ramp, RampState};
pub use rates::{RateStatus, Rates, RatesOutput, RatesState};
