//! The signals of a run over time, as CSV: the measured signals, the output of a model, and the
//! contribution of each of its parts.
//!
//! There is one line for each sample of the estimation grid, on which least squares runs, and every
//! column is filtered: these are the numbers that the fit uses. The fit drops the first and the
//! last lines.

use super::final_fit::FinalFit;
use super::intervals::term_name;
use super::Shares;
use crate::fit::Solution;
use crate::ledger::Ledger;
use crate::problem::{Channel, Prepared};

/// A column of numbers on the estimation grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Its unit, if the record states one.
    pub unit: Option<String>,
    /// One value for each sample.
    pub values: Vec<f64>,
}

impl Column {
    pub(crate) fn new(name: impl Into<String>, unit: Option<&str>, values: Vec<f64>) -> Self {
        Self {
            name: name.into(),
            unit: unit.map(str::to_owned),
            values,
        }
    }

    fn header(&self) -> String {
        match &self.unit {
            Some(unit) => format!("{} [{unit}]", self.name),
            None => self.name.clone(),
        }
    }
}

/// The trace of an identified record as CSV.
///
/// `t` counts from the first sample that was read of each record. The parts of the final
/// model are named after its effects; they sum to `final`. Parts that pass through an output stage
/// (a delay, a lag) are given before the stage, and the stage as the change that it makes.
///
/// # Errors
/// A message if the trace cannot be computed.
pub fn trace(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Result<String, String> {
    let unit = data.output_unit.as_deref();
    let last = &done.solution;
    let mut columns = vec![
        input(data),
        Column::new("measured", unit, data.target.clone()),
        Column::new("baseline", unit, ledger.declared.prediction.clone()),
        Column::new("final", unit, last.prediction.clone()),
        Column::new("residual", unit, last.residual.clone()),
    ];
    columns.extend(parts(data, last)?);
    let mut segments = vec!["dropped"; data.target.len()];
    for (name, rows) in [
        ("fit", &data.split.fit),
        ("selection", &data.split.selection),
        ("held-out", &data.split.held_out),
    ] {
        rows.iter().for_each(|&row| segments[row] = name);
    }
    csv(data, &segments, &columns)
}

/// The input through the filter.
pub(crate) fn input(data: &Prepared) -> Column {
    Column {
        name: "input".to_owned(),
        ..position(data, &data.input)
    }
}

/// The position of a channel through the filter.
pub(super) fn position(data: &Prepared, channel: &Channel) -> Column {
    let position: Vec<f64> = channel.motion.iter().map(|m| m.position).collect();
    let unit = channel.unit.as_deref();
    Column::new(channel.name.clone(), unit, data.filtered(&position))
}

/// The filtered contribution of each part of a model.
pub(crate) fn parts(data: &Prepared, solution: &Solution) -> Result<Vec<Column>, String> {
    let shares = Shares::of(data, solution).ok_or("the parts of the model have no values")?;
    let mut named: Vec<(String, Vec<f64>)> = Vec::new();
    if let Some(transmission) = shares.transmission {
        let names = ["gain", "hysteresis", "offset"].map(|part| format!("transmission.{part}"));
        named.extend(names.into_iter().zip(transmission));
    }
    for (term, share) in solution.structure.terms.iter().zip(shares.terms) {
        named.extend(share.map(|share| (term_name(data, term), share)));
    }
    if let (Some(table), Some(share)) = (&solution.structure.table, shares.table) {
        named.push((format!("unknown: {}", table.variable.words(data)), share));
    }
    let mut columns: Vec<Column> = Vec::with_capacity(named.len());
    for (name, share) in named {
        let like = |c: &&Column| c.name == name || c.name.starts_with(&format!("{name}#"));
        let name = match columns.iter().filter(like).count() {
            0 => name,
            // Two tones, two steps of the pretension.
            before => format!("{name}#{}", before + 1),
        };
        let values = data.filtered(&share);
        columns.push(Column::new(name, data.output_unit.as_deref(), values));
    }
    Ok(columns)
}

/// The lines: record (where there are several), time, segment, then the columns.
pub(crate) fn csv(
    data: &Prepared,
    segments: &[&str],
    columns: &[Column],
) -> Result<String, String> {
    let failed = |e: csv::Error| format!("the trace: {e}");
    let several = data.pieces.len() > 1;
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut line: Vec<String> = Vec::new();
    line.extend(several.then(|| "record".to_owned()));
    line.extend(["t [s]".to_owned(), "segment".to_owned()]);
    line.extend(columns.iter().map(Column::header));
    writer.write_record(&line).map_err(failed)?;
    let step = data.stride as f64 * data.dt;
    for piece in &data.pieces {
        for row in piece.rows.clone() {
            line.clear();
            line.extend(several.then(|| piece.path.clone()));
            // What is beyond nine digits is rounding.
            let t = format!("{:.9e}", (row - piece.rows.start) as f64 * step);
            line.push(t.parse::<f64>().unwrap_or_default().to_string());
            line.push(segments[row].to_owned());
            line.extend(columns.iter().map(|c| c.values[row].to_string()));
            writer.write_record(&line).map_err(failed)?;
        }
    }
    let bytes = writer.into_inner().map_err(|e| format!("the trace: {e}"))?;
    String::from_utf8(bytes).map_err(|e| format!("the trace: {e}"))
}
