//! Forward selection to first order: names are added one at a time while the criterion falls.

use super::linear::Linear;
use super::policy;

impl Linear<'_> {
    /// The columns of the present model, and of the names that a forward selection adds to it.
    pub(super) fn with_names(&self) -> Vec<usize> {
        let all = self.everything();
        let (target, _) = self.target_of(&all);
        let mut columns = self.columns_of(&all);
        let mut swept = self.without(&all);
        let mut added: Vec<usize> = Vec::new();
        while added.len() < policy::MOST_NAMES {
            let sse = swept.at(target, target).max(1e-14);
            let is_new = |g: &usize| {
                let own = &self.groups[*g];
                !own.is_curve() && added.iter().all(|&a| !self.groups[a].is_like(own))
            };
            let left = |g: usize| {
                let gain = swept.gain(&self.groups[g].columns, target);
                (1.0 - gain / sse).max(1e-14).ln() + self.price(g)
            };
            let names = (0..self.groups.len()).filter(is_new);
            let best = names
                .map(|g| (left(g), g))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            let Some((_, g)) = best.filter(|(change, _)| *change < 0.0) else {
                break;
            };
            swept.sweep(&self.groups[g].columns);
            columns.extend(&self.groups[g].columns);
            added.push(g);
        }
        columns
    }

    /// Squared error that a forward selection from the present set leaves, in units of the output's
    /// squared scale.
    pub(super) fn left_by_names(&self) -> f64 {
        let (target, unit) = self.target_of(&self.everything());
        unit * self.grams.squared_error(&self.with_names(), target)
    }
}
