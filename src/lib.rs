//! Hysteretic cable transmissions: models that fit on the bench and run in firmware.
#![no_std]
#![forbid(unsafe_code)]

pub mod effect;
mod error;
pub mod hysteresis;
pub mod model;
mod real;
pub mod signal;
pub mod transmission;

pub use error::Error;
pub use real::Real;
