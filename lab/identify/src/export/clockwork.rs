//! Effects that belong to the record and not to the rig: they are not exported.
//!
//! A tone has a phase, a drift a start, a pretension step a time and a degradation a history: each
//! refers to the first sample of the record. In firmware they would restart at every power-on and
//! be wrong. They are fitted so that they do not disturb the other terms. The exported model is
//! then refitted without them on the same segments, so it is the best fit among the models that
//! firmware can run. The state after a pretension step, however, belongs to the rig
//! (`after_steps`).

use super::ROOM;
use crate::fit::Solution;
use crate::model::effects::of_the_record;
use crate::model::structure::Structure;
use crate::problem::Prepared;
use crate::score::hats::HATS;
use bowden::effect::Effect;

/// Whether an effect refers to the first sample of its record.
#[must_use]
pub fn is_clockwork(effect: &Effect<f64>) -> bool {
    counts_from_the_start(effect.info().family)
}

/// Whether the effects of a family refer to the first sample of their record.
#[must_use]
pub fn counts_from_the_start(family: &'static str) -> bool {
    of_the_record(family).is_some()
}

/// The reason why an effect of this family is not exported; empty if it is exported.
#[must_use]
pub fn because(family: &'static str) -> &'static str {
    of_the_record(family).unwrap_or_default()
}

/// The structure of a solution without the effects that `goes` selects. A curve is removed if the
/// core has none over its variable; otherwise it has as many points as the model has room for.
#[must_use]
pub fn without(solution: &Solution, goes: impl Fn(&Effect<f64>) -> bool) -> Structure {
    let mut structure = solution.structure.clone();
    structure.terms.retain(|t| !goes(&t.effect));
    let room = ROOM.saturating_sub(structure.terms.len()).clamp(2, HATS);
    let curve = structure.table.filter(|curve| curve.over().is_some());
    structure.table = curve.map(|curve| curve.with_fewer_knots(solution.curve_gains(), room));
    structure
}

/// Whether a solution contains a curve, or effects that refer to the first sample.
#[must_use]
pub fn has_clockwork(solution: &Solution) -> bool {
    let mut terms = solution.structure.terms.iter();
    solution.structure.table.is_some() || terms.any(|t| is_clockwork(&t.effect))
}

/// The name of a curve that the core does not support, if a solution has one.
#[must_use]
pub fn lost_curve_name(data: &Prepared, solution: &Solution) -> Option<String> {
    let curve = solution.structure.table.as_ref();
    let lost = curve.filter(|curve| curve.over().is_none());
    lost.map(|curve| curve.name(data))
}
