//! One property, one function: asked by the harnesses, by proptest and by fuzzing.
//!
//! They use the public interface alone, so that a test or a fuzz target can include this
//! folder with `#[path]`. Each says in its name what must be true.

pub mod control;
pub mod effect;
pub mod signal;
pub mod tracking;
