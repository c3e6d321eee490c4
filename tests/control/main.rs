//! The controllers: closed forms, windup, bad samples, bumpless changes, peers.

// Clippy's allowance covers the test functions, not what they share.
#![allow(clippy::unwrap_used)]

mod bad_samples;
mod bumpless;
mod cascade;
mod compensator;
mod drive;
mod learning;
mod liveness;
mod observer;
mod options;
mod peers;
mod pid;
mod properties;
mod relay;
mod returns;
mod told;
mod windup;
