//! From the bench to the motor: an exported model as a feed-forward.
//!
//! `bowden identify --invertible --model-out examples/data/demo.rs` has written the module `demo`
//! from the program's built-in record. Here the compensator computes the command for a desired
//! torque while the pulley turns, and the model returns the torque for this command. `cargo run
//! --release --example feed_forward` prints the difference.

#[path = "data/demo.rs"]
pub mod demo;

use bowden::control::{Compensator, CompensatorInput, CompensatorState};
use bowden::effect::Motion;
use bowden::model::{ModelState, Sample};
use bowden::signal::{Rates, RatesState};
use bowden::Error;

/// Sample time of the loop \[s\].
const DT: f32 = 1e-3;

/// Largest difference between the desired torque and the model's torque, and the largest command
/// \[N·m\].
pub fn run(seconds: f32) -> Result<(f32, f32), Error> {
    let model = demo::model()?;
    let compensator = Compensator::try_new(&model)?.with_ranges(&demo::ranges())?;
    let rates = Rates::try_new(demo::RATES_TIME_CONSTANT)?;
    let (mut past, mut inverse, mut plant) = (
        RatesState::new(),
        CompensatorState::new(),
        ModelState::new(),
    );
    let (mut worst, mut most) = (0.0_f32, 0.0_f32);
    for k in 0..(seconds / DT) as u16 {
        let t = f32::from(k) * DT;
        // The desired torque of a controller, and the position from the pulley's encoder.
        let desired = 5.0 * (4.0 * t).sin() + 1.5 * (11.0 * t).sin();
        let phi_p = 0.4 * (2.5 * t).sin();
        let pulley = rates.step(&mut past, phi_p, DT).motion;
        let channels = [pulley, Motion::default()];
        let at = CompensatorInput {
            channels: &channels,
            ..CompensatorInput::new(DT, desired)
        };
        let command = compensator.step(&mut inverse, &at).command;
        let input = Motion {
            position: command,
            ..Motion::default()
        };
        let sample = Sample {
            dt: DT,
            input,
            load: command,
            channels: &channels,
        };
        let torque = model.step(&mut plant, &sample);
        worst = worst.max((torque - desired).abs());
        most = most.max(command.abs());
    }
    Ok((worst, most))
}

fn main() -> Result<(), Error> {
    let (worst, most) = run(20.0)?;
    println!("wanted and given differ by at most {worst:e} N·m, with commands up to {most} N·m");
    Ok(())
}
