//! A play or a stop that the hysteresis imitates.
//!
//! Both effects are hystereses. The hysteresis of the baseline, fitted without them, imitates their
//! loop, and their column then lies in the span of its slopes. To first order the effect gains
//! nothing, so no move proposes it, although the residual may be up to twelve times the noise. The
//! gain shows only if the hysteresis is refitted together with the effect. Therefore, if no move is
//! accepted any more and the residual exceeds the noise, a stop is added to the model and all is
//! refitted, from its trial widths and from three hystereses. The stop is named if the model then
//! reaches the noise, and if its error on left-out blocks is smaller by more than chance. A stop
//! with a negative gain is a play.
//!
//! To halve the squared error is not enough. On a damper's record whose noise no model reaches, a
//! stop did so. Its selection frequency was 9 of 100 half-records, and the model's error on the
//! rig's other records was 28 times the error on its own record, instead of six times.

use super::bank::Identity;
use super::moves::is_same;
use super::policy;
use super::run::{gates, Search, Standing};
use crate::fit::settle::settle;
use crate::fit::Solution;
use crate::model::catalogue::Candidate;
use crate::model::structure::{FitTerm, Role, Structure};
use crate::scale::{LEVEL_OF_ONE, NOISE, PART};
use crate::score::blocks::{sign_flip_p_above, Regime};
use crate::score::left_out::ratios;
use bowden::model::Source;

/// The effect that a hysteresis may hide if both read the input.
const HIDDEN: &str = "presliding";

impl Search<'_> {
    /// Names an effect that the hysteresis hides; returns whether one was named.
    pub(super) fn uncovered(&mut self, standing: &Standing) -> bool {
        let linear = &standing.linear;
        let here = linear.identities(&linear.everything(), &[]);
        let is_new = !self.uncovered.iter().any(|known| is_same(known, &here));
        let is_noise = self.is_at_noise(&self.now);
        let found = self.now.structure.terms.len() - self.declared.structure.terms.len();
        let may = self.now.structure.hysteresis && found < self.most;
        if !is_new || is_noise || !may || self.regime != Regime::Blocks {
            return false;
        }
        self.uncovered.push(here);
        let Some((next, p)) = self.with_hidden(standing) else {
            return false;
        };
        let Some(added) = next.structure.terms.iter().last().copied() else {
            return false;
        };
        self.named(Identity::of(&added), next, p);
        true
    }

    /// The model with an additional stop or play of the input, and the p-value of the comparison;
    /// `None` if the effect is not accepted.
    fn with_hidden(&self, standing: &Standing) -> Option<(Solution, f64)> {
        let linear = &standing.linear;
        let terms = linear.groups.iter().filter_map(|group| group.candidate());
        let terms = terms.map(|candidate| candidate.term);
        let own = terms.filter(|t| t.source == Source::Input && t.effect.name() == HIDDEN);
        let structures: Vec<Structure> = own.map(|term| self.and(term)).collect();
        let at_noise = (NOISE * self.data.noise_floor / self.now.rmse.fit).powi(2);
        let is_hopeless = |rough: f64| (rough / (at_noise * standing.sse)).ln() > policy::HOPELESS;
        let next = self.fitted(&structures, structures.len(), is_hopeless)?;
        let next = self.of_its_sign(next)?;
        let gained = (self.now.sse(self.data) / next.sse(self.data)).ln();
        let least = linear.prices.of_name(2) + PART;
        let p = sign_flip_p_above(&ratios(self.data, &self.now, &next));
        let accepted = self.is_at_noise(&next)
            && gained > least
            && p <= LEVEL_OF_ONE
            && gates(self.data, &self.now, &next, linear.regime).is_ok();
        accepted.then_some((next, p))
    }

    /// The present structure with one more term.
    fn and(&self, term: FitTerm) -> Structure {
        let mut structure = self.now.structure.clone();
        structure.terms.push(term);
        structure
    }

    /// A presliding with a negative gain is a backlash.
    fn of_its_sign(&self, model: Solution) -> Option<Solution> {
        let index = model.structure.terms.len() - 1;
        let term = model.structure.terms.at(&model.free, &model.values)?[index];
        let (true, Some(Candidate { term, .. })) =
            (model.gain(index) < 0.0, Candidate::twin(&term))
        else {
            return Some(model);
        };
        let structure = self.and(term);
        let free = structure.free(self.data);
        let value = |role: Role| match role {
            Role::Shape { term, index } => {
                let own = structure.terms.find(term)?;
                model.value(role).or_else(|| own.effect.shape(index))
            }
            _ => model.value(role),
        };
        let values: Option<Vec<f64>> = free.iter().map(|f| value(f.role)).collect();
        settle(self.data, &structure, &free, values?)
    }
}
