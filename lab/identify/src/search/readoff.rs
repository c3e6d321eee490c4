//! From the final set of a search to the results table: terms, alternatives, the unmodelled curve.

use super::bank::Identity;
use super::carries_over::delivered;
use super::exchange::is_told_apart;
use super::kept::Kept;
use super::linear::Linear;
use super::moves::Move;
use super::policy;
use super::refit::{other_hystereses, Priced, FAIR, ROUGH};
use super::run::{Entry, Search, Standing};
use crate::fit::projection::Span;
use crate::fit::search::descend;
use crate::fit::settle::settle;
use crate::fit::Solution;
use crate::ledger::{reject, Grade, Ledger, Round, Unknown};
use crate::model::catalogue::Candidate;
use crate::model::kind::is_stage;
use crate::model::structure::{FitTerm, Free, Role, Structure};
use crate::model::Table;
use crate::problem::Prepared;
use crate::scale::{HALF, PART, TWENTIETH};
use crate::score::blocks::Regime;
use crate::score::left_out::on_blocks;
use crate::score::tones::may_be_of_the_motion;
use std::sync::Arc;

/// Maximum number of alternatives to one name that are refitted.
const RIVALS: usize = 8;
/// Starts of the refit of an alternative: its trial shapes and the linear step.
const STARTS: usize = 2;

