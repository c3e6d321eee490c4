//! A simulated rig with motor, cable, spring-loaded joint, sensors and delay.
//!
//! The rig models the experiment of Nguyen et al. (2018) as ordinary differential equations. Use it
//! to test a controller, or to compare an error bound with a measured error, without hardware:
//!
//! ```text
//! tau_c·tau_m' = N_A·u − tau_m                               current loop
//! th2·w_p'     = tau_m − th1·w_p − tau_i                     motor and proximal pulley
//! tau_i        = K_c·(phi_p − phi_d) + c_c·(w_p − w_d)       stretch of the cable
//! tau_o        = B·tau_i − kappa_eta·eta − T0 + Σ g·effect   (6), (7), undeclared effects
//! J_d·w_d'     = tau_o − K·phi_d − c_d·w_d + load            joint against its spring, as (4)
//! ```
//!
//! The integration uses short sub-steps and computes velocities before positions. The torque
//! sensors have a lag, white noise and an A/D converter. Encoders measure the angles. Velocities
//! and accelerations are filtered differences of the angles. The command reaches the drive after a
//! delay of whole samples. B, kappa_eta and T0 can drift as in a moving conduit ([`Drift`]). Any
//! effect of the catalogue can be added without the controller's knowledge. One seed determines all
//! random numbers.
//!
//! The paper does not give the inertias, stiffnesses, drive gain or noise. They were chosen so that
//! the errors of the PI controller and of the adaptive law match Table 3 of the paper. The
//! agreement of these two errors is therefore calibrated. No other result was fitted.
//!
//! The crate is `no_std` and needs no heap, so the same trial can run on a microcontroller. The
//! features `serde`, `defmt` and `std` are off by default.
#![no_std]
#![forbid(unsafe_code)]

mod checked;
mod config;
mod drift;
mod noise;
mod plant;
mod reference;
mod sensor;

pub use config::RigConfig;
pub use drift::Drift;
pub use noise::Noise;
pub use reference::Reference;

use bowden::effect::Motion;
use bowden::model::Term;
use bowden::{Error, Real};
use drift::DriftState;
use plant::{Plant, PlantState};
use sensor::{Encoder, EncoderState, TorqueSensor, TorqueSensorState};

/// Maximum number of samples between a command and its effect on the drive.
pub const MOST_DELAY: usize = 8;

/// Maximum number of sub-steps in one step. With a longer `dt`, each sub-step is longer.
const MOST_SUB_STEPS: u32 = 4000;

/// A rig with at most `N` undeclared effects.
///
/// ```
/// use bowden_rig::{Reference, Rig, RigConfig};
///
/// let rig = Rig::<f64, 0>::try_new(RigConfig::reference(), &[])?;
/// let reference = Reference::paper();
/// let mut state = rig.start(7); // everything random follows from the seed
/// let (mut integral, mut worst) = (0.0, 0.0_f64);
/// for _ in 0..4000 {
///     let now = state.sample();
///     let error = now.measured - reference.at(now.time);
///     integral += error * 1e-3;
///     rig.step(&mut state, -30.0 * error - 18.0 * integral, 1e-3); // (15), Table 1
///     if now.time > 3.0 {
///         worst = worst.max((now.tau_o - reference.at(now.time)).abs());
///     }
/// }
/// assert!(worst < 2.0, "{worst} N·m");
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Rig<T, const N: usize> {
    config: RigConfig<T>,
    plant: Plant<T, N>,
    output: TorqueSensor<T>,
    input: TorqueSensor<T>,
    encoder: Encoder<T>,
    delay: usize,
}

/// True and measured values of the rig at one sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RigSample<T> {
    /// Time since the start \[s\].
    pub time: T,
    /// True distal torque \[N·m\].
    pub tau_o: T,
    /// Measured distal torque \[N·m\].
    pub measured: T,
    /// True proximal torque \[N·m\].
    pub tau_i: T,
    /// Measured proximal torque \[N·m\].
    pub measured_input: T,
    /// Motor torque \[N·m\].
    pub tau_m: T,
    /// Motion of the proximal pulley \[rad\], as firmware computes it from the encoder.
    pub proximal: Motion<T>,
    /// Motion of the distal pulley \[rad\], as firmware computes it from the encoder.
    pub distal: Motion<T>,
    /// Hysteresis state, in [-1, 1].
    pub eta: T,
    /// B at this sample.
    pub b: T,
    /// kappa_eta at this sample \[N·m\].
    pub kappa_eta: T,
    /// T0 at this sample \[N·m\].
    pub t0: T,
    /// Whether the motion has exceeded the range of floats. The rig then stops.
    pub diverged: bool,
}

