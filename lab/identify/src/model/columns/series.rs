//! Input stages: what they do to every column, found by differences.

use super::{raw_columns, Moves, RawColumns};
use crate::model::structure::{FitTerm, Free, Role, Structure};
use crate::problem::Prepared;
use std::sync::Arc;

/// What an input stage adds to the output of a fitted model.
#[must_use]
pub fn series_column(
    data: &Prepared,
    structure: &Structure,
    (free, values): (&[Free], &[f64]),
    gains: &[f64],
    term: &FitTerm,
) -> Option<Vec<f64>> {
    let mut with = structure.clone();
    with.terms.push(*term);
    let output = |structure: &Structure| -> Option<Vec<f64>> {
        Some(raw_columns(data, structure, free, values)?.output(gains))
    };
    let (with, without) = (output(&with)?, output(structure)?);
    Some(with.iter().zip(&without).map(|(a, b)| a - b).collect())
}

/// The columns before the output stages.
pub(crate) fn early(raw: &RawColumns) -> &[Arc<Vec<f64>>] {
    match raw.stages.before.is_empty() {
        true => &raw.columns,
        false => &raw.stages.before,
    }
}

impl Moves {
    /// Adds the slopes in the shapes and states of the input stages.
    pub(super) fn add_series(
        &mut self,
        data: &Prepared,
        structure: &Structure,
        free: &[Free],
        values: &[f64],
    ) -> Option<()> {
        for (j, f) in free.iter().enumerate() {
            let (term, step) = match f.role {
                Role::Shape { term, .. } => (term, 1e-5 * values[j].abs().max(1e-9)),
                Role::Start { term, .. } => (term, 1e-5 * data.input.reach),
                _ => continue,
            };
            let own = structure.terms.find(term);
            if !own.is_some_and(|own| own.effect.is_input_stage()) {
                continue;
            }
            let at = |sign: f64| {
                let mut moved = values.to_vec();
                moved[j] += sign * step;
                raw_columns(data, structure, free, &moved)
            };
            let (up, down) = (at(1.0)?, at(-1.0)?);
            for (k, (a, b)) in early(&up).iter().zip(early(&down)).enumerate() {
                if a != b {
                    let slope = a.iter().zip(b.iter()).map(|(a, b)| (a - b) / (2.0 * step));
                    self.0[j].push((k, slope.collect()));
                }
            }
        }
        Some(())
    }
}
