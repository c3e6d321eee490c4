//! Uniform time: the step, and the signals on it.

use crate::scale::PART;
use std::ops::Range;

/// Rates that differ by less than this share are one rate: clocks drift by less.
const SAME_RATE: f64 = 1e-3;

/// The usual step of a record \[s\].
pub(super) fn usual_step(time: &[f64]) -> f64 {
    let mut steps: Vec<f64> = time.windows(2).map(|w| w[1] - w[0]).collect();
    steps.sort_by(f64::total_cmp);
    let median = steps[steps.len() / 2];
    // A clock is steady if its steps, but for a tenth at either end, deviate by less than a part.
    // The mean of the steps that are no gaps. Where the clock is steady, a step over a row that was lost
    // is two of them: counted as one it would move every sample behind it off the grid.
    let usual = &steps[..steps.partition_point(|s| *s <= 3.0 * median)];
    let single = steps.partition_point(|s| *s <= 1.5 * median);
    let off = |i: usize| (steps[i] - median).abs() / median;
    let steady = off(single / 10).max(off(single - 1 - single / 10)) < PART;
    let samples = usual.iter().map(|s| match steady {
        true => (s / median).round().max(1.0),
        false => 1.0,
    });
    let mean = usual.iter().sum::<f64>() / samples.sum::<f64>();
    // Nine digits: what is beyond them is the rounding of the sum.
    format!("{mean:.9e}").parse().unwrap_or(mean)
}

/// A uniform grid over a record, and the positions of its points between the samples.
pub(super) struct Uniform {
    pub(super) dt: f64,
    pub(super) len: usize,
    /// The record's own usual step \[s\].
    own: f64,
    position: Option<Vec<(usize, f64)>>,
    pub(super) stretched: usize,
}

impl Uniform {
    /// A grid of step `dt` over a record whose usual step is `own`.
    pub(super) fn new(time: &[f64], own: f64, dt: f64) -> Result<Self, String> {
        let span = time[time.len() - 1] - time[0];
        let uneven = time
            .iter()
            .enumerate()
            .any(|(i, t)| (t - time[0] - i as f64 * dt).abs() > 0.02 * dt);
        if !uneven {
            return Ok(Self {
                dt,
                len: time.len(),
                own,
                position: None,
                stretched: 0,
            });
        }
        // Past this there is more gap than record, and the grid would not fit into memory.
        if span / own > 20.0 * time.len() as f64 {
            return Err(format!(
                "the record spans {span:.6} s, but its usual time step is {own:.6} s, so the record consists mostly of gaps; cut it with --start and --end"
            ));
        }
        let len = (span / dt + 1e-6).floor() as usize + 1;
        let mut position = Vec::with_capacity(len);
        let mut left = 0;
        for k in 0..len {
            let t = time[0] + k as f64 * dt;
            while left + 2 < time.len() && time[left + 1] <= t {
                left += 1;
            }
            let fraction = ((t - time[left]) / (time[left + 1] - time[left])).clamp(0.0, 1.0);
            position.push((left, fraction));
        }
        let stretched = time.windows(2).filter(|w| w[1] - w[0] > 1.5 * own).count();
        Ok(Self {
            dt,
            len,
            own,
            position: Some(position),
            stretched,
        })
    }

    /// Whether the grid is finer than the record.
    pub(super) fn is_finer(&self) -> bool {
        self.own / self.dt > 1.0 + SAME_RATE
    }

    /// The variance, and the covariance of neighbours, on the grid for samples with white noise of
    /// unit variance. A point between two samples is the mean of both noises.
    pub(super) fn noise(&self) -> [f64; 2] {
        let Some(position) = &self.position else {
            return [1.0, 0.0];
        };
        let common = |a: &(usize, f64), b: &(usize, f64)| match b.0 - a.0 {
            0 => (1.0 - a.1) * (1.0 - b.1) + a.1 * b.1,
            1 => a.1 * (1.0 - b.1),
            _ => 0.0,
        };
        let own = position.iter().map(|p| common(p, p)).sum::<f64>();
        let next = position.windows(2).map(|w| common(&w[0], &w[1]));
        let points = position.len() as f64;
        [own / points, next.sum::<f64>() / points]
    }

    /// A grid over the same record at its own rate.
    pub(super) fn at_own_rate(&self, time: &[f64]) -> Result<Self, String> {
        Self::new(time, self.own, self.own)
    }

    /// Gaps longer than half a period of the cut-off: they hide motion that matters.
    pub(super) fn gaps(&self, time: &[f64], cutoff: f64) -> Vec<Range<usize>> {
        let longest = (5.0 * self.own).max(0.5 / cutoff);
        let index = |t: f64| ((t - time[0]) / self.dt).round() as usize;
        time.windows(2)
            .filter(|w| w[1] - w[0] > longest)
            .map(|w| index(w[0])..index(w[1]).min(self.len))
            .collect()
    }

    /// A stretch of samples on the uniform grid.
    pub(super) fn stretch(&self, time: &[f64], samples: &Range<usize>) -> Range<usize> {
        let index = |i: usize| ((time[i] - time[0]) / self.dt).round() as usize;
        let last = samples.end.clamp(1, time.len()) - 1;
        index(samples.start)..(index(last) + 1).min(self.len)
    }

    pub(super) fn signal(&self, values: &[f64]) -> Vec<f64> {
        let Some(position) = &self.position else {
            return values.to_vec();
        };
        // At its own rate a record's samples are only moved a little; between the samples of
        // a slower one a straight line would take from the motion that the filter lets pass.
        let slower = (self.own / self.dt - 1.0).abs() > SAME_RATE;
        let between = |&(i, f): &(usize, f64)| match slower {
            false => values[i] + f * (values[i + 1] - values[i]),
            true => cubic(values, i, f),
        };
        position.iter().map(between).collect()
    }
}

/// The cubic through the neighbours with their slopes (Catmull and Rom).
fn cubic(values: &[f64], i: usize, f: f64) -> f64 {
    let p = |k: usize| values[k.min(values.len() - 1)];
    let (a, b, c, d) = (p(i.saturating_sub(1)), p(i), p(i + 1), p(i + 2));
    let (m, n) = (0.5 * (c - a), 0.5 * (d - b));
    let (f2, f3) = (f * f, f * f * f);
    (2.0 * f3 - 3.0 * f2 + 1.0) * b
        + (f3 - 2.0 * f2 + f) * m
        + (3.0 * f2 - 2.0 * f3) * c
        + (f3 - f2) * n
}