/// State of a [`Rig`] between samples, created by [`Rig::start`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(
        serialize = "T: Real + serde::Serialize, [bowden::effect::EffectState<T>; N]: serde::Serialize",
        deserialize = "T: Real + serde::Deserialize<'de>, [bowden::effect::EffectState<T>; N]: serde::Deserialize<'de>"
    ))
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RigState<T, const N: usize> {
    plant: PlantState<T, N>,
    drift: DriftState<T>,
    output: TorqueSensorState<T>,
    input: TorqueSensorState<T>,
    proximal: EncoderState<T>,
    distal: EncoderState<T>,
    noise: Noise,
    commands: [T; MOST_DELAY],
    /// Rounding error of the time.
    carry: T,
    sample: RigSample<T>,
}

impl<T: Real, const N: usize> RigState<T, N> {
    /// The last sample. Before the first step, this is the sample at time zero.
    #[inline]
    #[must_use]
    pub fn sample(&self) -> RigSample<T> {
        self.sample
    }

    /// True motion of the proximal pulley \[rad\], without encoder and filter.
    #[inline]
    #[must_use]
    pub fn proximal(&self) -> Motion<T> {
        self.plant.proximal()
    }

    /// True motion of the distal pulley \[rad\], without encoder and filter.
    #[inline]
    #[must_use]
    pub fn distal(&self) -> Motion<T> {
        self.plant.distal()
    }
}

impl<T: Real, const N: usize> Rig<T, N> {
    /// A rig with this configuration and these undeclared effects.
    ///
    /// The effects read `Source::Input` (the proximal torque), `Source::Channel(0)` (the proximal
    /// pulley) or `Source::Channel(1)` (the distal pulley). Their load is the proximal torque. An
    /// effect that reads an acceleration receives the acceleration of the previous sub-step. The
    /// gain of an inertia must therefore be smaller than the inertia of its pulley.
    ///
    /// # Errors
    /// The errors of the configuration (see [`RigConfig`]), [`Error::Capacity`] for more than `N`
    /// effects, [`Error::OutOfRange`] with `"channel"`, or [`Error::NonFinite`] with `"origin"` or
    /// `"gain"`.
    pub fn try_new(config: RigConfig<T>, undeclared: &[Term<T>]) -> Result<Self, Error> {
        config.check()?;
        Ok(Self {
            plant: Plant::try_new(&config, undeclared)?,
            output: TorqueSensor::new(&config, config.noise, config.output_range),
            input: TorqueSensor::new(&config, config.input_noise, config.input_range),
            encoder: Encoder::new(&config),
            delay: usize::from(config.delay),
            config,
        })
    }

    /// The configuration.
    #[inline]
    #[must_use]
    pub fn config(&self) -> &RigConfig<T> {
        &self.config
    }

    /// The undeclared effects.
    #[inline]
    #[must_use]
    pub fn undeclared(&self) -> &[Term<T>] {
        self.plant.undeclared()
    }

    /// The state at rest. All torques are zero, except that the distal torque is −T0. The sensors
    /// have been read once.
    #[must_use]
    pub fn start(&self, seed: u64) -> RigState<T, N> {
        let mut state = RigState {
            plant: PlantState::new(),
            drift: DriftState::new(),
            output: TorqueSensorState::new(),
            input: TorqueSensorState::new(),
            proximal: EncoderState::new(),
            distal: EncoderState::new(),
            noise: Noise::new(seed),
            commands: [T::zero(); MOST_DELAY],
            carry: T::zero(),
            sample: RigSample::default(),
        };
        let (b, kappa_eta, t0) = (self.config.b, self.config.kappa_eta, self.config.t0);
        state.sample = RigSample {
            b,
            kappa_eta,
            t0,
            tau_o: -t0,
            ..RigSample::default()
        };
        state.output.level = -t0;
        state.sample.measured = self.output.read(&state.output, &mut state.noise);
        state.sample.measured_input = self.input.read(&state.input, &mut state.noise);
        state
    }

