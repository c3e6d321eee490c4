//! The smallest effects that a search on a record would have found.

use super::asked::Asked;
use super::model::effects;
use super::record::{channel_name, RecordFacts};
use crate::conclude::intervals::{gain_unit, shape_unit, term_name};
use crate::foresight::power::{power as try_all, Answer, Question, Row};
use crate::problem::Prepared;
use crate::record::Record;

/// The table of the smallest detectable effects.
#[derive(Debug, Clone)]
pub struct PowerFacts {
    /// The path of the record.
    pub label: String,
    /// The record as it was read.
    pub record: RecordFacts,
    /// Names of all parts of the last model.
    pub model: Vec<String>,
    /// Number of trials for each amplitude.
    pub trials: usize,
    /// Number of trials without an injected effect in which the search found an effect.
    pub named_without: usize,
    /// The rows, sorted by family (the simplest first), name and channel.
    pub rows: Vec<PowerRow>,
}

/// One effect.
#[derive(Debug, Clone)]
pub struct PowerRow {
    /// Its family.
    pub family: &'static str,
    /// Its own name.
    pub effect: &'static str,
    /// Its name, with its channel unless it reads the input.
    pub name: String,
    /// The channel that it reads.
    pub channel: String,
    /// The injected shapes.
    pub shapes: Vec<ShapeFacts>,
    /// Unit of its gain, if the record states the units of its columns.
    pub gain_unit: Option<String>,
    /// The result.
    pub answer: Answer,
}

/// An injected shape.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeFacts {
    /// Its name in the effect's formula.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// Its unit, if the record states the units of its columns.
    pub unit: Option<String>,
}

/// Injects every requested effect and counts how often a search finds it.
///
/// `effects` contains names of effects or families. An empty list means all effects.
///
/// # Errors
/// A message if no model can be identified from the record or an effect is unknown.
pub fn power(
    record: &Record,
    asked: &Asked,
    question: &Question,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<PowerFacts, String> {
    let (data, structure) = asked.prepare_moving(std::slice::from_ref(record))?;
    let ledger = asked
        .search(&data, &structure, tell)
        .map_err(|message| format!("{}: {message}", record.path))?;
    let table = try_all(&data, &ledger, question, |done, all| {
        tell(&format!("testing: {done} of {all} effects"));
    })?;
    Ok(PowerFacts {
        label: record.path.clone(),
        record: RecordFacts::new(&data),
        model: effects(&data, ledger.last()),
        trials: table.trials,
        named_without: table.named_without,
        rows: table.rows.iter().map(|r| PowerRow::new(&data, r)).collect(),
    })
}

impl PowerRow {
    fn new(data: &Prepared, row: &Row) -> Self {
        let effect = row.term.effect;
        let shapes = effect.info().shapes.iter().enumerate();
        let shapes = shapes.filter_map(|(index, shape)| {
            Some(ShapeFacts {
                name: shape.name,
                value: effect.shape(index)?,
                unit: shape_unit(data, &row.term, index),
            })
        });
        Self {
            family: effect.info().family,
            effect: effect.name(),
            name: term_name(data, &row.term),
            channel: channel_name(data, row.term.source),
            shapes: shapes.collect(),
            gain_unit: gain_unit(data, &row.term),
            answer: row.answer.clone(),
        }
    }
}
