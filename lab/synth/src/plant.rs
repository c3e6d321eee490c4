//! From the recipe to the record.

use super::contribution::Running;
use super::recipe::{refuse, Base, Mode, Recipe, RecipeError};
use super::rig::{self, Channel, Moment, Rig};
use super::sensor::{noise, quantise, spread};
use super::stage::{self, Grid};
use super::{hysteresis, Column, Synthetic, Truth};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Motion before the first sample \[s\]: nothing starts from rest at t = 0.
const BEFORE: f64 = 2.0;
/// Fewest fine steps a sample, and the longest fine step \[s\].
const SUBSTEPS: f64 = 20.0;
const LONGEST_STEP: f64 = 1e-4;
/// Most fine steps in all: ten million samples at 1 kHz, some gigabytes. Where all of them are
/// kept, a tenth of that.
const MOST_STEPS: f64 = 2.1e8;
/// Stands for the noise as measure of strength where there is none.
const STRENGTH_UNIT: f64 = 0.05;

/// Makes a record.
///
/// # Errors
/// An unknown effect or channel, a number out of range, or a strength that the
/// effect cannot reach: see [`RecipeError`].
pub fn generate(recipe: &Recipe) -> Result<Synthetic, RecipeError> {
    recipe.check()?;
    // One stream each: what is planted changes neither the motion nor the noise.
    let stream = |number: u64| {
        let mut rng = ChaCha8Rng::seed_from_u64(recipe.seed);
        rng.set_stream(number);
        rng
    };
    let rig = Rig::draw(&mut stream(0), recipe);
    let base = rig::base(&mut stream(1), recipe);
    let mut running = Vec::new();
    for (index, planted) in recipe.effects.iter().enumerate() {
        running.push(Running::start(
            planted,
            &rig,
            recipe,
            &mut stream(16 + index as u64),
        )?);
    }

    let grid = grid(recipe, running.iter().any(Running::is_stage))?;
    let run = integrate(&rig, &base, recipe, &grid, &mut running);
    let mut output = run.output;
    let unit = if recipe.noise > 0.0 {
        recipe.noise
    } else {
        STRENGTH_UNIT
    };
    for (effect, planted) in running
        .iter_mut()
        .zip(&recipe.effects)
        .filter(|(effect, _)| !effect.is_stage())
    {
        let fine = std::mem::take(&mut effect.fine);
        effect.scale(&grid.sampled(&fine), planted.strength * unit, planted.gain)?;
        output
            .iter_mut()
            .zip(fine)
            .for_each(|(sum, value)| *sum += effect.truth.gain * value);
    }
    for (effect, planted) in running
        .iter_mut()
        .zip(&recipe.effects)
        .filter(|(effect, _)| effect.is_stage())
    {
        let wanted = planted.strength * unit;
        let (time, change) = stage::apply(&effect.truth.effect, &output, &grid, wanted)?;
        effect.truth.gain = time;
        effect.truth.contribution = grid.sampled(&change).into_owned();
        effect.truth.rms = spread(&effect.truth.contribution);
        output
            .iter_mut()
            .zip(change)
            .for_each(|(sum, value)| *sum += value);
    }

    let clean = grid.sampled(&output).into_owned();
    let errors: Vec<f64> = noise(&mut stream(2), recipe.colour, grid.samples)
        .iter()
        .map(|e| recipe.noise * e)
        .collect();
    let measured: Vec<f64> = clean
        .iter()
        .zip(&errors)
        .map(|(y, e)| quantise(y + e, recipe.quantisation))
        .collect();
    let columns = columns(recipe, &run.moments, measured, &running, &mut stream(3));
    let truth = Truth {
        base,
        effects: running.into_iter().map(|effect| effect.truth).collect(),
        eta: run.moments.iter().map(|moment| moment.eta).collect(),
        input: run.moments.iter().map(|moment| moment.input.x).collect(),
        output: clean,
        noise_rms: spread(&errors),
    };
    Ok(Synthetic { columns, truth })
}

