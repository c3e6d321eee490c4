//! What each fuzz target asks of the core and of the lab.
//!
//! A target is three lines in `targets/` that call `check` of the module of its name. The
//! properties are those that the harnesses prove of one step (`../proofs/properties`); here
//! they are asked of runs of many steps, found by coverage. In this folder
//! `cargo test --lib --no-default-features`
//! replays `seeds/` through every `check`, on any toolchain.

pub mod adaptive;
pub mod blocks;
pub mod compensator;
pub mod constructors;
pub mod forms;
pub mod hysteresis;
pub mod inverse;
pub mod model;
pub mod numbers;
pub mod pid;
#[allow(missing_docs, dead_code)]
#[path = "../../proofs/properties/mod.rs"]
pub mod properties;
pub mod record;
pub mod states;

#[cfg(test)]
mod replay;
