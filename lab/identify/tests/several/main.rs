//! Several records of one rig, fitted together.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod alone;
mod grids;
mod joint;
mod many;
mod rig;
#[allow(dead_code)]
#[path = "../shared/mod.rs"]
mod shared;
