//! The moves from one set to another, and what each promises.
//!
//! A move takes up to two names out, keeps or drops the curve, and puts up to two names in,
//! or a curve, or as many names as the Gram matrix asks for. Pairs in one move are what lets
//! two effects in that explain nothing one at a time. The criterion of all is the same:
//! `J = ln SSE + sum of prices` (see `Prices`).

use super::bank::Identity;
use super::gram::Swept;
use super::linear::{Kept, Linear, Member};
use super::policy;
use crate::ledger::{Gate, Rejection};
use crate::model::catalogue::Candidate;
use crate::model::Variable;
use crate::score::blocks::Regime;

/// Pairs of names whose slopes are looked at, of each set that is kept.
const PAIRS: usize = 10;
/// Moves that are looked at, of each set that is kept.
const MOVES: usize = 40;
/// Moves whose sign flips are counted in one round.
const TESTED: usize = 60;
/// From so many on, another shape of names that failed is not tested again.
const OTHER_SHAPES: usize = 40;
/// Moves per kept set that are completed by more names.
const COMPLETED: usize = 3;

/// A move, with its promise.
#[derive(Debug, Clone)]
pub(super) struct Move {
    pub(super) kept: Kept,
    /// Groups that come in.
    pub(super) added: Vec<usize>,
    /// The criterion, to first order.
    pub(super) promise: f64,
    /// The sign-flip p-value of each that comes in, given all others.
    pub(super) p: Vec<f64>,
}

/// What a round of moves gave.
pub(super) struct Proposed {
    /// Those that pass the test, the best promise first.
    pub(super) moves: Vec<Move>,
    /// Names that fail it.
    pub(super) rejected: Vec<Rejection>,
    /// Whether a move was left out only because it has more names than were asked for.
    pub(super) is_cut: bool,
}

/// What a search looks for, one after the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Phase {
    /// Any move that promises a lower criterion.
    Any,
    /// Fewer names, whatever they promise: a name at a trial shape is a poor stand-in for what
    /// it is once it is refitted, and two that are bent together may stand where one belongs.
    Fewer,
    /// Once names have come to an end, a curve at a lower price.
    Curves,
}

/// Which moves are wanted.
pub(super) struct Wanted<'a> {
    /// Sets that were refitted before.
    pub(super) visited: &'a [Vec<Identity>],
    /// Which kind of move is looked for.
    pub(super) phase: Phase,
    /// Most names.
    pub(super) most: usize,
    /// The criterion of the present model.
    pub(super) below: f64,
}

/// Whether two sets have the same members.
pub(super) fn is_same(a: &[Identity], b: &[Identity]) -> bool {
    let count = |set: &[Identity], one: &Identity| set.iter().filter(|o| *o == one).count();
    a.len() == b.len() && a.iter().all(|one| count(a, one) == count(b, one))
}

