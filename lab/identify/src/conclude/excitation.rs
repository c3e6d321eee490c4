//! The motion that would identify a parameter that the record does not identify.

use crate::fit::Solution;
use crate::model::effects::shown_by;
use crate::model::structure::{Role, TermId};
use crate::model::turns;
use crate::problem::{Piece, Prepared};
use crate::scale::TWENTIETH;

/// Number of reversals of the input on the fit segment, by more than a twentieth of its range.
fn reversals(data: &Prepared) -> usize {
    let back = TWENTIETH * 2.0 * data.input.reach;
    let of = |piece: &Piece| match piece.rows_of(&data.split.fit) {
        [first, .., last] => turns(
            &data.input,
            &(first * data.stride..last * data.stride + 1),
            back,
        )
        .len(),
        _ => 0,
    };
    data.pieces.iter().map(of).sum()
}

/// Why a record with fewer than two reversals determines neither sigma nor n: in a single stroke a
/// sharper knee is equivalent to another rho, and the unloading branch is missing. `None` if there
/// are more reversals.
pub(super) fn without_reversals(data: &Prepared) -> Option<String> {
    (reversals(data) < 2).then(|| {
        format!(
            "fewer than two reversals of {} on the fit segment",
            data.input.name
        )
    })
}

/// The motion that would identify a linear gain of the transmission.
pub(crate) const TRANSMISSION: &str = "full strokes past the knee, in both directions";

/// The motion that would identify a non-linear parameter.
pub(crate) fn of_role(solution: &Solution, role: Role) -> &'static str {
    let own = |term: TermId| {
        let term = solution.structure.terms.find(term);
        term.map_or("", |t| shown_by(t.effect.name()))
    };
    match role {
        Role::Rho => "reversals at several amplitudes, the smallest well below the knee",
        Role::Sigma => "full strokes past the knee, then slow reversals of several sizes",
        Role::N => "slow full strokes that dwell near the knee",
        Role::Eta0 { .. } => {
            "a full stroke just before the record (the parameter belongs only to this record)"
        }
        Role::Start { .. } => {
            "a known motion just before the record (the parameter belongs only to this record)"
        }
        Role::Origin { .. } => "strokes on both sides of the origin",
        Role::Shape { term, index } => {
            let fit = solution.structure.terms.find(term);
            match fit
                .and_then(|t| t.effect.info().shapes.get(index))
                .map(|shape| shape.name)
            {
                // The width of a change of sign, whatever it belongs to.
                Some("v_e") => shown_by("coulomb"),
                _ => own(term),
            }
        }
        Role::Stage { term } => own(term),
    }
}
