//! The search loop: propose moves, refit the best ones, accept one, and linearise again.

use super::bank::{Bank, Identity};
use super::coarse::Coarse;
use super::linear::{Linear, Member};
use super::moves::{is_same, Move, Phase, Wanted};
use super::policy;
use super::refit::{on, present, Tried};
use super::told::reached;
use crate::fit::projection::Span;
use crate::fit::search::descend;
use crate::fit::settle::settle;
use crate::fit::{fit, Solution};
use crate::ledger::{reject, Gate, Rejection};
use crate::model::catalogue::Candidate;
use crate::problem::clock::Moment;
use crate::problem::Prepared;
use crate::scale::{is_raised, PART, QUARTER, TWENTIETH};
use crate::score::blocks::Regime;
use crate::score::left_out::on_blocks;
use std::sync::Arc;

/// Least decrease of the criterion that counts.
pub(super) const FALLEN: f64 = 1e-3;
/// Maximum number of turns: the search ends in any case.
const TURNS: usize = 40;

/// The record that a search keeps of an added member.
pub(super) struct Entry {
    pub(super) identity: Identity,
    /// Exact sign-flip p-value; `None` if the blocks were too short for a test.
    pub(super) p: Option<f64>,
    /// Names that did as well instead of it when it was added.
    pub(super) siblings: Vec<Candidate>,
    /// For a curve: reduction of the SSE by the best one or two names over that by the curve.
    pub(super) q: f64,
}

/// A search under way.
pub(super) struct Search<'a> {
    pub(super) data: &'a Prepared,
    pub(super) coarse: &'a Coarse<'a>,
    pub(super) fine: &'a Prepared,
    pub(super) bank: Bank<'a>,
    pub(super) declared: Arc<Solution>,
    pub(super) now: Arc<Solution>,
    /// Every accepted model.
    pub(super) reached: Vec<Arc<Solution>>,
    pub(super) entries: Vec<Entry>,
    pub(super) rejected: Vec<Rejection>,
    /// Names that were added and later removed.
    pub(super) superseded: Vec<Rejection>,
    pub(super) regime: Regime,
    pub(super) correlation_time: f64,
    /// Whether moves beyond the requested number of names were discarded.
    pub(super) is_cut: bool,
    pub(super) most: usize,
    /// Start and length \[s\] of the time budget.
    budget: Option<(Moment, f64)>,
    pub(super) visited: Vec<Vec<Identity>>,
    /// Sets in which a power law has been tried instead of named friction.
    pub(super) exchanges: Vec<Vec<Identity>>,
    /// Sets in which effects that the hysteresis hides have been tried.
    pub(super) uncovered: Vec<Vec<Identity>>,
    failures: usize,
    phase: Phase,
    /// Whether the final model has been fitted from all starts.
    is_last_anew: bool,
    linear: Option<Standing<'a>>,
}

/// The present model: its linearisation, and its refitted squared error.
pub(super) struct Standing<'a> {
    /// The model that is linearised.
    of: Arc<Solution>,
    pub(super) linear: Linear<'a>,
    pub(super) moved: Span,
    /// Squared error on the coarse grid.
    pub(super) sse: f64,
}

impl<'a> Search<'a> {
    pub(super) fn new(
        (data, coarse, fine): (&'a Prepared, &'a Coarse<'a>, &'a Prepared),
        declared: &Solution,
        most: usize,
    ) -> Self {
        let declared = Arc::new(declared.clone());
        Self {
            data,
            coarse,
            fine,
            bank: Bank::new((data, fine), &declared),
            now: Arc::clone(&declared),
            reached: vec![Arc::clone(&declared)],
            declared,
            entries: Vec::new(),
            rejected: Vec::new(),
            superseded: Vec::new(),
            regime: Regime::Blocks,
            correlation_time: 0.0,
            is_cut: false,
            most,
            budget: None,
            visited: Vec::new(),
            exchanges: Vec::new(),
            uncovered: Vec::new(),
            failures: 0,
            phase: Phase::Any,
            is_last_anew: false,
            linear: None,
        }
    }

