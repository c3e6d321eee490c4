//! Missing rows: jumps of the time.

use super::Found;
use crate::time::median_step;

/// A step that exceeds the usual step by this share is a gap,
const GAP: f64 = 0.5;
/// where the usual steps (up to this quantile) do not themselves spread
const USUAL: f64 = 0.95;
/// so far that a gap must exceed them by this many times their spread.
const SPREAD: f64 = 3.0;
/// With more gaps than this share of the steps, time is uneven by nature, and no rows are lost.
const UNEVEN: f64 = 0.05;
/// Share of the time in gaps from which the data between them are insufficient.
const GRAVE: f64 = 0.2;

pub(super) fn find(time: &[f64]) -> Option<Found> {
    let step = median_step(time);
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    let long = steps.get((USUAL * steps.len() as f64) as usize)?;
    let limit = step + (GAP * step).max(SPREAD * (long - step));
    let mut samples = Vec::new();
    let (mut longest, mut missing) = (0.0_f64, 0.0);
    for (i, pair) in time.windows(2).enumerate() {
        let gone = pair[1] - pair[0];
        if gone > limit {
            samples.push(i..i + 2);
            longest = longest.max(gone);
            missing += gone - step;
        }
    }
    let (first, last) = (time.first()?, time.last()?);
    if samples.is_empty() || samples.len() as f64 > UNEVEN * time.len() as f64 {
        return None;
    }
    let share = missing / (last - first);
    let gaps = if samples.len() == 1 { "gap" } else { "gaps" };
    Some(Found {
        message: format!(
            "{} {gaps} in time, the longest of {longest:.4} s instead of the usual {step:.4} s; {:.2} % of the time",
            samples.len(),
            100.0 * share
        ),
        grave: share > GRAVE,
        most: 1.0,
        samples,
    })
}
