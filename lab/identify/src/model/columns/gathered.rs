//! The columns as they are collected, with known columns reused.

use super::series::early;
use super::RawColumns;
use crate::problem::Stretch;
use std::sync::Arc;

/// Columns before the output stages, in the order of their gains.
pub(super) struct Gathered<'a> {
    last: Option<&'a RawColumns>,
    pub(super) columns: Vec<Arc<Stretch>>,
    /// Whether a column is the same for all values of the free parameters.
    pub(super) fixed: Vec<bool>,
}

impl<'a> Gathered<'a> {
    pub(super) fn after(last: Option<&'a RawColumns>, count: usize) -> Self {
        Self {
            last,
            columns: Vec::with_capacity(count),
            fixed: Vec::with_capacity(count),
        }
    }

    /// Adds one column; it is computed only if it may have changed since the last time.
    pub(super) fn push(
        &mut self,
        fixed: bool,
        column: impl FnOnce() -> Option<Stretch>,
    ) -> Option<()> {
        self.push_all(fixed, 1, || Some(vec![column()?]))
    }

    /// Adds `count` columns that are computed together.
    pub(super) fn push_all(
        &mut self,
        fixed: bool,
        count: usize,
        columns: impl FnOnce() -> Option<Vec<Stretch>>,
    ) -> Option<()> {
        let next = self.columns.len();
        let known = self.last.filter(|_| fixed).map(early);
        match known.and_then(|all| all.get(next..next + count)) {
            Some(known) => self.columns.extend_from_slice(known),
            None => self.columns.extend(columns()?.into_iter().map(Arc::new)),
        }
        self.fixed.resize(self.columns.len(), fixed);
        Some(())
    }
}
