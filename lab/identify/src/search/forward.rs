//! First-order forward selection: terms are added one at a time while the criterion falls.

use super::gram::Swept;
use super::kept::Kept;
use super::linear::Linear;
use super::partial::Partial;
use super::policy;

impl Linear<'_> {
    /// Forward selection from a set, up to `most` names; returns the added groups.
    pub(super) fn greedy(&self, kept: &Kept, added: &[usize], most: usize) -> Vec<usize> {
        let (target, _) = self.target_of(kept);
        self.completed(&self.without(kept), target, added, most)
    }

    /// Forward selection on a matrix from which the columns of a set are already swept.
    pub(super) fn completed(
        &self,
        swept: &Swept,
        target: usize,
        added: &[usize],
        most: usize,
    ) -> Vec<usize> {
        let sought = &self.sought;
        let factors = sought.factors(|freedoms| self.prices.of_name(freedoms));
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

    /// Squared error after a forward selection from the present set, in units of the output's
    /// squared scale.
    pub(super) fn left_by_names(&self) -> f64 {
        let all = self.everything();
        let (target, unit) = self.target_of(&all);
        let mut columns = self.columns_of(&all);
        for g in self.greedy(&all, &[], policy::MOST_NAMES) {
            columns.extend(&self.groups[g].columns);
        }
        unit * self.grams.squared_error(&columns, target)
    }
}
