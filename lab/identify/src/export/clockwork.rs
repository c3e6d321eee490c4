//! Effects that belong to the record and not to the rig: they are not exported.
//!
//! A tone has a phase, a drift a start, a pretension step a time and a degradation a history: each
//! refers to the first sample of the record. In firmware they would restart at every power-on and
//! be wrong. They are fitted so that they do not disturb the others; then the model that is handed
//! over is fitted again without them, on the same segments: among the models that firmware can run
//! it is the one that fits best. What a pretension step leaves behind is the rig's, though
//! (`after_steps`).

use super::ROOM;
use crate::fit::Solution;
use crate::model::effects::of_the_record;
use crate::model::structure::Structure;
use crate::problem::Prepared;
use crate::score::hats::HATS;
use bowden::effect::Effect;

/// Whether an effect counts from the first sample of its record.
#[must_use]
pub fn is_clockwork(effect: &Effect<f64>) -> bool {
    counts_from_the_start(effect.info().family)
}

/// Whether the effects of a family count from the first sample of their record.
#[must_use]
pub fn counts_from_the_start(family: &'static str) -> bool {
    of_the_record(family).is_some()
}

/// Why an effect of this family is not handed over; empty where it is.
#[must_use]
pub fn because(family: &'static str) -> &'static str {
    of_the_record(family).unwrap_or_default()
}

/// The structure of a solution without the effects that `goes` names. A curve goes where the core has
/// none over its variable, and else has as many points as there is room for.
#[must_use]
pub fn without(solution: &Solution, goes: impl Fn(&Effect<f64>) -> bool) -> Structure {
    let mut structure = solution.structure.clone();
    structure.terms.retain(|t| !goes(&t.effect));
    let room = ROOM.saturating_sub(structure.terms.len()).clamp(2, HATS);
    let curve = structure.table.filter(|curve| curve.over().is_some());
    structure.table = curve.map(|curve| curve.with_fewer_knots(solution.curve_gains(), room));
    structure
}

/// Whether the record's own clockwork, or a curve, is part of a solution.
#[must_use]
pub fn has_clockwork(solution: &Solution) -> bool {
    let mut terms = solution.structure.terms.iter();
    solution.structure.table.is_some() || terms.any(|t| is_clockwork(&t.effect))
}

/// The name of a curve that the core does not have, where a solution has one.
#[must_use]
pub fn lost_curve_name(data: &Prepared, solution: &Solution) -> Option<String> {
    let curve = solution.structure.table.as_ref();
    let lost = curve.filter(|curve| curve.over().is_none());
    lost.map(|curve| curve.name(data))
}
