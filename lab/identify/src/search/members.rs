//! Other sets of terms that describe a mechanism as well as those found.
//!
//! If no model explains a record, the terms of a mechanism are descriptions of one curve. Sets with
//! at most as many terms are compared to first order by `ln SSE` plus a penalty per parameter, and
//! the model is refitted with the best of them.

use super::kept::Kept;
use super::linear::{Group, Linear};
use super::moves::{is_same, Move};
use super::policy;
use super::run::{Search, Standing};
use crate::ledger::Description;
use crate::model::catalogue::Candidate;
use crate::model::mechanism::Mechanism;
use crate::scale::TWENTIETH;
use rayon::prelude::*;

impl Search<'_> {
    /// The sets of terms that describe each mechanism of the final model about as well. None if the
    /// model is complete: its terms then have their own alternatives.
    pub(super) fn descriptions(&self, standing: &Standing) -> Vec<Description> {
        if self.is_at_noise(&self.now) {
            return Vec::new();
        }
        let all = self.found_by_mechanism().into_iter();
        all.flat_map(|(mechanism, found)| self.instead_of(standing, mechanism, found))
            .collect()
    }

    /// The terms found for each mechanism that has terms.
    fn found_by_mechanism(&self) -> Vec<(Mechanism, Vec<usize>)> {
        let own = self.declared.structure.terms.len();
        let of_term = |term| Mechanism::of_term(&self.now.structure.terms[term]);
        let terms = own..self.now.structure.terms.len();
        let all = Mechanism::ALL.into_iter().map(|mechanism| {
            let found = terms.clone().filter(|&term| of_term(term) == mechanism);
            (mechanism, found.collect::<Vec<usize>>())
        });
        all.filter(|(_, found)| !found.is_empty()).collect()
    }

    /// The sets of a mechanism whose squared error is within a factor of 1.25 of the least.
    fn instead_of(
        &self,
        standing: &Standing,
        mechanism: Mechanism,
        found: Vec<usize>,
    ) -> Vec<Description> {
        let linear = &standing.linear;
        let refitted = |one: &Move| {
            let real = linear.refit((self.coarse, &standing.moved), one, usize::MAX, |_| true)?;
            let terms = one.added.iter();
            let terms: Option<Vec<Candidate>> =
                terms.map(|&g| linear.groups[g].candidate()).collect();
            Some((terms?, real.sse / standing.sse))
        };
        let sets = linear.sets(found, mechanism);
        let refitted: Vec<_> = sets.par_iter().map(refitted).collect();
        let mut refitted: Vec<(Vec<Candidate>, f64)> = refitted.into_iter().flatten().collect();
        refitted.sort_by(|a, b| a.1.total_cmp(&b.1));
        let least = refitted.first().map_or(1.0, |best| best.1.min(1.0));
        let is_as_good = |(_, error): &(_, f64)| (error / least).ln() <= policy::CURVE_AFTER_NAMES;
        let as_good = refitted.into_iter().filter(is_as_good);
        as_good
            .map(|(terms, error)| Description {
                mechanism,
                terms,
                error_ratio: error.sqrt(),
            })
            .collect()
    }
}

impl Linear<'_> {
    /// The best sets of at most as many terms of a mechanism instead of those found, to first
    /// order. Each longer set extends one of the best shorter sets by one term.
    fn sets(&self, found: Vec<usize>, mechanism: Mechanism) -> Vec<Move> {
        let most = found.len();
        let kept = Kept {
            dropped: found,
            table: self.has_table(),
        };
        let present = self.identities(&self.everything(), &[]);
        let is_own = |group: &Group| {
            let term = group.candidate().map(|candidate| candidate.term);
            term.is_some_and(|term| Mechanism::of_term(&term) == mechanism)
        };
        let own: Vec<usize> = (0..self.groups.len())
            .filter(|&g| is_own(&self.groups[g]))
            .collect();
        let mut all: Vec<Move> = Vec::new();
        let mut longest = vec![Move {
            kept,
            added: Vec::new(),
            promise: f64::INFINITY,
            p: Vec::new(),
        }];
        for _ in 0..most {
            let longer = longest.par_iter().flat_map(|set| self.grown(set, &own));
            longest = self.best(longer.collect());
            all.extend(longest.iter().cloned());
        }
        all.retain(|set| !is_same(&self.identities(&set.kept, &set.added), &present));
        self.best(all)
    }

    /// A set, extended by each of the groups in turn.
    fn grown(&self, set: &Move, own: &[usize]) -> Vec<Move> {
        let mut swept = self.without(&set.kept);
        set.added
            .iter()
            .for_each(|&g| swept.sweep(&self.groups[g].columns));
        let (target, unit) = self.target_of(&set.kept);
        let sse = swept.at(target, target);
        let is_new = |g: &&usize| {
            let is_like = |a: &usize| self.groups[*a].is_like(&self.groups[**g]);
            !set.added.iter().any(is_like)
        };
        let with = |&g: &usize| {
            let added = [&set.added[..], &[g]].concat();
            let left = sse - swept.gain(&self.groups[g].columns, target);
            let parameters: usize = added.iter().map(|&a| self.groups[a].freedoms).sum();
            let promise = (unit * left.max(1e-14 * sse)).ln() + TWENTIETH * parameters as f64;
            Move {
                added,
                promise,
                ..set.clone()
            }
        };
        own.iter().filter(is_new).map(with).collect()
    }

    /// The best few of some sets, each at its best shapes.
    fn best(&self, mut sets: Vec<Move>) -> Vec<Move> {
        sets.sort_by(|a, b| a.promise.total_cmp(&b.promise));
        let names = |set: &Move| -> Vec<_> {
            let added = set.added.iter();
            added.map(|&g| self.groups[g].identity()).collect()
        };
        let mut best: Vec<Move> = Vec::new();
        for set in sets {
            if best.len() == policy::REFITTED {
                break;
            }
            if !best.iter().any(|own| is_same(&names(own), &names(&set))) {
                best.push(set);
            }
        }
        best
    }
}