impl Search<'_> {
    /// The results table of the search.
    pub(super) fn ledger(mut self) -> Option<Ledger> {
        let standing = self.last()?;
        let rivals = self.rivals(&standing);
        let descriptions = self.descriptions(&standing);
        let own = self.declared.structure.terms.len();
        let order = standing.linear.by_weight();
        self.now = Arc::new(arranged(self.data, &self.now, &order)?);
        let weight = order[own..].iter().map(|index| index - own);
        let weighed: Vec<_> = weight.map(|i| rivals[i].clone()).collect();
        let path = self.path()?;
        let mut ledger = Ledger::of((*self.declared).clone());
        ledger.descriptions = descriptions;
        ledger.regime = self.regime;
        ledger.correlation_time = self.correlation_time;
        let superseded = std::mem::take(&mut self.superseded);
        self.rejected
            .retain(|r| !superseded.iter().any(|s| s.candidate.is_like(&r.candidate)));
        ledger.rejected = std::mem::take(&mut self.rejected);
        reject(&mut ledger.rejected, superseded);
        let mut before = Arc::clone(&self.declared);
        for (index, (solution, rivals)) in path.iter().zip(weighed).enumerate() {
            let term = self.now.structure.terms[own + index];
            let candidate = Candidate::from(term);
            let p = self.entry(Identity::of(&term)).and_then(|e| e.p);
            if p.is_none() {
                ledger.regime = Regime::Effect;
            }
            let explained = 1.0 - solution.sse(self.data) / before.sse(self.data);
            let (blocks_better, _) = on_blocks(self.data, &before, solution, self.regime);
            ledger.rounds.push(Round {
                grade: match rivals.is_empty()
                    && !self.now.is_on_bound(own + index)
                    && !may_be_of_the_motion(self.data, &term)
                {
                    true => Grade::High,
                    false => Grade::Low,
                },
                candidate,
                p,
                rivals,
                explained,
                blocks_better,
                before: before.rmse,
                after: solution.rmse,
                solution: (**solution).clone(),
            });
            before = Arc::clone(solution);
        }
        ledger.unknown = self.unknown(&before);
        self.deliver(&mut ledger)?;
        // Only a model within the noise can tell which formula is right.
        if !self.is_at_noise(ledger.last()) {
            let rounds = ledger.rounds.iter_mut().chain(&mut ledger.beyond);
            rounds.for_each(|round| round.grade = Grade::Low);
        }
        let rounds = ledger.rounds.iter().chain(&ledger.beyond);
        let found: Vec<Candidate> = rounds.map(|r| r.candidate).collect();
        ledger
            .rejected
            .retain(|r| !found.iter().any(|own| own.is_like(&r.candidate)));
        Some(ledger)
    }

    /// Delivers the model with the smallest error on left-out blocks, or a simpler one that does as
    /// well. Models without the curve are simpler than models with it, and within each group those
    /// with fewer names are simpler. Later rounds go to `beyond`.
    fn deliver(&self, ledger: &mut Ledger) -> Option<()> {
        let count = ledger.rounds.len();
        let curved = match &ledger.unknown {
            None => Vec::new(),
            Some(unknown) => self.beside_the_curve(ledger, unknown)?,
        };
        let rounds = ledger.rounds.iter().map(|r| &r.solution);
        let named = std::iter::once(&ledger.declared).chain(rounds);
        let models: Vec<&Solution> = named.chain(&curved).collect();
        let best = delivered(self.data, &models);
        let names = best % (count + 1);
        ledger.beyond = ledger.rounds.split_off(names);
        let with_curve = curved.into_iter().nth(names).filter(|_| best > count);
        let before = ledger.named().clone();
        let unknown = ledger.unknown.take();
        ledger.unknown = unknown.zip(with_curve).map(|(unknown, solution)| Unknown {
            share: 1.0 - solution.sse(self.data) / before.sse(self.data),
            before: before.rmse,
            after: solution.rmse,
            solution,
            ..unknown
        });
        Some(())
    }

    /// The model with the curve and no name, with the first name, and so on, refitted.
    fn beside_the_curve(&self, ledger: &Ledger, unknown: &Unknown) -> Option<Vec<Solution>> {
        let own = self.declared.structure.terms.len();
        let mut models = Vec::new();
        let named =
            std::iter::once(&ledger.declared).chain(ledger.rounds.iter().map(|r| &r.solution));
        for (count, named) in named.enumerate() {
            models.push(match count == ledger.rounds.len() {
                true => unknown.solution.clone(),
                false => {
                    let table = self.now.structure.table.clone();
                    self.shortened(own + count, named, table)?
                }
            });
        }
        Some(models)
    }

    fn unknown(&self, named: &Solution) -> Option<Unknown> {
        let variable = self.now.structure.table.as_ref()?.variable;
        let entry = self.entry(Identity::Curve(variable));
        Some(Unknown {
            variable,
            share: 1.0 - self.now.sse(self.data) / named.sse(self.data),
            p: entry.and_then(|e| e.p).unwrap_or(1.0),
            q: entry.map_or(0.0, |e| e.q),
            before: named.rmse,
            after: self.now.rmse,
            solution: (*self.now).clone(),
        })
    }

    /// The model with the first name, with the first two, and so on.
    fn path(&self) -> Option<Vec<Arc<Solution>>> {
        let terms = &self.now.structure.terms;
        let own = self.declared.structure.terms.len();
        let mut path: Vec<Arc<Solution>> = Vec::new();
        for count in own + 1..=terms.len() {
            let wanted: Vec<Identity> = terms[..count].iter().map(Identity::of).collect();
            let known = |s: &Arc<Solution>| {
                let order = order_of(s, &wanted).filter(|_| s.structure.table.is_none())?;
                arranged(self.data, s, &order)
            };
            // Of several fits of one set the last one is the best.
            let solution = match self.reached.iter().rev().find_map(known) {
                Some(mut known) => {
                    // A name that was removed and added again has another id in an earlier model.
                    let own = &mut known.structure.terms;
                    own.recognise(&mut known.free, terms);
                    known
                }
                None => self.shortened(count, path.last().unwrap_or(&self.declared), None)?,
            };
            path.push(Arc::new(solution));
        }
        Some(path)
    }

    /// The final model reduced to its first terms and the given curve, refitted.
    fn shortened(&self, terms: usize, last: &Solution, table: Option<Table>) -> Option<Solution> {
        let mut structure: Structure = self.now.structure.clone();
        structure.terms.truncate(terms);
        structure.table = table;
        let free = structure.free(self.data);
        let of = |first: &Solution, second: &Solution| -> Vec<f64> {
            let value = |f: &Free| first.value(f.role).or(second.value(f.role));
            free.iter().map(|f| value(f).unwrap_or(0.5)).collect()
        };
        let mut starts = vec![
            of(&self.now, last),
            of(last, &self.now),
            self.nearly(last, &free),
        ];
        if structure.hysteresis {
            let present = starts[0].clone();
            starts.extend(other_hystereses(self.data, &free, &present));
        }
        let search = |start: &[f64], effort| self.coarse.descend(&structure, &free, start, effort);
        let rough = starts.iter().filter_map(|s| search(s, ROUGH));
        let (_, start) = rough.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let (_, start) = search(&start, FAIR)?;
        let (_, values) = descend(self.fine, &structure, &free, &start, 30, 1e-6)?;
        settle(self.data, &structure, &free, values)
    }

    /// A model's values, with stages that it does not have set near the bound at which they have no
    /// effect: for a linear term a gain of zero is a valid start, for a stage it is not.
    fn nearly(&self, last: &Solution, free: &[Free]) -> Vec<f64> {
        let terms = &self.now.structure.terms;
        let is_stage = |role: Role| match role {
            Role::Stage { .. } => true,
            Role::Shape { term, .. } => terms
                .with_ids()
                .any(|(id, t)| id == term && t.effect.is_input_stage()),
            _ => false,
        };
        let value = |f: &Free| match last.value(f.role) {
            None if is_stage(f.role) => f.range.near_least(),
            known => known.or(self.now.value(f.role)).unwrap_or(0.5),
        };
        free.iter().map(value).collect()
    }

    /// For each name, the candidates that do as well instead of it once refitted.
    fn rivals(&self, standing: &Standing) -> Vec<Vec<Candidate>> {
        let own = self.declared.structure.terms.len();
        let linear = &standing.linear;
        let all = linear.everything();
        let columns = linear.columns_of(&all);
        let full = linear
            .grams
            .squared_error(&columns, linear.target_of(&all).0);
        let context = Context {
            linear,
            full,
            // Refitted squared errors on the coarse grid over those to first order.
            scale: standing.sse / full,
            moved: &standing.moved,
        };
        (own..self.now.structure.terms.len())
            .map(|index| self.rivals_of(&context, index))
            .collect()
    }

    fn rivals_of(&self, context: &Context, index: usize) -> Vec<Candidate> {
        use rayon::prelude::*;
        let linear = context.linear;
        let kept = Kept {
            dropped: vec![index],
            table: linear.has_table(),
        };
        let term = self.now.structure.terms[index];
        let known = self.entry(Identity::of(&term));
        let (close, sse) = context.close(&kept, &term, known);
        let allowed = policy::allowed_to_a_rival(sse, context.full);
        let really: Vec<Option<(Candidate, f64)>> = close
            .into_par_iter()
            .map(|g| {
                let swap = Move {
                    kept: kept.clone(),
                    added: vec![g],
                    promise: 0.0,
                    p: Vec::new(),
                };
                let grids = (self.coarse, context.moved);
                let wanted = |rough: &Priced| rough.sse / context.scale <= (1.0 + HALF) * allowed;
                let real = linear.refit(grids, &swap, STARTS, wanted)?;
                let left = real.sse / context.scale;
                let candidate = linear.groups[g].candidate()?;
                (left <= allowed).then_some((candidate, left))
            })
            .collect();
        let mut found: Vec<(Candidate, f64)> = really.into_iter().flatten().collect();
        found.extend(self.stages_instead(context, index));
        found.sort_by(|a, b| a.1.total_cmp(&b.1));
        // One function under two names is one effect: neither family is an alternative to it.
        let twin = Candidate::twin(&term);
        let mut rivals: Vec<Candidate> = Vec::new();
        for (rival, _) in found {
            let same =
                |o: &Candidate| (o.family, o.term.source) == (rival.family, rival.term.source);
            if !twin.iter().chain(&rivals).any(same) {
                rivals.push(rival);
            }
        }
        rivals
    }
}

