//! A column that changes only in every k-th row, because the logger sampled and held a slower
//! sensor.
//!
//! The recorded column lags by half of its update period. A search would identify this lag as a
//! delay, a lag or friction. The updates are true samples, and a curve through them replaces the
//! staircase. The steps of a converter look similar during uniform motion, but then all steps are
//! one count.

use super::scale::{quantile, ENOUGH, GRAVE};

/// Replaces the staircase with a curve through its edges, and returns a note. `step` is the time
/// between two rows \[s\].
pub(super) fn smooth(name: &str, values: &mut [f64], step: f64) -> Option<String> {
    let edges: Vec<usize> = (1..values.len())
        .filter(|&i| values[i] != values[i - 1])
        .collect();
    let period = period(&edges)?;
    let sizes: Vec<f64> = edges
        .iter()
        .map(|&i| (values[i] - values[i - 1]).abs())
        .collect();
    let count = sizes.iter().copied().fold(f64::INFINITY, f64::min);
    let ones = sizes.iter().filter(|size| **size < 1.5 * count).count();
    // Most steps of a held signal of a fine sensor are larger.
    if 2 * ones > sizes.len() {
        return None;
    }
    // A period and a half without an update: the signal was at rest, and stays a line.
    let rested = |rows: usize| rows as f64 > 1.5 * period;
    let at: Vec<f64> = edges.iter().map(|&i| values[i]).collect();
    // The slope at an edge, from the neighbouring edges.
    let slope = |k: usize| -> f64 {
        let (before, after) = (k.saturating_sub(1), (k + 1).min(edges.len() - 1));
        let rests = |a: usize, b: usize| rested(edges[b] - edges[a]);
        match before == after || rests(before, k) || rests(k, after) {
            true => 0.0,
            false => (at[after] - at[before]) / (edges[after] - edges[before]) as f64,
        }
    };
    for k in 0..edges.len() - 1 {
        let (from, to) = (edges[k], edges[k + 1]);
        let length = (to - from) as f64;
        if rested(to - from) {
            // It rested until one period before the next update.
            let last = to - period.round() as usize;
            for (i, value) in values[last + 1..to].iter_mut().enumerate() {
                let u = (i + 1) as f64 / (to - last) as f64;
                *value = at[k] + u * (at[k + 1] - at[k]);
            }
            continue;
        }
        let (a, b) = (slope(k) * length, slope(k + 1) * length);
        for (i, value) in values[from + 1..to].iter_mut().enumerate() {
            let u = (i + 1) as f64 / length;
            let (u2, u3) = (u * u, u * u * u);
            *value = (2.0 * u3 - 3.0 * u2 + 1.0) * at[k]
                + (u3 - 2.0 * u2 + u) * a
                + (3.0 * u2 - 2.0 * u3) * at[k + 1]
                + (u3 - u2) * b;
        }
    }
    Some(format!(
        "`{name}` changes only in every {}th row ({:.1} Hz), which delays it by {:.3} ms; a curve through its updates replaces it",
        two_decimals(period),
        1.0 / (period * step),
        500.0 * (period - 1.0) * step
    ))
}

/// The period of the updates [rows]; `None` if they have none.
fn period(edges: &[usize]) -> Option<f64> {
    let gaps = edges.windows(2).map(|pair| (pair[1] - pair[0]) as f64);
    let all: Vec<f64> = gaps.collect();
    let usual = quantile(all.iter().copied(), 0.5).filter(|_| all.len() >= ENOUGH)?;
    let near = all.iter().copied();
    let near: Vec<f64> = near.filter(|gap| (gap - usual).abs() <= 1.0).collect();
    let period = near.iter().sum::<f64>() / near.len().max(1) as f64;
    let is_regular = |gap: &&f64| {
        let steps = (**gap / period).round().max(1.0);
        (**gap - steps * period).abs() <= 1.0 + 0.02 * steps
    };
    let regular = all.iter().filter(is_regular).count() as f64;
    // To within a row, any updates lie on a shorter period.
    (period >= 4.0 && regular >= (1.0 - GRAVE) * all.len() as f64).then_some(period)
}

fn two_decimals(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn signal(row: f64) -> f64 {
        3.0 * (0.004 * row).sin() + (0.0093 * row + 1.0).sin()
    }

    #[test]
    fn stairs_of_any_period_become_the_signal_again() {
        for period in [5.0, 16.667, 20.0, 50.0] {
            let held = |row: usize| signal(((row as f64 / period).floor() * period).ceil());
            let mut values: Vec<f64> = (0..8000).map(held).collect();
            let late = values.clone();
            let said = smooth("f", &mut values, 1e-3).unwrap();
            assert!(said.contains(" Hz)"), "{said}");
            let error = |all: &[f64]| {
                let rows = 100..7900;
                let squares = rows.map(|row| (all[row] - signal(row as f64)).powi(2));
                squares.sum::<f64>().sqrt()
            };
            // The rows of an update are true; a cubic through them errs by the fourth derivative.
            assert!(error(&values) < 0.05 * error(&late), "{period}");
        }
    }

    #[test]
    fn even_motion_of_an_encoder_noise_and_slow_signals_stay_as_they_are() {
        // A triangle whose counts come every 25 rows.
        let triangle = |row: usize| {
            let phase = (row % 4000) as f64 / 2000.0;
            (80.0 * (1.0 - (phase - 1.0).abs())).floor()
        };
        let noisy = |row: usize| ((row as f64 * 12.9898).sin() * 43758.5453).rem_euclid(1.0);
        let counts = |row: usize| (40.0 * signal(row as f64)).round();
        let all: [&dyn Fn(usize) -> f64; 3] = [&triangle, &noisy, &counts];
        for of in all {
            let signal: Vec<f64> = (0..16_000).map(of).collect();
            let mut own = signal.clone();
            assert_eq!(smooth("f", &mut own, 1e-3), None);
            assert_eq!(own, signal);
        }
    }
}
