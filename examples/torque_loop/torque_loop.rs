//! The torque loop of one joint, to copy into firmware.
//!
//! A PI closes the loop, the inverse of the identified model is the feed-forward, and
//! `signal::Rates` computes a velocity from the encoder counts. The loop uses no heap, cannot panic
//! and does not depend on a board. [`TorqueLoop::try_new`] checks everything once at start-up;
//! [`TorqueLoop::tick`] is one call of the timer interrupt.
//!
//! **What happens in a fault.** During bad samples the command is held for at most 20 ms. Then the
//! drive is switched off and stays off until [`TorqueLoop::acknowledge`] is called. Every tick with
//! a valid time feeds the watchdog, even during a fault: the watchdog detects a loop that no longer
//! runs, and a restart would lose the fault.
//!
//! **Dependencies** in `Cargo.toml` (a test builds this file in an empty crate with these lines):
//!
//! ```toml
//! [dependencies]
//! bowden = { path = "../bowden", features = ["serde"] }
//! crc = "3"
//! postcard = { version = "1", default-features = false, features = ["use-crc"] }
//! defmt = { version = "1", optional = true }
//!
//! [features]
//! defmt = ["dep:defmt", "bowden/defmt"]
//! ```
//!
//! The feature `defmt` derives the log formats; if you do not need it, delete its lines there and
//! in this file.

use bowden::control::{
    AntiWindup, BenchRange, Compensator, CompensatorInput, CompensatorState, Fallback, Limits, Pid,
    PidInput, PidSettings, PidState, Status,
};
use bowden::effect::Motion;
use bowden::model::{Model, Source};
use bowden::signal::{Rates, RatesState};
use bowden::Error;

/// Counts of the encoder per turn; the counter then restarts.
pub const COUNTS: f32 = 16384.0;
/// Angle of one count \[rad\].
const COUNT: f32 = core::f32::consts::TAU / COUNTS;
/// Command while the drive is off, and the start of the command afterwards \[N·m\].
const SAFE: f32 = 0.0;
/// Longest valid time between two ticks \[s\].
const LONGEST_DT: f32 = 0.005;
/// Range of the pulley's motion on the bench, from `ranges()` in `model.rs`: \[rad\], \[rad/s\],
/// \[rad/s²\]. An encoder that is reset looks like a motion; the feed-forward clamps a faster
/// motion to this range.
const PULLEY: BenchRange<f32> = BenchRange {
    source: Source::Channel(0),
    low: Motion {
        position: -0.45185134,
        velocity: -1.5794401,
        acceleration: -5.8742285,
    },
    high: Motion {
        position: 0.5994563,
        velocity: 1.608444,
        acceleration: 4.6569395,
    },
};
/// A little more than half of the torque that one encoder count causes through the filter of the
/// rates and the friction in `model.rs`: 0.73 N·m·s/rad · COUNT / (2 · 8 ms) \[N·m\]. Without this
/// play the feed-forward would treat each count as a reversal.
const PLAY: f32 = 0.02;
/// The value that `bowden identify --model-out` writes into `model.rs`.
const CHECKSUM: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// Why the loop cannot start.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum StartError {
    /// The bytes of the model are damaged or belong to another version.
    Model,
    /// A number that a constructor refuses.
    Settings(Error),
}

impl From<Error> for StartError {
    fn from(error: Error) -> Self {
        Self::Settings(error)
    }
}

/// Readings of the sensors at one tick.
#[derive(Debug, Clone, Copy)]
pub struct Sensors {
    /// Time since the last tick \[s\], from a free-running counter.
    pub dt: f32,
    /// Desired torque \[N·m\].
    pub wanted: f32,
    /// Torque at the joint \[N·m\]; NaN if the converter reports an error.
    pub torque: f32,
    /// Encoder of the pulley.
    pub counts: u16,
}

/// Actions of the firmware after a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Action {
    /// Command for the drive \[N·m\].
    pub command: f32,
    /// Whether the drive's output stage is on.
    pub enabled: bool,
    /// Whether the watchdog is fed.
    pub feed: bool,
    /// Status for the log.
    pub status: Status,
}

/// One joint: its configuration, which may be in flash, and its state.
#[derive(Debug)]
pub struct TorqueLoop {
    pi: Pid<f32>,
    compensator: Compensator<f32, 8>,
    rates: Rates<f32>,
    pi_state: PidState<f32>,
    compensator_state: CompensatorState<f32, 8>,
    rates_state: RatesState<f32>,
    /// Whether the last sample was usable: a fault can be acknowledged only then.
    usable: bool,
}

impl TorqueLoop {
    /// A loop at rest, with a model from `bowden identify --model-out model.postcard`.
    ///
    /// # Errors
    /// [`StartError`].
    pub fn try_new(model: &[u8]) -> Result<Self, StartError> {
        let model: Model<f32, 8> =
            postcard::from_bytes_crc32(model, CHECKSUM.digest()).map_err(|_| StartError::Model)?;
        Ok(Self {
            pi: Pid::try_new(PidSettings {
                anti_windup: AntiWindup::BackCalculation { tracking_time: 0.1 },
                ..PidSettings::new(
                    0.5,
                    25.0,
                    // The range of the drive, and how fast the command may change.
                    Limits::try_new(-10.0, 40.0)?.with_slew(2000.0)?,
                    LONGEST_DT,
                    // After 20 ms without a good sample: the safe command.
                    Fallback::try_new(20, SAFE)?,
                )
            })?,
            compensator: Compensator::try_new(&model)?
                .with_longest_dt(LONGEST_DT)?
                .with_ranges(&[PULLEY])?
                .with_play(PLAY)?,
            rates: Rates::try_new(0.008)?.with_period(COUNTS * COUNT)?,
            pi_state: PidState::new(),
            compensator_state: CompensatorState::new(),
            rates_state: RatesState::new(),
            usable: false,
        })
    }

    /// One sample.
    pub fn tick(&mut self, now: &Sensors) -> Action {
        let dt = now.dt;
        let feed = dt > 0.0 && dt <= LONGEST_DT;
        let angle = f32::from(now.counts) * COUNT;
        // An invalid time counts as unknown: the rates are held, not restarted.
        let known = if feed { dt } else { f32::NAN };
        let pulley = self.rates.step(&mut self.rates_state, angle, known);
        // From the desired torque, not from the noisy measurement. A bad sample holds the command.
        let wish = CompensatorInput {
            channels: &[pulley.motion],
            ..CompensatorInput::new(dt, now.wanted)
        };
        let bench = self.compensator.step(&mut self.compensator_state, &wish);
        let sample = PidInput {
            feed_forward: bench.command,
            ..PidInput::new(dt, now.wanted, now.torque)
        };
        self.usable = feed && (now.wanted + now.torque).is_finite();
        let out = self.pi.step(&mut self.pi_state, &sample);
        Action {
            command: out.command,
            enabled: !self.pi_state.is_latched(),
            feed,
            status: out.status,
        }
    }

    /// Acknowledges the fault: the loop closes again and starts from the safe command.
    ///
    /// While the sample is still bad, the call is refused and the drive stays off.
    pub fn acknowledge(&mut self) -> bool {
        if self.usable {
            self.pi_state.acknowledge();
        }
        self.usable
    }
}
