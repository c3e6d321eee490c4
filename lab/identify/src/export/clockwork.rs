//! Effects that belong to the record and not to the rig: they are not handed over.
//!
//! A tone has a phase, a drift a beginning, a pretension step a moment and a degradation a
//! past: each counts from the first sample of the record. In firmware they would begin again
//! with every switch-on, and be wrong. They are fitted so that they do not disturb the
//! others; then the model that is handed over is fitted again without them, on the same
//! segments: among the models that firmware can run it is the one that fits best. What a pretension
//! step leaves behind is the rig's, though (`after_steps`).

use crate::fit::Solution;
use crate::model::effects::of_the_record;
use crate::model::structure::Structure;
use crate::problem::Prepared;
use bowden::effect::{Effect, Family};

/// Whether an effect counts from the first sample of its record.
#[must_use]
pub fn is_clockwork(effect: &Effect<f64>) -> bool {
    counts_from_the_start(effect.family())
}

/// Whether the effects of a family count from the first sample of their record.
#[must_use]
pub fn counts_from_the_start(family: Family) -> bool {
    of_the_record(family).is_some()
}

/// Why an effect of this family is not handed over; empty where it is.
#[must_use]
pub fn because(family: Family) -> &'static str {
    of_the_record(family).unwrap_or_default()
}

/// The structure of a solution without the effects that `goes` names and without the table of
/// what has no name.
#[must_use]
pub fn without(solution: &Solution, goes: impl Fn(&Effect<f64>) -> bool) -> Structure {
    let mut structure = solution.structure.clone();
    structure.table = None;
    structure.terms.retain(|t| !goes(&t.effect));
    structure
}

/// Whether the record's own clockwork, or its table, is part of a solution.
#[must_use]
pub fn has_clockwork(solution: &Solution) -> bool {
    let mut terms = solution.structure.terms.iter();
    solution.structure.table.is_some() || terms.any(|t| is_clockwork(&t.effect))
}

/// The name of the table of what has no name, where there is one.
#[must_use]
pub fn table_name(data: &Prepared, solution: &Solution) -> Option<String> {
    let table = solution.structure.table.as_ref()?;
    Some(format!("the table over {}", table.variable.words(data)))
}