    /// Runs until no move is accepted or the time budget is spent; returns whether it was spent.
    pub(super) fn run(
        &mut self,
        budget: Option<(Moment, f64)>,
        mut progress: impl FnMut(&str),
    ) -> bool {
        self.budget = budget;
        let mut told = 0;
        for turn in 1..=TURNS {
            if self.is_over() {
                return true;
            }
            let found = self.now.structure.terms.len() - self.declared.structure.terms.len();
            if self.reached.len() > told {
                progress(&reached(self.data, &self.now));
                told = self.reached.len();
            }
            progress(&format!(
                "searching for missing terms, round {turn}, found so far: {found}"
            ));
            let Some(mut standing) = self.last() else {
                break;
            };
            let goes_on = self.turn(&standing);
            if Arc::ptr_eq(&standing.of, &self.now) {
                standing.linear.prices.curve = self.curve_price();
                self.linear = Some(standing);
            } else {
                self.leave(&standing);
            }
            if !goes_on && !self.begun_anew() {
                break;
            }
        }
        false
    }

    /// Fits the final model once more from all starts if its residual exceeds the noise: the few
    /// starts of a move may have missed the optimum. Returns whether a better one was found.
    fn begun_anew(&mut self) -> bool {
        if self.is_last_anew
            || self.is_at_noise(&self.now)
            || Arc::ptr_eq(&self.now, &self.declared)
        {
            return false;
        }
        self.is_last_anew = true;
        let now = &self.now;
        let Some(next) = fit(self.data, &now.structure, Some(now), 0.0) else {
            return false;
        };
        let gained = (now.sse(self.data) / next.sse(self.data)).ln();
        if gained < TWENTIETH || is_raised(next.rmse.selection, now.rmse.selection) {
            return false;
        }
        self.now = Arc::new(next);
        self.reached.push(Arc::clone(&self.now));
        if let Some(standing) = self.linear.take() {
            self.leave(&standing);
        }
        (self.phase, self.failures) = (Phase::Any, 0);
        true
    }

    fn is_over(&self) -> bool {
        self.budget
            .is_some_and(|(begun, seconds)| begun.elapsed() >= seconds)
    }

