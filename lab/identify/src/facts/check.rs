//! Whether a model still holds on another record.

use super::asked::Asked;
use super::check_facts::{CheckFacts, DependsOn};
use super::check_sentence::sentence;
use super::record::RecordFacts;
use crate::check::{Check, Given};
use crate::record::Mode;
use std::path::Path;

/// The text of a model file, checked.
#[derive(Debug, Clone)]
pub struct ModelOfFile {
    given: Given,
    mode: Mode,
}

/// What is asked of a model and a record.
#[derive(Debug, Clone)]
pub struct CheckQuestion {
    /// The columns; the mode is the model's.
    pub asked: Asked,
    /// Whether the signals over time are wanted.
    pub trace: bool,
}

/// The answer.
#[derive(Debug, Clone)]
pub struct Checked {
    /// Where the record was read.
    pub label: String,
    /// What came out.
    pub facts: CheckFacts,
    /// The signals over time as CSV, where that was asked for.
    pub trace: Option<String>,
}

impl ModelOfFile {
    /// Reads the text of a model file.
    ///
    /// # Errors
    /// One sentence that says what is wrong with it.
    pub fn parse(text: &str) -> Result<Self, String> {
        let given = Given::parse(text)?;
        let mode = given.mode()?;
        Ok(Self { given, mode })
    }

    /// The mode that the model is of.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.mode
    }
}

/// Runs a model on a record that it has not seen.
///
/// # Errors
/// One line that names the record.
pub fn check(
    model: &ModelOfFile,
    record: &Path,
    question: &CheckQuestion,
) -> Result<Checked, String> {
    let mut asked = question.asked.clone();
    asked.options.mode = Some(model.mode);
    let record = asked
        .read(record)
        .map_err(|e| format!("{e} (the model is of {} mode)", model.mode.name()))?;
    let label = record.path.clone();
    let check =
        Check::new(record, &model.given, asked.cutoff).map_err(|message| named(&label, message))?;
    Ok(Checked {
        trace: match question.trace {
            true => Some(check.trace()?),
            false => None,
        },
        facts: CheckFacts::new(&check),
        label,
    })
}

/// The message with the record's name, once.
fn named(label: &str, message: String) -> String {
    match message.starts_with(label) {
        true => message,
        false => format!("{label}: {message}"),
    }
}

impl CheckFacts {
    /// The facts of a check.
    #[must_use]
    pub fn new(check: &Check) -> Self {
        let offset_alone = check.offset_alone();
        let depends_on = check.depends_on.iter();
        let mut facts = Self {
            record: RecordFacts::new(&check.data),
            line: check.line,
            deviation: check.deviation,
            rmse: check.rmse,
            rmse_gain_offset: check.rmse_gain_offset,
            rmse_corrected: match offset_alone {
                true => (check.rmse.powi(2) - check.mean.powi(2)).max(0.0).sqrt(),
                false => check.rmse_gain_offset,
            },
            mean: check.mean,
            allowed: check.allowed,
            reference: check.reference(),
            came_with: check.about.nrmse,
            own_cutoff: check.about.cutoff_hz,
            own_rate: check.about.rate_hz,
            outside: check.outside.clone(),
            depends_on: depends_on.map(|d| DependsOn::new(&check.data, d)).collect(),
            left_out: check.left_out,
            offset_alone,
            quiet: check.is_quiet(),
            verdict: check.verdict,
            sentence: String::new(),
        };
        facts.sentence = sentence(&facts);
        facts
    }
}
