//! What a record could not show: what would have been missed, and which motion to record next.

pub mod plan;
pub mod power;
