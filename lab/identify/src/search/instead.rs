//! Single terms instead of a curve.
//!
//! To first order, a curve over a variable promises more than a single term over it whose shape
//! lies between trial shapes, and so do many terms together. After a refit the single term may be
//! as good. Before a curve is accepted, the most promising terms over its variable are therefore
//! refitted.

use super::linear::{Linear, Member};
use super::moves::{is_same, Move};
use super::policy;
use super::refit::{Priced, Tried};
use super::run::{Search, Standing, FALLEN};
use crate::model::catalogue::Candidate;
use crate::model::kind::is_stage;
use crate::model::Variable;
use crate::score::blocks::Regime;

impl Linear<'_> {
    /// The variable of a curve that a move adds.
    fn curve_of(&self, one: &Move) -> Option<Variable> {
        let member = |&g: &usize| match self.groups[g].member {
            Member::Curve(variable) => Some(variable),
            Member::Name(_) => None,
        };
        one.added.iter().find_map(member)
    }

    /// Whether a move adds a curve.
    pub(super) fn adds_curve(&self, one: &Move) -> bool {
        self.curve_of(one).is_some()
    }

    /// The names over the variable of a curve that a move adds, the most promising ones first. Each
    /// replaces the curve alone, at its best trial shape, and must pass the test, as in a move.
    fn names_instead(&self, curve: &Move) -> Vec<Move> {
        let Some(variable) = self.curve_of(curve) else {
            return Vec::new();
        };
        let mut instead: Vec<Move> = Vec::new();
        for mut one in self.moves_from(&curve.kept) {
            let [g] = one.added[..] else { continue };
            // As the curve, a function of the variable: nothing that remembers, no stage.
            let reads = |c: &Candidate| {
                let effect = &c.term.effect;
                c.variables().contains(&variable) && !effect.info().memory && !is_stage(effect)
            };
            let is_known = |m: &Move| self.groups[m.added[0]].is_like(&self.groups[g]);
            if !self.groups[g].candidate().is_some_and(|c| reads(&c))
                || instead.iter().any(is_known)
            {
                continue;
            }
            one.p = self.p_values(&one);
            let fails = self.regime == Regime::Blocks && one.p[0] > self.prices.level;
            if !fails {
                instead.push(one);
            }
            if instead.len() == policy::INSTEAD {
                break;
            }
        }
        instead
    }
}

impl Search<'_> {
    /// Refits the names instead of a curve; returns those that lower the criterion. They do not
    /// count as visited: together with a curve, or later, each may do better.
    pub(super) fn names_instead(&self, standing: &Standing, curve: &Move, j: f64) -> Vec<Tried> {
        let linear = &standing.linear;
        let mut tried = Vec::new();
        for one in linear.names_instead(curve) {
            let set = linear.identities(&one.kept, &one.added);
            if self.visited.iter().any(|known| is_same(known, &set)) {
                continue;
            }
            let grids = (self.coarse, &standing.moved);
            let wanted = |rough: &Priced| rough.j < j + policy::HOPELESS;
            tried.extend(linear.refit(grids, &one, usize::MAX, wanted));
        }
        tried.retain(|t| t.j < j - FALLEN);
        tried
    }
}
