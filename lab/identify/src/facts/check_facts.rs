//! What a check found, as plain data.

use super::record::RecordFacts;
use crate::check::{Errors, Line, Outside, Verdict};
use crate::problem::Prepared;
use crate::score::dependences::Dependence;

/// A model on a record that it has not seen.
#[derive(Debug, Clone)]
pub struct CheckFacts {
    /// What was read.
    pub record: RecordFacts,
    /// Gain and offset of the prediction.
    pub line: Line,
    /// Standard deviation of the filtered output, in its unit.
    pub deviation: f64,
    /// Rms error as it is, in the output's unit.
    pub rmse: f64,
    /// Rms error with the fitted gain and offset.
    pub rmse_gain_offset: f64,
    /// Rms error with what has moved corrected: the offset alone, where that suffices.
    pub rmse_corrected: f64,
    /// Mean of the error as it is.
    pub mean: f64,
    /// Rms error up to which the model holds; `None` where nothing tells it.
    pub allowed: Option<f64>,
    /// The held-out error that the model came with, as a share of the standard deviation.
    pub reference: Option<f64>,
    /// What the model's file says of its errors.
    pub came_with: Option<Errors>,
    /// The cut-off that the model's file states \[Hz\].
    pub own_cutoff: Option<f64>,
    /// The sampling rate that the model's file states \[Hz\].
    pub own_rate: Option<f64>,
    /// Where this record goes beyond what the model has seen.
    pub outside: Vec<Outside>,
    /// On what the residual depends, where the model does not hold.
    pub depends_on: Vec<DependsOn>,
    /// Seconds at the start that do not count.
    pub left_out: f64,
    /// Whether an offset alone is what has moved.
    pub offset_alone: bool,
    /// Whether the output moves by little more than the noise.
    pub quiet: bool,
    /// The verdict.
    pub verdict: Verdict,
    /// The verdict in one or two sentences.
    pub sentence: String,
}

/// A variable on which the residual depends.
#[derive(Debug, Clone, PartialEq)]
pub struct DependsOn {
    /// Its name.
    pub variable: &'static str,
    /// The variable for people.
    pub words: String,
    /// The channel that it is made of.
    pub channel: String,
    /// Share of the squared error that a free curve over it takes.
    pub share: f64,
    /// Exact sign-flip p-value of that curve; `None` where it could not be tested.
    pub p: Option<f64>,
}

impl DependsOn {
    pub(super) fn new(data: &Prepared, one: &Dependence) -> Self {
        Self {
            variable: one.variable.name(data),
            words: one.variable.words(data),
            channel: data
                .channel(one.variable.source())
                .map_or_else(String::new, |c| c.name.clone()),
            share: one.share,
            p: one.p,
        }
    }
}
