//! Names that are added one by one, to first order, while the criterion falls.

use super::bank::Identity;
use super::gram::Swept;
use super::linear::{Kept, Linear};
use super::partial::{Entries, Partial};
use super::policy;

/// What a forward selection chooses among: the model's own names, then the candidates.
#[derive(Default)]
pub(super) struct Sought {
    entries: Entries,
    identities: Vec<Identity>,
    /// Number of columns that each pays for.
    freedoms: Vec<usize>,
    /// The candidate's group; `None` of a name of the model.
    groups: Vec<Option<usize>>,
}

impl Sought {
    pub(super) fn of(linear: &Linear) -> Self {
        let own = (linear.declared..linear.now.structure.terms.len()).map(|index| {
            let columns = linear.term(index);
            let identity = Identity::of(&linear.now.structure.terms[index]);
            (None, identity, columns, columns.len())
        });
        let groups = linear.groups.iter().enumerate();
        let groups = groups.filter(|(_, group)| !group.is_curve());
        let groups = groups.map(|(g, group)| {
            let columns = &group.columns[..];
            (Some(g), group.identity(), columns, group.freedoms)
        });
        let all: Vec<_> = own.chain(groups).collect();
        Self {
            entries: Entries::of(all.iter().map(|one| one.2)),
            identities: all.iter().map(|one| one.1).collect(),
            freedoms: all.iter().map(|one| one.3).collect(),
            groups: all.iter().map(|one| one.0).collect(),
        }
    }

    /// What lowers the criterion most, if anything does; `factors` are e to the prices.
    fn best(
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

    fn factors(&self, linear: &Linear) -> Vec<f64> {
        let price = |&freedoms: &usize| linear.prices.of_name(freedoms).exp();
        self.freedoms.iter().map(price).collect()
    }
}

impl Linear<'_> {
    /// Names that are added one by one while the criterion falls, from a set on.
    pub(super) fn greedy(&self, kept: &Kept, added: &[usize], most: usize) -> Vec<usize> {
        let (target, _) = self.target_of(kept);
        self.completed(&self.without(kept), target, added, most)
    }

    /// The same beside what a swept matrix has taken out.
    pub(super) fn completed(
        &self,
        swept: &Swept,
        target: usize,
        added: &[usize],
        most: usize,
    ) -> Vec<usize> {
        let sought = &self.sought;
        let factors = sought.factors(self);
        let mut partial = Partial::beside(swept, &sought.entries, target);
        for &g in added {
            partial.sweep(&self.groups[g].columns);
        }
        let mut all = added.to_vec();
        while all.len() < most {
            let free = |n: usize| {
                let group = sought.groups[n].map(|g| &self.groups[g]);
                group.is_some_and(|own| all.iter().all(|&a| !self.groups[a].is_like(own)))
            };
            let best = sought.best(&partial, &factors, free);
            let Some((n, g)) = best.and_then(|n| Some((n, sought.groups[n]?))) else {
                break;
            };
            partial.sweep(sought.entries.group(n));
            all.push(g);
        }
        all
    }

    /// What a forward selection among the candidates and the model's own names finds on some
    /// blocks, beside the declared model.
    pub(super) fn found_on(&self, blocks: &[usize]) -> Vec<Identity> {
        let sought = &self.sought;
        let factors = sought.factors(self);
        let names = self.declared..self.now.structure.terms.len();
        let declared = Kept {
            dropped: names.collect(),
            table: self.has_table(),
        };
        let (target, _) = self.target_of(&self.everything());
        let mut partial = Partial::on_blocks(&self.grams, blocks, &sought.entries, target);
        partial.sweep(&self.columns_of(&declared));
        let mut found: Vec<Identity> = Vec::new();
        while found.len() < policy::MOST_NAMES {
            let free = |n: usize| !found.contains(&sought.identities[n]);
            let Some(n) = sought.best(&partial, &factors, free) else {
                break;
            };
            found.push(sought.identities[n]);
            partial.sweep(sought.entries.group(n));
        }
        found
    }
}
