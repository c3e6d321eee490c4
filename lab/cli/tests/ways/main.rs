//! New ways in and out from outside: limited rounds, traces, models on the next record.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod program;
mod refused;
mod rig;
#[allow(dead_code)]
#[path = "../shell/mod.rs"]
mod shell;
