//! A torque loop to copy into firmware: PI, feed-forward from the bench, safe commands.
//!
//! `cargo run --release --example torque_loop` runs it on a simulated joint, with bad
//! samples and a dead sensor on the way, and prints what a telemetry channel would show.
//!
//! `TorqueLoop` is the part to copy. It has no heap and does not panic: the constructor
//! checks everything once, at start-up; `tick` is one call of the timer interrupt. The
//! paper drives the gearbox's input; here the drive takes the proximal torque \[N·m\].

use bowden::control::{
    AntiWindup, Compensator, CompensatorInput, CompensatorState, Fallback, Limits, Pid, PidInput,
    PidOutput, PidSettings, PidState, Status,
};
use bowden::effect::{Effect, Motion};
use bowden::hysteresis::{BoucWen, Shape};
use bowden::model::{Model, Source, Term};
use bowden::transmission::Transmission;
use bowden::Error;

// ---- the part to copy -------------------------------------------------------

/// What the bench has identified, as `bowden close --model-out` writes it.
fn identified() -> Result<Model<f32, 1>, Error> {
    let shape = Shape::try_new(0.09582, 0.6, 3.871)?;
    let cable = Transmission::torque(0.9978, 7.004, 0.05174, shape)?;
    let viscous = Term {
        effect: Effect::Viscous,
        source: Source::Channel(0),
        origin: 0.0,
        gain: -0.4,
    };
    Model::try_new(Some(cable), &[viscous])
}

/// One joint: the configuration may live in flash, the state in RAM.
struct TorqueLoop {
    pi: Pid<f32>,
    compensator: Compensator<f32, 1>,
    pi_state: PidState<f32>,
    compensator_state: CompensatorState<f32, 1>,
}

impl TorqueLoop {
    fn try_new() -> Result<Self, Error> {
        let pi = Pid::try_new(PidSettings {
            anti_windup: AntiWindup::BackCalculation { tracking_time: 0.1 },
            ..PidSettings::new(
                0.5,
                25.0,
                Limits::try_new(-10.0, 60.0)?.with_slew(2000.0)?,
                // Five timer periods: what is longer is no sample.
                0.005,
                // 20 ms without a good sample: let go, until somebody has seen it.
                Fallback::try_new(20, 0.0)?,
            )
        })?;
        Ok(Self {
            pi,
            compensator: Compensator::try_new(&identified()?)?,
            pi_state: PidState::new(),
            compensator_state: CompensatorState::new(),
        })
    }

    /// One sample: torques \[N·m\], velocity of the pulley \[rad/s\], `dt` \[s\].
    fn tick(&mut self, dt: f32, reference: f32, measured: f32, velocity: f32) -> PidOutput<f32> {
        let pulley = [Motion {
            velocity,
            ..Motion::default()
        }];
        // From the reference, not from the noisy measurement. A bad sample holds it.
        let wish = CompensatorInput {
            channels: &pulley,
            ..CompensatorInput::new(dt, reference)
        };
        let bench = self.compensator.step(&mut self.compensator_state, &wish);
        let sample = PidInput {
            feed_forward: bench.command,
            ..PidInput::new(dt, reference, measured)
        };
        self.pi.step_with_terms(&mut self.pi_state, &sample)
    }

    /// The operator has seen the fault: the next good sample closes the loop again.
    fn acknowledge(&mut self) {
        self.pi_state.acknowledge();
    }

    /// Takes over from a command that is out already, without a jump.
    fn start_at(&mut self, command: f32, reference: f32, measured: f32) {
        let at = PidInput {
            feed_forward: self.compensator_state.command(),
            ..PidInput::new(0.0, reference, measured)
        };
        self.pi_state.resume_from(&self.pi, command, &at);
    }
}

// ---- a joint to run it on ---------------------------------------------------

/// A cable that is not quite what the bench saw, a drive's lag, a sensor's noise.
struct Joint {
    cable: Transmission<f64>,
    eta: BoucWen<f64>,
    drive: f64,
    noise: u32,
}