    /// The last model, to first order.
    pub(super) fn last(&mut self) -> Option<Standing<'a>> {
        match self.linear.take() {
            Some(standing) => Some(standing),
            None => self.stand(),
        }
    }

    /// Keeps the part of a linearisation that the next one shares.
    fn leave(&mut self, standing: &Standing<'a>) {
        let linear = &standing.linear;
        self.bank.keep(&linear.columns.all, &linear.grams);
    }

    fn curve_price(&self) -> f64 {
        match self.phase {
            Phase::Curves => policy::CURVE_AFTER_NAMES,
            Phase::Any | Phase::Fewer => policy::CURVE_AGAINST_NAMES,
        }
    }

    fn stand(&mut self) -> Option<Standing<'a>> {
        let declared = self.declared.structure.terms.len();
        let price = self.curve_price();
        let seen = on(self.fine, self.data, &self.now)?;
        let moved = Span::of(self.fine, seen.columns.iter().chain(&seen.tangents));
        Some(Standing {
            of: Arc::clone(&self.now),
            linear: Linear::new(&mut self.bank, (&self.now, seen), declared, price),
            moved,
            sse: present(self.data, self.coarse, &self.now),
        })
    }

    /// One round of moves; returns whether the search continues.
    fn turn(&mut self, standing: &Standing<'a>) -> bool {
        let linear = &standing.linear;
        (self.regime, self.correlation_time) = (linear.regime, linear.correlation_time);
        let all = linear.everything();
        let here = linear.identities(&all, &[]);
        if !self.visited.iter().any(|v| is_same(v, &here)) {
            self.visited.push(here);
        }
        let j = (standing.sse / linear.unit()).ln() + linear.price_of(&all);
        let proposed = linear.propose(&Wanted {
            visited: &self.visited,
            phase: self.phase,
            most: self.most,
            below: j - FALLEN,
        });
        self.is_cut |= proposed.is_cut;
        reject(&mut self.rejected, proposed.rejected);
        if proposed.moves.is_empty() {
            return self.exhausted(standing);
        }
        let mut tried = self.refitted(standing, &proposed.moves, j);
        let is_curve = |best: &&Tried| self.phase == Phase::Any && linear.adds_curve(&best.made);
        if let Some(curve) = chosen(&tried).filter(is_curve) {
            let curve = curve.made.clone();
            tried.extend(self.names_instead(standing, &curve, j));
            tried.sort_by(|a, b| a.j.total_cmp(&b.j));
        }
        match chosen(&tried).map(|best| self.accepted(standing, best, &tried)) {
            Some(true) => {
                self.failures = 0;
                self.phase = match self.phase {
                    // Names that the curve makes redundant are removed next.
                    Phase::Curves => Phase::Fewer,
                    Phase::Any | Phase::Fewer if self.now.structure.table.is_some() => self.phase,
                    Phase::Any | Phase::Fewer => Phase::Any,
                };
                true
            }
            _ => {
                self.failures += 1;
                self.failures < policy::FAILURES || self.exhausted(standing)
            }
        }
    }

    /// After the last name: first moves to fewer names, then a power law instead of named friction,
    /// then effects that the hysteresis hides, then curves at a lower price.
    fn exhausted(&mut self, standing: &Standing<'a>) -> bool {
        self.failures = 0;
        let names = self.now.structure.terms.len() - self.declared.structure.terms.len();
        if self.phase == Phase::Any && names > 1 {
            self.phase = Phase::Fewer;
            // Smaller sets that were refitted earlier may be tried again from this model.
            let all = self.now.structure.terms.len();
            self.visited.retain(|set| set.len() >= all);
            return true;
        }
        if self.exchanged(standing) || self.uncovered(standing) {
            self.phase = Phase::Any;
            return true;
        }
        if self.phase == Phase::Curves || self.now.structure.table.is_some() {
            return false;
        }
        self.phase = Phase::Curves;
        let has_curve = |v: &Vec<Identity>| v.iter().any(|m| matches!(m, Identity::Curve(_)));
        self.visited.retain(|v| !has_curve(v));
        true
    }

    /// Refits moves, the most promising first, and skips a move that promises less than another
    /// move has reached. Returns the moves that lower the criterion, the best first.
    fn refitted(&mut self, standing: &Standing<'a>, moves: &[Move], j: f64) -> Vec<Tried> {
        let linear = &standing.linear;
        let mut tried: Vec<Tried> = Vec::new();
        let (mut least, mut named) = (j, false);
        for one in moves {
            // One member of a refitted pair may do alone what the pair promised.
            let is_part = |t: &Tried| {
                t.made.kept == one.kept && one.added.iter().all(|g| t.made.added.contains(g))
            };
            let promising = self.phase == Phase::Fewer
                || tried.iter().any(is_part)
                || linear.is_one_stage(one)
                || one.promise <= least + PART
                || one.promise <= moves[0].promise + PART;
            if named && !promising {
                continue;
            }
            if !tried.is_empty() && self.is_over() {
                break;
            }
            self.visited.push(linear.identities(&one.kept, &one.added));
            let grids = (self.coarse, &standing.moved);
            let refit = linear.refit(grids, one, usize::MAX, |rough| {
                rough.j < j + policy::HOPELESS
            });
            if let Some(real) = refit {
                // A curve sets no bound for names: names are refitted before a curve may win.
                if real.structure.table.is_none() || linear.has_table() {
                    least = least.min(real.j);
                    named = true;
                }
                tried.push(real);
            }
        }
        tried.retain(|t| t.j < j - FALLEN);
        tried.sort_by(|a, b| a.j.total_cmp(&b.j));
        tried
    }

    /// Applies the acceptance tests to a refitted move; returns whether it became the present
    /// model.
    fn accepted(&mut self, standing: &Standing<'a>, best: &Tried, tried: &[Tried]) -> bool {
        let linear = &standing.linear;
        let free = best.structure.free(self.data);
        let values = descend(self.fine, &best.structure, &free, &best.values, 30, 1e-6)
            .map_or_else(|| best.values.clone(), |(_, values)| values);
        let Some(next) = settle(self.data, &best.structure, &free, values) else {
            return false;
        };
        if linear.takes_names_out(&best.made) {
            if is_raised(next.rmse.selection, self.now.rmse.selection) {
                return false;
            }
        } else if !best.made.added.is_empty() {
            if let Err(gate) = gates(self.data, &self.now, &next, linear.regime) {
                for (&g, &p) in best.made.added.iter().zip(&best.made.p) {
                    let candidate = linear.groups[g].candidate();
                    let p = Some(p);
                    let one = candidate.map(|candidate| Rejection { candidate, gate, p });
                    reject(&mut self.rejected, one);
                }
                return false;
            }
        }
        for (&g, &p) in best.made.added.iter().zip(&best.made.p) {
            let group = &linear.groups[g];
            self.entries.push(Entry {
                identity: group.identity(),
                p: (linear.regime == Regime::Blocks || group.is_curve()).then_some(p),
                siblings: siblings(standing, best, tried, g),
                q: match group.is_curve() {
                    true => linear.explained_by_names(&best.made, g),
                    false => 0.0,
                },
            });
        }
        self.is_cut = false;
        let dropped = best.made.kept.dropped.iter();
        let dropped: Vec<Rejection> = dropped.map(|&index| self.out(index)).collect();
        self.superseded.extend(dropped);
        self.goes_on_with(next);
        true
    }

    /// Adopts a model with a name that no move proposed.
    pub(super) fn named(&mut self, identity: Identity, next: Solution, p: f64) {
        self.entries.push(Entry {
            identity,
            p: Some(p),
            siblings: Vec::new(),
            q: 0.0,
        });
        self.goes_on_with(next);
    }

    /// Adopts a model as the present one.
    fn goes_on_with(&mut self, next: Solution) {
        // A name that was rejected jointly with another model may pass with this one.
        self.rejected.clear();
        self.now = Arc::new(next);
        self.reached.push(Arc::clone(&self.now));
    }

    /// Whether the residual of a model is only noise.
    pub(super) fn is_at_noise(&self, model: &Solution) -> bool {
        super::is_at_noise(self.data, model)
    }

    /// The rejection of a term that a move removes.
    pub(super) fn out(&self, index: usize) -> Rejection {
        let term = self.now.structure.terms[index];
        Rejection {
            candidate: term.into(),
            gate: Gate::Superseded,
            p: self.entry(Identity::of(&term)).and_then(|e| e.p),
        }
    }

    /// The latest entry of a member.
    pub(super) fn entry(&self, identity: Identity) -> Option<&Entry> {
        self.entries.iter().rev().find(|e| e.identity == identity)
    }
}

