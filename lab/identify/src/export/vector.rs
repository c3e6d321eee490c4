//! A test vector: samples of the record, and the outputs that the model must reproduce.
//!
//! There is one CSV file next to each model file. A firmware build of the model is correct if it
//! steps through the rows from a new state and reproduces the last columns, on any processor. Each
//! row is one sample: `dt`, the input and its rates, the load, each channel and its rates, then the
//! outputs of the model in `f32` and in `f64`. The samples are the shortest decimals of `f32`
//! numbers, so both float types read exactly these numbers.

use super::{ModelFile, MOST_TERMS};
use crate::problem::Prepared;
use crate::record::Mode;
use bowden::effect::Motion;
use bowden::model::{Model, ModelState, Sample};
use bowden::Real;
use std::fmt::Write as _;

/// Maximum number of samples, evenly spaced over the record.
pub const MOST_ROWS: usize = 400;

/// One sample of the file.
struct Row {
    dt: f64,
    input: Motion<f64>,
    load: f64,
    channels: Vec<Motion<f64>>,
}

/// The shortest decimal of the nearest `f32`.
fn short(value: f64) -> f64 {
    format!("{}", value as f32).parse().unwrap_or(value)
}

/// The vector of one record as CSV.
///
/// # Errors
/// A message with the part of the model that the core refuses.
pub fn csv(data: &Prepared, record: usize, file: &ModelFile) -> Result<String, String> {
    let rows = rows(data, record);
    let single = answers::<f32>(&rows, &file.model_in()?);
    let double = answers::<f64>(&rows, &file.model_in()?);
    let mut out = header(file);
    for ((row, single), double) in rows.iter().zip(single).zip(double) {
        let _ = write!(out, "{}", row.dt);
        let mut motion = |m: &Motion<f64>| {
            let _ = write!(out, ",{},{},{}", m.position, m.velocity, m.acceleration);
        };
        motion(&row.input);
        let _ = write!(out, ",{}", row.load);
        let mut motion = |m: &Motion<f64>| {
            let _ = write!(out, ",{},{},{}", m.position, m.velocity, m.acceleration);
        };
        row.channels.iter().for_each(&mut motion);
        let _ = writeln!(out, ",{single},{double}");
    }
    Ok(out)
}

fn header(file: &ModelFile) -> String {
    let rates = |name: &str| format!("{name},{name}.velocity,{name}.acceleration");
    let channels: String = file
        .channels
        .iter()
        .map(|name| format!(",{}", rates(name)))
        .collect();
    format!(
        "dt,{},load{channels},output_f32,output_f64\n",
        rates("input")
    )
}

/// Whether a file that begins with this line is a test vector, with any channels.
#[must_use]
pub fn is_header(line: &str) -> bool {
    let line = line.trim_end();
    line.starts_with("dt,input,input.velocity,input.acceleration,load,")
        && line.ends_with(",output_f32,output_f64")
}

/// Samples of the record, evenly thinned.
fn rows(data: &Prepared, record: usize) -> Vec<Row> {
    let whole = data.pieces.get(record).map_or(0..0, |p| p.work.clone());
    let step = whole.len().div_ceil(MOST_ROWS).max(1);
    let narrow = |m: &Motion<f64>| Motion {
        position: short(m.position),
        velocity: short(m.velocity),
        acceleration: short(m.acceleration),
    };
    whole
        .step_by(step)
        .map(|i| {
            let input = narrow(&data.input.motion[i]);
            let channels: Vec<Motion<f64>> =
                data.channels.iter().map(|c| narrow(&c.motion[i])).collect();
            Row {
                dt: short(data.dt * step as f64),
                load: load(data, input.position, &channels),
                input,
                channels,
            }
        })
        .collect()
}

/// The load that effects read: the load channel, else the input in torque mode.
pub(crate) fn load<T: Real>(data: &Prepared, input: T, channels: &[Motion<T>]) -> T {
    match (data.load.and_then(|i| channels.get(i)), data.mode) {
        (Some(load), _) => load.position,
        (None, Mode::Torque) => input,
        (None, Mode::Displacement) => T::zero(),
    }
}

/// What the model answers, from a fresh state on.
fn answers<T: Real>(rows: &[Row], model: &Model<T, MOST_TERMS>) -> Vec<T> {
    let own = |m: &Motion<f64>| Motion {
        position: T::from_f64(m.position),
        velocity: T::from_f64(m.velocity),
        acceleration: T::from_f64(m.acceleration),
    };
    let mut state = ModelState::new();
    rows.iter()
        .map(|row| {
            let channels: Vec<Motion<T>> = row.channels.iter().map(own).collect();
            let sample = Sample {
                dt: T::from_f64(row.dt),
                input: own(&row.input),
                load: T::from_f64(row.load),
                channels: &channels,
            };
            model.step(&mut state, &sample)
        })
        .collect()
}
