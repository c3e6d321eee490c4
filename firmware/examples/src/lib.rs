//! The torque loop of `examples/torque_loop`, the same two files for the chip and its host.
#![no_std]
#![forbid(unsafe_code)]

#[path = "../../../examples/torque_loop/scenario.rs"]
pub mod scenario;
#[path = "../../../examples/torque_loop/torque_loop.rs"]
pub mod torque_loop;

/// What `bowden identify --invertible --model-out model.postcard` has written.
pub const MODEL: &[u8] = include_bytes!("../../../examples/data/demo.postcard");
