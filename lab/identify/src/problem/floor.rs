//! The noise floor: the sensor's noise behind the filter.

use super::blind::bridged;
use super::uniform::Uniform;
use super::ZeroPhase;
use crate::record::Record;

/// Rms of white noise behind the filter at `cutoff`, estimated from what the
/// smoother at 2.5 times that took away.
pub(super) fn of(output: &[f64], smoothed: &[f64], cutoff: f64, rate: f64) -> f64 {
    // Differences of neighbours see the noise at the top of the band and not the signal.
    let n = output.len();
    let removed: Vec<f64> = output.iter().zip(smoothed).map(|(a, b)| a - b).collect();
    let passed = ZeroPhase::new(2.5 * cutoff, rate).noise_gain();
    // What is left of white noise after taking away its smoothed part: 1 − 2 h0 + sum h².
    let mut impulse = vec![0.0; 4001];
    impulse[2000] = 1.0;
    let centre = ZeroPhase::new(2.5 * cutoff, rate).apply(&impulse)[2000];
    let share = 1.0 - 2.0 * centre + passed * passed;
    if share <= 0.02 {
        return 0.0;
    }
    let variance = removed.iter().map(|v| v * v).sum::<f64>() / n as f64 / share;
    variance.sqrt() * ZeroPhase::new(cutoff, rate).noise_gain()
}

/// The same of a record that is slower than the grid: at its own rate. Of what is laid between its
/// samples the top of the band is empty.
pub(super) fn of_slower(record: &Record, on_grid: &Uniform, cutoff: f64) -> Result<f64, String> {
    let own = on_grid.at_own_rate(&record.time)?;
    let output = own.signal(&bridged(record, &record.output));
    let rate = 1.0 / own.dt;
    let smoothed = ZeroPhase::new(2.5 * cutoff, rate).apply(&output);
    Ok(of(&output, &smoothed, cutoff, rate))
}
