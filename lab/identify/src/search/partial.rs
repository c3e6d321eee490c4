//! The few entries of a Gram matrix that a forward selection reads.
//!
//! One step needs the products within each group of columns and those with the target: about
//! two thousand of several hundred thousand entries. Only these are updated when a column is
//! added; the row of a column is computed when that column is added.

use super::gram::{gain, Grams, Swept, DEPENDENT};
use super::policy::EXCITED;
use std::ops::Range;

/// Positions of the entries that a selection among groups of columns reads.
#[derive(Debug, Clone, Default)]
pub struct Entries {
    /// The columns of all groups, one after the other.
    columns: Vec<usize>,
    groups: Vec<Range<usize>>,
    /// Products within the groups: the upper triangle of each by rows.
    inner: Vec<(usize, usize)>,
    /// Where those of each group begin.
    begin: Vec<usize>,
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
            entries.begin.push(entries.inner.len());
            for (n, &i) in group.iter().enumerate() {
                entries.inner.extend(group[n..].iter().map(|&j| (i, j)));
                entries.reach = entries.reach.max(i + 1);
            }
        }
        entries
    }

    /// Columns of a group.
    #[must_use]
    pub fn group(&self, group: usize) -> &[usize] {
        &self.columns[self.groups[group].clone()]
    }
}

/// Source of the entries.
enum Source<'a> {
    /// Some blocks, scaled up to the whole record.
    Blocks(&'a Grams, &'a [usize], f64),
    /// A matrix swept by a set, on the whole fit segment.
    Swept(&'a Swept),
}

/// Residual products of groups of columns and a target, given a growing set of columns.
pub struct Partial<'a> {
    source: Source<'a>,
    entries: &'a Entries,
    target: usize,
    inner: Vec<f64>,
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
    /// On some blocks only, with entries scaled up to the whole record.
    #[must_use]
    pub fn on_blocks(
        grams: &'a Grams,
        blocks: &'a [usize],
        entries: &'a Entries,
        target: usize,
    ) -> Self {
        let factor = grams.blocks() as f64 / blocks.len().max(1) as f64;
        Self::new(Source::Blocks(grams, blocks, factor), entries, target)
    }

    /// On a matrix that is swept by a set already.
    #[must_use]
    pub fn beside(swept: &'a Swept, entries: &'a Entries, target: usize) -> Self {
        Self::new(Source::Swept(swept), entries, target)
    }

    fn new(source: Source<'a>, entries: &'a Entries, target: usize) -> Self {
        let at = |&(i, j): &(usize, usize)| source.at(i, j);
        let inner = entries.inner.iter().map(at).collect();
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
            let mut inner = self.inner.as_mut_slice();
            for group in &self.entries.groups {
                let own = &own[group.clone()];
                for (n, first) in own.iter().enumerate() {
                    let (triangle, rest) = inner.split_at_mut(own.len() - n);
                    for (v, second) in triangle.iter_mut().zip(&own[n..]) {
                        *v -= first * second;
                    }
                    inner = rest;
                }
            }
            let to_target = row[self.target];
            for (v, own) in self.with_target.iter_mut().zip(&own) {
                *v -= own * to_target;
            }
            self.rest -= to_target * to_target;
            self.set.push(s);
            self.swept.push(row);
        }
    }

    /// The residual products of a column, given the set, divided by its own residual norm;
    /// `None` where it depends on the set.
    fn row(&self, s: usize) -> Option<Vec<f64>> {
        let mut row = self.source.row(s, self.reach);
        for before in &self.swept {
            let factor = before[s];
            for (v, r) in row.iter_mut().zip(before) {
                *v -= factor * r;
            }
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
        let columns = self.entries.groups[group].clone();
        let (d, inner) = (columns.len(), &self.inner[self.entries.begin[group]..]);
        match inner.first() {
            Some(&own) if d > 0 && own > EXCITED => {
                let right = &self.with_target[columns];
                // Row i of the triangle begins after i rows of d, d - 1, … entries.
                gain(
                    |i, j| inner[i * (2 * d + 1 - i) / 2 + j - i],
                    |i| right[i],
                    d,
                )
            }
            _ => 0.0,
        }
    }
}

impl Source<'_> {
    fn at(&self, i: usize, j: usize) -> f64 {
        match self {
            Self::Blocks(grams, blocks, factor) => factor * grams.sum_at(blocks, i, j),
            Self::Swept(swept) => swept.at(i, j),
        }
    }

    /// Products of a column with the first `count` ones.
    fn row(&self, s: usize, count: usize) -> Vec<f64> {
        match self {
            Self::Blocks(grams, blocks, factor) => {
                let mut row = grams.sum_of_row(blocks, s, count);
                for r in &mut row {
                    *r *= factor;
                }
                row
            }
            Self::Swept(swept) => (0..count).map(|j| swept.at(s, j)).collect(),
        }
    }
}
