//! One row: fields from the JSON of a record.

use bowden_lab::facts::RecordError;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A row; the columns of the table have the names of the fields. A row contains no times, so the
/// same records give the same bytes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Row {
    /// The path, as given.
    pub file: String,
    /// `ok` or `error`.
    pub status: String,
    /// The error, if identification failed.
    pub error: Option<String>,
    /// Line in the file, from 1; for a binary file, the row.
    pub line: Option<i64>,
    /// Column of the file.
    pub column: Option<String>,
    pub verdict: Option<String>,
    /// Mechanisms such as `friction@x`, the largest share first.
    pub mechanisms: Option<Vec<String>>,
    /// Names of the delivered terms; empty in a row with an error.
    pub names: Option<Vec<String>>,
    pub confidences: Option<Vec<String>>,
    /// Root mean square errors \[unit of the output\].
    pub baseline_held_out: Option<f64>,
    pub final_held_out: Option<f64>,
    pub floor: Option<f64>,
    /// Of the final model.
    pub parameters: Option<Vec<String>>,
    pub values: Option<Vec<Option<f64>>>,
    pub units: Option<Vec<Option<String>>>,
    pub evaluations: Option<i64>,
    pub jacobians: Option<i64>,
    pub columns_filtered: Option<i64>,
    pub searches: Option<i64>,
}

impl Row {
    /// The row of a record whose identification failed.
    pub fn failed(file: &str, message: String) -> Self {
        Self {
            file: file.to_owned(),
            status: "error".to_owned(),
            error: Some(message),
            ..Self::default()
        }
    }

    /// The row of a record that could not be read.
    pub fn refused(file: &str, error: &RecordError) -> Self {
        Self {
            line: error.line().and_then(|line| i64::try_from(line).ok()),
            column: error.column().map(str::to_owned),
            ..Self::failed(file, error.to_string())
        }
    }

    /// The row from the output of `identify --json`.
    pub fn of_json(file: &str, text: &str) -> Result<Self, String> {
        let report: Value = serde_json::from_str(text).map_err(|e| e.to_string())?;
        let at = |path: &str| report.pointer(path);
        let number = |path: &str| at(path).and_then(Value::as_f64);
        let count = |name: &str| at(&format!("/cost/{name}")).and_then(Value::as_i64);
        let each = |path: &str| at(path).and_then(Value::as_array).into_iter().flatten();
        let text = |of: &Value, name: &str| of[name].as_str().map(str::to_owned);
        let rounds = |name: &str| each("/terms").map(|round| text(round, name)).collect();
        let mechanism = |lack: &Value| {
            let (name, channel) = (text(lack, "mechanism")?, text(lack, "channel")?);
            Some(format!("{name}@{channel}"))
        };
        let parameters = || each("/final/parameters");
        Ok(Self {
            file: file.to_owned(),
            status: "ok".to_owned(),
            verdict: text(&report, "verdict"),
            mechanisms: each("/lacks").map(mechanism).collect(),
            names: rounds("effect"),
            confidences: rounds("confidence"),
            baseline_held_out: number("/baseline/rmse/held_out"),
            final_held_out: number("/final/rmse/held_out"),
            floor: number("/noise_floor/held_out").or_else(|| number("/noise_floor")),
            parameters: parameters().map(|own| text(own, "name")).collect(),
            values: Some(parameters().map(|own| own["value"].as_f64()).collect()),
            units: Some(parameters().map(|own| text(own, "unit")).collect()),
            evaluations: count("evaluations"),
            jacobians: count("jacobians"),
            columns_filtered: count("columns_filtered"),
            searches: count("searches"),
            ..Self::default()
        })
    }

    /// As one line of JSON.
    pub fn json(&self) -> Result<String, String> {
        serde_json::to_string(self).map_err(|e| e.to_string())
    }

    /// From that line.
    pub fn parse(line: &str) -> Result<Self, String> {
        serde_json::from_str(line).map_err(|e| format!("its row cannot be read: {e}"))
    }

    pub fn is_error(&self) -> bool {
        self.status == "error"
    }
}
