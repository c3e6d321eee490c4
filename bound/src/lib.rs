//! Error bounds and stability certificates for the controllers, with their assumptions.
//!
//! | certificate | law and time | what is bounded |
//! |---|---|---|
//! | [`Theorem1`] | as published, continuous time | limsup of \|e\|, as in Nguyen et al. (2018) |
//! | [`Tightest`] | as published, continuous time | limsup of \|e\|, with the best choice of the free constants |
//! | [`Rms`] | as published, continuous time | root mean square of e |
//! | [`PeakContinuous`] | as published, continuous time, bounded estimates | limsup of \|e\| |
//! | [`PeakSampled`] | first order, sampled, bounded estimates | \|e\| for all time (the box theorem) |
//! | [`PeakRounded`] | first order, sampled, bounded estimates, every rounding error of the shipped step | \|e\| for all time |
//! | [`RmsSampled`] | first order, sampled, bounded estimates | root mean square of e |
//! | [`PerStep`] | first order, sampled, bounded estimates | V from step to step |
//!
//! Two further types certify a P or PI controller for every plant in a range:
//! - [`ObserverStability`] certifies that the controller with a
//!   [`DisturbanceObserver`](bowden::control::DisturbanceObserver) is stable.
//! - [`IterativeLearningConvergence`] certifies that the controller with
//!   [`IterativeLearning`](bowden::control::IterativeLearning) converges.
//!
//! Each certificate in the table is constructed from an [`Adaptive`](bowden::control::Adaptive) law
//! and a [`Plant`], which contains the known ranges of the plant. The constructors check every
//! assumption that these two determine. [`Certificate::assumptions`] lists the assumptions that the
//! user must check. The documentation of each type lists all assumptions.
//!
//! **The bound of Theorem 1 is correct but vacuous.** With the gains of Table 2, alpha = 0.5 and
//! Delta = 7 N·m, the bound is 1138 N·m. The measured error is 0.3 N·m rms.
//!
//! # Corrections to the paper
//! - (35)-(38) hold only as limits superior, or for all time if V is initially below phi/theta. The
//!   bound can be reduced from `(1 + lambda)·delta` to `|e| <= sqrt(1 + lambda²)·delta`.
//! - Delta = 7 N·m is kappa_eta, not the bound on `D_h = kappa_eta·eta + d + T0`. With
//!   `|eta| <= 1` the bound is `kappa_eta + |T0| + |d|`: 7.056 N·m for the first parameter set
//!   without d.
//! - The constant 0.2785 applies to `tanh` and is W(1/e) = 0.27846, where W is the Lambert
//!   function. For the clamped sign function, the constant is 1/4.
//! - Remark 1 (less leakage gives a smaller error) is true for the RMS certificate, but false for
//!   delta, which grows without bound as the leakage tends to zero.
//! - The text refers to "control laws (26), (30)", which should be (19) and (23).

#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "std")]
extern crate std;

mod certificate;
mod checked;
mod dyadic;
mod halving;
mod interval;
mod learning;
mod mean;
mod observer;
mod peak;
mod per_step;
mod plant;
mod plants;
mod rms;
mod rms_sampled;
mod rounded;
mod sampled;
mod theorem_1;
mod tightest;
mod truth;
mod zeros;

pub use certificate::{Certificate, Kind};
pub use dyadic::{Dyadic, Enclosure};
pub use interval::Interval;
pub use learning::IterativeLearningConvergence;
pub use observer::ObserverStability;
pub use peak::PeakContinuous;
pub use per_step::PerStep;
pub use plant::{Known, Plant};
pub use plants::PlantRange;
pub use rms::Rms;
pub use rms_sampled::RmsSampled;
pub use rounded::{Inequality, Named, PeakRounded, Roundings};
pub use sampled::PeakSampled;
pub use theorem_1::Theorem1;
pub use tightest::Tightest;
