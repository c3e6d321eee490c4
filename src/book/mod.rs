//! The crate as a short book: from the idea to a motor.
//!
//! 1. [The idea](idea): hysteresis in a cable, and its effect on a torque controller.
//! 2. [The equations](equations): the model, its conventions, and corrections to Nguyen et al.
//!    (2018).
//! 3. [Reading a verdict](verdict): the results of `bowden identify`, and the next step after
//!    each.
//! 4. [Choosing a controller](controller): controllers, gains, and cost in instructions.
//! 5. [From bench to motor](motor): the model in firmware, step by step, and the tests on the
//!    board.
//!
//! The tests compile and run every program on these pages.

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
