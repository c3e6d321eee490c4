//! Several effects at once, where each is turned down because the others are missing.
//!
//! What is missing beside it acts on every gate as noise: an effect may be worse on the
//! stop-check, or on many blocks, only because another one shows there. So the whole
//! forward set is fitted together and thinned out by refitting; then each that is left
//! is taken out again and has to be found anew, by the scan and through all gates, now
//! beside the others. No gate is lowered.

use super::attempt::{attempt, Accepted, Attempt};
use crate::fit::{fit_from, glance_from, Known, Solution};
use crate::ledger::{Gate, Ledger, Rejection, Round};
use crate::model::catalogue::Candidate;
use crate::model::structure::Structure;
use crate::problem::Prepared;
use crate::score::scan::Regime;

/// The forward set takes at least this share of the squared error ...
const WORTH: f64 = 0.3;
/// ... and fitted together leaves at most this one.
const LEFT: f64 = 0.6;
/// A member whose removal raises the squared error by less than this is thinned out.
const NEEDED: f64 = 0.05;
/// At most this many are fitted together.
const MEMBERS: usize = 6;

/// The effects that pass all gates beside each other, in the order in which they are
/// added, each with the model up to it; empty where there are none.
pub(crate) fn joint(
    data: &Prepared,
    now: &Solution,
    tried: &Attempt,
    most: usize,
) -> Vec<Accepted> {
    let set = &tried.forward[..tried.forward.len().min(most).min(MEMBERS)];
    if tried.regime == Regime::Effect || tried.forward_share < WORTH || set.len() < 2 {
        return Vec::new();
    }
    these(data, now, set)
}

/// Whether more would be tried at once if there were room for more than `most`.
pub(crate) fn is_cut(tried: &Attempt, most: usize) -> bool {
    tried.regime == Regime::Blocks
        && tried.forward_share >= WORTH
        && tried.forward.len().min(MEMBERS) > most
}

/// The same, of a set that is given.
pub(crate) fn these(data: &Prepared, now: &Solution, set: &[(Candidate, f64)]) -> Vec<Accepted> {
    search(data, now, set).unwrap_or_default()
}

fn search(data: &Prepared, now: &Solution, set: &[(Candidate, f64)]) -> Option<Vec<Accepted>> {
    let own = now.structure.terms.len();
    let mut full = together(data, now, set)?;
    if full.sse(data) > LEFT * now.sse(data) {
        return None;
    }
    full = thinned(data, full, own)?;
    let mut found: Vec<Accepted> = Vec::new();
    // Each is taken from the front and, if it is found again, comes back at the end.
    for _ in own..full.structure.terms.len() {
        let without = drop_terms(data, &full, &[own])?;
        match attempt(data, &without, |_| ()).accepted {
            Some(accepted) => {
                full = accepted.solution.clone();
                found.push(accepted);
            }
            None => full = without,
        }
    }
    if found.is_empty() || full.sse(data) > LEFT * now.sse(data) {
        return None;
    }
    chain(data, now, &full, found)
}

/// All of the set beside the present model.
fn together(data: &Prepared, now: &Solution, set: &[(Candidate, f64)]) -> Option<Solution> {
    let mut structure = now.structure.clone();
    let mut known = Known::of(now);
    for (candidate, coefficient) in set {
        known.set_stage(structure.terms.len(), *coefficient);
        structure.terms.push(candidate.term);
    }
    fit_from(data, &structure, Some(&known), 0.0)
}

/// What is left of the rounds when those are taken back whose work the later ones, or the
/// table, do as well.
pub(crate) struct Kept {
    /// The rounds that are needed.
    pub(crate) rounds: Vec<Accepted>,
    /// The others.
    pub(crate) gone: Vec<Rejection>,
    /// The model of the rounds that are needed, with the table where there is one.
    pub(crate) full: Solution,
}

