//! The torque loop of one joint, to copy into firmware.
//!
//! A PI closes the loop, the model that the bench has identified turned round feeds it
//! forward, `signal::Rates` makes a velocity of the encoder's counts. No heap, no panic,
//! nothing of a board: [`TorqueLoop::try_new`] checks everything once at start-up,
//! [`TorqueLoop::tick`] is one call of the timer's interrupt.
//!
//! **What happens in a fault.** A bad sample is held for at most 20 ms; then the drive is
//! switched off and stays off until somebody has called [`TorqueLoop::acknowledge`]. The
//! watchdog is fed by every tick whose time makes sense, in a fault too: it is there for
//! a loop that no longer runs, and a chip that restarts would forget the fault.

use bowden::control::{
    AntiWindup, Compensator, CompensatorInput, CompensatorState, Fallback, Fault, Limits, Pid,
    PidInput, PidSettings, PidState, Status,
};
use bowden::model::Model;
use bowden::signal::{Rates, RatesState};
use bowden::Error;

/// Counts of the encoder in a turn; they start again after that.
pub const COUNTS: f32 = 16384.0;
/// Angle of a count \[rad\].
const COUNT: f32 = core::f32::consts::TAU / COUNTS;
/// What the drive gets while it is off, and where it starts again from \[N·m\].
const SAFE: f32 = 0.0;
/// Longest time between two ticks that is a sample \[s\].
const LONGEST_DT: f32 = 0.005;
/// As `bowden close --model-out` writes it into the file.
const CHECKSUM: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// Why the loop cannot start.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum StartError {
    /// The bytes of the model are damaged, or those of another version.
    Model,
    /// A number that its constructor refuses.
    Settings(Error),
}

impl From<Error> for StartError {
    fn from(error: Error) -> Self {
        Self::Settings(error)
    }
}

/// What the sensors say at one tick.
#[derive(Debug, Clone, Copy)]
pub struct Sensors {
    /// Since the last tick \[s\], from a counter that runs free.
    pub dt: f32,
    /// Torque that is wanted \[N·m\].
    pub wanted: f32,
    /// Torque at the joint \[N·m\]; NaN where the converter reports an error.
    pub torque: f32,
    /// Encoder of the pulley.
    pub counts: u16,
}

/// What the firmware does after a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Action {
    /// To the drive \[N·m\].
    pub command: f32,
    /// Whether the drive's output stage is on.
    pub enabled: bool,
    /// Whether the watchdog is fed.
    pub feed: bool,
    /// For the log.
    pub status: Status,
}

/// One joint: its configuration, which may live in flash, and its state.
#[derive(Debug)]
pub struct TorqueLoop {
    pi: Pid<f32>,
    compensator: Compensator<f32, 8>,
    rates: Rates<f32>,
    pi_state: PidState<f32>,
    compensator_state: CompensatorState<f32, 8>,
    rates_state: RatesState<f32>,
    /// The last sample of the PI, from which an acknowledgement starts.
    last: Option<PidInput<f32>>,
    /// The fault for which the drive is off.
    latched: Option<Fault>,
}

impl TorqueLoop {
    /// A loop at rest, with a model as `bowden close --model-out model.postcard` writes it.
    ///
    /// # Errors
    /// [`StartError`].
    pub fn try_new(model: &[u8]) -> Result<Self, StartError> {
        let model: Model<f32, 8> =
            postcard::from_bytes_crc32(model, CHECKSUM.digest()).map_err(|_| StartError::Model)?;
        Ok(Self {
            pi: Pid::try_new(PidSettings {
                // What the drive can give, and how fast it may change.
                limits: Limits::try_new(-10.0, 40.0)?.with_slew(2000.0)?,
                anti_windup: AntiWindup::BackCalculation { tracking_time: 0.1 },
                // 20 ms without a good sample: let go.
                fallback: Fallback::try_new(20, SAFE)?,
                ..PidSettings::new(0.5, 25.0)
            })?,
            compensator: Compensator::try_new(&model)?,
            rates: Rates::try_new(0.008)?.with_period(COUNTS * COUNT)?,
            pi_state: PidState::new(),
            compensator_state: CompensatorState::new(),
            rates_state: RatesState::new(),
            last: None,
            latched: None,
        })
    }

    /// One sample.
    pub fn tick(&mut self, now: &Sensors) -> Action {
        let feed = now.dt > 0.0 && now.dt <= LONGEST_DT;
        // A counter that has wrapped: the sample cannot be used.
        let dt = if feed { now.dt } else { f32::NAN };
        let angle = f32::from(now.counts) * COUNT;
        let pulley = self.rates.step(&mut self.rates_state, angle, dt);
        // From what is wanted, not from the noisy measurement. A bad sample holds it.
        let wish = CompensatorInput {
            channels: &[pulley.motion],
            ..CompensatorInput::new(dt, now.wanted)
        };
        let bench = self.compensator.step(&mut self.compensator_state, &wish);
        let sample = PidInput {
            feed_forward: bench.command,
            ..PidInput::new(dt, now.wanted, now.torque)
        };
        self.last = Some(sample);
        if let Some(fault) = self.latched {
            return Action {
                command: SAFE,
                enabled: false,
                feed,
                status: Status::Safe(fault),
            };
        }
        let out = self.pi.step(&mut self.pi_state, &sample);
        if let Status::Safe(fault) = out.status {
            self.latched = Some(fault);
        }
        Action {
            command: out.command,
            enabled: self.latched.is_none(),
            feed,
            status: out.status,
        }
    }

    /// Somebody has seen the fault: the loop closes again, from the safe command on.
    ///
    /// Refused, and the drive stays off, while the sample is still bad.
    pub fn acknowledge(&mut self) -> bool {
        let Some(sample) = self.last else {
            return false;
        };
        if self.pi_state.resume_from(&self.pi, SAFE, &sample) != Status::Good {
            return false;
        }
        self.latched = None;
        true
    }
}
