//! A whole loop: the PI on the simulated rig, with the signal's bad samples.

use crate::{pid, Case, Output, Sample};
use bowden::Error;
use bowden_rig::{Rig, RigConfig, RigState};
use core::hint::black_box;

/// The PI on the reference rig; the value is the distal torque as it is.
///
/// Its cost is the plant's, which no firmware has: it is here for the numbers.
#[derive(Debug)]
pub struct ClosedLoop {
    controller: pid::Pi,
    rig: Rig<f32, 0>,
    state: RigState<f32, 0>,
}

impl Case for ClosedLoop {
    // Forty sub-steps of the plant a sample: 0.1 s of it says enough.
    const SAMPLES: usize = 100;
    const STACK: usize = 4096;

    fn try_new() -> Result<Self, Error> {
        let rig = Rig::try_new(black_box(RigConfig::reference()), &[])?;
        Ok(Self {
            controller: pid::Pi::try_new()?,
            rig,
            state: rig.start(7),
        })
    }

    fn step(&mut self, at: &Sample) -> Output {
        let now = self.state.sample();
        // A bad sample of the signal is one of the rig's sensor.
        let measured = if at.measured.is_finite() {
            now.measured
        } else {
            at.measured
        };
        let command = self.controller.step(&Sample { measured, ..*at });
        let after = self.rig.step(&mut self.state, command.value, 0.001);
        Output {
            value: after.tau_o,
            status: command.status,
        }
    }
}
