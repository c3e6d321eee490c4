//! The names once more, when all are there.
//!
//! A name is chosen while the others are still missing. What it then takes of their work is
//! no merit of its own: a Coulomb friction and a quadratic drag stand in for a Stribeck
//! friction and a viscous one as long as neither of these has its partner. So each is taken
//! out of the whole again and has to be found anew, by the scan and through all gates, beside
//! the others. What is found in its place and leaves no more takes the place, and who its
//! rivals are is decided there.

use super::attempt::{attempt, Accepted};
use super::duel::is_noise;
use super::joint::{chain, drop_terms, these};
use super::unknown::over;
use crate::fit::{glance_from, Known, Solution};
use crate::ledger::{Gate, Ledger, Rejection};
use crate::model::catalogue::Candidate;
use crate::model::Variable;
use crate::problem::Prepared;
use crate::score::scan::{Pair, Regime};

/// With more names than this the later ones carry little meaning, and each costs a scan.
const MOST: usize = 5;
/// So often all are gone through: one that has changed may change another.
const SWEEPS: usize = 2;
/// What takes a place leaves at most this many times what was left before, on the fit and
/// on the stop-check.
const NO_MORE: f64 = 1.01;

/// Two in the place of two leave at most this many times what was left before.
const CLEARLY_LESS: f64 = 0.95;
/// With so many names there may be fewer that do as well.
const MANY: usize = 4;
/// So many pairs are tried in the place of one.
const TWOS: usize = 3;

/// The rounds anew.
pub(crate) struct Revisited {
    pub(crate) rounds: Vec<Accepted>,
    /// The names whose places others have taken.
    pub(crate) gone: Vec<Rejection>,
}

/// Goes through the rounds; `None` where nothing changes.
pub(crate) fn revisited(data: &Prepared, ledger: &Ledger) -> Option<Revisited> {
    let count = ledger.rounds.len();
    if ledger.unknown.is_some() || !(2..=MOST).contains(&count) {
        return None;
    }
    let own = ledger.declared.structure.terms.len();
    let mut full = ledger.named().clone();
    let mut rounds: Vec<Accepted> = ledger.rounds.iter().map(Accepted::from).collect();
    let mut gone = Vec::new();
    let mut changed = false;
    for _ in 0..SWEEPS {
        let mut moved = false;
        // What is found anew comes back at the end, so that the next one moves up.
        let mut place = 0;
        for _ in 0..count {
            let without = drop_terms(data, &full, &[own + place])?;
            let tried = attempt(data, &without, |_| ());
            let found = tried.accepted.filter(|_| tried.regime == Regime::Blocks);
            let old = &mut rounds[place];
            match found {
                Some(new) if new.candidate.is_like(&old.candidate) => {
                    changed |= differ(&new.rivals, &old.rivals) || old.p.is_none();
                    old.rivals = new.rivals;
                    old.p = old.p.or(new.p);
                    place += 1;
                }
                Some(new) if no_more(data, &new.solution, &full) => {
                    moved = true;
                    full = new.solution.clone();
                    let Accepted { candidate, p, .. } = rounds.remove(place);
                    let gate = Gate::Superseded;
                    gone.push(Rejection { candidate, gate, p });
                    rounds.push(new);
                }
                Some(new) if new.rivals.iter().any(|rival| rival.is_like(&old.candidate)) => {
                    // As good, and simpler, but not once it is fitted to the end.
                    let others = std::iter::once(new.candidate).chain(new.rivals);
                    let others: Vec<Candidate> = others
                        .filter(|other| !other.is_like(&old.candidate))
                        .collect();
                    changed |= differ(&others, &old.rivals);
                    old.rivals = others;
                    place += 1;
                }
                _ => place += 1,
            }
        }
        if !moved {
            break;
        }
    }
    if let Some((least, others)) = by_twos(data, &full, &mut rounds, own) {
        full = least;
        gone.extend(others);
    }
    if gone.is_empty() && !changed {
        return None;
    }
    let rounds = chain(data, &ledger.declared, &full, rounds)?;
    Some(Revisited { rounds, gone })
}

/// Two names over the same variable, and the two, or the one, that explain it better.
///
/// A curve over one variable can be bent from many pieces, and the piece that is found
/// first decides of the second. So both are taken out, and what else two pieces can make of
/// the variable is tried through all gates.
fn by_twos(
    data: &Prepared,
    full: &Solution,
    rounds: &mut Vec<Accepted>,
    own: usize,
) -> Option<(Solution, [Rejection; 2])> {
    // Where nothing is left to gain, only one in the place of two is a gain.
    let at_noise = is_noise(data.noise_floor, full.rmse.fit);
    if at_noise && rounds.len() < MANY {
        return None;
    }
    for second in 1..rounds.len() {
        for first in 0..second {
            let (one, other) = (&rounds[first].candidate, &rounds[second].candidate);
            let also = other.variables();
            let mut shared = one.variables();
            shared.retain(|variable| also.contains(variable));
            if shared.is_empty() {
                continue;
            }
            let places = [own + second, own + first];
            if let Some((found, least)) = instead_of(data, full, places, &shared, at_noise) {
                let gone = [second, first].map(|place| {
                    let Accepted { candidate, p, .. } = rounds.remove(place);
                    let gate = Gate::Superseded;
                    Rejection { candidate, gate, p }
                });
                rounds.extend(found);
                return Some((least, gone));
            }
        }
    }
    None
}

/// What over these variables leaves clearly less than the terms at two places do.
fn instead_of(
    data: &Prepared,
    full: &Solution,
    places: [usize; 2],
    variables: &[Variable],
    at_noise: bool,
) -> Option<(Vec<Accepted>, Solution)> {
    let coarse = data.for_search(true);
    let (now, ..) = glance_from(&coarse, &full.structure, &Known::of(full), 0.0)?;
    let without = drop_terms(data, full, &places)?;
    let known = Known::of(&without);
    let near = |pair: &Pair| {
        let mut structure = without.structure.clone();
        structure.terms.extend(pair.iter().map(|(c, _)| c.term));
        let glance = glance_from(&coarse, &structure, &known, 0.0);
        glance.is_some_and(|(sse, ..)| sse <= now)
    };
    let found = over(data, &without, variables, TWOS)
        .iter()
        .filter(|pair| near(pair))
        .map(|pair| these(data, &without, pair))
        .filter(|found| found.len() <= if at_noise { 1 } else { 2 })
        .filter_map(|found| Some((found.last()?.solution.clone(), found)))
        .min_by(|a, b| a.0.sse(data).total_cmp(&b.0.sse(data)));
    let (least, found) = found?;
    let most = if at_noise { NO_MORE } else { CLEARLY_LESS };
    let better =
        least.sse(data) <= most * full.sse(data) && least.rmse.stop <= NO_MORE * full.rmse.stop;
    better.then_some((found, least))
}

fn differ(some: &[Candidate], others: &[Candidate]) -> bool {
    some.len() != others.len() || !some.iter().zip(others).all(|(a, b)| a.is_like(b))
}

fn no_more(data: &Prepared, new: &Solution, old: &Solution) -> bool {
    new.sse(data) <= NO_MORE * old.sse(data) && new.rmse.stop <= NO_MORE * old.rmse.stop
}
