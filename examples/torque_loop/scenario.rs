//! Ten seconds of a joint with faults, identical on a microcontroller and on the host.
//!
//! [`Scenario::tick`] is the body of a timer interrupt: it reads the sensors of the simulated
//! joint, runs the loop and drives the joint. Its log is a [`Line`] in whole mN·m, which a
//! microcontroller can log without formatting a float.

use super::torque_loop::{Action, Sensors, StartError, TorqueLoop, COUNTS};
use bowden::control::Status;
use bowden::hysteresis::{BoucWen, BoucWenState};
use bowden::transmission::Transmission;
use bowden::{Error, Real};
use core::fmt::{Display, Formatter};

/// Ticks per second.
pub const RATE: u32 = 1000;
const DT: f32 = 1e-3;
/// Ticks of the scenario.
const LENGTH: u32 = 10_000;

/// A tick that is logged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Time since the start \[ms\].
    pub time: u32,
    /// Desired torque \[mN·m\].
    pub wanted: i32,
    /// Torque at the joint \[mN·m\].
    pub torque: i32,
    /// Command \[mN·m\].
    pub command: i32,
    /// Status of the loop.
    pub status: Status,
}

impl Display for Line {
    fn fmt(&self, to: &mut Formatter<'_>) -> core::fmt::Result {
        let Self {
            time,
            wanted,
            torque,
            command,
            status,
        } = self;
        write!(
            to,
            "{time} ms: wanted {wanted}, joint {torque}, command {command} mN·m, {status:?}"
        )
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Line {
    fn format(&self, to: defmt::Formatter<'_>) {
        let Self {
            time,
            wanted,
            torque,
            command,
            status,
        } = self;
        defmt::write!(
            to,
            "{} ms: wanted {}, joint {}, command {} mN·m, {}",
            time,
            wanted,
            torque,
            command,
            status
        );
    }
}

/// A cable that differs slightly from the bench model, the lag of a drive, the noise of a sensor.
#[derive(Debug)]
struct Joint {
    cable: Transmission<f32>,
    eta: BoucWenState<f32>,
    drive: f32,
    torque: f32,
    noise: u32,
}

impl Joint {
    fn try_new() -> Result<Self, Error> {
        let shape = BoucWen::try_new(0.5, 0.5, 1.3)?;
        Ok(Self {
            cable: Transmission::torque(0.93, 1.9, 0.1, shape)?,
            eta: BoucWenState::new(),
            drive: 0.0,
            torque: 0.0,
            noise: 1,
        })
    }

    /// Advances by one millisecond with a command \[N·m\] and a velocity of the pulley \[rad/s\].
    fn step(&mut self, action: &Action, velocity: f32) {
        let command = if action.enabled { action.command } else { 0.0 };
        self.drive += 0.5 * (command - self.drive);
        self.torque = self.cable.step(&mut self.eta, self.drive) - 0.6 * velocity;
    }

    /// The sensor, with noise of ±0.02 N·m.
    fn measured(&mut self) -> f32 {
        let next = self.noise.wrapping_mul(1_664_525);
        self.noise = next.wrapping_add(1_013_904_223);
        self.torque + 0.04 * ((self.noise >> 8) as f32 / (1 << 24) as f32 - 0.5)
    }
}

/// The loop, its joint, and the present tick.
#[derive(Debug)]
pub struct Scenario {
    control: TorqueLoop,
    joint: Joint,
    tick: u32,
    status: Status,
}

/// Result of a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Told {
    /// Output of the loop.
    pub action: Action,
    /// Whether an attempt to acknowledge the fault succeeded, if there was one.
    pub acknowledged: Option<bool>,
    /// A line for the log, if there is one.
    pub line: Option<Line>,
}

impl Scenario {
    /// At rest, with the model of the joint.
    ///
    /// # Errors
    /// [`StartError`].
    pub fn try_new(model: &[u8]) -> Result<Self, StartError> {
        Ok(Self {
            control: TorqueLoop::try_new(model)?,
            joint: Joint::try_new()?,
            tick: 0,
            status: Status::Good,
        })
    }

    /// Advances by one millisecond; `None` after the end of the scenario.
    pub fn tick(&mut self) -> Option<Told> {
        if self.tick >= LENGTH {
            return None;
        }
        let k = self.tick;
        self.tick += 1;
        let t = k as f32 * DT;
        let rise = if t < 1.0 { t } else { 1.0 };
        let wanted = rise * (8.0 + 4.0 * Real::sin(1.571 * t));
        let (angle, velocity) = (0.5 * Real::sin(1.571 * t), 0.7855 * Real::cos(1.571 * t));
        let measured = self.joint.measured();
        // An encoder that has been reset.
        let shift = if k < 7000 { 0.0 } else { 2.0 };
        let action = self.control.tick(&Sensors {
            dt: if k == 8000 { 4295.0 } else { DT }, // a counter that wrapped
            wanted,
            torque: match k {
                3000..=3004 => f32::NAN, // five lost samples
                5000..=5099 => f32::NAN, // a connector that is unplugged and reconnected
                _ => measured,
            },
            counts: counts(angle + shift),
        });
        // The first attempt comes while the sensor is still dead, and is refused.
        let acknowledged = matches!(k, 5050 | 6000).then(|| self.control.acknowledge());
        self.joint.step(&action, velocity);
        let news = core::mem::discriminant(&self.status) != core::mem::discriminant(&action.status);
        self.status = action.status;
        let line = (news || matches!(k % RATE, 0 | 500)).then(|| Line {
            time: k,
            wanted: milli(wanted),
            torque: milli(self.joint.torque),
            command: milli(action.command),
            status: action.status,
        });
        Some(Told {
            action,
            acknowledged,
            line,
        })
    }
}

/// The count of an encoder, which restarts after each turn.
fn counts(angle: f32) -> u16 {
    let turns = angle / core::f32::consts::TAU;
    let turns = if turns < 0.0 { turns + 1.0 } else { turns };
    (turns * COUNTS) as u16
}

/// To the nearest thousandth.
fn milli(value: f32) -> i32 {
    let half = if value < 0.0 { -0.5 } else { 0.5 };
    (1000.0 * value + half) as i32
}
