//! What a record may be written as: each form gives the same answer, or one line.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod forms;
mod record;
mod refused;
#[allow(dead_code)]
#[path = "../shell/mod.rs"]
mod shell;
