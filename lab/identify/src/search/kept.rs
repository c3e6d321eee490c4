//! The part of a model that a move keeps.

use crate::model::structure::Structure;

/// The part of a model that a move keeps.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Kept {
    pub(super) dropped: Vec<usize>,
    pub(super) table: bool,
}

impl Kept {
    /// The kept part of a structure.
    pub(super) fn of(&self, structure: &Structure) -> Structure {
        let mut kept = structure.clone();
        let ids = structure.terms.ids();
        for &index in &self.dropped {
            kept.terms.remove(ids[index]);
        }
        if !self.table {
            kept.table = None;
        }
        kept
    }
}
