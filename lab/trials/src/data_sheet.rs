//! The nominal parameters of a rig's drive, and the observer that is built from them.

use super::setup::ObserverGains;
use bowden::control::{DisturbanceObserver, NominalPlant};
use bowden::Error;
use bowden_rig::RigConfig;
use std::f64::consts::TAU;

/// Time from a command to its torque \[s\].
#[must_use]
pub fn latency(rig: &RigConfig<f64>, rate: f64) -> f64 {
    f64::from(rig.delay) / rate + rig.drive_lag
}

/// Time from a command to its effect in the measured torque \[s\]. The command is held over a
/// sample, and therefore acts half a sample later on average.
#[must_use]
pub fn shown(rig: &RigConfig<f64>, rate: f64) -> f64 {
    latency(rig, rate) + 0.5 / rate + rig.sensor_lag
}

/// The plant from command to torque, without friction.
///
/// The torque is `N(s)·phi_d`, from the joint's spring, damping and inertia. The motor acts through
/// the cable against this torque, and against its own inertia and damping. Therefore
/// `P = gain/(1 + (th2·s² + th1·s)/N(s))`. N is approximated by its stiffness, in series with the
/// stiffness of the cable.
///
/// # Errors
/// The error of the core for an invalid parameter.
pub fn nominal(rig: &RigConfig<f64>) -> Result<NominalPlant<f64>, Error> {
    let stiffness = (rig.cable_stiffness.recip() + rig.load_stiffness.recip()).recip();
    NominalPlant::of_mechanics(
        rig.drive_gain * rig.b,
        rig.motor_inertia,
        rig.motor_damping,
        stiffness,
    )
}

/// Rejects a value that is not positive and finite.
///
/// # Errors
/// [`Error::NonFinite`] or [`Error::OutOfRange`] with the name.
pub fn above_zero(value: f64, name: &'static str) -> Result<(), Error> {
    match value.is_finite() {
        false => Err(Error::NonFinite(name)),
        true if value <= 0.0 => Err(Error::OutOfRange(name)),
        true => Ok(()),
    }
}

/// The observer of these gains at a rate \[Hz\]; the nominal plant defaults to the rig's values.
///
/// # Errors
/// The error of the core for an invalid parameter.
pub fn observer(
    gains: &ObserverGains,
    rig: &RigConfig<f64>,
    rate: f64,
) -> Result<DisturbanceObserver<f64>, Error> {
    above_zero(gains.frequency, "frequency")?;
    let own = nominal(rig)?;
    let plant = NominalPlant::try_new(
        gains.gain.unwrap_or(own.gain()),
        gains.natural_frequency.unwrap_or(own.natural_frequency()),
        gains.damping_ratio.unwrap_or(own.damping_ratio()),
    )?;
    let time_constant = (TAU * gains.frequency).recip();
    let longest_dt = 0.1;
    DisturbanceObserver::try_new(plant, time_constant, gains.limit, longest_dt)?
        .with_latency(shown(rig, rate))
}