    /// Advances by `dt` \[s\] and reads the sensors.
    ///
    /// If the command is not finite, the drive keeps the last command. If `dt` is not positive and
    /// finite, the state does not change.
    pub fn step(&self, state: &mut RigState<T, N>, command: T, dt: T) -> RigSample<T> {
        self.step_with_load(state, command, T::zero(), dt)
    }

    /// [`step`](Self::step) with an additional external torque on the joint \[N·m\].
    ///
    /// On a test bench, this torque makes the motion of the joint independent of the transmitted
    /// torque. Without this torque, the spring couples the angle to the torque, and no record can
    /// distinguish their effects.
    pub fn step_with_load(
        &self,
        state: &mut RigState<T, N>,
        command: T,
        load: T,
        dt: T,
    ) -> RigSample<T> {
        if !(dt > T::zero() && dt.is_finite()) {
            return state.sample;
        }
        let drive = self.enqueue(state, command);
        let load = if load.is_finite() { load } else { T::zero() };
        let count = sub_steps(dt / self.config.sub_step);
        let Some(h) = T::from(count).map(|count| dt / count) else {
            return state.sample;
        };
        // All that changes before it is known whether the motion stays finite.
        let was = (
            (state.plant, state.drift, state.noise),
            (state.output, state.input),
        );
        let (b, kappa_eta, t0) = state.drift.step(
            self.config.drift.as_ref(),
            &self.config,
            &mut state.noise,
            dt,
        );
        state.plant.configure(b, kappa_eta, t0);
        let share = -(-h / self.config.sensor_lag).exp_m1();
        for _ in 0..count {
            if !self.plant.step(&mut state.plant, drive, load, h) {
                (
                    (state.plant, state.drift, state.noise),
                    (state.output, state.input),
                ) = was;
                state.sample.diverged = true;
                return state.sample;
            }
            state.output.follow(state.plant.tau_o, share);
            state.input.follow(state.plant.tau_i, share);
        }
        state.tick(dt);
        state.sample = RigSample {
            time: state.sample.time,
            tau_o: state.plant.tau_o,
            measured: self.output.read(&state.output, &mut state.noise),
            tau_i: state.plant.tau_i,
            measured_input: self.input.read(&state.input, &mut state.noise),
            tau_m: state.plant.tau_m,
            proximal: self
                .encoder
                .read(&mut state.proximal, state.plant.proximal().position, dt),
            distal: self
                .encoder
                .read(&mut state.distal, state.plant.distal().position, dt),
            eta: state.plant.eta(),
            b,
            kappa_eta,
            t0,
            diverged: state.sample.diverged,
        };
        state.sample
    }

    /// Adds a command to the queue and returns the command that reaches the drive.
    fn enqueue(&self, state: &mut RigState<T, N>, command: T) -> T {
        let command = if command.is_finite() {
            command
        } else {
            state.commands.first().copied().unwrap_or_else(T::zero)
        };
        let out = match self.delay {
            0 => command,
            late => state
                .commands
                .get(late - 1)
                .copied()
                .unwrap_or_else(T::zero),
        };
        let mut moved = command;
        for place in &mut state.commands {
            core::mem::swap(place, &mut moved);
        }
        out
    }
}

impl<T: Real, const N: usize> RigState<T, N> {
    /// Adds dt to a compensated sum. At 1 kHz, a plain `f32` clock would drift within minutes.
    fn tick(&mut self, dt: T) {
        let step = dt - self.carry;
        let time = self.sample.time + step;
        if time.is_finite() {
            self.carry = (time - self.sample.time) - step;
            self.sample.time = time;
        }
    }
}

/// Number of sub-steps in a step: none is longer than configured, within rounding.
fn sub_steps<T: Real>(ratio: T) -> u32 {
    let wanted = (ratio - T::from_f64(1e-3)).ceil();
    match wanted.to_u32() {
        Some(count) => count.clamp(1, MOST_SUB_STEPS),
        None => MOST_SUB_STEPS,
    }
}
