//! A play or a stop that the hysteresis imitates.
//!
//! Both are hystereses. The declared one, fitted without them, bends towards their loop, and where
//! it has arrived their column lies among its own slopes: to first order nothing is gained, and no
//! move proposes them, with up to twelve times the noise left. What they explain shows only where
//! the hysteresis is fitted anew together with them. So once no move is accepted any more and more
//! than noise is left, a stop is refitted beside all that is there, from its trial widths and from
//! three hystereses. It is named if the model then ends at the noise, and errs less on left-out
//! blocks by more than chance. With a negative gain it is a play.
//!
//! That it halves the squared error is not enough. On a damper's record, of which no model reaches the
//! noise, a stop did; it recurred in 9 of 100 half-records, and the model erred 28 times as much on the
//! rig's other records as at home, in place of six times.

use super::bank::Identity;
use super::moves::is_same;
use super::policy;
use super::run::{gates, Search, Standing};
use crate::fit::settle::settle;
use crate::fit::Solution;
use crate::model::catalogue::Candidate;
use crate::model::structure::{FitTerm, Role, Structure};
use crate::score::blocks::{sign_flip_p_above, Regime};
use crate::score::left_out::ratios;
use bowden::model::Source;

/// The effect that a hysteresis may hide where both read the input.
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

    /// The model with a stop or a play of the input beside all that is there, and the p-value of
    /// the comparison; `None` where it is not accepted.
    fn with_hidden(&self, standing: &Standing) -> Option<(Solution, f64)> {
        let linear = &standing.linear;
        let terms = linear.groups.iter().filter_map(|group| group.candidate());
        let terms = terms.map(|candidate| candidate.term);
        let own = terms.filter(|t| t.source == Source::Input && t.effect.name() == HIDDEN);
        let structures: Vec<Structure> = own.map(|term| self.and(term)).collect();
        let at_noise = (policy::AT_FLOOR * self.data.noise_floor / self.now.rmse.fit).powi(2);
        let is_hopeless = |rough: f64| (rough / (at_noise * standing.sse)).ln() > policy::HOPELESS;
        let next = self.fitted(&structures, structures.len(), is_hopeless)?;
        let next = self.of_its_sign(next)?;
        let gained = (self.now.sse(self.data) / next.sse(self.data)).ln();
        let least = linear.prices.of_name(2) + policy::EQUAL;
        let p = sign_flip_p_above(&ratios(self.data, &self.now, &next));
        let accepted = self.is_at_noise(&next)
            && gained > least
            && p <= policy::SHORTER
            && gates(self.data, &self.now, &next, linear.regime).is_ok();
        accepted.then_some((next, p))
    }

    /// The present structure and one term more.
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
