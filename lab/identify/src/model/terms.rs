//! The effects of a model, each with an identity that does not depend on the others.

use super::parameter::{Free, Role};
use super::term::{FitTerm, TermId};
use std::ops::Deref;

/// Terms in the order in which they were added.
///
/// They are read as a slice; [`push`](Self::push) adds a term and assigns its identity. An identity
/// is never assigned twice, not even by a clone that replaces the original. Two clones that both
/// continue may assign one identity to different terms.
#[derive(Debug, Clone, Default)]
pub struct Terms {
    own: Vec<FitTerm>,
    ids: Vec<TermId>,
    next: u32,
}

/// Whether they are the same effects in the same order, with any identities.
impl PartialEq for Terms {
    fn eq(&self, other: &Self) -> bool {
        self.own == other.own
    }
}

impl Deref for Terms {
    type Target = [FitTerm];

    fn deref(&self) -> &[FitTerm] {
        &self.own
    }
}

impl<'a> IntoIterator for &'a Terms {
    type Item = &'a FitTerm;
    type IntoIter = std::slice::Iter<'a, FitTerm>;

    fn into_iter(self) -> Self::IntoIter {
        self.own.iter()
    }
}

impl FromIterator<FitTerm> for Terms {
    fn from_iter<I: IntoIterator<Item = FitTerm>>(terms: I) -> Self {
        let mut all = Self::default();
        for term in terms {
            all.push(term);
        }
        all
    }
}

impl Terms {
    /// Adds a term at the end, with a new identity.
    pub fn push(&mut self, term: FitTerm) -> TermId {
        let id = TermId(self.next);
        self.next += 1;
        self.own.push(term);
        self.ids.push(id);
        id
    }

    /// Removes a term, if present; the others keep their identities.
    pub fn remove(&mut self, id: TermId) -> Option<FitTerm> {
        let place = self.place(id)?;
        self.ids.remove(place);
        Some(self.own.remove(place))
    }

    /// Removes all terms except those that `stays` selects.
    pub fn retain(&mut self, mut stays: impl FnMut(&FitTerm) -> bool) {
        let mut kept = self.own.iter().map(&mut stays);
        self.ids.retain(|_| kept.next().unwrap_or(false));
        self.own.retain(stays);
    }

    /// Removes all terms except the first ones.
    pub fn truncate(&mut self, count: usize) {
        self.own.truncate(count);
        self.ids.truncate(count);
    }

    /// The same terms in another order, by their present places.
    #[must_use]
    pub fn arranged(&self, order: &[usize]) -> Self {
        let pairs = order.iter().filter_map(|&place| {
            let pair = (*self.own.get(place)?, *self.ids.get(place)?);
            Some(pair)
        });
        let (own, ids) = pairs.unzip();
        Self {
            own,
            ids,
            next: self.next,
        }
    }

    /// The identities, in the order of the terms.
    #[must_use]
    pub fn ids(&self) -> &[TermId] {
        &self.ids
    }

    /// The terms with their identities.
    pub fn with_ids(&self) -> impl Iterator<Item = (TermId, &FitTerm)> {
        self.ids.iter().copied().zip(&self.own)
    }

    /// The position of a term; `None` if the term has been removed.
    #[must_use]
    pub fn place(&self, id: TermId) -> Option<usize> {
        self.ids.iter().position(|own| *own == id)
    }

    /// A term by its identity; `None` if the term has been removed.
    #[must_use]
    pub fn find(&self, id: TermId) -> Option<&FitTerm> {
        self.own.get(self.place(id)?)
    }

    /// Whether a parameter is the time at which an effect steps.
    pub(crate) fn is_moment(&self, role: Role) -> bool {
        match role {
            Role::Shape { term, index } => self.find(term).is_some_and(|t| t.is_moment(index)),
            _ => false,
        }
    }

    /// The terms at the values of their free parameters; `None` if the core rejects one. Values of
    /// removed terms are ignored.
    #[must_use]
    pub fn at(&self, free: &[Free], values: &[f64]) -> Option<Self> {
        let mut all = self.clone();
        for (f, &value) in free.iter().zip(values) {
            let place = f.role.term().and_then(|id| self.place(id));
            let Some(term) = place.and_then(|place| all.own.get_mut(place)) else {
                continue;
            };
            match f.role {
                Role::Shape { index, .. } => {
                    term.effect = term.effect.with_shape(index, value).ok()?;
                }
                Role::Origin { .. } => term.origin = value,
                Role::Start { record, .. } => {
                    if let Some(start) = term.start.get_mut(record) {
                        *start = value;
                    }
                }
                Role::Rho | Role::Sigma | Role::N | Role::Eta0 { .. } | Role::Stage { .. } => {}
            }
        }
        Some(all)
    }

