//! A torque loop to copy into firmware, run with bad samples and a dead sensor.
//!
//! `torque_loop.rs` is the part to copy; `scenario.rs` is the simulated joint. `cargo run --release
//! --example torque_loop` runs both on the host; `firmware/examples` runs the same two files as an
//! RTIC task on an emulated Cortex-M4F, and logs the same numbers through defmt: `cd firmware &&
//! cargo xtask --torque-loop`.

mod scenario;
mod torque_loop;

use scenario::{Scenario, RATE};
use torque_loop::StartError;

/// The file written by `bowden identify --invertible --model-out model.postcard`.
const MODEL: &[u8] = include_bytes!("../data/demo.postcard");

fn main() -> Result<(), StartError> {
    let mut scenario = Scenario::try_new(MODEL)?;
    let (mut ticks, mut unfed) = (0, 0);
    while let Some(told) = scenario.tick() {
        ticks += 1;
        unfed += u32::from(!told.action.feed);
        if let Some(line) = told.line {
            println!("{line}");
        }
    }
    println!("{ticks} ticks at {RATE} Hz, {unfed} without feeding the watchdog");
    Ok(())
}
