//! The noise floor: the sensor's noise after the filter.

use super::blind::bridged;
use super::spectrum::power;
use super::uniform::Uniform;
use super::ZeroPhase;
use crate::record::Record;

/// RMS of white noise after the filter at `cutoff`, estimated from the part that the smoother at
/// 2.5 times this cut-off removed; `[variance, covariance]` are the variance of unit white noise,
/// and the covariance of its neighbours, on this grid ([`Uniform::noise`]).
pub(super) fn of(
    output: &[f64],
    smoothed: &[f64],
    [variance, covariance]: [f64; 2],
    (cutoff, rate): (f64, f64),
) -> f64 {
    // Differences of neighbours see the noise at the top of the band and not the signal.
    let n = output.len();
    let removed: Vec<f64> = output.iter().zip(smoothed).map(|(a, b)| a - b).collect();
    let passed = ZeroPhase::new(2.5 * cutoff, rate).noise_gain();
    // What is left of white noise after taking away its smoothed part: 1 − 2 h0 + sum h²; and of its
    // neighbours: sum h·(h one sample on) − 2 h1.
    let mut impulse = vec![0.0; 4001];
    impulse[2000] = 1.0;
    let smooth = ZeroPhase::new(2.5 * cutoff, rate).apply(&impulse);
    let squares = 1.0 - 2.0 * smooth[2000] + passed * passed;
    let neighbours = smooth.windows(2).map(|h| h[0] * h[1]).sum::<f64>() - 2.0 * smooth[2001];
    let share = variance * squares + 2.0 * covariance * neighbours;
    if share <= 0.02 {
        return 0.0;
    }
    let noise = 1.0 - share_of_lines(&power(&removed), 5.0 * cutoff / rate);
    let of_samples = noise * removed.iter().map(|v| v * v).sum::<f64>() / n as f64 / share;
    of_samples.sqrt() * ZeroPhase::new(cutoff, rate).noise_gain()
}

/// A bin of the spectrum is part of a line from this many medians of its neighbours on. Of white
/// noise one bin of a thousand million is.
const LINE: f64 = 30.0;
/// A line extends to both sides as far as its bins exceed the level by this factor.
const SKIRT: f64 = 4.0;
/// Neighbours that are looked at together: many more than the bins of a line under a Hann window.
const NEIGHBOURS: usize = 100;

/// The share of lines (mains hum, a pump, a fan) in the power of a spectrum above a frequency, which
/// is given as a share of half the rate. Lines are not noise: the filter removes them completely.
fn share_of_lines(power: &[f64], from: f64) -> f64 {
    let first = ((from * power.len() as f64) as usize).min(power.len());
    let band = &power[first..];
    let median = |near: &[f64]| {
        let (mut near, middle) = (near.to_vec(), near.len() / 2);
        *near.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    let levels: Vec<f64> = band.chunks(NEIGHBOURS).map(median).collect();
    let (mut lines, mut end) = (0.0, 0);
    for bin in 0..band.len() {
        let level = levels[bin / NEIGHBOURS];
        if bin < end || band[bin] <= LINE * level {
            continue;
        }
        let stands_out = |other: &&f64| **other > SKIRT * level;
        let before = band[end..bin].iter().rev().take_while(stands_out);
        let behind = band[bin..].iter().take_while(stands_out);
        end = bin + behind.clone().count();
        lines += before.chain(behind).map(|p| p - level).sum::<f64>();
    }
    let whole: f64 = power.iter().sum();
    match whole > 0.0 {
        true => (lines / whole).clamp(0.0, 1.0),
        false => 0.0,
    }
}

/// The same for a record that is slower than the grid, at its own rate: interpolated samples have
/// no noise at the top of the band.
pub(super) fn of_slower(record: &Record, on_grid: &Uniform, cutoff: f64) -> Result<f64, String> {
    let own = on_grid.at_own_rate(&record.time)?;
    let output = own.signal(&bridged(record, &record.output));
    let rate = 1.0 / own.dt;
    let smoothed = ZeroPhase::new(2.5 * cutoff, rate).apply(&output);
    Ok(of(&output, &smoothed, own.noise(), (cutoff, rate)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Noise of one seed, uniform and of unit variance.
    fn noise(samples: usize) -> Vec<f64> {
        let mut state: u64 = 7;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            12_f64.sqrt() * ((state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5)
        };
        (0..samples).map(|_| next()).collect()
    }

    fn floor(output: &[f64]) -> f64 {
        let (cutoff, rate) = (7.0, 500.0);
        let smoothed = ZeroPhase::new(2.5 * cutoff, rate).apply(output);
        of(output, &smoothed, [1.0, 0.0], (cutoff, rate))
    }

    /// A record with jittering time stamps or lost rows has the noise of its sensor.
    #[test]
    fn what_lies_between_the_samples_of_a_grid_is_less_noisy_than_they_are() {
        let (cutoff, rate, samples) = (7.0, 500.0, 20_000);
        let plain = noise(samples);
        let alone = floor(&plain);
        let of_record = |time: &[f64], values: &[f64]| {
            let own = super::super::uniform::usual_step(time);
            let grid = Uniform::new(time, own, own).unwrap();
            let output = grid.signal(values);
            let smoothed = ZeroPhase::new(2.5 * cutoff, 1.0 / own).apply(&output);
            (
                of(&output, &smoothed, grid.noise(), (cutoff, 1.0 / own)),
                own,
            )
        };
        let even = |i: usize| i as f64 / rate;
        // Jitter of 45 % of a step either way.
        let jitter: Vec<f64> = noise(samples)
            .iter()
            .enumerate()
            .map(|(i, n)| even(i) + 0.26 * n / rate)
            .collect();
        let (jittered, _) = of_record(&jitter, &plain);
        assert!((jittered / alone - 1.0).abs() < 0.03, "{jittered} {alone}");
        // Every 97th row is lost: the others stay where they are.
        let kept = |i: &usize| i % 97 != 50;
        let time: Vec<f64> = (0..samples).filter(kept).map(even).collect();
        let values: Vec<f64> = (0..samples).filter(kept).map(|i| plain[i]).collect();
        let (with_gaps, step) = of_record(&time, &values);
        assert!((step * rate - 1.0).abs() < 1e-8, "{step}");
        assert!(
            (with_gaps / alone - 1.0).abs() < 0.03,
            "{with_gaps} {alone}"
        );
    }

    #[test]
    fn hum_is_no_noise() {
        let plain = noise(20_000);
        let alone = floor(&plain);
        // What passes the filter of white noise of unit variance.
        let passed = ZeroPhase::new(7.0, 500.0).noise_gain();
        assert!((alone / passed - 1.0).abs() < 0.03, "{alone} {passed}");
        for (size, frequency) in [(0.5, 50.0), (10.0, 50.0), (10.0, 49.983), (100.0, 150.2)] {
            // With a weak line in addition to the strong one.
            let at = |i: usize, frequency: f64| (TAU * frequency * i as f64 / 500.0).sin();
            let hum = |i: usize| size * at(i, frequency) + 0.5 * at(i, 87.0);
            let mains: Vec<f64> = plain.iter().enumerate().map(|(i, n)| n + hum(i)).collect();
            let with = floor(&mains);
            // Of ten thousand bins a line leaves the power of some dozens.
            assert!(
                (with / alone - 1.0).abs() < 0.02,
                "{frequency}: {with} {alone}"
            );
        }
    }

    #[test]
    fn noise_alone_has_no_lines() {
        for samples in [500, 4_000, 60_000] {
            assert_eq!(share_of_lines(&power(&noise(samples)), 0.07), 0.0);
        }
    }
}
