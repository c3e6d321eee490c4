//! Which motion would show a parameter that the record leaves open.

use crate::fit::Solution;
use crate::model::effects::shown_by;
use crate::model::structure::{Role, TermId};

/// What would show a linear gain of the transmission.
pub(crate) const TRANSMISSION: &str = "full strokes past the knee, in both directions";

/// What would show a non-linear parameter.
pub(crate) fn of_role(solution: &Solution, role: Role) -> &'static str {
    let own = |term: TermId| {
        let term = solution.structure.terms.find(term);
        term.map_or("", |t| shown_by(t.effect.name()))
    };
    match role {
        Role::Rho => "reversals at several amplitudes, the smallest well inside the knee",
        Role::Sigma => "full strokes past the knee, then slow reversals of several sizes",
        Role::N => "slow full strokes that dwell near the knee",
        Role::Eta0 { .. } => "a full stroke just before the record; it belongs to this record only",
        Role::Start { .. } => {
            "a known motion just before the record; it belongs to this record only"
        }
        Role::Origin { .. } => "strokes on both sides of the origin",
        Role::Shape { term, index } => {
            let fit = solution.structure.terms.find(term);
            match fit.and_then(|t| t.effect.shape_names().get(index).copied()) {
                // The width of a change of sign, whatever it belongs to.
                Some("v_e") => shown_by("coulomb"),
                _ => own(term),
            }
        }
        Role::Stage { term } => own(term),
    }
}
