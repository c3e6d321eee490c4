//! Power-law drag instead of other friction terms.
//!
//! `sgn(v)·|v|^a`, 0 < a < 1, lies between Coulomb (a towards 0) and viscous friction (a = 1). It
//! fits a sum of the two nearly as well as they do, with one name instead of two, so the price of a
//! name would decide between them. Power-law drag is therefore not a candidate of the moves. Once
//! no move is accepted any more, two replacements are refitted for the named friction of a channel,
//! or for a curve over its velocity: the power law, and the pair of viscous and Coulomb friction,
//! which has one parameter more. The power law is named only if its criterion is better than that
//! of the named terms, and if its error on blocks that were left out of the fit of the gains is
//! smaller than that of the pair, by more than chance. If the residual exceeds the noise, every
//! block repeats the same misfit: then the power law must also be better by a margin, and halve the
//! pair's squared error. At the noise, a margin would keep viscous, Coulomb and Stribeck friction,
//! which together imitate a power law.

use super::bank::Identity;
use super::kept::Kept;
use super::moves::is_same;
use super::policy;
use super::refit::{other_hystereses, FAIR, ROUGH};
use super::run::{Search, Standing, FALLEN};
use crate::fit::search::descend;
use crate::fit::settle::settle;
use crate::fit::Solution;
use crate::ledger::Rejection;
use crate::model::structure::{FitTerm, Role, Structure};
use crate::model::Variable;
use crate::problem::MOST_RECORDS;
use crate::scale::{is_raised, LEVEL_OF_ONE, PART, TWENTIETH};
use crate::score::blocks::{sign_flip_p_above, Regime};
use crate::score::left_out::ratios;
use bowden::effect::Effect;
use bowden::model::Source;

/// The effect that replaces other friction.
const POWER_LAW: &str = "power-law";
/// The pair that it must outperform.
const PAIR: [&str; 2] = ["viscous", "coulomb"];
/// Friction between rest and fast motion, which a power law may replace.
const FRICTION: &[&str] = &["viscous", "coulomb", "stribeck"];
/// This friction, and drag that grows faster than the velocity.
const WITH_DRAG: &[&str] = &[
    "viscous",
    "coulomb",
    "stribeck",
    "drag-quadratic",
    "drag-cubic",
];
/// Exponents from which the fit starts.
const EXPONENTS: [f64; 2] = [0.3, 0.6];
/// Widths of the sign, in units of the usual speed, from which Coulomb's fit starts: those of
/// its trial shapes.
const WIDTHS: [f64; 2] = [0.01, 0.08];
/// Number of starts that continue after the rough search.
const FURTHER: usize = 2;

/// Whether one name is a power law, and the other is friction on the same channel with which it was
/// compared.
pub(super) fn is_told_apart(own: &FitTerm, other: &FitTerm) -> bool {
    own.effect.name() == POWER_LAW
        && own.source == other.source
        && PAIR.contains(&other.effect.name())
}

fn has(terms: &[FitTerm], source: Source, name: &str) -> bool {
    let mut terms = terms.iter();
    terms.any(|t| t.source == source && t.effect.name() == name)
}

/// The terms that a power law would replace.
struct Place {
    source: Source,
    kept: Kept,
}

