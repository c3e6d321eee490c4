//! Identification as a whole: what is known to be in a record is found again.
//!
//! The records come from [`bowden_synth`], which shares no code with the fit: an
//! error in a common regressor or integrator cannot cancel out of sight.
//!
//! * [`headline`]: what the project promises, on one record each, in seconds.
//! * [`recovery`]: planted Bouc-Wen parameters come back, and so do their intervals.
//! * [`planted`]: an undeclared effect is found, named and taken away.
//! * [`nulls`]: where the search finds no term, nothing is added.
//! * [`beside`]: effects that are found only beside each other, and names that imitated one leave at once.
//! * [`delivered`]: the final model has seen all but what is held out, and is nearer to the truth.
//! * [`unneeded`]: baseline parts that the record does not need are told.
//! * [`series`]: a play is found with its width, in series too, and where the hysteresis imitates it.
//! * [`hardening`]: the benchmark of Noël and Schoukens comes back.
//! * [`power_law`]: a power law of the velocity is told from viscous and Coulomb friction.
//! * [`stretch`]: the stretch of a cable is one name beside the two angles, a delay at every cut-off.
//! * [`torque_alone`]: without an angle in the record, viscous friction follows the torque's rate.
//! * [`turned`]: a sensor or a scale that was mounted the other way round changes signs, no names.
//! * [`widths`]: an interval is as wide as the noise makes it, whatever its seed.
//! * [`exported`]: what was fitted is what runs in firmware.
//! * [`foresight`]: what a record could not show, and which record would.
//! * [`search`]: the algebra of the search against direct computation.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod beside;
mod delivered;
mod exported;
mod foresight;
mod hardening;
mod headline;
mod nulls;
mod planted;
mod power_law;
mod recovery;
mod rig;
mod search;
mod series;
mod stretch;
mod torque_alone;
mod turned;
mod unneeded;
mod widths;
