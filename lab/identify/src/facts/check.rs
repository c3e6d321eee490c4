//! Tests whether a model is valid on another record.

use super::asked::Asked;
use super::figures::Figures;
use super::record::{channel_name, RecordFacts};
use crate::check::{summary, Check, Errors, Given, Outside, Verdict};
use crate::conclude::finding::Told;
use crate::conclude::line::Line;
use crate::problem::Prepared;
use crate::record::{Mode, Options, Record};
use crate::score::dependences::Dependence;
use std::path::Path;

/// A model on another record.
#[derive(Debug, Clone)]
pub struct CheckFacts {
    /// The record as it was read.
    pub record: RecordFacts,
    /// Gain and offset of the prediction.
    pub line: Line,
    /// Standard deviation of the filtered output, in its unit.
    pub deviation: f64,
    /// Rms error of the unchanged model, in the output's unit.
    pub rmse: f64,
    /// Rms error with the fitted gain and offset.
    pub rmse_gain_offset: f64,
    /// Rms error up to which the model holds; `None` if no limit can be determined.
    pub allowed: Option<f64>,
    /// The model's own held-out error, as a fraction of the standard deviation.
    pub reference: Option<f64>,
    /// The same error in the unit of the output, if the model file states it.
    pub reference_rmse: Option<f64>,
    /// The errors that the model file states.
    pub came_with: Option<Errors>,
    /// The cut-off that the model's file states \[Hz\].
    pub own_cutoff: Option<f64>,
    /// The sampling rate that the model's file states \[Hz\].
    pub own_rate: Option<f64>,
    /// Ranges in which this record exceeds the model's own record.
    pub outside: Vec<Outside>,
    /// The variables that the residual depends on, if the model does not hold.
    pub depends_on: Vec<DependsOn>,
    /// Seconds at the start that are excluded.
    pub left_out: f64,
    /// The verdict.
    pub verdict: Verdict,
    /// The error up to which the model holds, in words.
    pub rule: String,
    /// The findings, the most important first.
    pub findings: Vec<Told>,
    /// The findings in words.
    pub sentence: String,
}

/// A variable on which the residual depends.
#[derive(Debug, Clone, PartialEq)]
pub struct DependsOn {
    /// Its name.
    pub variable: &'static str,
    /// The printed name of the variable.
    pub words: String,
    /// The channel that it is computed from.
    pub channel: String,
    /// Share of the squared error that a free-form function of the variable removes.
    pub share: f64,
    /// Exact sign-flip p-value of this function; `None` if no test was possible.
    pub p: Option<f64>,
}

/// A checked model file.
#[derive(Debug, Clone)]
pub struct ModelOfFile {
    given: Given,
    mode: Mode,
}

/// A request for a model and a record.
#[derive(Debug, Clone)]
pub struct CheckQuestion {
    /// The columns; the mode is the model's.
    pub asked: Asked,
    /// Whether the signals over time are requested.
    pub trace: bool,
    /// Whether the data of a page are requested.
    pub figures: bool,
}

/// The result of a validation.
#[derive(Debug, Clone)]
pub struct Checked {
    /// Path of the record.
    pub label: String,
    /// The result.
    pub facts: CheckFacts,
    /// The signals over time as CSV, if requested.
    pub trace: Option<String>,
    /// The data of a page, if requested.
    pub figures: Option<Figures>,
}

impl ModelOfFile {
    /// Reads the text of a model file.
    ///
    /// # Errors
    /// One sentence on the first error in it.
    pub fn parse(text: &str) -> Result<Self, String> {
        let given = Given::parse(text)?;
        let mode = given.mode()?;
        Ok(Self { given, mode })
    }

    /// Rejects a model that does not describe its own records.
    ///
    /// # Errors
    /// A message if its verdict is `no-input-dependence`.
    pub fn could_hold(&self) -> Result<(), String> {
        match self.given.about.verdict.as_deref() {
            Some("no-input-dependence") => Err(
                "the model does not describe its own records (verdict `no-input-dependence`), so it cannot be validated; `bowden identify` prints the reason"
                    .to_owned(),
            ),
            _ => Ok(()),
        }
    }

    /// The mode of the model.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.mode
    }
}

/// Runs a model on another record.
///
/// # Errors
/// A message with the record.
pub fn check(
    model: &ModelOfFile,
    record: &Path,
    question: &CheckQuestion,
) -> Result<Checked, String> {
    let mut asked = question.asked.clone();
    asked.options.mode = Some(model.mode);
    let read = asked.read(record).map_err(|e| {
        let any = Asked {
            options: Options {
                mode: None,
                ..asked.options.clone()
            },
            ..asked.clone()
        };
        match any.read(record) {
            // Its columns are those of the other mode.
            Ok(_) => format!("{e} (the model is in {} mode)", model.mode.name()),
            Err(_) => e,
        }
    });
    check_record(model, read?, question)
}

/// Runs a model on a record that was already read.
///
/// # Errors
/// The same as [`check()`].
pub fn check_record(
    model: &ModelOfFile,
    record: Record,
    question: &CheckQuestion,
) -> Result<Checked, String> {
    model.could_hold()?;
    let label = record.path.clone();
    let check = Check::new(record, &model.given, question.asked.cutoff)
        .map_err(|message| named(&label, message))?;
    Ok(Checked {
        trace: match question.trace {
            true => Some(check.trace()?),
            false => None,
        },
        figures: match question.figures {
            true => Some(Figures::of_check(&check)?),
            false => None,
        },
        facts: CheckFacts::new(&check),
        label,
    })
}

/// The message with the name of the record, but not twice.
fn named(label: &str, message: String) -> String {
    match message.starts_with(label) {
        true => message,
        false => format!("{label}: {message}"),
    }
}

impl CheckFacts {
    /// The facts of a validation.
    #[must_use]
    pub fn new(check: &Check) -> Self {
        let depends_on = check.depends_on.iter();
        let findings = check.findings();
        Self {
            record: RecordFacts::new(&check.data),
            line: check.line,
            deviation: check.deviation,
            rmse: check.rmse,
            rmse_gain_offset: check.rmse_gain_offset,
            allowed: check.allowed,
            reference: check.reference(),
            reference_rmse: check.about.held_out_rmse,
            came_with: check.about.nrmse,
            own_cutoff: check.about.cutoff_hz,
            own_rate: check.about.rate_hz,
            outside: check.outside.clone(),
            depends_on: depends_on.map(|d| DependsOn::new(&check.data, d)).collect(),
            left_out: check.left_out,
            verdict: check.verdict,
            rule: check.rule(),
            sentence: summary(&findings),
            findings: findings.into_iter().map(Told::from).collect(),
        }
    }
}

impl DependsOn {
    fn new(data: &Prepared, one: &Dependence) -> Self {
        Self {
            variable: one.variable.name(data),
            words: one.variable.words(data),
            channel: channel_name(data, one.variable.source()),
            share: one.share,
            p: one.p,
        }
    }
}
