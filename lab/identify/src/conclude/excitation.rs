//! Which motion would show a parameter that the record leaves open.

use crate::fit::Solution;
use crate::model::structure::Role;
use bowden::effect::Family;

/// What would show a linear gain of the transmission.
pub(crate) const TRANSMISSION: &str = "full strokes past the knee, in both directions";

/// What would show a non-linear parameter.
pub(crate) fn of_role(solution: &Solution, role: Role) -> &'static str {
    let family = |term: usize| solution.structure.terms[term].effect.family();
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
                Some(&"v_e") => of_family(Family::Coulomb),
                _ => of_family(family(term)),
            }
        }
        Role::Stage { term } => of_family(family(term)),
    }
}

/// What would show an effect.
pub(crate) fn of_family(family: Family) -> &'static str {
    match family {
        Family::Viscous => "speeds that vary tenfold",
        Family::Drag => "speeds up to the highest that the rig allows",
        Family::Coulomb => "slow passages through standstill, and fast ones",
        Family::Stribeck => "slow passages: steady speeds below and above v_s",
        Family::Asymmetry => "the same strokes in both directions, at several speeds",
        Family::LoadFriction | Family::Capstan | Family::Direction => {
            "the same motion under several loads"
        }
        Family::Inertia => "the same speeds at several accelerations",
        Family::Stiffness | Family::Gravity | Family::Ripple | Family::Saturation => {
            "slow strokes over the whole range of position"
        }
        Family::PositionFriction => "short strokes at several positions",
        Family::Backlash => "reversals with strokes shorter and longer than the play",
        Family::Delay | Family::Lag => "faster motion: several tones up to the cut-off",
        Family::Creep => "steps with holds of several time constants",
        Family::Rate => "the same stroke at several speeds",
        Family::Presliding => "small reversals inside large strokes",
        Family::Pinching => "full strokes, and strokes that turn near the centre",
        Family::Degradation => "many full strokes: a longer record",
        Family::Pretension => "as much motion before the step as after it",
        Family::Temperature => "the same motion over a wider range of temperature",
        Family::Crosstalk => "motion of that channel apart from the input",
        Family::Drift | Family::Tone => "a longer record",
        _ => "strokes over the whole range, in both directions",
    }
}