impl Search<'_> {
    /// Replaces named friction with a power law; returns whether it was replaced.
    pub(super) fn exchanged(&mut self, standing: &Standing) -> bool {
        let linear = &standing.linear;
        let here = linear.identities(&linear.everything(), &[]);
        let is_new = !self.exchanges.iter().any(|known| is_same(known, &here));
        if self.regime != Regime::Blocks || !is_new {
            return false;
        }
        self.exchanges.push(here);
        for place in self.places() {
            if let Some((next, p)) = self.with_power_law(standing, &place) {
                self.exchange(&place, next, p);
                return true;
            }
        }
        false
    }

    /// The channels with named friction, or with a curve over their velocity, and the terms that a
    /// power law would replace there.
    fn places(&self) -> Vec<Place> {
        let terms = &self.now.structure.terms;
        let own = self.declared.structure.terms.len();
        let curve = self.now.structure.table.as_ref().map(|t| t.variable);
        let over = match curve {
            Some(Variable::Velocity(source)) => Some(source),
            _ => None,
        };
        let mut places: Vec<Place> = Vec::new();
        for source in terms[own..].iter().map(|term| term.source).chain(over) {
            // Where both are declared, there is no pair to compare it with.
            let both = PAIR.iter().all(|name| self.declares(source, name));
            if both || has(terms, source, POWER_LAW) {
                continue;
            }
            let table = curve.is_some_and(|v| v != Variable::Velocity(source));
            let among = |replaced: &[&str]| -> Vec<usize> {
                let is = |t: &FitTerm| t.source == source && replaced.contains(&t.effect.name());
                (own..terms.len()).filter(|&i| is(&terms[i])).collect()
            };
            let all = [among(WITH_DRAG), among(FRICTION)];
            // One of three or more may be there in addition.
            let but_one = all[0].iter().filter(|_| all[0].len() > 2).map(|&kept| {
                let others = all[0].iter().filter(|&&i| i != kept);
                others.copied().collect()
            });
            for dropped in all.iter().cloned().chain(but_one) {
                let kept = Kept { dropped, table };
                let known = |p: &Place| p.source == source && p.kept == kept;
                let is_something = !kept.dropped.is_empty() || over == Some(source);
                if is_something && !places.iter().any(known) {
                    places.push(Place { source, kept });
                }
            }
        }
        places
    }

    /// Whether the baseline model has this effect on this channel.
    fn declares(&self, source: Source, name: &str) -> bool {
        has(&self.declared.structure.terms, source, name)
    }

    /// The model with a power law instead, and the p-value of its comparison with the pair; `None`
    /// if the power law is not accepted.
    fn with_power_law(&self, standing: &Standing, place: &Place) -> Option<(Solution, f64)> {
        let linear = &standing.linear;
        let laws: Option<Vec<Structure>> = EXPONENTS
            .iter()
            .map(|&a| self.with(place, &[(POWER_LAW, &[a])]))
            .collect();
        // Its gain and its exponent.
        let price = linear.price_of(&place.kept) + linear.prices.of_name(2);
        let present = standing.sse.ln() + linear.price_of(&linear.everything());
        let is_hopeless = |rough: f64| rough.ln() + price > present + policy::HOPELESS;
        let law = self.fitted(&laws?, 1, is_hopeless)?;
        let new = law.sse(self.data).ln() + price;
        let old = self.now.sse(self.data).ln() + linear.price_of(&linear.everything());
        // Above the noise every block repeats the same misfit, which no test among blocks sees.
        let is_noise = self.is_at_noise(&law);
        let margin = match is_noise {
            true => FALLEN,
            false => PART,
        };
        if new > old - margin || is_raised(law.rmse.selection, self.now.rmse.selection) {
            return None;
        }
        let pair = self.pair(place)?;
        let p = sign_flip_p_above(&ratios(self.data, &pair, &law));
        let gained = (pair.sse(self.data) / law.sse(self.data)).ln();
        let (least, worst) = match is_noise {
            true => (0.0, 1.0 + TWENTIETH),
            false => (policy::CURVE_AGAINST_NAMES, 1.0),
        };
        let beats = p <= LEVEL_OF_ONE
            && gained > least
            && law.rmse.selection <= worst * pair.rmse.selection;
        beats.then_some((law, p))
    }

    /// The model with viscous and Coulomb friction instead.
    fn pair(&self, place: &Place) -> Option<Solution> {
        let speed = self.data.channel(place.source)?.speed;
        let beside = place.kept.of(&self.now.structure);
        let lacks = |name: &str| !has(&beside.terms, place.source, name);
        let made = |width: f64| {
            let shapes = [width * speed];
            let both: [(&str, &[f64]); 2] = [(PAIR[0], &[]), (PAIR[1], &shapes)];
            let added: Vec<_> = both.into_iter().filter(|(name, _)| lacks(name)).collect();
            self.with(place, &added)
        };
        let pairs: Option<Vec<Structure>> = WIDTHS.into_iter().map(made).collect();
        self.fitted(&pairs?, 1, |_| false)
    }

    /// The present structure with other effects instead.
    fn with(&self, place: &Place, added: &[(&str, &[f64])]) -> Option<Structure> {
        let mut structure = place.kept.of(&self.now.structure);
        for (name, shapes) in added {
            structure.terms.push(FitTerm {
                effect: Effect::try_from_name(name, shapes).ok()?,
                source: place.source,
                origin: 0.0,
                start: [0.0; MOST_RECORDS],
            });
        }
        Some(structure)
    }

    /// The best fit from the shapes of some structures of the same effects, the other parameters
    /// as they are, and from two other hystereses with the shapes of the first `few` of them. `None`
    /// where the squared error of the best rough search on the coarse grid is hopeless.
    pub(super) fn fitted(
        &self,
        structures: &[Structure],
        few: usize,
        is_hopeless: impl Fn(f64) -> bool,
    ) -> Option<Solution> {
        use rayon::prelude::*;
        let structure = structures.first()?;
        let free = structure.free(self.data);
        let start = |from: &Structure| -> Vec<f64> {
            let shape = |role: Role| match role {
                Role::Shape { term, index } => from.terms.find(term)?.effect.shape(index),
                Role::Origin { term } => Some(from.terms.find(term)?.origin),
                Role::Start { .. } => Some(0.0),
                _ => None,
            };
            let value = |role: Role| self.now.value(role).or_else(|| shape(role));
            free.iter().map(|f| value(f.role).unwrap_or(0.5)).collect()
        };
        let mut starts: Vec<Vec<f64>> = structures.iter().map(start).collect();
        if structure.hysteresis {
            let present: Vec<Vec<f64>> = starts.iter().take(few).cloned().collect();
            let others = |from: &Vec<f64>| -> Vec<Vec<f64>> {
                other_hystereses(self.data, &free, from).collect()
            };
            starts.extend(present.iter().flat_map(others));
        }
        let search = |start: &[f64], effort| self.coarse.descend(structure, &free, start, effort);
        let rough: Vec<_> = starts.par_iter().map(|s| search(s, ROUGH)).collect();
        let mut rough: Vec<_> = rough.into_iter().flatten().collect();
        rough.sort_by(|a, b| a.0.total_cmp(&b.0));
        if rough.first().is_none_or(|(sse, _)| is_hopeless(*sse)) {
            return None;
        }
        rough.truncate(FURTHER);
        let fair: Vec<_> = rough.par_iter().map(|(_, s)| search(s, FAIR)).collect();
        let fair = fair.into_iter().flatten();
        let (_, start) = fair.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let (_, values) = descend(self.fine, structure, &free, &start, 30, 1e-6)?;
        settle(self.data, structure, &free, values)
    }

    fn exchange(&mut self, place: &Place, next: Solution, p: f64) {
        let dropped = place.kept.dropped.iter();
        let dropped: Vec<Rejection> = dropped.map(|&index| self.out(index)).collect();
        self.superseded.extend(dropped);
        self.named(Identity::Name(POWER_LAW, place.source), next, p);
    }
}
