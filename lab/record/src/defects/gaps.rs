//! Missing rows: jumps of the time.

use super::Found;
use crate::scale::{steps, usual, GRAVE, LEAP, MISSING};
use crate::time::median_step;

pub(super) fn find(time: &[f64]) -> Option<Found> {
    let step = median_step(time);
    // Where the steps do not spread, half a step more is a row that is missing.
    let limit = step + (0.5 * step).max(LEAP * (usual(steps(time))? - step));
    let is_gap = |(_, gone): &(usize, f64)| *gone > limit;
    let gaps: Vec<(usize, f64)> = steps(time).enumerate().filter(is_gap).collect();
    // With many gaps time is uneven by nature, and no rows are missing.
    if gaps.is_empty() || gaps.len() as f64 > GRAVE * time.len() as f64 {
        return None;
    }
    let longest = gaps.iter().map(|(_, gone)| *gone).fold(0.0, f64::max);
    let missing: f64 = gaps.iter().map(|(_, gone)| gone - step).sum();
    let share = missing / (time.last()? - time.first()?);
    let word = if gaps.len() == 1 { "gap" } else { "gaps" };
    Some(Found {
        message: format!(
            "{} {word} in time, {1:.2} % of the record; the longest is {longest:.4} s instead of the usual {step:.4} s",
            gaps.len(),
            100.0 * share
        ),
        grave: share > MISSING,
        samples: gaps.into_iter().map(|(i, _)| i..i + 2).collect(),
    })
}
