//! The controllers: closed forms, windup, bad samples, bumpless changes, peers.

// Clippy's allowance covers the test functions, not what they share.
#![allow(clippy::unwrap_used)]

mod bad_samples;
mod bumpless;
mod compensator;
mod learning;
mod observer;
mod peers;
mod pid;
mod properties;
mod windup;
