//! The error of a model on a microcontroller: sample by sample, with causal rates.
//!
//! The velocities of the fit come from a zero-phase filter, which uses future samples. Firmware
//! cannot do this. Here the exported model runs as in firmware: in `f32`, from a new state, at the
//! record's time stamps, on the recorded columns, with the velocities and accelerations of
//! [`Rates`]. Its output then passes through the same grids and filters as the measured output, so
//! both errors refer to the same rows and the same band.

use super::vector::load;
use super::{ModelFile, MOST_TERMS};
use crate::fit::Segments;
use crate::problem::Prepared;
use crate::record::Record;
use bowden::effect::Motion;
use bowden::model::{Model, ModelState, Sample};
use bowden::signal::{Play, PlayState, Rates, RatesState};

/// The time constant for the rates of a fit with this cut-off \[s\].
///
/// # Errors
/// If the cut-off has no valid time constant.
pub fn time_constant(cutoff: f64) -> Result<f64, String> {
    let rates = Rates::for_cutoff(cutoff).map_err(|e| e.to_string())?;
    Ok(rates.time_constant())
}

/// The errors with causal rates, as shares of the output's standard deviation.
///
/// `files` are the models: one for all records, or one for each. `half_width` is that of a [`Play`]
/// on the input, if there is one.
///
/// # Errors
/// A message if the model cannot be built, or if its output cannot be resampled.
pub fn causal(
    records: &[Record],
    data: &Prepared,
    files: &[ModelFile],
    time_constant: f64,
    half_width: Option<f64>,
) -> Result<Segments, String> {
    let mut answered = Vec::with_capacity(records.len());
    for (index, record) in records.iter().enumerate() {
        let file = files.get(index).or(files.first());
        let file = file.ok_or("no model was exported")?;
        answered.push(answers(data, record, file, time_constant, half_width)?);
    }
    let answered = data.answered(records, answered)?;
    let pairs = data.target.iter().zip(&answered);
    let residual: Vec<f64> = pairs.map(|(measured, answer)| measured - answer).collect();
    Ok(Segments::of(data, &residual).normalised(data, &data.target))
}

/// The model's answers to a record as it was recorded.
fn answers(
    data: &Prepared,
    record: &Record,
    file: &ModelFile,
    time_constant: f64,
    half_width: Option<f64>,
) -> Result<Vec<f64>, String> {
    let model: Model<f32, MOST_TERMS> = file.model_in()?;
    let play = half_width.map(|r| Play::try_new(r as f32)).transpose();
    let (play, mut held) = (play.map_err(|e| e.to_string())?, PlayState::new());
    let rates = Rates::try_new(time_constant as f32).map_err(|e| e.to_string())?;
    let mut state = ModelState::new();
    let columns = || std::iter::once(&record.input).chain(&record.channels);
    let mut past = vec![RatesState::new(); record.channels.len() + 1];
    let mut before = record.time.first().map_or(0.0, |t| t - record.step());
    let mut motions: Vec<Motion<f32>> = Vec::with_capacity(past.len());
    let mut answers = Vec::with_capacity(record.samples());
    for (i, &time) in record.time.iter().enumerate() {
        let dt = (time - before) as f32;
        before = time;
        motions.clear();
        let measured = columns().map(|c| c.values[i] as f32).enumerate();
        let measured = measured.map(|(index, x)| match (index, play) {
            (0, Some(play)) => play.step(&mut held, x),
            _ => x,
        });
        let measured = measured.zip(&mut past);
        motions.extend(measured.map(|(x, own)| rates.step(own, x, dt).motion));
        let (input, channels) = (motions[0], &motions[1..]);
        let sample = Sample {
            dt,
            input,
            load: load(data, input.position, channels),
            channels,
        };
        answers.push(f64::from(model.step(&mut state, &sample)));
    }
    Ok(answers)
}
