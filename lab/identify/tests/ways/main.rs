//! New ways in and out: limited rounds, traces, models on the next record, models by round.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod check;
mod figures;
mod measured;
mod mechanisms;
mod rig;
mod rounds;
#[allow(dead_code)]
#[path = "../shared/mod.rs"]
mod shared;
mod trace;
