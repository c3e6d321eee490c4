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
//!
//! **What it needs** in `Cargo.toml` (a test builds this file in an empty crate with these lines):
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
//! The feature `defmt` derives the log formats; without it, delete its lines there and in this file.

use bowden::control::{
    AntiWindup, BenchRange, Compensator, CompensatorInput, CompensatorState, Fallback, Limits, Pid,
    PidInput, PidSettings, PidState, Status,
};
use bowden::effect::Motion;
use bowden::model::{Model, Source};
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
/// How the pulley has moved on the bench, as `model.rs` has it in `ranges()`: \[rad\], \[rad/s\],
/// \[rad/s²\]. An encoder that was reset looks like a motion; the feed-forward takes none for true
/// that is faster than this.
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
/// A little more than half of what a count of the encoder makes of torque, through the filter of the
/// rates and the friction of `model.rs`: 0.73 N·m·s/rad · COUNT / (2 · 8 ms) \[N·m\]. Without it the
/// feed-forward takes each count for a reversal.
const PLAY: f32 = 0.02;
/// As `bowden identify --model-out` writes it into the file.
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
    /// Whether the last sample could be used: no fault is acknowledged before.
    usable: bool,
}

impl TorqueLoop {
    /// A loop at rest, with a model as `bowden identify --model-out model.postcard` writes it.
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
                    // What the drive can give, and how fast it may change.
                    Limits::try_new(-10.0, 40.0)?.with_slew(2000.0)?,
                    LONGEST_DT,
                    // 20 ms without a good sample: let go.
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
        // A time that makes no sense is not known: the rates are held, not started anew.
        let known = if feed { dt } else { f32::NAN };
        let pulley = self.rates.step(&mut self.rates_state, angle, known);
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
        self.usable = feed && (now.wanted + now.torque).is_finite();
        let out = self.pi.step(&mut self.pi_state, &sample);
        Action {
            command: out.command,
            enabled: !self.pi_state.is_latched(),
            feed,
            status: out.status,
        }
    }

    /// Somebody has seen the fault: the loop closes again, from the safe command on.
    ///
    /// Refused, and the drive stays off, while the sample is still bad.
    pub fn acknowledge(&mut self) -> bool {
        if self.usable {
            self.pi_state.acknowledge();
        }
        self.usable
    }
}
