//! Every bad record gets one clear line, and no bytes at all make the reader panic.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod bare;
#[allow(dead_code)]
#[path = "../shared/rows.rs"]
mod fine;
mod forms;
mod json;
mod lines;
mod options;
mod panics;

mod segments;
mod signals;
mod sparse;
mod units;

use fine::*;
