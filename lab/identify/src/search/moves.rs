//! Moves from one set of effects to another, and the criterion that each promises.
//!
//! A move removes up to two names, keeps or removes the curve, and adds up to two names, or a
//! curve, or a set of names completed by forward selection. Moves of pairs find two effects that
//! explain something only together. All moves are compared by one criterion, `J = ln SSE + sum of
//! prices` (see `Prices`).

use super::bank::Identity;
use super::gram::Swept;
use super::kept::Kept;
use super::linear::{Linear, Member};
use super::policy;
use crate::ledger::{reject, Gate, Rejection};
use crate::model::catalogue::Candidate;
use crate::model::kind::is_stage;
use crate::model::Variable;
use crate::score::blocks::Regime;

/// Pairs of names that are evaluated with their slopes, for each kept set.
const PAIRS: usize = 10;
/// Maximum number of moves from each kept set.
const MOVES: usize = 40;
/// Maximum number of moves whose sign-flip p-values are computed in one round.
const TESTED: usize = 60;
/// After this many tests in a round, a set that fails is not tested again at other shapes.
const OTHER_SHAPES: usize = 40;

/// A move and its first-order criterion.
#[derive(Debug, Clone)]
pub(super) struct Move {
    pub(super) kept: Kept,
    /// Groups that are added.
    pub(super) added: Vec<usize>,
    /// The criterion, to first order.
    pub(super) promise: f64,
    /// Sign-flip p-value of each added group, given all other members.
    pub(super) p: Vec<f64>,
}

/// Result of one round of moves.
pub(super) struct Proposed {
    /// Moves that pass the test, by ascending promised criterion.
    pub(super) moves: Vec<Move>,
    /// Names that fail the test.
    pub(super) rejected: Vec<Rejection>,
    /// Whether a move was discarded only because it exceeds the requested number of names.
    pub(super) is_cut: bool,
}

/// Phases of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Phase {
    /// Any move that promises a lower criterion.
    Any,
    /// Moves to fewer names, with any predicted criterion: the prediction at a trial shape is poor
    /// before a refit, and two names with bent shapes may imitate a single other one.
    Fewer,
    /// A curve at a lower price, once no further name is found.
    Curves,
}

/// Which moves a round may propose.
pub(super) struct Wanted<'a> {
    /// Sets that have already been refitted.
    pub(super) visited: &'a [Vec<Identity>],
    /// Phase of the search.
    pub(super) phase: Phase,
    /// Maximum number of names.
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
    /// The moves that are worth a refit.
    pub(super) fn propose(&self, wanted: &Wanted) -> Proposed {
        use rayon::prelude::*;
        let all: Vec<Vec<Move>> = self
            .sets_to_keep()
            .into_par_iter()
            .map(|kept| self.moves_from(&kept))
            .collect();
        let mut all: Vec<Move> = all.into_iter().flatten().collect();
        if wanted.phase == Phase::Fewer {
            all.extend(self.removals());
        }
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

    /// Sets of three or more names over one variable. Together they imitate any curve over it,
    /// so a move that replaces all of them by one curve is tried.
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

    /// Removals of three or more names. Several names may imitate one effect that a later move
    /// has added; without any one or two of them the others do not.
    fn removals(&self) -> Vec<Move> {
        let names: Vec<usize> = (self.declared..self.now.structure.terms.len()).collect();
        let sets =
            (0..1_usize << names.len()).filter(|set| set.count_ones() as usize >= policy::MANY);
        let of = |set: usize| {
            let dropped = names.iter().enumerate();
            let dropped = dropped.filter(|(bit, _)| set >> bit & 1 == 1);
            let kept = Kept {
                dropped: dropped.map(|(_, &index)| index).collect(),
                table: self.has_table(),
            };
            Move {
                promise: self.left(&kept).max(1e-14).ln() + self.price_of(&kept),
                kept,
                added: Vec::new(),
                p: Vec::new(),
            }
        };
        sets.map(of).collect()
    }

    pub(super) fn moves_from(&self, kept: &Kept) -> Vec<Move> {
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

    /// The best pairs of names, each pair at its best shapes, evaluated with slopes.
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

    /// Several names may explain a curve together although no one or two of them do. The best
    /// moves are therefore completed by forward selection before a curve competes with them.
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
            .take(policy::REFITTED)
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

    /// Tests the best moves by sign flips, each set of members once.
    fn tested(&self, all: Vec<Move>, wanted: &Wanted) -> Proposed {
        let mut seen: Vec<Vec<Identity>> = wanted.visited.to_vec();
        let mut proposed = Proposed {
            moves: Vec::new(),
            rejected: Vec::new(),
            is_cut: false,
        };
        // Kinds of moves whose first-order promises are the least accurate: the best one of each
        // is refitted whatever the others promise.
        let stage = |m: &Move| self.is_one_stage(m);
        let many = |m: &Move| m.kept.dropped.len() >= m.added.len() + policy::MANY;
        let poor: &[&dyn Fn(&Move) -> bool] = match wanted.phase {
            Phase::Fewer => &[&stage, &many],
            Phase::Any | Phase::Curves => &[&stage],
        };
        let has =
            |proposed: &Proposed, kind: &dyn Fn(&Move) -> bool| proposed.moves.iter().any(kind);
        let mut tested = 0;
        for mut one in all {
            let members = self.identities(&one.kept, &one.added);
            let names = members
                .iter()
                .filter(|m| matches!(m, Identity::Name(..)))
                .count();
            let has_curve = one.added.iter().any(|&g| self.groups[g].is_curve());
            // A curve would imitate the names beyond the requested number.
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
            if is_full && !poor.iter().any(|kind| kind(&one) && !has(&proposed, kind)) {
                continue;
            }
            tested += 1;
            if tested > TESTED {
                break;
            }
            one.p = self.p_values(&one);
            // Names need no test if the blocks are too short for one; a curve, which fits
            // anything, always has to pass.
            let asked = |g: usize| self.regime == Regime::Blocks || self.groups[g].is_curve();
            let fails = |(&g, &p): (&usize, &f64)| asked(g) && p > self.prices.level;
            let failed = one.added.iter().zip(&one.p).position(fails);
            if let Some(worst) = failed {
                if tested > OTHER_SHAPES {
                    seen.push(members);
                }
                let candidate = self.groups[one.added[worst]].candidate();
                let (gate, p) = (Gate::P, Some(one.p[worst]));
                let failed = candidate.map(|candidate| Rejection { candidate, gate, p });
                reject(&mut proposed.rejected, failed);
                continue;
            }
            seen.push(members);
            proposed.moves.push(one);
            if proposed.moves.len() >= policy::REFITTED
                && poor.iter().all(|kind| has(&proposed, kind))
            {
                break;
            }
        }
        proposed
    }

    /// Whether the move adds one stage and nothing else. A stage acts on every column, so its
    /// first-order promise is the least accurate: the best stage is always refitted.
    pub(super) fn is_one_stage(&self, one: &Move) -> bool {
        let [only] = one.added[..] else { return false };
        let effect = self.groups[only].candidate().map(|c| c.term.effect);
        effect.is_some_and(|e| is_stage(&e))
    }

    /// Whether the move reduces the number of names and does not change the curve.
    pub(super) fn takes_names_out(&self, one: &Move) -> bool {
        let curves = one.added.iter().filter(|&&g| self.groups[g].is_curve());
        one.added.len() < one.kept.dropped.len()
            && curves.count() == 0
            && one.kept.table == self.has_table()
    }

    pub(super) fn p_values(&self, one: &Move) -> Vec<f64> {
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