/// `keeps_all`: an effect on the finished output needs all of its fine steps.
fn grid(recipe: &Recipe, keeps_all: bool) -> Result<Grid, RecipeError> {
    let samples = (recipe.seconds * recipe.rate).round();
    let every = SUBSTEPS.max((1.0 / (recipe.rate * LONGEST_STEP)).ceil());
    let h = 1.0 / (recipe.rate * every);
    let first = (BEFORE / h).ceil();
    let kept = if keeps_all { 10.0 } else { 1.0 };
    if kept * (first + samples * every) > MOST_STEPS {
        return refuse(format!(
            "{samples} samples at {} Hz are too many{}",
            recipe.rate,
            if keeps_all {
                " with a delay or a lag"
            } else {
                ""
            }
        ));
    }
    Ok(Grid {
        h,
        first: first as usize,
        every: every as usize,
        samples: samples as usize,
        keeps_all,
    })
}

struct Run {
    /// The moments that are sampled.
    moments: Vec<Moment>,
    /// Output of the transmission alone, where the grid keeps it.
    output: Vec<f64>,
}

fn integrate(rig: &Rig, base: &Base, recipe: &Recipe, grid: &Grid, running: &mut [Running]) -> Run {
    let steps = grid.first + (grid.samples - 1) * grid.every + 1;
    let (mut output, mut moments) = (Vec::new(), Vec::with_capacity(grid.samples));
    let mut eta = 0.0;
    let mut rate = 0.0;
    let mut follower = rig.at(-(grid.first as f64) * grid.h, grid.h).input.x;
    for i in 0..steps {
        let t = (i as f64 - grid.first as f64) * grid.h;
        let mut moment = rig.at(t, grid.h);
        let before = follower;
        follower = hysteresis::follow(follower, moment.input.x, recipe.play);
        if i > 0 {
            let rates = if recipe.play > 0.0 {
                // The play's output has corners: its mean rate over the step.
                [(follower - before) / grid.h; 3]
            } else {
                [rate, rig.input_rate(t - 0.5 * grid.h), moment.input.v]
            };
            eta = hysteresis::step(base, eta, grid.h, rates);
        }
        rate = moment.input.v;
        moment.eta = eta;
        let (u, loop_part) = (follower, base.kappa_eta * eta);
        let is_sample = grid.is_sample(i);
        let is_kept = is_sample || grid.keeps_all;
        if is_kept {
            output.push(match recipe.mode {
                Mode::Torque => base.gain * u - loop_part - base.offset,
                Mode::Displacement => base.gain * u + loop_part + base.offset,
            });
        }
        for effect in running.iter_mut() {
            effect.step(&moment, is_kept);
        }
        if is_sample {
            moments.push(moment);
        }
    }
    Run { moments, output }
}

/// The columns as they are recorded; channels that nobody asked for are not.
fn columns(
    recipe: &Recipe,
    moments: &[Moment],
    measured: Vec<f64>,
    running: &[Running],
    rng: &mut ChaCha8Rng,
) -> Vec<Column> {
    let mode = recipe.mode;
    let torque = mode == Mode::Torque;
    let needed = |channel: Channel| running.iter().any(|effect| effect.needs(channel, mode));
    let reading = |channel: Channel, count: f64| -> Option<Column> {
        let (name, unit) = channel.label(mode)?;
        let values = moments
            .iter()
            .map(|moment| quantise(channel.of(moment).x, count))
            .collect();
        Some(Column { name, unit, values })
    };
    let time = moments
        .iter()
        .enumerate()
        .map(|(k, _)| k as f64 / recipe.rate)
        .collect();
    let mut columns = vec![Column {
        name: "t",
        unit: "s",
        values: time,
    }];
    let count = if torque {
        recipe.quantisation
    } else {
        recipe.resolution
    };
    if let Some((name, unit)) = Channel::Input.label(mode) {
        let errors = noise(rng, 0.0, moments.len());
        let read =
            |(moment, e): (&Moment, f64)| quantise(moment.input.x + recipe.input_noise * e, count);
        columns.push(Column {
            name,
            unit,
            values: moments.iter().zip(errors).map(read).collect(),
        });
    }
    let (name, unit) = if torque {
        ("tau_o", "N·m")
    } else {
        ("f", "N")
    };
    columns.push(Column {
        name,
        unit,
        values: measured,
    });
    columns.extend(reading(Channel::Proximal, recipe.resolution));
    columns.extend(reading(Channel::Distal, recipe.resolution));
    if recipe.load || needed(Channel::Load) {
        columns.extend(reading(Channel::Load, recipe.quantisation));
    }
    if recipe.temperature || needed(Channel::Temperature) {
        columns.extend(reading(Channel::Temperature, 0.01));
    }
    if needed(Channel::Auxiliary) {
        columns.extend(reading(Channel::Auxiliary, 10.0 / 65536.0));
    }
    columns
}
