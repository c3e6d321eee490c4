//! The gains file, schema `bowden.gains/1`, which `bowden design` writes and `bowden compare`
//! reads.
//!
//! The file has one table for each controller, with the names of the core's fields, so that
//! firmware with the feature `serde` can read a table into `PidSettings` or `AdaptiveSettings`.

use bowden::control::{Adaptive, AdaptiveSettings, Pid, PidSettings};
use serde::{Deserialize, Serialize};

/// The schema.
pub const SCHEMA: &str = "bowden.gains/1";

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GainsFile {
    /// [`SCHEMA`].
    pub schema: String,
    /// The conditions that the gains were designed for.
    pub design: DesignedFor,
    /// PI.
    pub pi: PidSettings<f64>,
    /// The PID, if the derivative helps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pid: Option<PidSettings<f64>>,
    /// The adaptive law in first-order form without regressors, if gains are admissible.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adaptive: Option<AdaptiveSettings<f64, 0>>,
    /// The ranges of the plant of the adaptive law that `bowden certify` assumes, if they are
    /// known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plant: Option<Known>,
}

/// Known ranges of a plant: the input of a certificate of the adaptive law, in addition to the
/// gains.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Known {
    /// Smallest and largest alpha \[N·m/command unit\].
    pub alpha: [f64; 2],
    /// Bound on the disturbance \[N·m\].
    pub disturbance: f64,
    /// Bound on the rate \[N·m/s\].
    pub disturbance_rate: f64,
    /// Bound on the reference \[N·m\].
    pub reference: f64,
    /// Bound on the rate \[N·m/s\].
    pub reference_rate: f64,
}

impl Known {
    /// The key of the first invalid number, and the allowed values.
    fn refused(&self) -> Option<(&'static str, String)> {
        let [low, high] = self.alpha;
        if !(low.is_finite() && high.is_finite() && 0.0 < low && low <= high) {
            let what = "a pair of finite positive numbers, the lower one first";
            return Some(("alpha", format!("[{low}, {high}]: must be {what}")));
        }
        let bounds = [
            ("disturbance", self.disturbance),
            ("disturbance_rate", self.disturbance_rate),
            ("reference", self.reference),
            ("reference_rate", self.reference_rate),
        ];
        let wrong = bounds.iter().find(|(_, x)| !(x.is_finite() && *x >= 0.0));
        wrong.map(|(name, x)| {
            let what = "must be a finite number, zero or positive";
            (*name, format!("{x}: {what}"))
        })
    }
}

/// The conditions that gains were designed for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DesignedFor {
    /// The program and its version.
    pub by: String,
    /// Name of the model's file, without folders.
    pub model: String,
    /// Sampling rate \[Hz\].
    pub rate: f64,
    /// Delay from a command to its effect in the measured torque \[s\].
    pub delay: f64,
    /// Torque at the proximal pulley per command unit \[N·m/command unit\].
    pub drive_gain: f64,
    /// Noise of the measured torque \[N·m rms\].
    pub noise: f64,
}

impl GainsFile {
    /// Reads a text; `label` is the name of the file.
    ///
    /// # Errors
    /// A message with file, line, column and key.
    pub fn parse(text: &str, label: &str) -> Result<Self, String> {
        let gains: Self = toml::from_str(text).map_err(|e| message(&e, text, label))?;
        if gains.schema != SCHEMA {
            return Err(at(
                text,
                label,
                "",
                "schema",
                &format!("schema {:?} must be {SCHEMA:?}", gains.schema),
            ));
        }
        let d = &gains.design;
        for (value, name, above) in [
            (d.rate, "rate", true),
            (d.delay, "delay", false),
            (d.drive_gain, "drive_gain", true),
            (d.noise, "noise", false),
        ] {
            if !(value.is_finite() && value >= 0.0 && (value > 0.0 || !above)) {
                let what = if above {
                    "positive"
                } else {
                    "zero or positive"
                };
                let line = format!("[design]: {name} {value}: must be a finite number, {what}");
                return Err(at(text, label, "design", name, &line));
            }
        }
        let refused = |table: &str, error: bowden::Error| {
            let name = error.parameter().split(['.', ' ']).next().unwrap_or("");
            at(text, label, table, name, &format!("[{table}]: {error}"))
        };
        Pid::try_new(gains.pi).map_err(|e| refused("pi", e))?;
        if let Some(pid) = gains.pid {
            Pid::try_new(pid).map_err(|e| refused("pid", e))?;
        }
        if let Some(law) = gains.adaptive {
            Adaptive::try_new(law).map_err(|e| refused("adaptive", e))?;
        }
        if let Some((name, what)) = gains.plant.as_ref().and_then(Known::refused) {
            let line = format!("[plant]: {name} {what}");
            return Err(at(text, label, "plant", name, &line));
        }
        Ok(gains)
    }

