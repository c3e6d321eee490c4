//! The entries of a Gram matrix that a forward selection reads.
//!
//! One step needs the products within each group of columns and those with the target: about
//! two thousand of several hundred thousand entries. Only these are updated when a column is
//! added; the row of a column is computed when that column is added.

use super::gram::{gain, Swept, DEPENDENT};
use super::policy::EXCITED;
use crate::algebra::{subtract, subtract_products};
use std::ops::Range;

/// Positions of the entries that a selection among groups of columns reads.
#[derive(Debug, Clone, Default)]
pub struct Entries {
    /// The columns of all groups, one after the other.
    columns: Vec<usize>,
    groups: Vec<Range<usize>>,
    /// Number of columns of the largest group.
    largest: usize,
    /// Number of columns up to the last one of a group.
    reach: usize,
}

impl Entries {
    /// Entries for some groups of columns. The first column of a group is the effect's own, the
    /// others are its slopes.
    #[must_use]
    pub fn of<'a>(groups: impl IntoIterator<Item = &'a [usize]>) -> Self {
        let mut entries = Self::default();
        for group in groups {
            let first = entries.columns.len();
            entries.columns.extend(group);
            entries.groups.push(first..entries.columns.len());
            entries.largest = entries.largest.max(group.len());
            let last = group.iter().max().map_or(0, |last| last + 1);
            entries.reach = entries.reach.max(last);
        }
        entries
    }

    /// Columns of a group.
    #[must_use]
    pub fn group(&self, group: usize) -> &[usize] {
        &self.columns[self.groups[group].clone()]
    }
}

/// Residual products of groups of columns and a target, given a growing set of columns.
pub struct Partial<'a> {
    source: &'a Swept,
    entries: &'a Entries,
    target: usize,
    /// Products within the groups. The first row has those of each column with itself, the
    /// next one those with the column behind it, and so on; what crosses from one group to the
    /// next is not read.
    inner: Vec<Vec<f64>>,
    with_target: Vec<f64>,
    rest: f64,
    /// One row for each column of the set: its residual products with the first columns, given
    /// the set before it, divided by its own residual norm. Later columns are in no entry.
    swept: Vec<Vec<f64>>,
    /// Length of these rows.
    reach: usize,
    /// The column of each row.
    set: Vec<usize>,
}

impl<'a> Partial<'a> {
    /// On a matrix that is swept by a set already.
    #[must_use]
    pub fn beside(source: &'a Swept, entries: &'a Entries, target: usize) -> Self {
        let count = entries.columns.len();
        let mut inner: Vec<Vec<f64>> = (0..entries.largest)
            .map(|apart| vec![0.0; count - apart])
            .collect();
        for group in &entries.groups {
            for (apart, row) in inner.iter_mut().enumerate().take(group.len()) {
                let pairs = entries.columns[group.clone()].iter();
                let pairs = pairs.zip(&entries.columns[group.start + apart..group.end]);
                for (entry, (&i, &j)) in row[group.start..].iter_mut().zip(pairs) {
                    *entry = source.at(i, j);
                }
            }
        }
        let columns = entries.columns.iter();
        let with_target = columns.map(|&c| source.at(c, target)).collect();
        let rest = source.at(target, target);
        Self {
            source,
            entries,
            target,
            inner,
            with_target,
            rest,
            swept: Vec::new(),
            reach: entries.reach.max(target + 1),
            set: Vec::new(),
        }
    }

    /// Squared error of the set, in units of the target's squared scale.
    #[must_use]
    pub fn squared_error(&self) -> f64 {
        self.rest
    }

    /// Adds columns to the set.
    pub fn sweep(&mut self, columns: &[usize]) {
        let reach = columns.iter().map(|s| s + 1).max();
        self.widen(reach.unwrap_or(0));
        let mut own = Vec::with_capacity(self.entries.columns.len());
        for &s in columns {
            let Some(row) = self.row(s) else { continue };
            own.clear();
            own.extend(self.entries.columns.iter().map(|&c| row[c]));
            for (apart, inner) in self.inner.iter_mut().enumerate() {
                subtract_products(inner, &own, &own[apart..]);
            }
            let to_target = row[self.target];
            subtract(&mut self.with_target, to_target, &own);
            self.rest -= to_target * to_target;
            self.set.push(s);
            self.swept.push(row);
        }
    }

    /// The residual products of a column, given the set, divided by its own residual norm;
    /// `None` if it depends on the set.
    fn row(&self, s: usize) -> Option<Vec<f64>> {
        let mut row: Vec<f64> = (0..self.reach).map(|j| self.source.at(s, j)).collect();
        for before in &self.swept {
            subtract(&mut row, before[s], before);
        }
        let pivot = row[s];
        if pivot < DEPENDENT {
            return None;
        }
        let scale = pivot.sqrt().recip();
        for v in &mut row {
            *v *= scale;
        }
        Some(row)
    }

    /// Makes the rows at least so long.
    fn widen(&mut self, reach: usize) {
        if reach <= self.reach {
            return;
        }
        self.reach = reach;
        self.swept.clear();
        for s in std::mem::take(&mut self.set) {
            if let Some(row) = self.row(s) {
                self.set.push(s);
                self.swept.push(row);
            }
        }
    }

    /// As [`Swept::gain`].
    #[must_use]
    pub fn gain(&self, group: usize) -> f64 {
        let Range { start, end } = self.entries.groups[group];
        match self.inner.first().and_then(|own| own[..end].get(start)) {
            Some(&own) if own > EXCITED => gain(
                |i, j| self.inner[j - i][start + i],
                |i| self.with_target[start + i],
                end - start,
            ),
            _ => 0.0,
        }
    }
}
