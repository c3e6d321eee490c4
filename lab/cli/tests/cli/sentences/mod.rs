//! The closing sentence on files that a newcomer has: the wrong cable, the wrong column, a
//! plant that integrates, a stretch that is like no other, a model that firmware spoils.
//!
//! The records are made here or by the program's own generator, and altered here; neither
//! shares code with the fit.

mod apart;
mod checked;
pub mod files;
mod held_out;
mod no_model;
mod on_a_chip;
mod rigs;
mod told;
