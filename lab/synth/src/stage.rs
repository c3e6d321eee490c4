//! Effects on the complete output, which delay it.

use super::recipe::{refuse, RecipeError};
use super::sensor::spread;
use std::borrow::Cow;

/// Longest delay or lag that is tried \[s\].
const LONGEST: f64 = 0.5;

/// The fine grid, and which of its points are samples.
pub(super) struct Grid {
    pub(super) h: f64,
    pub(super) first: usize,
    pub(super) every: usize,
    pub(super) samples: usize,
    /// Whether signals hold all points of the grid, or only the samples.
    pub(super) keeps_all: bool,
}

impl Grid {
    pub(super) fn is_sample(&self, index: usize) -> bool {
        index >= self.first && (index - self.first).is_multiple_of(self.every)
    }

    /// The samples of a signal.
    pub(super) fn sampled<'a>(&self, kept: &'a [f64]) -> Cow<'a, [f64]> {
        if !self.keeps_all {
            return Cow::Borrowed(kept);
        }
        let samples = kept.iter().skip(self.first).step_by(self.every);
        samples.take(self.samples).copied().collect()
    }
}

/// The output `late` seconds ago, between two points of the grid.
fn delayed(output: &[f64], grid: &Grid, late: f64) -> Vec<f64> {
    let steps = late / grid.h;
    let whole = steps.floor();
    let part = steps - whole;
    let at = |index: usize, back: usize| output[index.saturating_sub(back)];
    let back = whole as usize;
    (0..output.len())
        .map(|i| (1.0 - part) * at(i, back) + part * at(i, back + 1))
        .collect()
}

/// The output behind a first-order lag.
fn lagging(output: &[f64], grid: &Grid, tau: f64) -> Vec<f64> {
    let share = if tau > 0.0 {
        -(-grid.h / tau).exp_m1()
    } else {
        1.0
    };
    let mut state = output.first().copied().unwrap_or_default();
    let mut follow = |value: &f64| {
        state += share * (value - state);
        state
    };
    output.iter().map(&mut follow).collect()
}

/// Delays or lags the output so that the change has the requested rms; returns the time constant
/// and the change on the fine grid.
pub(super) fn apply(
    effect: &str,
    output: &[f64],
    grid: &Grid,
    wanted: f64,
) -> Result<(f64, Vec<f64>), RecipeError> {
    let change = |time: f64| -> Vec<f64> {
        let late = if effect == "delay" {
            delayed(output, grid, time)
        } else {
            lagging(output, grid, time)
        };
        late.iter()
            .zip(output)
            .map(|(late, now)| late - now)
            .collect()
    };
    let rms = |time: f64| spread(&grid.sampled(&change(time)));
    let (mut low, mut high) = (0.0, grid.h);
    while rms(high) < wanted {
        low = high;
        high *= 2.0;
        if high > LONGEST {
            return refuse(format!(
                "{effect}: even a time of {LONGEST} s would not reach the requested strength"
            ));
        }
    }
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if rms(middle) < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok((high, change(high)))
}
