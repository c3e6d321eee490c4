//! Columns of the present model, and the target of each set without some of its stages.

use crate::fit::Solution;
use crate::model::structure::Role;
use crate::problem::{Prepared, Stretch};
use std::sync::Arc;

/// Columns of the present model, by the part of the model that they belong to.
pub(super) struct Present {
    pub(super) columns: Vec<Arc<Stretch>>,
    pub(super) own: Vec<usize>,
    pub(super) terms: Vec<Vec<usize>>,
    pub(super) table: Vec<usize>,
    pub(super) free: Vec<usize>,
    pub(super) target: usize,
    pub(super) unstaged: Vec<(Vec<usize>, usize)>,
}

impl Present {
    /// Appends the model's columns to those of the bank.
    pub(super) fn new(mut columns: Vec<Arc<Stretch>>, data: &Prepared, now: &Solution) -> Self {
        let first = columns.len();
        columns.extend(now.columns.iter().cloned().map(Arc::new));
        let mut next = first + now.structure.base();
        let mut own: Vec<usize> = (first..next).collect();
        let mut terms: Vec<Vec<usize>> = Vec::new();
        for term in &now.structure.terms {
            terms.push(if term.is_linear() {
                vec![next]
            } else {
                Vec::new()
            });
            next += usize::from(term.is_linear());
        }
        let table = (next..columns.len()).collect();
        let mut free = Vec::new();
        for ((f, &value), tangent) in now.free.iter().zip(&now.values).zip(&now.tangents) {
            let slope = f.range.slope(f.range.on_line(value));
            free.push(columns.len());
            let place = f.role.term().and_then(|id| now.structure.terms.place(id));
            match place {
                Some(term) => terms[term].push(columns.len()),
                None => own.push(columns.len()),
            }
            columns.push(Arc::new(tangent.map(|t| t * slope)));
        }
        let target = columns.len();
        columns.push(Arc::new(data.target.clone().into()));
        let mut present = Self {
            columns,
            own,
            terms,
            table,
            free,
            target,
            unstaged: Vec::new(),
        };
        present.unstage(data, now);
        present
    }

    /// A stage acts on all columns, so it has no separate column. A set without the stage has
    /// another target instead: the output plus the stage's value times its slope.
    fn unstage(&mut self, data: &Prepared, now: &Solution) {
        let effect = |of: &[f64], i: usize| -> Vec<f64> {
            let mut sum = of.to_vec();
            now.tangents[i].add_to(&mut sum, now.values[i]);
            sum
        };
        let terms = now.structure.terms.with_ids().enumerate();
        let stages: Vec<(usize, usize)> = terms
            .filter_map(|(term, (id, own))| {
                let input = own.effect.is_input_stage();
                let at = now.free.iter().position(|f| match f.role {
                    Role::Stage { term: of } => of == id,
                    Role::Shape { term: of, .. } => of == id && input,
                    _ => false,
                })?;
                Some((term, at))
            })
            .collect();
        for (k, &(term, at)) in stages.iter().enumerate() {
            let one = effect(&data.target, at);
            for &(other, also) in &stages[..k] {
                self.unstaged.push((vec![other, term], self.columns.len()));
                self.columns.push(Arc::new(effect(&one, also).into()));
            }
            self.unstaged.push((vec![term], self.columns.len()));
            self.columns.push(Arc::new(one.into()));
        }
    }
}
