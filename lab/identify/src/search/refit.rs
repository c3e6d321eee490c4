//! The squared error of a move with all shapes refitted, started from its linear prediction.

use super::bank::Own;
use super::coarse::{Coarse, Effort};
use super::kept::Kept;
use super::linear::{Linear, Member};
use super::moves::Move;
use crate::fit::projection::Span;
use crate::fit::settle::settle;
use crate::fit::Solution;
use crate::model::catalogue::{simplicity, Candidate};
use crate::model::structure::{FitTerm, Free, Range, Role, Structure, TermId};
use crate::model::Variable;
use crate::problem::Prepared;
use crate::score::hats::{score, Scored, HATS};

/// Evaluations and tolerance of a rough and of a fair search.
pub(super) const ROUGH: Effort = (10, 1e-3);
pub(super) const FAIR: Effort = (40, 1e-5);
/// Two further starts (rho in units of 1/reach of the input, sigma, n): the present hysteresis
/// may have adapted to the missing effect.
const HYSTERESES: [(f64, f64, f64); 2] = [(3.0, 0.6, 2.0), (25.0, 0.8, 1.5)];

/// A move that was refitted on the coarse grid.
pub(super) struct Tried {
    pub(super) made: Move,
    pub(super) structure: Structure,
    pub(super) values: Vec<f64>,
    /// The criterion.
    pub(super) j: f64,
    pub(super) sse: f64,
}

/// Squared error and criterion reached by a search.
pub(super) struct Priced {
    pub(super) sse: f64,
    pub(super) j: f64,
}

impl Tried {
    /// Order of preference: names before curves, curves before crowds; then the simpler effects.
    pub(super) fn rank(&self) -> (bool, bool, usize) {
        let terms = &self.structure.terms;
        // The constant exceeds every rank, so that a smaller number of effects comes first.
        let sum = terms.iter().map(|t| simplicity(&t.effect).0 + 30).sum();
        let came_in = &terms[terms.len().saturating_sub(self.made.added.len())..];
        let has_curve = self.structure.table.is_some();
        (!has_curve && is_crowd(came_in), has_curve, sum)
    }
}

/// Whether three or more effects read one variable: together they imitate any curve over it.
fn is_crowd(terms: &[FitTerm]) -> bool {
    let read: Vec<Vec<Variable>> = terms
        .iter()
        .map(|&term| Candidate::from(term).variables())
        .collect();
    let over = |variable: &Variable| read.iter().filter(|r| r.contains(variable)).count();
    read.iter().flatten().any(|variable| over(variable) > 2)
}

/// The structure of a move and the starts of its search.
struct Plan {
    structure: Structure,
    /// The added terms, each with its group.
    added: Vec<(TermId, usize)>,
    /// Price of an added curve.
    curve: f64,
}

