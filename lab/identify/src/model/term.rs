//! One effect in a model under fit.

use super::effects::entry;
use crate::problem::MOST_RECORDS;
use bowden::effect::Effect;
use bowden::model::Source;

/// The identity of a term among all terms that its structure has ever had.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct TermId(pub(super) u32);

/// One effect in a model under fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitTerm {
    /// The effect with its present shapes.
    pub effect: Effect<f64>,
    /// The motion that it reads.
    pub source: Source,
    /// The origin from which it measures position.
    pub origin: f64,
    /// The motion of the channel just before each record: an effect with memory depends on this
    /// unknown motion, so it is fitted.
    pub start: [f64; MOST_RECORDS],
}

impl FitTerm {
    /// Whether its gain is one of the linear gains: the gain of an output stage acts on all
    /// columns, and an input stage has a gain of one.
    #[must_use]
    pub fn is_linear(&self) -> bool {
        !self.effect.is_output_stage() && !self.effect.is_input_stage()
    }

    /// Whether the effect remembers motion from before the record.
    #[must_use]
    pub fn has_past(&self) -> bool {
        entry(self.effect.name()).is_some_and(|entry| entry.past)
    }

    /// Whether a shape is a moment of the record, which moves by whole samples.
    pub(crate) fn is_moment(&self, shape: usize) -> bool {
        entry(self.effect.name()).is_some_and(|entry| entry.is_moment(shape))
    }

    /// Whether the effect happens at a moment of the record.
    pub(crate) fn has_moment(&self) -> bool {
        (0..self.effect.info().shapes.len()).any(|shape| self.is_moment(shape))
    }
}
