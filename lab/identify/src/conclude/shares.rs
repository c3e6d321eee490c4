//! The contribution of each part of a fitted model to its output.

use crate::fit::Solution;
use crate::model::columns::{by_stage, early, raw_columns};
use crate::problem::Prepared;

/// The parts of a model's output on the work grid, before the filter: they sum to it.
///
/// An output stage acts on the sum of all other parts. The other parts are therefore given before
/// the stages, and the part of a stage is the change that it makes. An input stage has no separate
/// part: it changes the part of the transmission.
#[derive(Debug, Clone)]
pub struct Shares {
    /// The transmission's gain, hysteresis and constant, if there is a transmission.
    pub transmission: Option<[Vec<f64>; 3]>,
    /// One for each term of the structure; `None` for an input stage.
    pub terms: Vec<Option<Vec<f64>>>,
    /// The table of the unmodelled curve, if there is one.
    pub table: Option<Vec<f64>>,
}

impl Shares {
    /// The parts of a solution; `None` if the record lacks a channel that the solution reads.
    #[must_use]
    pub fn of(data: &Prepared, solution: &Solution) -> Option<Self> {
        let Solution {
            structure,
            free,
            values,
            gains,
            ..
        } = solution;
        let raw = raw_columns(data, structure, free, values)?;
        let columns = early(&raw);
        let sum = |indices: &mut dyn Iterator<Item = usize>| {
            let mut sum = vec![0.0; data.work_len()];
            for k in indices {
                columns[k].add_to(&mut sum, gains[k]);
            }
            sum
        };
        let base = structure.base();
        let transmission = structure
            .hysteresis
            .then(|| [0, 1, 2].map(|part| sum(&mut (part..base).step_by(3))));
        let first = columns.len() - structure.table_gains();
        let table = (structure.table_gains() > 0).then(|| sum(&mut (first..columns.len())));
        let mut changes = by_stage(&raw, sum(&mut (0..columns.len()))).into_iter();
        let mut linear = base..first;
        let terms = structure.terms.iter().map(|term| {
            if term.effect.is_output_stage() {
                return changes.next();
            }
            let own = term.is_linear().then(|| linear.next()).flatten()?;
            Some(sum(&mut std::iter::once(own)))
        });
        Some(Self {
            terms: terms.collect(),
            transmission,
            table,
        })
    }
}