/// The simplest of the moves whose criterion equals the best one's and that add no more members.
fn chosen(tried: &[Tried]) -> Option<&Tried> {
    let best = tried.first()?;
    let equal =
        |t: &&Tried| t.j <= best.j + PART && t.made.added.len() <= best.made.added.len().max(1);
    tried
        .iter()
        .filter(equal)
        .min_by(|a, b| a.rank().cmp(&b.rank()).then(a.j.total_cmp(&b.j)))
}

/// Names that were refitted instead of an added name and did as well.
fn siblings(standing: &Standing, best: &Tried, tried: &[Tried], own: usize) -> Vec<Candidate> {
    let linear = &standing.linear;
    let as_good = |t: &&Tried| {
        t.sse <= policy::allowed_to_a_rival(standing.sse, best.sse) && t.made.kept == best.made.kept
    };
    let instead = |t: &Tried| -> Option<Candidate> {
        let mut theirs = t.made.added.iter().filter(|g| !best.made.added.contains(g));
        let mut ours = best.made.added.iter().filter(|g| !t.made.added.contains(g));
        let (Some(&g), None) = (theirs.next(), theirs.next()) else {
            return None;
        };
        let only = ours.next() == Some(&own) && ours.next().is_none();
        linear.groups[g].candidate().filter(|_| only)
    };
    tried.iter().filter(as_good).filter_map(instead).collect()
}

/// Acceptance tests: the selection segment, which no search has used, and the left-out blocks.
pub(super) fn gates(
    data: &Prepared,
    old: &Solution,
    new: &Solution,
    regime: Regime,
) -> Result<(), Gate> {
    let taken = 1.0 - (new.rmse.fit / old.rmse.fit).powi(2);
    let carried = 1.0 - (new.rmse.selection / old.rmse.selection).powi(2);
    let large = match regime {
        Regime::Blocks => policy::LARGE,
        Regime::Effect => policy::LARGE_UNTESTED,
    };
    let worse = is_raised(new.rmse.selection, old.rmse.selection);
    if taken > 0.0 && carried < QUARTER * taken && (taken < large || worse) {
        return Err(Gate::StopCheck);
    }
    match on_blocks(data, old, new, regime) {
        (_, true) => Ok(()),
        (_, false) => Err(Gate::Blocks),
    }
}

impl Linear<'_> {
    /// Reduction by the best one or two names, as a share of that by a curve, to first order.
    fn explained_by_names(&self, one: &Move, curve: usize) -> f64 {
        let mut swept = self.without(&one.kept);
        for &g in one.added.iter().filter(|&&g| g != curve) {
            swept.sweep(&self.groups[g].columns);
        }
        let (target, _) = self.target_of(&one.kept);
        let whole = swept.gain_of_any(&self.groups[curve].columns, target);
        let names = self.groups.iter().filter_map(|g| match g.member {
            Member::Name(_) => Some(swept.gain(&g.columns, target)),
            Member::Curve(_) => None,
        });
        let pair = self
            .pairs(&swept, target)
            .iter()
            .map(|p| p.0)
            .fold(0.0, f64::max);
        (names.fold(pair, f64::max) / whole.max(f64::MIN_POSITIVE)).min(1.0)
    }
}
