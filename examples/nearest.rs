//! A feed-forward from a model that has no exact inverse.
//!
//! `cargo run --release --example nearest`
//!
//! The README's model has sigma = 2.97: just after a reversal its output falls while its input
//! rises, so there is no inverse, and `Compensator::try_new` refuses it. `Compensator::try_nearest`
//! inverts the nearest model that has an inverse and returns the changes. The error is the
//! difference between the true model's output for the command and the desired output. The viscous
//! friction of the pulley is compensated with velocities from an encoder through `Rates`.

use bowden::control::{Compensator, CompensatorInput, CompensatorState, Status};
use bowden::effect::{Motion, Viscous};
use bowden::hysteresis::BoucWen;
use bowden::model::{Model, ModelState, Sample, Source, Term};
use bowden::signal::{Rates, RatesState};
use bowden::transmission::Transmission;
use bowden::{Error, Real};

/// The model that `bowden identify` has identified: torques in N·m, the proximal pulley in rad.
fn identified<T: Real>() -> Result<Model<T, 1>, Error> {
    let shape = BoucWen::try_new(T::from_f64(0.382), T::from_f64(2.97), T::from_f64(1.02))?;
    let cable = Transmission::torque(
        T::from_f64(0.952),
        T::from_f64(2.29),
        T::from_f64(0.050),
        shape,
    )?;
    let friction = Term {
        effect: Viscous.into(),
        source: Source::Channel(0),
        origin: T::zero(),
        gain: T::from_f64(-0.264),
    };
    Model::try_new(Some(cable), &[friction])
}

const DT: f64 = 1e-3;
/// Counts of the encoder per turn; its counter restarts after each turn.
const COUNTS: u32 = 16_384;

/// The desired torque \[N·m\] and the true motion of the pulley: a large swing with small
/// reversals.
fn wish(t: f64) -> (f64, Motion<f64>) {
    let torque = 6.0 * (1.9 * t).sin() + 1.5 * (7.3 * t).sin();
    let pulley = Motion {
        position: 2.0 * t + 0.8 * (1.9 * t).sin(),
        velocity: 2.0 + 0.8 * 1.9 * (1.9 * t).cos(),
        acceleration: -0.8 * 1.9 * 1.9 * (1.9 * t).sin(),
    };
    (torque, pulley)
}

/// The part that runs in firmware, in single precision.
struct FeedForward {
    compensator: Compensator<f32, 1>,
    rates: Rates<f32>,
    state: CompensatorState<f32, 1>,
    pulley: RatesState<f32>,
}

impl FeedForward {
    /// One tick of the timer: the command \[N·m\] for a desired torque and a counter.
    fn tick(&mut self, desired: f32, counter: f32) -> (f32, Status) {
        let pulley = self.rates.step(&mut self.pulley, counter, DT as f32);
        let turn = core::f32::consts::TAU / COUNTS as f32;
        let channels = [Motion {
            position: turn * pulley.motion.position,
            velocity: turn * pulley.motion.velocity,
            acceleration: turn * pulley.motion.acceleration,
        }];
        let at = CompensatorInput {
            channels: &channels,
            ..CompensatorInput::new(DT as f32, desired)
        };
        let out = self.compensator.step(&mut self.state, &at);
        (out.command, out.status)
    }
}

/// Rms error \[N·m\] of the true model's output, with and without a feed-forward.
fn run(mut feed: FeedForward) -> Result<[f64; 2], Error> {
    let plant = identified::<f64>()?;
    let (mut fed, mut bare) = (ModelState::new(), ModelState::new());
    let (mut sum, mut counted) = ([0.0; 2], 0.0);
    for k in 0..20_000_u32 {
        let t = DT * f64::from(k);
        let (desired, pulley) = wish(t);
        let counts = pulley.position / core::f64::consts::TAU * f64::from(COUNTS);
        let counter = counts.floor().rem_euclid(f64::from(COUNTS));
        let (command, status) = feed.tick(desired as f32, counter as f32);
        if status != Status::Good {
            println!("{t:.3} s: {status:?}");
        }
        // For comparison: a feed-forward from the gain of the cable alone.
        let commands = [f64::from(command), desired / 0.952];
        for ((state, input), sum) in [&mut fed, &mut bare]
            .into_iter()
            .zip(commands)
            .zip(&mut sum)
        {
            let input = Motion {
                position: input,
                ..Motion::default()
            };
            let sample = Sample {
                dt: DT,
                input,
                load: input.position,
                channels: &[pulley],
            };
            let error = plant.step(state, &sample) - desired;
            // After the first reversals, because the initial state is unknown.
            *sum += if t < 4.0 { 0.0 } else { error * error };
        }
        counted += if t < 4.0 { 0.0 } else { 1.0 };
    }
    Ok(sum.map(|sum| (sum / counted).sqrt()))
}

fn main() -> Result<(), Error> {
    let model = identified::<f32>()?;
    if let Err(refusal) = Compensator::try_new(&model) {
        println!("try_new:     {refusal}");
    }
    let (compensator, changed) = Compensator::try_nearest(&model)?;
    if let Some(sigma) = changed.sigma {
        println!("try_nearest: sigma {:.4} -> {:.4}", sigma.0, sigma.1);
    }
    if let Some(rho) = changed.rho {
        println!("try_nearest: rho {:.4} -> {:.4}", rho.0, rho.1);
    }
    for term in changed.left_out() {
        println!("try_nearest: without {}", model.terms()[term].effect.name());
    }

    // The cut-off of the fit was 5 Hz; one turn of the encoder is one turn of its counter.
    let rates = Rates::for_cutoff(5.0)?.with_period(COUNTS as f32)?;
    let [fed, bare] = run(FeedForward {
        compensator,
        rates,
        state: CompensatorState::new(),
        pulley: RatesState::new(),
    })?;
    println!("rms error of the output, 4 s to 20 s, of a wish of 4.4 N·m rms:");
    println!("    wish / B                        {bare:.3} N·m");
    println!("    nearest model and its friction  {fed:.3} N·m");
    Ok(())
}