    /// The file as TOML.
    ///
    /// # Errors
    /// The error of the serialiser if a number cannot be written.
    pub fn toml(&self) -> Result<String, toml::ser::Error> {
        let d = &self.design;
        Ok(format!(
            "# Designed by {} for {} at {} Hz with a delay of {} s\n{}",
            d.by,
            d.model,
            d.rate,
            d.delay,
            toml::to_string(self)?
        ))
    }

    /// Number of samples of `design.rate` in one step of the adaptive law; 1 if the law runs at
    /// this rate.
    #[must_use]
    pub fn adaptive_every(&self) -> usize {
        let step = self.adaptive.map(|law| law.form);
        match step {
            Some(bowden::control::Form::FirstOrder { step, .. }) => {
                (step * self.design.rate).round().max(1.0) as usize
            }
            _ => 1,
        }
    }
}

/// Whether a text is a file of `bowden design`, by its schema.
pub(crate) fn is_of_design(text: &str) -> bool {
    let table = toml::from_str::<toml::Table>(text).ok();
    table.is_some_and(|table| table.get("schema").and_then(toml::Value::as_str) == Some(SCHEMA))
}

/// file:line:column of a key of a table, or of the table, before a line.
fn at(text: &str, label: &str, table: &str, key: &str, line: &str) -> String {
    let mut inside = table.is_empty();
    let mut place = None;
    for (number, row) in text.lines().enumerate() {
        let trimmed = row.trim();
        if let Some(name) = trimmed.strip_prefix('[').and_then(|r| r.split(']').next()) {
            inside = name == table || name.strip_prefix(table).is_some_and(|r| r.starts_with('.'));
            if name == table {
                place = Some((number + 1, 1));
            }
        }
        let own = trimmed.split('=').next().unwrap_or("").trim();
        if inside && !key.is_empty() && own == key {
            let column = row.chars().take_while(|c| c.is_whitespace()).count() + 1;
            return format!("{label}:{}:{column}: {line}", number + 1);
        }
    }
    match place {
        Some((number, column)) => format!("{label}:{number}:{column}: {line}"),
        None => format!("{label}: {line}"),
    }
}

/// The error as `file:line:column: message`, in one line.
pub(crate) fn message(error: &toml::de::Error, text: &str, label: &str) -> String {
    if text.trim_start().starts_with('{') {
        return format!(
            "{label}: this file is JSON; pass TOML, as `bowden identify --model-out MODEL.toml` and `bowden design --out GAINS.toml` write it"
        );
    }
    let what = error.message().replace('\n', " ");
    match error.span() {
        None => format!("{label}: {what}"),
        Some(span) => {
            let before = text.get(..span.start).unwrap_or(text);
            let line = before.matches('\n').count() + 1;
            let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
            let key = key_at(text, span.start).map_or_else(String::new, |k| format!("`{k}`: "));
            format!("{label}:{line}:{column}: {key}{what}")
        }
    }
}

/// The key of the line with an error.
fn key_at(text: &str, at: usize) -> Option<&str> {
    let start = text.get(..at)?.rfind('\n').map_or(0, |i| i + 1);
    let line = text.get(start..)?.lines().next()?.trim();
    let key = line.split_once('=').map_or(line, |(key, _)| key).trim();
    // An error of the whole file stands at its beginning, where a comment may be.
    (!key.is_empty() && !key.starts_with('#')).then_some(key)
}
