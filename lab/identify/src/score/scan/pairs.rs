//! The two candidates that take most together, where none does by itself.

use super::{Workspace, EXCITED};
use crate::fit::Solution;
use crate::model::catalogue::Candidate;
use crate::problem::Prepared;

/// Two effects, each with the coefficient that it has beside the other.
pub(crate) type Pair = [(Candidate, f64); 2];

/// The pairs that take most of what a model leaves, at their trial shapes: the best first,
/// each two names once.
pub(crate) fn pairs(
    data: &Prepared,
    solution: &Solution,
    candidates: &[Candidate],
    most: usize,
) -> Vec<Pair> {
    let space = Workspace::new(data, solution, candidates);
    let alone: Vec<(f64, f64)> = space
        .columns
        .iter()
        .map(|column| (column.norm_squared(), column.dot(&space.residual)))
        .collect();
    let of = |k: usize| candidates[space.kept[k]];
    let mut found: Vec<(f64, usize, usize, f64, f64)> = Vec::new();
    for (i, &(a, score_a)) in alone.iter().enumerate() {
        for (j, &(b, score_b)) in alone.iter().enumerate().skip(i + 1) {
            let inner = space.columns[i].dot(&space.columns[j]);
            let determinant = a * b - inner * inner;
            if of(i).is_like(&of(j)) || determinant < EXCITED * a * b {
                continue;
            }
            let one = (score_a * b - score_b * inner) / determinant;
            let two = (score_b * a - score_a * inner) / determinant;
            let gain = one * score_a + two * score_b;
            let entry = (gain, i, j, one / space.norms[i], two / space.norms[j]);
            let alike = |&(_, p, q, ..): &(f64, usize, usize, f64, f64)| {
                of(p).is_like(&of(i)) && of(q).is_like(&of(j))
            };
            match found.iter_mut().find(|other| alike(other)) {
                Some(slot) if slot.0 < gain => *slot = entry,
                Some(_) => {}
                None => found.push(entry),
            }
        }
    }
    found.sort_by(|p, q| q.0.total_cmp(&p.0));
    found.truncate(most);
    found
        .into_iter()
        .map(|(_, i, j, one, two)| [(of(i), one), (of(j), two)])
        .collect()
}
