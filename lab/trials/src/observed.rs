//! A disturbance observer beside a law, with its nominal plant turned round along the reference.

use super::lineup::{latency, RATE};
use super::setup::ObserverGains;
use bowden::control::{DisturbanceObserver, NominalPlant, ObserverInput, ObserverState};
use bowden::effect::Motion;
use bowden_rig::RigConfig;
use std::f64::consts::TAU;

/// Longest step that counts \[s\].
const LONGEST_DT: f64 = 0.1;

/// An observer, and how far ahead its feed-forward reads the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observed {
    /// The observer, with the nominal plant.
    pub observer: DisturbanceObserver<f64>,
    /// How long a command takes to show in what is measured \[s\].
    pub lead: f64,
}

impl Observed {
    /// The observer of a setup on its rig.
    ///
    /// # Errors
    /// What the core refuses of the numbers.
    pub fn new(gains: &ObserverGains, rig: &RigConfig<f64>) -> Result<Self, bowden::Error> {
        let own = nominal(rig)?;
        let plant = NominalPlant::try_new(
            gains.gain.unwrap_or(own.gain()),
            gains.natural_frequency.unwrap_or(own.natural_frequency()),
            gains.damping_ratio.unwrap_or(own.damping_ratio()),
        )?;
        let time_constant = (TAU * gains.frequency).recip();
        // The command is held over a sample, and acts half of one later in the mean.
        let lead = latency(rig, RATE) + 0.5 / RATE + rig.sensor_lag;
        let observer = DisturbanceObserver::try_new(plant, time_constant, gains.limit, LONGEST_DT)?
            .with_latency(lead)?;
        Ok(Self { observer, lead })
    }
}

/// What the rig's data sheet says of command and torque, without friction.
///
/// The torque is that of the joint's spring, damping and inertia N(s)·phi_d; the motor works
/// through the cable against the same and against its own, so that
/// `P = gain/(1 + (th2·s² + th1·s)/N(s))`. For N its stiffness is taken, with the cable's.
pub(crate) fn nominal(rig: &RigConfig<f64>) -> Result<NominalPlant<f64>, bowden::Error> {
    let stiffness = (rig.cable_stiffness.recip() + rig.load_stiffness.recip()).recip();
    NominalPlant::of_mechanics(
        rig.drive_gain * rig.b,
        rig.motor_inertia,
        rig.motor_damping,
        stiffness,
    )
}

/// The same while it runs.
pub(crate) struct Observing<'a> {
    observed: &'a Observed,
    state: ObserverState<f64>,
}

impl<'a> Observing<'a> {
    pub(crate) fn new(observed: &'a Observed) -> Self {
        let state = ObserverState::new();
        Self { observed, state }
    }

    /// What is added to the next command \[units\]; `sent` is what went out at the last sample.
    pub(crate) fn step(
        &mut self,
        dt: f64,
        sent: f64,
        measured: f64,
        ahead: impl Fn(f64) -> Motion<f64>,
    ) -> f64 {
        let Observed { observer, lead } = self.observed;
        let at = ObserverInput { dt, sent, measured };
        let seen = observer.step(&mut self.state, &at);
        seen.estimate + observer.plant().feed_forward(&ahead(*lead))
    }
}
