//! Time stamps that do not state when the samples were taken.
//!
//! Uneven samples with correct time stamps are resampled and do no harm. If a logger stamps late,
//! the samples are evenly spaced, but their time stamps are wrong. The signals distinguish the two
//! cases. Either the time stamps or the row numbers predict a sample better from its neighbours.

use super::Found;
use crate::scale::{spread, BETTER, FRACTION, MANY, TOLD};
use crate::time::median_step;
use crate::Column;
use std::ops::Range;

pub(super) fn find(time: &[f64], columns: &[&Column]) -> Option<Found> {
    let step = median_step(time);
    let shifts = shifts(time, step);
    let signals = columns.iter().take(2).map(|c| c.values.as_slice());
    // The end that shows it best.
    let error = signals
        .filter(|signal| rows_predict(time, signal, step))
        .map(|signal| error(&shifts, signal))
        .fold(0.0, f64::max);
    if error < TOLD {
        return None;
    }
    let known: Vec<f64> = shifts.iter().flatten().copied().collect();
    let rms = (known.iter().map(|s| s * s).sum::<f64>() / known.len() as f64).sqrt();
    Some(Found {
        message: format!(
            "the time stamps jitter by {:.0} % of the sampling period (rms), but the samples are evenly spaced, so a signal has an error of {:.1} % of its standard deviation; --rate HZ computes the time from the row number",
            100.0 * rms,
            100.0 * error
        ),
        grave: error > FRACTION,
        samples: stretches(&shifts, 0.5 * rms),
    })
}

/// Deviation of each time stamp from even spacing around it, in steps; `None` near a gap.
fn shifts(time: &[f64], step: f64) -> Vec<Option<f64>> {
    let at = |i: usize| -> Option<f64> {
        let from = i.checked_sub(MANY)?;
        let around = time.get(from..=i + MANY)?;
        let span = around.last()? - around.first()?;
        let rows = 2.0 * MANY as f64;
        // A row more or less over the window is a gap, not jitter.
        if (span / step - rows).abs() > 0.1 * rows {
            return None;
        }
        let mean = around.iter().sum::<f64>() / around.len() as f64;
        Some((time[i] - mean) / step)
    };
    (0..time.len()).map(at).collect()
}

/// Whether even rows predict a signal better than its stamps do.
fn rows_predict(time: &[f64], signal: &[f64], step: f64) -> bool {
    let (mut by_stamps, mut by_rows) = (0.0, 0.0);
    for (t, s) in time.windows(3).zip(signal.windows(3)) {
        if t[2] - t[0] > 4.0 * step {
            continue;
        }
        let fraction = (t[1] - t[0]) / (t[2] - t[0]);
        by_stamps += (s[1] - s[0] - fraction * (s[2] - s[0])).powi(2);
        by_rows += (s[1] - 0.5 * (s[0] + s[2])).powi(2);
    }
    by_stamps > BETTER * by_rows
}

/// RMS error of the signal due to the shifts, as a fraction of its standard deviation.
fn error(shifts: &[Option<f64>], signal: &[f64]) -> f64 {
    let (mut sum, mut known) = (0.0, 0.0_f64);
    for (i, shift) in shifts.iter().enumerate().skip(2) {
        if let (Some(shift), Some(next)) = (shift, signal.get(i + 2)) {
            sum += (shift * (next - signal[i - 2]) / 4.0).powi(2);
            known += 1.0;
        }
    }
    (sum / known.max(1.0)).sqrt() / spread(signal)
}

/// The intervals in which the time stamps are wrong by at least this number of steps.
fn stretches(shifts: &[Option<f64>], least: f64) -> Vec<Range<usize>> {
    let mut stretches: Vec<Range<usize>> = Vec::new();
    for (i, shift) in shifts.iter().enumerate() {
        if shift.is_none_or(|s| s.abs() < least) {
            continue;
        }
        match stretches.last_mut() {
            Some(last) if i - last.end <= MANY => last.end = i + 1,
            _ => stretches.push(i..i + 1),
        }
    }
    stretches
}