    /// Takes over the identities of the first terms of another model, which are the same effects
    /// in the same order, and updates the parameters.
    pub(crate) fn recognise(&mut self, free: &mut [Free], other: &Self) {
        for f in free {
            let place = f.role.term().and_then(|id| self.place(id));
            if let Some(&id) = place.and_then(|place| other.ids.get(place)) {
                f.role = f.role.of(id);
            }
        }
        for (own, id) in self.ids.iter_mut().zip(&other.ids) {
            *own = *id;
        }
        self.next = self.next.max(other.next);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::model::range::Range;
    use crate::problem::MOST_RECORDS;
    use bowden::effect::Effect;
    use bowden::model::Source;

    fn term(name: &str, shapes: &[f64]) -> FitTerm {
        FitTerm {
            effect: Effect::try_from_name(name, shapes).unwrap(),
            source: Source::Input,
            origin: 0.0,
            start: [0.0; MOST_RECORDS],
        }
    }

    /// Viscous, Coulomb and Stribeck friction.
    fn three() -> Terms {
        let all = [
            term("viscous", &[]),
            term("coulomb", &[0.1]),
            term("stribeck", &[0.2, 1.0]),
        ];
        all.into_iter().collect()
    }

    fn free(role: Role) -> Free {
        let range = Range::Free;
        Free { role, range }
    }

    #[test]
    fn removing_one_renames_nothing() {
        let mut terms = three();
        let [viscous, coulomb, stribeck] = terms.ids().try_into().unwrap();
        assert_eq!(terms.remove(coulomb).unwrap().effect.name(), "coulomb");
        assert_eq!(terms.ids(), [viscous, stribeck]);
        assert_eq!(terms.find(stribeck).unwrap().effect.name(), "stribeck");
        assert_eq!(
            (terms.place(stribeck), terms.place(coulomb)),
            (Some(1), None)
        );
        assert!(terms.remove(coulomb).is_none());
    }

    #[test]
    fn an_identity_is_not_given_again() {
        let mut terms = three();
        let gone = terms.ids()[2];
        terms.remove(gone);
        let next = terms.push(term("drift", &[]));
        assert_ne!(next, gone);
        let mut fewer = terms.clone();
        fewer.truncate(1);
        assert!(!terms.ids().contains(&fewer.push(term("gain", &[]))));
    }

    #[test]
    fn terms_that_stay_or_move_keep_their_identities() {
        let terms = three();
        let [viscous, coulomb, stribeck] = terms.ids().try_into().unwrap();
        let mut kept = terms.clone();
        kept.retain(|t| t.effect.name() != "viscous");
        assert_eq!(kept.ids(), [coulomb, stribeck]);
        assert_eq!(kept[0].effect.name(), "coulomb");
        let turned = terms.arranged(&[2, 0, 1]);
        assert_eq!(turned.ids(), [stribeck, viscous, coulomb]);
        assert_eq!(turned[0].effect.name(), "stribeck");
    }

    #[test]
    fn values_reach_their_term_wherever_it_is() {
        let mut terms = three();
        let [viscous, coulomb, stribeck] = terms.ids().try_into().unwrap();
        let (index, record) = (0, 1);
        let free = [
            free(Role::Shape {
                term: coulomb,
                index,
            }),
            free(Role::Start {
                term: stribeck,
                record,
            }),
            free(Role::Origin { term: viscous }),
        ];
        terms.remove(viscous);
        let terms = terms.arranged(&[1, 0]).at(&free, &[0.7, 5.0, 9.0]).unwrap();
        assert_eq!(terms.find(coulomb).unwrap().effect.shape(0), Some(0.7));
        assert_eq!(terms.find(stribeck).unwrap().start[1], 5.0);
        assert!(terms.iter().all(|t| t.origin == 0.0), "viscous has gone");
    }

    #[test]
    fn the_same_effects_of_another_model_are_recognised() {
        let (mut here, mut there) = (three(), three());
        for id in there.ids().to_vec() {
            there.remove(id);
        }
        for term in three().iter() {
            there.push(*term);
        }
        let index = 0;
        let role = |terms: &Terms| Role::Shape {
            term: terms.ids()[1],
            index,
        };
        let mut own = [free(role(&here))];
        here.recognise(&mut own, &there);
        assert_eq!(here.ids(), there.ids());
        assert_eq!(own[0].role, role(&there));
        assert!(!there.ids().contains(&here.push(term("drift", &[]))));
    }
}