impl Linear<'_> {
    /// Searches the shapes of a move on the coarse grid from at most `most` starts. `None` if no
    /// start can be evaluated, or if the best rough search does not satisfy `wanted`.
    pub(super) fn refit(
        &self,
        (coarse, moved): (&Coarse, &Span),
        one: &Move,
        most: usize,
        wanted: impl Fn(&Priced) -> bool,
    ) -> Option<Tried> {
        use rayon::prelude::*;
        let plan = self.plan(moved, one)?;
        let free = plan.structure.free(self.data);
        let search =
            |start: &[f64], effort: Effort| coarse.descend(&plan.structure, &free, start, effort);
        let mut starts = self.starts(&plan, one, &free);
        starts.truncate(most);
        // Two searches from one start at the same time would each be counted or one alone.
        starts.dedup();
        let rough: Vec<Option<(f64, Vec<f64>)>> =
            starts.par_iter().map(|s| search(s, ROUGH)).collect();
        let best = rough
            .into_iter()
            .flatten()
            .min_by(|a, b| a.0.total_cmp(&b.0))?;
        let added: f64 = one
            .added
            .iter()
            .map(|&g| match self.groups[g].member {
                Member::Name(_) => self.price(g),
                Member::Curve(_) => plan.curve,
            })
            .sum();
        let price = self.price_of(&one.kept) + added;
        let priced = |sse: f64| Priced {
            sse,
            j: (sse / self.unit()).ln() + price,
        };
        if !wanted(&priced(best.0)) {
            return None;
        }
        let (sse, values) = search(&best.1, FAIR)?;
        Some(Tried {
            j: priced(sse).j,
            made: one.clone(),
            structure: plan.structure,
            values,
            sse,
        })
    }

    fn plan(&self, moved: &Span, one: &Move) -> Option<Plan> {
        let mut structure = one.kept.of(&self.now.structure);
        let mut added = Vec::new();
        let mut curve = 0.0;
        for &g in &one.added {
            match self.groups[g].member {
                Member::Name(c) => added.push((structure.terms.push(c.term), g)),
                Member::Curve(variable) => {
                    let (scored, price) = match one.kept.dropped.is_empty() {
                        true => self.curve(moved, &self.now, variable)?,
                        false => self.curve_instead(&one.kept, variable)?,
                    };
                    structure.table = Some(scored.table);
                    curve = price;
                }
            }
        }
        Some(Plan {
            structure,
            added,
            curve,
        })
    }

    /// The curve that replaces the dropped names, fitted jointly with the kept columns.
    fn curve_instead(&self, kept: &Kept, variable: Variable) -> Option<(Scored, f64)> {
        let columns = self.columns_of(kept);
        let moved = Span::of(self.seen, columns.iter().map(|&c| &*self.columns.all[c]));
        let without = Solution {
            residual: self.seen.target.clone(),
            ..self.now.clone()
        };
        self.curve(&moved, &without, variable)
    }

    /// The curve with the number of hat functions that has the lowest criterion.
    fn curve(&self, moved: &Span, now: &Solution, variable: Variable) -> Option<(Scored, f64)> {
        let made = [1, 2, 4].into_iter().filter_map(|times| {
            let count = times * HATS;
            let scored = score(self.seen, now, moved, variable, count)?;
            let price = self.prices.of_curve(count);
            Some(((1.0 - scored.share).max(1e-14).ln() + price, scored, price))
        });
        let best = made.min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some((best.1, best.2))
    }

    /// Starts: the trial shapes, the linear step from them, and two other hystereses. Without the last
    /// two, once the model has names, a damper's record ends with six names instead of four, and with a
    /// held-out error of 7.4 % instead of 6.1 %.
    fn starts(&self, plan: &Plan, one: &Move, free: &[Free]) -> Vec<Vec<f64>> {
        let mut columns = self.columns_of(&one.kept);
        for &g in &one.added {
            columns.extend(&self.groups[g].columns);
        }
        let (target, _) = self.target_of(&one.kept);
        let gains = self.grams.coefficients(&columns, target);
        let gain = |column: usize| {
            let at = columns.iter().position(|&c| c == column);
            at.map_or(0.0, |i| gains[i])
        };
        let known: Vec<(f64, f64)> = free.iter().map(|f| self.known(plan, f, &gain)).collect();
        let stepped = free.iter().zip(&known).map(|(f, &(value, step))| {
            let step = match step.is_finite() {
                true => step.clamp(-1.0, 1.0),
                false => 0.0,
            };
            match f.range {
                _ if step == 0.0 => value,
                Range::Free => value + step,
                range => range.decode(range.on_line(value) + step),
            }
        });
        let plain: Vec<f64> = known.iter().map(|(value, _)| *value).collect();
        let mut starts = vec![plain.clone(), stepped.collect()];
        if plan.structure.hysteresis {
            starts.extend(other_hystereses(self.data, free, &plain));
        }
        starts
    }

    /// Value of a parameter, and its linear step on the unbounded scale of its range.
    fn known(&self, plan: &Plan, free: &Free, gain: &dyn Fn(usize) -> f64) -> (f64, f64) {
        let role = free.role;
        let present = |role: Role| {
            let i = self.now.free.iter().position(|f| f.role == role)?;
            Some((self.now.values[i], gain(self.free[i])))
        };
        let Some(term) = role.term() else {
            return present(role).unwrap_or((0.5, 0.0));
        };
        let Some((_, g)) = plan.added.iter().find(|(id, _)| *id == term) else {
            return present(role).unwrap_or((0.0, 0.0));
        };
        let group = &self.groups[*g];
        let own = gain(group.columns[0]);
        let slope = group.slopes.iter().position(|s| match (s.own, role) {
            (Own::Shape(i), Role::Shape { index, .. }) => i == index,
            (Own::Origin, Role::Origin { .. }) => true,
            _ => false,
        });
        let step = slope.map_or(0.0, |i| gain(group.columns[1 + i]) / own);
        let start = plan.structure.terms.find(term);
        (start.map_or(0.0, |t| start_of(t, free, own)), step)
    }
}

/// The given values, with each of [`HYSTERESES`] instead of their own hysteresis.
pub(super) fn other_hystereses<'a>(
    data: &'a Prepared,
    free: &'a [Free],
    values: &'a [f64],
) -> impl Iterator<Item = Vec<f64>> + 'a {
    HYSTERESES.into_iter().map(move |(rho, sigma, n)| {
        let at = |(f, &v): (&Free, &f64)| match f.role {
            Role::Rho => rho / data.input.reach,
            Role::Sigma => sigma,
            Role::N => n,
            Role::Eta0 { .. } => f.range.inside(v),
            _ => v,
        };
        free.iter().zip(values).map(at).collect()
    })
}

/// Start of a parameter of an added term.
fn start_of(term: &FitTerm, free: &Free, gain: f64) -> f64 {
    match free.role {
        Role::Shape { index, .. } => term.effect.shape(index).unwrap_or(0.0),
        Role::Origin { .. } => term.origin,
        Role::Stage { .. } => free.range.inside(gain),
        _ => 0.0,
    }
}

/// Squared error of the present model on the coarse grid.
pub(super) fn present(data: &Prepared, coarse: &Coarse, now: &Solution) -> f64 {
    let free = now.structure.free(data);
    let reached = coarse.descend(&now.structure, &free, &now.values, (10, 1e-4));
    reached.map_or(f64::INFINITY, |(sse, _)| sse)
}

/// The present model, evaluated on the rows that the fit sees.
pub(super) fn on(seen: &Prepared, data: &Prepared, now: &Solution) -> Option<Solution> {
    let free = now.structure.free(data);
    settle(seen, &now.structure, &free, now.values.clone())
}
