//! `bowden certify GAINS.toml`: what is proved of one's own gains, and who checks it.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod checked;
mod foreign;
mod forms;
#[allow(dead_code)]
#[path = "../shell/mod.rs"]
mod shell;

use shell::example;
