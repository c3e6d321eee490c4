//! Spectra: of the input, from which the default cut-off is taken, and of the fit segment.

use super::Prepared;
use rustfft::{num_complex::Complex, FftPlanner};

/// About eight times the highest tone of the input \[Hz\].
///
/// The highest tone is the highest frequency at which the amplitude spectrum (Hann
/// window, mean removed) reaches a tenth of its peak. The result is kept between
/// 20 periods in the record and a fifth of the rate.
#[must_use]
pub fn default_cutoff(input: &[f64], rate: f64) -> f64 {
    let power = power(input);
    let seconds = input.len() as f64 / rate;
    let peak = power.iter().copied().fold(0.0, f64::max);
    let bin = power
        .iter()
        .rposition(|&p| p >= 0.01 * peak)
        .unwrap_or(1)
        .max(1);
    let resolution = rate / (2 * (power.len() - 1)) as f64;
    // Two significant digits: a cut-off that can be said aloud and typed again.
    let raw = (8.0 * bin as f64 * resolution).clamp(20.0 / seconds, 0.2 * rate);
    format!("{raw:.1e}").parse().unwrap_or(raw)
}

/// One-sided power spectrum under a Hann window, zero-padded to a power of two.
#[must_use]
pub fn power(signal: &[f64]) -> Vec<f64> {
    let n = signal.len();
    let mean = signal.iter().sum::<f64>() / n.max(1) as f64;
    let size = n.next_power_of_two().max(4);
    let mut buffer = vec![Complex::new(0.0, 0.0); size];
    for (i, (slot, value)) in buffer.iter_mut().zip(signal).enumerate() {
        let window = 0.5 - 0.5 * (2.0 * std::f64::consts::PI * (i as f64 + 0.5) / n as f64).cos();
        slot.re = (value - mean) * window;
    }
    FftPlanner::new()
        .plan_fft_forward(size)
        .process(&mut buffer);
    buffer[..=size / 2].iter().map(|c| c.norm_sqr()).collect()
}

/// Power at each multiple of one over the fit segment's length, mean removed and gaps taken
/// as zero, under a window that is told the place and the length \[samples\].
pub(crate) fn power_of_fit(
    data: &Prepared,
    signal: &[f64],
    window: impl Fn(f64, f64) -> f64,
) -> Option<Vec<f64>> {
    let fit = &data.split.fit;
    let (&first, &last) = (fit.first()?, fit.last()?);
    let n = last - first + 1;
    let mean = fit.iter().map(|&i| signal[i]).sum::<f64>() / fit.len() as f64;
    let mut buffer = vec![Complex::new(0.0, 0.0); n];
    for &i in fit {
        buffer[i - first].re = (signal[i] - mean) * window((i - first) as f64 + 0.5, n as f64);
    }
    FftPlanner::new().plan_fft_forward(n).process(&mut buffer);
    Some(buffer[..=n / 2].iter().map(|c| c.norm_sqr()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_cutoff_is_eight_times_the_highest_tone() {
        let rate = 500.0;
        let signal: Vec<f64> = (0..10_000)
            .map(|i| {
                let t = f64::from(i) / rate;
                3.0 * (2.0 * std::f64::consts::PI * 0.4 * t).sin()
                    + (2.0 * std::f64::consts::PI * 1.5 * t).sin()
                    + 7.0
            })
            .collect();
        let cutoff = default_cutoff(&signal, rate);
        // The main lobe of the Hann window is two bins wide on each side: 8 × 2 × 0.05 Hz.
        assert!((12.0..13.0).contains(&cutoff), "{cutoff}");
    }
}
