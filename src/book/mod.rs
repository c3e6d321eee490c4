//! A short book about this crate, from the idea to the motor.
//!
//! 1. [The idea](idea)
//! 2. [The equations](equations)
//! 3. [Reading a verdict](verdict)
//! 4. [Choosing a controller](controller)
//! 5. [From bench to motor](motor)
//!
//! `cargo test` compiles and runs every Rust program on these pages.

#[doc = include_str!("idea.md")]
pub mod idea {}

#[doc = include_str!("equations.md")]
pub mod equations {}

#[doc = include_str!("verdict.md")]
pub mod verdict {}

#[doc = include_str!("controller.md")]
pub mod controller {}

#[doc = include_str!("motor.md")]
pub mod motor {}