impl Linear<'_> {
    /// The moves worth a refit.
    pub(super) fn propose(&self, wanted: &Wanted) -> Proposed {
        use rayon::prelude::*;
        let all: Vec<Vec<Move>> = self
            .sets_to_keep()
            .into_par_iter()
            .map(|kept| self.moves_from(&kept))
            .collect();
        let mut all: Vec<Move> = all.into_iter().flatten().collect();
        all.retain(|m| match wanted.phase {
            Phase::Fewer => self.takes_names_out(m),
            Phase::Any | Phase::Curves => m.promise < wanted.below,
        });
        all.sort_by(|a, b| a.promise.total_cmp(&b.promise));
        self.tested(all, wanted)
    }

    /// The present set, without its curve, and without one or two of its names.
    fn sets_to_keep(&self) -> Vec<Kept> {
        let names = self.declared..self.now.structure.terms.len();
        let mut dropped: Vec<Vec<usize>> = vec![Vec::new()];
        for a in names.clone() {
            dropped.push(vec![a]);
            dropped.extend((a + 1..names.end).map(|b| vec![a, b]));
        }
        dropped.extend(self.crowds());
        let with = |table: bool| {
            let sets = dropped.iter().filter(move |d| table || d.len() < 2);
            sets.map(move |d| Kept {
                dropped: d.clone(),
                table,
            })
        };
        match self.has_table() {
            true => with(true).chain(with(false)).collect(),
            false => dropped
                .iter()
                .cloned()
                .map(|dropped| Kept {
                    dropped,
                    table: false,
                })
                .collect(),
        }
    }

    /// Three and more names over one variable: together they imitate any curve over it, so they
    /// are compared with one.
    fn crowds(&self) -> Vec<Vec<usize>> {
        let names = || self.declared..self.now.structure.terms.len();
        let over = |index: usize, variable: Variable| {
            let variables = Candidate::from(self.now.structure.terms[index]).variables();
            variables.contains(&variable)
        };
        let curves = self.groups.iter().filter_map(|g| match g.member {
            Member::Curve(variable) => Some(variable),
            Member::Name(_) => None,
        });
        let mut crowds: Vec<Vec<usize>> = curves
            .map(|variable| names().filter(|&i| over(i, variable)).collect())
            .filter(|crowd: &Vec<usize>| crowd.len() > 2)
            .collect();
        crowds.sort();
        crowds.dedup();
        crowds
    }

    fn moves_from(&self, kept: &Kept) -> Vec<Move> {
        let swept = self.without(kept);
        let (target, unit) = self.target_of(kept);
        let sse = swept.at(target, target).max(1e-14);
        let price = self.price_of(kept) + unit.ln();
        let promise = |gain: f64, added: &[usize]| {
            let added: f64 = added.iter().map(|&g| self.price(g)).sum();
            (sse - gain).max(1e-14 * sse).ln() + price + added
        };
        let make = |added: Vec<usize>, gain: f64| Move {
            kept: kept.clone(),
            promise: promise(gain, &added),
            added,
            p: Vec::new(),
        };
        let mut moves = Vec::new();
        if *kept != self.everything() {
            moves.push(make(Vec::new(), 0.0));
        }
        for (g, group) in self.groups.iter().enumerate() {
            let gain = match group.is_curve() {
                true if kept.table => 0.0,
                true => swept.gain_of_any(&group.columns, target),
                false => swept.gain(&group.columns, target),
            };
            if gain > 0.0 {
                moves.push(make(vec![g], gain));
            }
        }
        for (gain, a, b) in self.best_pairs(&swept, target) {
            moves.push(make(vec![a, b], gain));
        }
        moves.sort_by(|a, b| a.promise.total_cmp(&b.promise));
        moves.truncate(MOVES);
        self.add_completed((kept, &swept), &mut moves, &make);
        moves
    }

    /// The best pairs, with their slopes; each two names once.
    fn best_pairs(&self, swept: &Swept, target: usize) -> Vec<(f64, usize, usize)> {
        let of = &self.kinds;
        let kinds = of.iter().max().map_or(0, |last| last + 1);
        let mut best: Vec<Option<(f64, usize, usize)>> = vec![None; kinds * kinds];
        for pair in self.pairs(swept, target) {
            let (a, b) = (of[pair.1], of[pair.2]);
            let slot = &mut best[a.min(b) * kinds + a.max(b)];
            if a != b && slot.is_none_or(|known| known.0 < pair.0) {
                *slot = Some(pair);
            }
        }
        let mut taken: Vec<(f64, usize, usize)> = best.into_iter().flatten().collect();
        taken.sort_by(|p, q| q.0.total_cmp(&p.0));
        taken.truncate(PAIRS);
        let gain = |a: usize, b: usize| {
            let both = [&self.groups[a].columns[..], &self.groups[b].columns[..]].concat();
            swept.gain(&both, target)
        };
        let slopes = |(_, a, b)| (gain(a, b), a, b);
        taken.into_iter().map(slopes).collect()
    }

    /// Names may each be poor, by twos poor as well, and together explain what one curve
    /// does: so the best sets of names are completed before a curve is compared with them.
    fn add_completed(
        &self,
        (kept, swept): (&Kept, &Swept),
        moves: &mut Vec<Move>,
        make: &dyn Fn(Vec<usize>, f64) -> Move,
    ) {
        let names = |m: &&Move| m.added.iter().all(|&g| !self.groups[g].is_curve());
        let begun: Vec<Vec<usize>> = moves
            .iter()
            .filter(names)
            .take(COMPLETED)
            .map(|m| m.added.clone())
            .collect();
        for added in begun {
            let present = self.now.structure.terms.len() - self.declared;
            let room = policy::MOST_NAMES.saturating_sub(present - kept.dropped.len());
            let (target, _) = self.target_of(kept);
            let whole = self.completed(swept, target, &added, room);
            if whole.len() > added.len().max(2) {
                let mut columns = self.columns_of(kept);
                let before = self.grams.squared_error(&columns, target);
                for &g in &whole {
                    columns.extend(&self.groups[g].columns);
                }
                let gain = before - self.grams.squared_error(&columns, target);
                moves.push(make(whole, gain));
            }
        }
    }

    /// Counts the sign flips of the best moves, each set of members once.
    fn tested(&self, all: Vec<Move>, wanted: &Wanted) -> Proposed {
        let mut seen: Vec<Vec<Identity>> = wanted.visited.to_vec();
        let mut proposed = Proposed {
            moves: Vec::new(),
            rejected: Vec::new(),
            is_cut: false,
        };
        let mut tested = 0;
        for mut one in all {
            let members = self.identities(&one.kept, &one.added);
            let names = members
                .iter()
                .filter(|m| matches!(m, Identity::Name(..)))
                .count();
            let has_curve = one.added.iter().any(|&g| self.groups[g].is_curve());
            // A curve would stand for the names that nobody asked for.
            let is_full = wanted.most < policy::MOST_NAMES && names >= wanted.most + self.declared;
            if has_curve && is_full {
                proposed.is_cut = true;
                continue;
            }
            if (wanted.phase == Phase::Curves && !has_curve)
                || seen.iter().any(|s| is_same(s, &members))
            {
                continue;
            }
            if names > policy::MOST_NAMES.min(wanted.most) + self.declared {
                proposed.is_cut |= names <= policy::MOST_NAMES + self.declared;
                continue;
            }
            let is_full = proposed.moves.len() >= policy::REFITTED;
            if is_full && !self.is_one_stage(&one) {
                continue;
            }
            tested += 1;
            if tested > TESTED {
                break;
            }
            one.p = self.p_values(&one);
            // Where the blocks are too short for a test, names go by size; a curve, which
            // bends to anything, has to pass it all the same.
            let asked = |g: usize| self.regime == Regime::Blocks || self.groups[g].is_curve();
            let fails = |(&g, &p): (&usize, &f64)| asked(g) && p > self.prices.level;
            let failed = one.added.iter().zip(&one.p).position(fails);
            if let Some(worst) = failed {
                if tested > OTHER_SHAPES {
                    seen.push(members);
                }
                proposed.reject(self.groups[one.added[worst]].candidate(), one.p[worst]);
                continue;
            }
            seen.push(members);
            proposed.moves.push(one);
            if proposed.moves.len() >= policy::REFITTED
                && proposed.moves.iter().any(|m| self.is_one_stage(m))
            {
                break;
            }
        }
        proposed
    }

    /// Whether all that comes in is one stage. A stage bends every column, so its promise is the
    /// poorest of all: the best one is refitted whatever else promises more.
    pub(super) fn is_one_stage(&self, one: &Move) -> bool {
        let [only] = one.added[..] else { return false };
        let effect = self.groups[only].candidate().map(|c| c.term.effect);
        effect.is_some_and(|e| e.is_input_stage() || e.is_output_stage())
    }

    /// Whether fewer names are left, and the curve as it is.
    pub(super) fn takes_names_out(&self, one: &Move) -> bool {
        let curves = one.added.iter().filter(|&&g| self.groups[g].is_curve());
        one.added.len() < one.kept.dropped.len()
            && curves.count() == 0
            && one.kept.table == self.has_table()
    }

    fn p_values(&self, one: &Move) -> Vec<f64> {
        let kept = self.columns_of(&one.kept);
        let (target, _) = self.target_of(&one.kept);
        let of = |index: usize| {
            let mut others = kept.clone();
            for (_, &g) in one.added.iter().enumerate().filter(|(i, _)| *i != index) {
                others.extend(&self.groups[g].columns);
            }
            let own = &self.groups[one.added[index]].columns;
            self.grams.p_value(own, &others, target)
        };
        (0..one.added.len()).map(of).collect()
    }
}

impl Proposed {
    fn reject(&mut self, candidate: Option<Candidate>, p: f64) {
        let Some(candidate) = candidate else { return };
        if self
            .rejected
            .iter()
            .all(|r| !r.candidate.is_like(&candidate))
        {
            self.rejected.push(Rejection {
                candidate,
                gate: Gate::P,
                p: Some(p),
            });
        }
    }
}
