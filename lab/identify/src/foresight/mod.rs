//! What a record could not show: the effects that it would have missed, and the motion to record
//! next.

pub mod plan;
pub mod power;
