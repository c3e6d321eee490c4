//! Controllers of the core on the rig: what is promised of them, and anti-windup.
#![allow(clippy::unwrap_used)]

mod anti_windup;

/// Nominal step \[s\].
const DT: f64 = 1e-3;
