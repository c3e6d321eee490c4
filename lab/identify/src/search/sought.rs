//! The candidates of a forward selection, and the choice of the best one.

use super::bank::Identity;
use super::partial::{Entries, Partial};

/// One candidate of a forward selection.
pub(super) struct Choice<'a> {
    /// Its group; `None` for a name that the model already has.
    pub(super) group: Option<usize>,
    pub(super) identity: Identity,
    pub(super) columns: &'a [usize],
    /// Number of columns in its price.
    pub(super) freedoms: usize,
}

/// All candidates of a forward selection: the names of the model, then the catalogue's.
#[derive(Default)]
pub(super) struct Sought {
    pub(super) entries: Entries,
    pub(super) identities: Vec<Identity>,
    /// Number of columns in the price of each.
    freedoms: Vec<usize>,
    /// The group of each candidate; `None` for a name that the model already has.
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

    /// The candidate that lowers the criterion most; `None` if none lowers it. `factors` are
    /// exp(price).
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

    /// exp(price) of each candidate, from the price as a function of the number of columns.
    pub(super) fn factors(&self, price: impl Fn(usize) -> f64) -> Vec<f64> {
        let factor = |&freedoms: &usize| price(freedoms).exp();
        self.freedoms.iter().map(factor).collect()
    }
}
