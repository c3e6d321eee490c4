//! Which of several alike explains it best once it is refitted beside the model.

use crate::fit::{glance, Solution};
use crate::model::catalogue::{simplicity, Candidate};
use crate::model::structure::Structure;
use crate::problem::Prepared;
use crate::score::scan::Finding;

/// A rival removes at least this share of the squared error that the best removes ...
const RIVAL_SHARE: f64 = 0.90;
/// ... and leaves at most this many times what the best leaves. Where one effect is
/// right, it leaves noise, and what only resembles it leaves many times that.
const RIVAL_REST: f64 = 2.0;

/// Where the best comes down to the noise, the simplest of the equals is named that leaves
/// at most this many times what the best leaves: two hundred independent values make the
/// best then e^9.5 times likelier.
const NAMED_REST: f64 = 1.1;
/// Error that counts as noise, in units of the estimated floor.
const AT_NOISE: f64 = 1.2;

/// Who explains it best once its shapes and the hysteresis are refitted.
pub(crate) struct Duel {
    pub(crate) candidate: Candidate,
    pub(crate) structure: Structure,
    pub(crate) stage_gain: f64,
    pub(crate) rivals: Vec<Candidate>,
    /// Squared error that is left, as a share of that before.
    pub(crate) rest: f64,
}

/// Refits every contender beside the present model; of those that do equally well the
/// simplest is named and the others are its rivals.
pub(crate) fn duel(data: &Prepared, now: &Solution, finding: &Finding) -> Option<Duel> {
    use rayon::prelude::*;
    let coarse = data.for_search(true);
    let (before, ..) = glance(&coarse, &now.structure, now, 0.0)?;
    let outcomes: Vec<Option<(f64, Structure, f64)>> = finding
        .contenders
        .par_iter()
        .map(|(candidate, coefficient)| {
            let mut structure = now.structure.clone();
            structure.terms.push(candidate.term);
            glance(&coarse, &structure, now, *coefficient)
        })
        .collect();
    let fitted: Vec<(Candidate, f64, Structure, f64)> = finding
        .contenders
        .iter()
        .zip(outcomes)
        .filter_map(|((candidate, _), outcome)| {
            outcome.map(|(sse, structure, gain)| (*candidate, sse, structure, gain))
        })
        .collect();
    let best = fitted
        .iter()
        .map(|(_, sse, ..)| *sse)
        .fold(f64::INFINITY, f64::min);
    let as_good =
        |sse: f64| before - sse >= RIVAL_SHARE * (before - best) && sse <= RIVAL_REST * best;
    let mut equals: Vec<(Candidate, f64, Structure, f64)> = fitted
        .into_iter()
        .filter(|(_, sse, ..)| as_good(*sse))
        .collect();
    // Where much else is missing, what each of them leaves says little.
    let at_noise = is_noise(
        data.noise_floor,
        (best / data.split.fit.len() as f64).sqrt(),
    );
    let clearly_more = |sse: f64| at_noise && sse > NAMED_REST * best;
    equals.sort_by(|a, b| {
        clearly_more(a.1)
            .cmp(&clearly_more(b.1))
            .then(simplicity(&a.0.term.effect).cmp(&simplicity(&b.0.term.effect)))
            .then(a.1.total_cmp(&b.1))
    });
    let mut equals = equals.into_iter();
    let (candidate, sse, structure, stage_gain) = equals.next()?;
    let mut rivals: Vec<Candidate> = Vec::new();
    for (rival, ..) in equals {
        let same = |other: &Candidate| {
            (other.family, other.term.source) == (rival.family, rival.term.source)
        };
        if !same(&candidate) && !rivals.iter().any(same) {
            rivals.push(rival);
        }
    }
    Some(Duel {
        candidate,
        structure,
        stage_gain,
        rivals,
        rest: sse / before,
    })
}

/// Whether an error counts as noise.
pub(crate) fn is_noise(floor: f64, rmse: f64) -> bool {
    rmse <= AT_NOISE * floor
}
