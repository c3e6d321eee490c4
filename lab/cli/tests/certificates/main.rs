//! `bowden certify GAINS.toml`: what is proved of one's own gains, and who checks it.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod checked;
mod foreign;
mod forms;
#[allow(dead_code)]
#[path = "../shell/mod.rs"]
mod shell;

/// A file of `examples/data`.
fn example(name: &str) -> String {
    format!("{}/../../examples/data/{name}", env!("CARGO_MANIFEST_DIR"))
}
