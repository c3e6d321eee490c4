//! Starting points of the searches.

use super::Solution;
use crate::model::structure::{Free, Range, Role, Structure};
use crate::problem::Prepared;

/// Values of the free parameters of an earlier fit. Values of terms that have been removed since
/// belong to no parameter.
#[derive(Debug, Clone)]
pub struct Known(Vec<(Role, f64)>);

impl Known {
    /// The values of a solution.
    #[must_use]
    pub fn of(solution: &Solution) -> Self {
        let roles = solution.free.iter().map(|f| f.role);
        Self(roles.zip(solution.values.iter().copied()).collect())
    }

    fn value(&self, role: Role) -> Option<f64> {
        self.0.iter().find(|(r, _)| *r == role).map(|(_, v)| *v)
    }
}

/// Eight deterministic starts, and the present optimum if there is one.
pub(super) fn starts(
    data: &Prepared,
    structure: &Structure,
    free: &[Free],
    from: Option<&Known>,
    stage_gain: f64,
) -> Vec<Vec<f64>> {
    let x = data.input.reach;
    // rho·X from nearly linear to nearly a relay, each with a soft and a sharp knee.
    const GRID: [(f64, f64, f64); 8] = [
        (1.0, 0.8, 1.2),
        (3.0, 0.6, 2.0),
        (3.0, 3.0, 1.3),
        (8.0, 0.7, 1.2),
        (8.0, 2.0, 2.5),
        (25.0, 0.8, 1.5),
        (60.0, 1.5, 1.2),
        (1.5, 30.0, 3.0),
    ];
    let present = |role: Role| from.and_then(|s| s.value(role));
    let at = |hysteresis: Option<(f64, f64, f64)>| -> Vec<f64> {
        free.iter()
            .map(|f| match (f.role, hysteresis) {
                (Role::Rho, Some((rho, ..))) => rho / x,
                (Role::Sigma, Some((_, sigma, _))) => sigma,
                (Role::N, Some((.., n))) => n,
                (Role::Eta0 { .. }, Some(_)) => f.range.inside(present(f.role).unwrap_or(0.0)),
                (Role::Stage { .. }, _) => {
                    present(f.role).unwrap_or_else(|| f.range.inside(stage_gain))
                }
                (Role::Shape { term, index }, _) => {
                    let term = structure.terms.find(term);
                    term.and_then(|t| t.effect.shape(index)).unwrap_or(0.0)
                }
                (Role::Origin { term }, _) => structure.terms.find(term).map_or(0.0, |t| t.origin),
                (Role::Start { term, record }, _) => {
                    structure.terms.find(term).map_or(0.0, |t| t.start[record])
                }
                (role, None) => present(role).unwrap_or(0.5),
            })
            .collect()
    };
    let mut all = Vec::new();
    if from.is_some() || !structure.hysteresis {
        all.push(at(None));
    }
    if structure.hysteresis {
        all.extend(GRID.iter().map(|&start| at(Some(start))));
    } else {
        // Without hysteresis only the effects' own shapes are searched: wider and narrower.
        for scale in [0.3, 3.0] {
            all.push(
                free.iter()
                    .zip(at(None))
                    .map(|(f, v)| match f.range {
                        Range::Log(lo, hi) => (v * scale).clamp(lo, hi),
                        _ => v,
                    })
                    .collect(),
            );
        }
    }
    all
}
