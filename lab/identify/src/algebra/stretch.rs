//! A column that is zero outside one stretch of its grid.
//!
//! Several files follow one another on one grid. A column that belongs to one file, such as the
//! derivative with respect to its initial state, is zero on all other files. It is therefore
//! stored, filtered and multiplied only on its own samples. A column of a single file is one
//! stretch from end to end.

use super::lanes;
use nalgebra::DVector;
use std::borrow::Cow;
use std::ops::{Index, Range};

/// A column of a grid, as the values of the one stretch on which it is not zero.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stretch {
    start: usize,
    values: Vec<f64>,
}

impl From<Vec<f64>> for Stretch {
    /// A column from the first sample of its grid on.
    fn from(values: Vec<f64>) -> Self {
        Self { start: 0, values }
    }
}

impl From<DVector<f64>> for Stretch {
    fn from(column: DVector<f64>) -> Self {
        Vec::from(column.data).into()
    }
}

impl FromIterator<f64> for Stretch {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        Vec::from_iter(values).into()
    }
}

impl Index<usize> for Stretch {
    type Output = f64;

    /// The value at a sample of the grid: zero outside of the stretch.
    #[inline]
    fn index(&self, sample: usize) -> &f64 {
        let own = self.values.get(sample.wrapping_sub(self.start));
        own.unwrap_or(&0.0)
    }
}

/// The samples that two ranges have in common; empty where there are none.
fn common(a: &Range<usize>, b: &Range<usize>) -> Range<usize> {
    let start = a.start.max(b.start);
    start..a.end.min(b.end).max(start)
}

impl Stretch {
    /// Values from the sample `start` of the grid on.
    #[must_use]
    pub fn at(start: usize, values: Vec<f64>) -> Self {
        Self { start, values }
    }

    /// The part of a column on some samples of its grid.
    #[must_use]
    pub fn cut(&self, range: Range<usize>) -> Self {
        let own = common(&self.range(), &range);
        let values = self.on(&own).to_vec();
        Self {
            start: own.start,
            values,
        }
    }

    /// The samples of the grid on which it may differ from zero.
    #[must_use]
    pub fn range(&self) -> Range<usize> {
        self.start..self.start + self.values.len()
    }

    /// The values on [`range`](Self::range).
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Takes the values out.
    #[must_use]
    pub fn into_values(self) -> Vec<f64> {
        self.values
    }

    /// The values on [`range`](Self::range), mutable.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// The values on some samples within [`range`](Self::range); empty if the samples are outside.
    #[must_use]
    pub fn on(&self, samples: &Range<usize>) -> &[f64] {
        let begin = samples.start.wrapping_sub(self.start);
        let end = begin.wrapping_add(samples.len());
        self.values.get(begin..end).unwrap_or(&[])
    }

