//! The crate as a short book: from the idea to a motor.
//!
//! 1. [The idea](idea): a cable has a memory, and what that does to a controller.
//! 2. [The equations](equations): the model, its conventions, and where the paper is corrected.
//! 3. [Reading a verdict](verdict): what the bench says of a record, and what to do next.
//! 4. [Choosing a controller](controller): which one, with which gains, at what price.
//! 5. [From bench to motor](motor): the model in firmware, step by step, and what to test.
//!
//! Every program on these pages is compiled and run with the tests.

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