impl Joint {
    fn try_new() -> Result<Self, Error> {
        let shape = Shape::try_new(0.11, 0.5, 3.0)?;
        Ok(Self {
            cable: Transmission::torque(0.93, 7.7, 0.3, shape)?,
            eta: BoucWen::new(),
            drive: 0.0,
            noise: 1,
        })
    }

    /// The distal torque 1 ms after a command, and as the sensor shows it.
    fn step(&mut self, command: f64, velocity: f64) -> (f64, f64) {
        self.drive += 0.5 * (command - self.drive);
        let tau_o = self.cable.step(&mut self.eta, self.drive) - 0.5 * velocity;
        self.noise = self
            .noise
            .wrapping_mul(1_664_525)
            .wrapping_add(1_013_904_223);
        let noise = 0.04 * (f64::from(self.noise >> 8) / f64::from(1 << 24) - 0.5);
        (tau_o, tau_o + noise)
    }
}

const DT: f64 = 1e-3;

fn reference(t: f64) -> (f64, f64) {
    let torque = (25.0 + 10.0 * (1.571 * t).sin()) * t.min(1.0);
    (torque, 0.8 * (1.571 * t).cos())
}

/// Root mean square error of the true output after 8 s \[N·m\].
fn quiet_run(bench: bool) -> Result<f64, Error> {
    let (mut torque_loop, mut joint) = (TorqueLoop::try_new()?, Joint::try_new()?);
    let (mut measured, mut sum) = (0.0, 0.0);
    for k in 0..16_000_u32 {
        let t = DT * f64::from(k);
        let (wanted, velocity) = reference(t);
        let out = if bench {
            torque_loop.tick(DT as f32, wanted as f32, measured as f32, velocity as f32)
        } else {
            let sample = PidInput::new(DT as f32, wanted as f32, measured as f32);
            torque_loop
                .pi
                .step_with_terms(&mut torque_loop.pi_state, &sample)
        };
        let (tau_o, sensed) = joint.step(f64::from(out.command), velocity);
        measured = sensed;
        sum += if t < 8.0 {
            0.0
        } else {
            (tau_o - wanted).powi(2)
        };
    }
    Ok((sum / 8000.0).sqrt())
}

fn main() -> Result<(), Error> {
    let (mut torque_loop, mut joint) = (TorqueLoop::try_new()?, Joint::try_new()?);
    let mut measured = 0.0;
    torque_loop.start_at(0.0, 0.0, 0.0);

    println!("     t  reference  output  command = feed-forward + proportional + integral");
    for k in 0..12_000_u32 {
        let t = DT * f64::from(k);
        let (wanted, velocity) = reference(t);
        let sensor = match k {
            4000..=4004 => f32::NAN, // five lost samples
            6000..=6099 => f32::NAN, // a connector that comes off, and is put back
            _ => measured as f32,
        };
        if k == 6500 {
            torque_loop.acknowledge();
        }
        let out = torque_loop.tick(DT as f32, wanted as f32, sensor, velocity as f32);
        let (tau_o, sensed) = joint.step(f64::from(out.command), velocity);
        measured = sensed;

        if k % 1000 == 0 || matches!(k, 4005 | 6019 | 6100 | 6500) {
            let terms = out.terms;
            let note = match out.status {
                Status::Good if terms.saturated => "limited".to_string(),
                Status::Good => String::new(),
                bad => format!("{bad:?}"),
            };
            println!(
                "{t:6.3} {wanted:10.3} {tau_o:7.3} {:8.3} {:14.3} {:14.3} {:10.3}  {note}",
                out.command, terms.feed_forward, terms.proportional, terms.integral,
            );
        }
    }
    println!("rms error of the output without lost samples, 8 s to 16 s:");
    println!(
        "    PI alone                      {:.3} N·m",
        quiet_run(false)?
    );
    println!(
        "    PI with the bench's model     {:.3} N·m",
        quiet_run(true)?
    );
    Ok(())
}
