//! The controllers: closed forms, windup, bad samples, bumpless changes, peers.

// Clippy's allowance covers the test functions, not what they share.
#![allow(clippy::unwrap_used, clippy::panic)]

mod bad_samples;
mod bumpless;
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
#[path = "../shared/mod.rs"]
mod shared;
mod told;
mod windup;

use bowden::control::*;
use bowden::hysteresis::{BoucWen, BoucWenState};
use bowden::model::Model;
use bowden::transmission::Transmission;
use bowden::{constant, Error, Real};
use proptest::prelude::*;
use shared::*;

const DT: f64 = 1e-3;

const WINDUPS: [AntiWindup<f64>; 4] = [
    AntiWindup::None,
    AntiWindup::Clamp,
    AntiWindup::Conditional,
    AntiWindup::BackCalculation { tracking_time: 0.1 },
];

fn range(low: f64, high: f64) -> Limits<f64> {
    Limits::try_new(low, high).unwrap()
}

/// A law with these gains, unlimited but for a change.
fn pid(k_p: f64, k_i: f64, change: impl FnOnce(&mut PidSettings<f64>)) -> Pid<f64> {
    Pid::try_new(with(PidSettings::unlimited(k_p, k_i), change)).unwrap()
}

fn refused(change: impl FnOnce(&mut PidSettings<f64>)) -> Error {
    Pid::try_new(with(PidSettings::unlimited(30.0, 18.0), change)).unwrap_err()
}
