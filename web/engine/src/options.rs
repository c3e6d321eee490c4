//! The user's options: those of the program, under the same names.

use bowden_lab::facts::{Asked, Mode, Options};
use serde::Deserialize;

/// The options of `bowden identify`; an absent option has its default.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Choices {
    /// `torque` or `displacement`.
    pub mode: Option<String>,
    /// Column of the time.
    pub time: Option<String>,
    /// Column of the input.
    pub input: Option<String>,
    /// Column of the output.
    pub output: Option<String>,
    /// Name and column of each further channel.
    pub channels: Vec<(String, String)>,
    /// Start \[s\].
    pub start: Option<f64>,
    /// End \[s\].
    pub end: Option<f64>,
    /// Cut-off frequency \[Hz\].
    pub cutoff: Option<f64>,
    /// Sample rate \[Hz\].
    pub rate: Option<f64>,
    /// Line of the column names.
    pub header_line: Option<usize>,
    /// The segment to read.
    pub segment: Option<usize>,
    /// The sheet of a workbook to read.
    pub sheet: Option<String>,
    /// Column names of a text file without a header.
    pub names: Vec<String>,
    /// Whether to drop bad rows.
    pub drop_bad: bool,
    /// The baseline model.
    pub baseline: Vec<String>,
    /// Maximum number of terms.
    pub max_terms: Option<usize>,
    /// Time limit of the search \[s\].
    pub time_limit: Option<f64>,
    /// Whether each file has separate gains.
    pub per_file: bool,
    /// Whether the exported model must be invertible.
    pub invertible: bool,
}

impl Choices {
    /// The options of the reader.
    ///
    /// # Errors
    /// One line if the mode is unknown.
    pub fn options(&self) -> Result<Options, String> {
        let mode = match self.mode.as_deref() {
            None => None,
            Some("torque") => Some(Mode::Torque),
            Some("displacement") => Some(Mode::Displacement),
            Some(other) => return Err(format!("`--mode {other}` must be torque or displacement")),
        };
        Ok(Options {
            mode,
            time: self.time.clone(),
            input: self.input.clone(),
            output: self.output.clone(),
            channels: self.channels.clone(),
            skip: self.start.unwrap_or(0.0),
            until: self.end,
            rate: self.rate,
            header_line: self.header_line,
            segment: self.segment,
            sheet: self.sheet.clone(),
            names: self.names.clone(),
            drop_bad: self.drop_bad,
        })
    }

    /// The options of the reader and of the search, common to all answers.
    ///
    /// # Errors
    /// One line if an option is out of range.
    pub fn asked(&self) -> Result<Asked, String> {
        let positive = |option: &str, value: Option<f64>| match value {
            Some(own) if !(own.is_finite() && own > 0.0) => Err(format!(
                "`{option} {own}` is out of range; it must be positive"
            )),
            _ => Ok(()),
        };
        positive("--cutoff", self.cutoff)?;
        positive("--time-limit", self.time_limit)?;
        let most = bowden_lab::facts::MOST_NAMES;
        if let Some(terms) = self.max_terms.filter(|terms| *terms > most) {
            return Err(format!(
                "`--max-terms {terms}` is out of range (0 to {most})"
            ));
        }
        Ok(Asked {
            options: self.options()?,
            cutoff: self.cutoff,
            declare: self.baseline.clone(),
            rounds: self.max_terms,
            budget: self.time_limit,
        })
    }
}
