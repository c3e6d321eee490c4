//! What a forward selection chooses among, and its choice.

use super::bank::Identity;
use super::partial::{Entries, Partial};

/// One of those that a selection chooses among.
pub(super) struct Choice<'a> {
    /// The candidate's group; `None` of a name of the model.
    pub(super) group: Option<usize>,
    pub(super) identity: Identity,
    pub(super) columns: &'a [usize],
    /// Number of columns that it pays for.
    pub(super) freedoms: usize,
}

/// What a forward selection chooses among: the model's own names, then the candidates.
#[derive(Default)]
pub(super) struct Sought {
    pub(super) entries: Entries,
    pub(super) identities: Vec<Identity>,
    /// Number of columns that each pays for.
    freedoms: Vec<usize>,
    /// The candidate's group; `None` of a name of the model.
    pub(super) groups: Vec<Option<usize>>,
}

impl Sought {
    pub(super) fn of(all: &[Choice]) -> Self {
        Self {
            entries: Entries::of(all.iter().map(|one| one.columns)),
            identities: all.iter().map(|one| one.identity).collect(),
            freedoms: all.iter().map(|one| one.freedoms).collect(),
            groups: all.iter().map(|one| one.group).collect(),
        }
    }

    /// What lowers the criterion most, if anything does; `factors` are e to the prices.
    pub(super) fn best(
        &self,
        partial: &Partial,
        factors: &[f64],
        allowed: impl Fn(usize) -> bool,
    ) -> Option<usize> {
        let sse = partial.squared_error().max(1e-14);
        let left = |n: usize| (1.0 - partial.gain(n) / sse).max(1e-14) * factors[n];
        let all = (0..self.identities.len()).filter(|&n| allowed(n));
        let best = all
            .map(|n| (left(n), n))
            .min_by(|a, b| a.0.total_cmp(&b.0))?;
        (best.0 < 1.0).then_some(best.1)
    }

    /// e to the price of each, from the price of so many columns.
    pub(super) fn factors(&self, price: impl Fn(usize) -> f64) -> Vec<f64> {
        let factor = |&freedoms: &usize| price(freedoms).exp();
        self.freedoms.iter().map(factor).collect()
    }
}