impl Search<'_> {
    /// Other stages of the model whose residual without this one is as small as that of this one
    /// without them. Two stages may share one effect; then each is an alternative to the other.
    fn stages_instead(&self, context: &Context, index: usize) -> Vec<(Candidate, f64)> {
        let linear = context.linear;
        let terms = &self.now.structure.terms;
        let stages = self.declared.structure.terms.len()..terms.len();
        let others = stages.filter(|&other| other != index && is_stage(&terms[other].effect));
        let others: Vec<usize> = others.collect();
        if others.is_empty() || !is_stage(&terms[index].effect) {
            return Vec::new();
        }
        let without = |dropped: Vec<usize>| Kept {
            dropped,
            table: linear.has_table(),
        };
        let refitted = |out: usize| {
            let removal = Move {
                kept: without(vec![out]),
                added: Vec::new(),
                promise: 0.0,
                p: Vec::new(),
            };
            let grids = (self.coarse, context.moved);
            let real = linear.refit(grids, &removal, STARTS, |_| true)?;
            Some(real.sse / context.scale)
        };
        let Some(left) = refitted(index) else {
            return Vec::new();
        };
        let rival = |other: usize| {
            let sse = linear.left(&without(vec![index.min(other), index.max(other)]));
            let named = refitted(other)?;
            let does = left <= policy::allowed_to_a_rival(sse, named);
            does.then_some((Candidate::from(terms[other]), left))
        };
        others.into_iter().filter_map(rival).collect()
    }
}

