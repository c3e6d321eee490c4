//! From the fitted model to the motor: what is written is what runs, and says what it is.
//!
//! * [`clockwork`]: what belongs to the record is not handed over, and the rest is refitted.
//! * [`invertible`]: the fit within what a compensator can invert.
//! * [`causal`]: the error with the rates of firmware.
//! * [`rust_file`]: `model.rs` compiles for every effect and says what its numbers mean.
//! * [`c_file`]: the model as a C header.
//! * [`postcard_file`]: the bytes that firmware reads, and their checksum.
//! * [`vector`]: the test vector beside each model.
//! * [`definition`]: a channel that is the sum of two says so.
//! * [`examples`]: the models in the repository, and the examples that run them.

mod c_file;
mod causal;
mod clockwork;
mod definition;
mod examples;
mod invertible;
mod postcard_file;
mod rig;
mod rust_file;
mod vector;
