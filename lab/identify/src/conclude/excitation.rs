//! Which motion would show a parameter that the record leaves open.

use crate::fit::Solution;
use crate::model::effects::shown_by;
use crate::model::structure::Role;

/// What would show a linear gain of the transmission.
pub(crate) const TRANSMISSION: &str = "full strokes past the knee, in both directions";

/// What would show a non-linear parameter.
pub(crate) fn of_role(solution: &Solution, role: Role) -> &'static str {
    let name = |term: usize| solution.structure.terms[term].effect.name();
    match role {
        Role::Rho => "reversals at several amplitudes, the smallest well inside the knee",
        Role::Sigma => "full strokes past the knee, then slow reversals of several sizes",
        Role::N => "slow full strokes that dwell about the knee",
        Role::Eta0 { .. } => "a full stroke just before the record; it belongs to this record only",
        Role::Start { .. } => {
            "a known motion just before the record; it belongs to this record only"
        }
        Role::Origin { .. } => "strokes on both sides of the origin",
        Role::Shape { term, index } => {
            let names = solution.structure.terms[term].effect.shape_names();
            match names.get(index) {
                // The width of a change of sign, whatever it belongs to.
                Some(&"v_e") => shown_by("coulomb"),
                _ => shown_by(name(term)),
            }
        }
        Role::Stage { term } => shown_by(name(term)),
    }
}
