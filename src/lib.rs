//! Bouc-Wen models of cable transmissions, and torque controllers, for firmware.
//!
//! A pair of Bowden cables transmits a torque with hysteretic friction: the output torque depends
//! on the present input and on earlier inputs. The crate models this hysteresis, in torque or in
//! displacement, with the **Bouc-Wen** equation. You can add **effects** from a catalogue, such as
//! viscous friction and backlash, to this model.
//!
//! The crate is `no_std`, allocates no memory, contains no unsafe code, and is generic over `f32`
//! and `f64`. Its run-time dependencies are `num-traits` and `libm`.
//!
//! ```
//! use bowden::control::{Fallback, Limits, Pid, PidInput, PidSettings, PidState};
//! use bowden::effect::Motion;
//! use bowden::hysteresis::BoucWen;
//! use bowden::model::{Model, ModelState, Sample};
//! use bowden::transmission::Transmission;
//!
//! // The cable: rho [1/(N·m)], sigma and n, then B, kappa_eta [N·m] and T0 [N·m].
//! let shape = BoucWen::try_new(0.382_f32, 0.54, 1.02)?;
//! let cable = Transmission::torque(0.952, 2.29, 0.05, shape)?;
//! let model = Model::<f32, 1>::try_new(Some(cable), &[])?;
//!
//! // The PI: k_p, k_i, limits [N·m], longest dt [s], safe command after 20 bad samples [N·m].
//! let limits = Limits::try_new(-20.0_f32, 60.0)?;
//! let pi = Pid::try_new(PidSettings::new(0.5, 25.0, limits, 0.005, Fallback::try_new(20, 0.0)?))?;
//!
//! let (mut cable_state, mut pi_state) = (ModelState::new(), PidState::new());
//! let mut tau_o = 0.0;
//! for _ in 0..1000 {
//!     let command = pi.step(&mut pi_state, &PidInput::new(0.001, 10.0, tau_o)).command;
//!     let input = Motion { position: command, velocity: 0.0, acceleration: 0.0 };
//!     let sample = Sample { dt: 0.001, input, load: command, channels: &[] };
//!     tau_o = model.step(&mut cable_state, &sample);
//! }
//! assert!((tau_o - 10.0).abs() < 0.1); // after 1 s the output is at the reference [N·m]
//! # Ok::<(), bowden::Error>(())
//! ```
//!
//! # The book
//! 1. [The idea](book::idea)
//! 2. [The equations](book::equations)
//! 3. [Reading a verdict](book::verdict) of `bowden identify`
//! 4. [Choosing a controller](book::controller)
//! 5. [From bench to motor](book::motor)
//!
//! # Modules
//! | module | contents | equations |
//! |---|---|---|
//! | [`hysteresis`] | the Bouc-Wen state equation, bounded for any step | (2), (7) |
//! | [`transmission`] | displacement to force, torque to torque, and the inverse | (1), (5), (6) |
//! | [`effect`] | viscous and Coulomb friction, backlash, creep, …: one regressor each | |
//! | [`model`] | a transmission plus effects: the predicted output | |
//! | [`control`] | torque controllers that reject bad samples | (14)-(26) |
//! | [`signal`] | filters, velocity and acceleration, play operator, plausibility checks | |
//!
//! The crate `bowden-bound` provides error bounds and stability certificates for the controllers,
//! equations (27) to (38).
//!
//! # Conventions
//! - Configuration and state are separate types.
//! - `try_new` checks every parameter. After construction, no function panics.
//! - A bad sample leaves the state unchanged, except for fault counters and elapsed times. A sample
//!   is bad if it contains a NaN, an infinity, or a `dt` that is not positive.
//! - Equation numbers refer to Nguyen et al. (2018); see [the equations](book::equations).
//!
//! # Features
//! All features are off by default:
//! - `serde`: every configuration is checked when it is deserialised. A [model](model::Model) can
//!   be read from the file that `bowden identify --model-out` writes.
//! - `defmt`: the public types implement `defmt::Format`, except samples that borrow channels.
//! - `std`: the crate links the standard library.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "std")]
extern crate std;

#[cfg(any(doc, doctest))]
pub mod book;
mod checked;
pub mod control;
pub mod effect;
mod error;
mod fault;
pub mod hysteresis;
#[cfg(feature = "serde")]
mod list;
pub mod model;
mod real;
pub mod signal;
pub mod transmission;

pub(crate) use checked::{checked, data};
pub use error::Error;
pub use real::Real;

/// The compile-time constructors of the configurations, which [`constant!`] calls.
#[doc(hidden)]
pub struct Constant<C>(core::marker::PhantomData<C>);

/// The proofs of this crate; see `proofs/README.md`.
#[cfg(kani)]
#[path = "../proofs/mod.rs"]
mod proofs;
#[cfg(kani)]
extern crate self as bowden;

/// The tests compile and run the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// The tests compile and run the examples of the page on drives and loops.
#[cfg(doctest)]
#[doc = include_str!("../docs/howto/drives-and-loops.md")]
struct DrivesAndLoops;