/// The rounds that are needed; `None` where nothing changes.
pub(crate) fn superseded(data: &Prepared, ledger: &Ledger) -> Option<Kept> {
    // One round stands for itself, unless there is a table.
    let least = usize::from(ledger.unknown.is_none());
    let own = ledger.declared.structure.terms.len();
    let mut full = ledger.last().clone();
    let mut kept: Vec<Accepted> = ledger.rounds.iter().map(Accepted::from).collect();
    let mut gone = Vec::new();
    while kept.len() > least {
        let Some(term) = replaceable(data, &full, own) else {
            break;
        };
        let Some(shorter) = drop_terms(data, &full, &[term]) else {
            break;
        };
        // The quick look does not count: what is left has to be as good once it is fitted,
        // also where no search has looked.
        let as_good = shorter.sse(data) * (1.0 - NEEDED) < full.sse(data)
            && shorter.rmse.stop <= 1.02 * full.rmse.stop;
        if !as_good {
            break;
        }
        let removed = kept.remove(term - own);
        gone.push(Rejection {
            candidate: removed.candidate,
            gate: Gate::Superseded,
            p: removed.p,
        });
        full = shorter;
    }
    let beside_table = |round: &Round| round.solution.structure.table.is_some();
    if gone.is_empty() && !ledger.rounds.iter().any(beside_table) {
        return None;
    }
    let mut named = full.clone();
    if named.structure.table.take().is_some() {
        named = fit_from(data, &named.structure, Some(&Known::of(&full)), 0.0)?;
    }
    Some(Kept {
        rounds: chain(data, &ledger.declared, &named, kept)?,
        gone,
        full,
    })
}

/// Without the members, from number `own` on, that the others can replace.
fn thinned(data: &Prepared, mut full: Solution, own: usize) -> Option<Solution> {
    while let Some(term) = replaceable(data, &full, own) {
        full = drop_terms(data, &full, &[term])?;
    }
    (full.structure.terms.len() > own).then_some(full)
}

/// The term, from number `own` on, whose removal costs least, where it costs little.
fn replaceable(data: &Prepared, full: &Solution, own: usize) -> Option<usize> {
    use rayon::prelude::*;
    let coarse = data.for_search(true);
    let (with, ..) = glance_from(&coarse, &full.structure, &Known::of(full), 0.0)?;
    let losses: Vec<Option<(usize, f64)>> = (own..full.structure.terms.len())
        .into_par_iter()
        .map(|term| {
            let (structure, known) = shortened(full, term);
            let (sse, ..) = glance_from(&coarse, &structure, &known, 0.0)?;
            Some((term, sse))
        })
        .collect();
    losses
        .into_iter()
        .flatten()
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .filter(|(_, sse)| *sse * (1.0 - NEEDED) < with)
        .map(|(term, _)| term)
}

fn shortened(full: &Solution, term: usize) -> (Structure, Known) {
    let mut structure = full.structure.clone();
    structure.terms.remove(term);
    (structure, Known::of(full).without(term))
}

/// Fitted anew without these terms, the last of them first.
pub(crate) fn drop_terms(data: &Prepared, full: &Solution, terms: &[usize]) -> Option<Solution> {
    let (mut structure, mut known) = (full.structure.clone(), Known::of(full));
    for &term in terms {
        structure.terms.remove(term);
        known = known.without(term);
    }
    fit_from(data, &structure, Some(&known), 0.0)
}

/// The models between the present one and the full one: one effect a round.
pub(crate) fn chain(
    data: &Prepared,
    now: &Solution,
    full: &Solution,
    found: Vec<Accepted>,
) -> Option<Vec<Accepted>> {
    let own = now.structure.terms.len();
    let count = found.len();
    let mut last = now.clone();
    let mut rounds = Vec::with_capacity(count);
    for (index, mut accepted) in found.into_iter().enumerate() {
        if index + 1 == count {
            accepted.solution = full.clone();
        } else {
            let mut structure = last.structure.clone();
            let term = own + index;
            structure.terms.push(full.structure.terms[term]);
            let mut known = Known::of(&last);
            known.set_stage(term, full.gain(term));
            accepted.solution = fit_from(data, &structure, Some(&known), 0.0)?;
        }
        last = accepted.solution.clone();
        rounds.push(accepted);
    }
    Some(rounds)
}
