//! Hysteretic cable transmissions: models fitted on the bench that run in firmware.
//!
//! A pair of Bowden cables transmits a torque with friction that remembers: the output
//! depends on where the input came from. This crate models that with a **Bouc-Wen**
//! hysteresis whose input is a torque or a displacement, and with a catalogue of the
//! **effects** that real rigs have beside it. `no_std`, no allocation, no unsafe code,
//! generic over `f32` and `f64`; run-time dependencies `num-traits` and `libm`.
//!
//! A newcomer may read [the book](book) first: idea, equations, verdicts, controllers, and the
//! way from the bench to the motor.
//!
//! | module | what it is | equations |
//! |---|---|---|
//! | [`hysteresis`] | the Bouc-Wen state, bounded for any step | (2), (7) |
//! | [`transmission`] | displacement to force, torque to torque, and the inverse | (1), (5), (6) |
//! | [`effect`] | viscous, Coulomb, Stribeck, backlash, …: one regressor each | |
//! | [`model`] | a transmission plus effects: the predicted output | |
//! | [`control`] | torque controllers that a bad sample cannot poison | (14)-(26) |
//! | [`bound`] | what can be promised of the adaptive law | (27)-(38) |
//! | [`signal`] | clamp, guard, play operator, rates of a position | |
//!
//! Conventions: config and state are two types; everything is checked once, in
//! `try_new`, and nothing panics after that; a bad sample (NaN, an infinity, a `dt` that
//! is not positive) leaves the state as it was. Equation numbers are those of the paper
//! on torque control of cable-conduit mechanisms that the project started from.
//!
//! # Features
//! All off: `serde` (configs deserialise through their checks; a [model](model::Model) is
//! the file that `bowden close --model-out` writes), `defmt`, `std`.
//!
//! ```
//! use bowden::hysteresis::{BoucWen, Shape};
//! use bowden::transmission::Transmission;
//!
//! // The paper's first identified set: rho, sigma, n, then B, kappa_eta, T0.
//! let shape = Shape::try_new(0.09582_f32, 98.36, 3.871)?;
//! let cable = Transmission::torque(0.9978, 7.004, 0.05174, shape)?;
//! let mut state = BoucWen::new();
//! cable.step(&mut state, 0.0);
//! let up = cable.step(&mut state, 16.0);
//! cable.step(&mut state, 20.0);
//! let down = cable.step(&mut state, 16.0);
//! assert!(down - up > 2.0); // the same input, another output [N·m]
//! # Ok::<(), bowden::Error>(())
//! ```
#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "std")]
extern crate std;

#[cfg(any(doc, doctest))]
pub mod book;
pub mod bound;
pub mod control;
pub mod effect;
mod error;
pub mod hysteresis;
pub mod model;
mod real;
pub mod signal;
pub mod transmission;

pub use error::Error;
pub use real::Real;

/// What is proved of this crate; `proofs/README.md` says how to run it.
#[cfg(kani)]
#[path = "../proofs/mod.rs"]
mod proofs;
#[cfg(kani)]
extern crate self as bowden;

/// The README's example is compiled and run with the tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
