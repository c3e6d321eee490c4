//! The coarse grid, and the results of local searches on it.

use crate::fit::search::descend;
use crate::model::structure::{Free, Structure};
use crate::problem::Prepared;
use std::sync::{Mutex, PoisonError};

/// Number of evaluations and tolerance of a local search.
pub(super) type Effort = (usize, f64);

/// The squared error that a search has reached, and its parameter values.
type Reached = Option<(f64, Vec<f64>)>;

/// The coarse grid of the refits, with the results of earlier searches. A model may be refitted
/// from the same start more than once: a rejected move returns as an alternative, or a set returns.
pub(super) struct Coarse<'a> {
    pub(super) data: &'a Prepared,
    known: Mutex<Vec<(Question, Reached)>>,
}

/// A local search. Its free parameters follow from the structure.
#[derive(PartialEq)]
struct Question {
    start: Vec<f64>,
    effort: Effort,
    structure: Structure,
}

impl<'a> Coarse<'a> {
    pub(super) fn new(data: &'a Prepared) -> Self {
        let known = Mutex::default();
        Self { data, known }
    }

    /// As [`descend`] on this grid.
    pub(super) fn descend(
        &self,
        structure: &Structure,
        free: &[Free],
        start: &[f64],
        effort: Effort,
    ) -> Reached {
        let question = Question {
            start: start.to_vec(),
            effort,
            structure: structure.clone(),
        };
        let all = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, reached)) = all().iter().find(|(known, _)| *known == question) {
            return reached.clone();
        }
        let (most, tolerance) = effort;
        let reached = descend(self.data, structure, free, start, most, tolerance);
        all().push((question, reached.clone()));
        reached
    }
}