    /// All values of a grid with this number of samples.
    #[must_use]
    pub fn whole(&self, samples: usize) -> Cow<'_, [f64]> {
        match self.values.len() == samples {
            true => Cow::Borrowed(&self.values),
            false => Cow::Owned((0..samples).map(|i| self[i]).collect()),
        }
    }

    /// The same stretch with each value changed.
    #[must_use]
    pub fn map(&self, change: impl Fn(f64) -> f64) -> Self {
        Self {
            start: self.start,
            values: self.values.iter().map(|&v| change(v)).collect(),
        }
    }

    /// Adds the stretch, times a factor, to a column of the whole grid.
    pub fn add_to(&self, sum: &mut [f64], factor: f64) {
        let own = sum.get_mut(self.range()).unwrap_or_default();
        for (slot, v) in own.iter_mut().zip(&self.values) {
            *slot += factor * v;
        }
    }

    /// Adds another stretch, times a factor; the result covers both.
    pub fn add(&mut self, other: &Self, factor: f64) {
        if other.values.is_empty() {
            return;
        }
        self.widen(&other.range());
        let from = other.start - self.start;
        for (slot, v) in self.values[from..].iter_mut().zip(&other.values) {
            *slot += factor * v;
        }
    }

    /// Whether all values are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.values.iter().all(|v| v.is_finite())
    }

    /// Appends its values on some samples of the grid, each times a factor.
    pub(crate) fn push_to(&self, all: &mut Vec<f64>, samples: Range<usize>, factor: f64) {
        let own = common(&self.range(), &samples);
        if own.is_empty() {
            all.resize(all.len() + samples.len(), 0.0);
            return;
        }
        all.resize(all.len() + (own.start - samples.start), 0.0);
        all.extend(self.on(&own).iter().map(|v| v * factor));
        all.resize(all.len() + (samples.end - own.end), 0.0);
    }

    /// Its values at some samples of the grid, in ascending order, as a column of these alone.
    pub(crate) fn at_rows(&self, rows: &[usize]) -> Self {
        let range = self.range();
        let begin = rows.partition_point(|&row| row < range.start);
        let end = begin + rows[begin..].partition_point(|&row| row < range.end);
        let own = rows[begin..end].iter();
        Self {
            start: begin,
            values: own.map(|&row| self.values[row - range.start]).collect(),
        }
    }

    /// Adds its values at some samples of the grid, in ascending order, to a column of these.
    pub(crate) fn add_at_rows(&self, sum: &mut [f64], rows: &[usize], factor: f64) {
        let range = self.range();
        let begin = rows.partition_point(|&row| row < range.start);
        for (slot, &row) in sum[begin..].iter_mut().zip(&rows[begin..]) {
            let Some(value) = self.values.get(row - range.start) else {
                break;
            };
            *slot += factor * value;
        }
    }

    /// Makes room for other samples.
    fn widen(&mut self, other: &Range<usize>) {
        let own = self.range();
        if self.values.is_empty() {
            *self = Self::at(other.start, vec![0.0; other.len()]);
            return;
        }
        if other.start < own.start {
            let before = std::iter::repeat_n(0.0, own.start - other.start);
            self.values.splice(0..0, before);
            self.start = other.start;
        }
        if other.end > own.end {
            self.values.resize(other.end - self.start, 0.0);
        }
    }

    /// Euclidean norm.
    pub(crate) fn norm(&self) -> f64 {
        lanes::dot(&self.values, &self.values).sqrt()
    }

    /// Sum of the products with another column.
    pub(super) fn dot(&self, other: &Self) -> f64 {
        let both = common(&self.range(), &other.range());
        lanes::dot(self.on(&both), other.on(&both))
    }

    /// Takes off another column times a factor; the stretch grows where that one goes beyond it.
    pub(super) fn take_off(&mut self, other: &Self, factor: f64) {
        if !common(&self.range(), &other.range()).is_empty() {
            self.widen(&other.range());
            let from = other.start - self.start;
            lanes::subtract(&mut self.values[from..], factor, &other.values);
        }
    }

    /// Divides all values.
    pub(super) fn divided(mut self, by: f64) -> Self {
        self.values.iter_mut().for_each(|v| *v /= by);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outside_of_its_stretch_a_column_is_zero() {
        let own = Stretch::at(2, vec![5.0, 6.0]);
        let all: Vec<f64> = (0..6).map(|i| own[i]).collect();
        assert_eq!(all, [0.0, 0.0, 5.0, 6.0, 0.0, 0.0]);
        assert_eq!(*own.whole(6), all);
        let mut pushed = Vec::new();
        own.push_to(&mut pushed, 3..6, 2.0);
        own.push_to(&mut pushed, 0..2, 2.0);
        own.push_to(&mut pushed, 5..6, 2.0);
        assert_eq!(pushed, [12.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(own.at_rows(&[0, 3, 5]), Stretch::at(1, vec![6.0]));
        assert_eq!(own.cut(0..3), Stretch::at(2, vec![5.0]));
        assert!(own.cut(4..6).values().is_empty());
    }

    #[test]
    fn columns_of_different_files_have_no_product() {
        let (one, other) = (Stretch::at(0, vec![1.0, 2.0]), Stretch::at(2, vec![3.0]));
        assert_eq!(one.dot(&other), 0.0);
        let mut same = one.clone();
        same.take_off(&other, 7.0);
        assert_eq!(same, one, "it has not grown");
    }

    #[test]
    fn what_is_taken_off_may_be_longer() {
        let mut own = Stretch::at(1, vec![5.0, 5.0]);
        own.take_off(&Stretch::from(vec![1.0, 2.0, 3.0, 4.0]), 2.0);
        assert_eq!(own, Stretch::from(vec![-2.0, 1.0, -1.0, -8.0]));
        let mut none = Stretch::default();
        none.add(&Stretch::at(3, vec![1.0]), 2.0);
        none.add(&Stretch::at(1, vec![1.0]), 1.0);
        assert_eq!(none, Stretch::at(1, vec![1.0, 0.0, 2.0]));
    }
}
