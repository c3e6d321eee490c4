//! Harnesses: what is proved of the shipped functions, one step at a time.
//!
//! A harness makes an arbitrary valid state and input, takes one shipped step and asks a
//! property of [`properties`], which proptest and the fuzz targets ask as well. Every
//! state that a run can reach is valid to start with and a step keeps it so: an inductive
//! step stands for a run of any length. `proofs/README.md` has the table.
//!
//! Harnesses that need private states sit in `adaptive/` and `hysteresis.rs`, which the
//! modules of those states include.

// A stub is named in an attribute only, which the compiler does not count as a use.
#![allow(dead_code, unused_imports)]

pub(crate) mod any;
mod construction;
mod contracts;
pub(crate) mod limited;
pub(crate) mod pid;
pub(crate) mod properties;
mod signal;
pub(crate) mod stubs;
mod tracking_box;
