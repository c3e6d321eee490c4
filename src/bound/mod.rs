//! What can be promised of the adaptive law, of an observer and of learning, and under which assumptions.
//!
//! | certificate | of | what it bounds |
//! |---|---|---|
//! | [`Theorem1`] | literal form, continuous time | limsup of \|e\|, as the paper has it |
//! | [`Tightest`] | literal form, continuous time | the same with the best choice of its free constants |
//! | [`Rms`] | literal form, continuous time | root mean square of e |
//! | [`PeakContinuous`] | literal form, continuous time, boxes | limsup of \|e\| |
//! | [`PeakSampled`] | lag form, sampled, boxes | \|e\| for all time: the box theorem |
//! | [`PeakRounded`] | lag form, sampled, boxes, every rounding of the shipped step | \|e\| for all time |
//! | [`RmsSampled`] | lag form, sampled, boxes | root mean square of e |
//! | [`PerStep`] | lag form, sampled, boxes | V from step to step |
//!
//! [`ObserverStability`] says something else, of a PI with a
//! [`DisturbanceObserver`](crate::control::DisturbanceObserver): that it is stable with every plant
//! of a range. [`LearningConvergence`] says of a PI with [`Learning`](crate::control::Learning) that
//! it converges, with every plant of a range.
//!
//! Each of the table is made from an [`Adaptive`](crate::control::Adaptive) law and a [`Plant`]: what is
//! known of it. What the two types can check is checked; what is left for the user to
//! check is in [`Certificate::assumptions`], and in full in each type's documentation.
//!
//! **Theorem 1 is right and says nothing.** With Table 2, alpha = 0.5 and Delta = 7 N·m its
//! bound is 1138 N·m, for a measured error of 0.3 N·m RMS. The others say something.
//!
//! # Where the paper is corrected
//! - (35)-(38) hold as limits superior, or for all time where V starts below
//!   phi/theta; and `|e| <= sqrt(1 + lambda²)·delta` already, below `(1 + lambda)·delta`.
//! - Delta = 7 N·m is kappa_eta, not the bound of `D_h = kappa_eta·eta + d + T0`: with
//!   `|eta| <= 1` that is `kappa_eta + |T0| + |d|`, 7.056 N·m for the first set without d.
//! - 0.2785 is W(1/e) = 0.27846, of `tanh`; the clamped sign has 1/4.
//! - Remark 1 (less leakage, less error) is false for delta, which grows without bound as
//!   the leakage goes to zero; it is true of the RMS certificate.
//! - "control laws (26), (30)" are (19), (23).

mod certificate;
mod dyadic;
mod halving;
mod learning;
mod observer;
mod peak;
mod per_step;
mod plant;
mod plants;
mod rms;
mod rms_sampled;
mod rounded;
mod sampled;
mod span;
mod theorem_1;
mod tightest;
mod truth;
mod zeros;

pub use certificate::{Certificate, Kind};
pub use dyadic::{Dyadic, Enclosure};
pub use learning::LearningConvergence;
pub use observer::ObserverStability;
pub use peak::PeakContinuous;
pub use per_step::PerStep;
pub use plant::{Interval, Known, Plant};
pub use plants::PlantRange;
pub use rms::Rms;
pub use rms_sampled::RmsSampled;
pub use rounded::{Inequality, Named, PeakRounded, Roundings};
pub use sampled::PeakSampled;
pub use theorem_1::Theorem1;
pub use tightest::Tightest;