/// Indices of the terms of a solution in the requested order; `None` if the sets differ.
fn order_of(solution: &Solution, wanted: &[Identity]) -> Option<Vec<usize>> {
    let terms = &solution.structure.terms;
    let mut order: Vec<usize> = Vec::new();
    for identity in wanted {
        let is_next = |i: &usize| !order.contains(i) && Identity::of(&terms[*i]) == *identity;
        let next = (0..terms.len()).find(is_next)?;
        order.push(next);
    }
    (order.len() == terms.len()).then_some(order)
}

/// The same model with its terms in another order.
fn arranged(data: &Prepared, solution: &Solution, order: &[usize]) -> Option<Solution> {
    if order.iter().copied().eq(0..solution.structure.terms.len()) {
        return Some(solution.clone());
    }
    let mut structure: Structure = solution.structure.clone();
    structure.terms = solution.structure.terms.arranged(order);
    let free = structure.free(data);
    let values: Option<Vec<f64>> = free.iter().map(|f| solution.value(f.role)).collect();
    settle(data, &structure, &free, values?)
}

impl Linear<'_> {
    /// Order of the terms: those of the baseline, then at each step the name that gives the least
    /// squared error together with those before it.
    fn by_weight(&self) -> Vec<usize> {
        let all = self.now.structure.terms.len();
        let mut order: Vec<usize> = (0..self.declared).collect();
        while order.len() < all {
            let error = |index: usize| {
                let out = |i: &usize| *i != index && !order.contains(i);
                let kept = Kept {
                    dropped: (self.declared..all).filter(out).collect(),
                    table: self.has_table(),
                };
                self.left(&kept)
            };
            let left = (self.declared..all).filter(|i| !order.contains(i));
            let best = left.min_by(|&a, &b| error(a).total_cmp(&error(b)));
            let Some(best) = best else { break };
            order.push(best);
        }
        order
    }
}

/// The final model, to first order and refitted.
struct Context<'a, 'b> {
    linear: &'a Linear<'b>,
    full: f64,
    scale: f64,
    moved: &'a Span,
}

impl Context<'_, '_> {
    /// Candidates of another family or channel that, to first order, nearly satisfy the rule for
    /// alternatives or satisfied it when the name was added, the best of each identity; and the
    /// squared error without the name. A stage acts on every column, so its first-order gain is the
    /// least accurate: for a stage, all other stages are refitted.
    fn close(&self, kept: &Kept, own: &FitTerm, known: Option<&Entry>) -> (Vec<usize>, f64) {
        let linear = self.linear;
        let swept = linear.without(kept);
        let (target, unit) = linear.target_of(kept);
        let sse = unit * swept.at(target, target);
        let mut close: Vec<(f64, usize)> = Vec::new();
        for (g, group) in linear.groups.iter().enumerate() {
            let Some(candidate) = group.candidate() else {
                continue;
            };
            if (candidate.family, candidate.term.source) == (own.effect.info().family, own.source)
                || is_told_apart(own, &candidate.term)
            {
                continue;
            }
            let gain = unit * swept.gain(&group.columns, target);
            // The gain at a trial shape predicts the gain at the fitted shape only roughly.
            let nearly = gain >= (1.0 - TWENTIETH) * (1.0 - PART) * (sse - self.full);
            let was = known.is_some_and(|e| e.siblings.iter().any(|s| s.is_like(&candidate)));
            let stages = is_stage(&own.effect) && is_stage(&candidate.term.effect);
            if !nearly && !was && !stages {
                continue;
            }
            match close
                .iter_mut()
                .find(|(_, o)| linear.groups[*o].is_like(group))
            {
                Some(slot) if slot.0 < gain => *slot = (gain, g),
                Some(_) => {}
                None => close.push((gain, g)),
            }
        }
        close.sort_by(|a, b| b.0.total_cmp(&a.0));
        (
            close.into_iter().take(RIVALS).map(|(_, g)| g).collect(),
            sse,
        )
    }
}
