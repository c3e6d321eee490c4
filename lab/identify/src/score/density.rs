//! Spectral density of residuals on the fit segment, and that of the sensor's noise.
//!
//! Hann window, one-sided, averaged over bands of equal width in the logarithm of the frequency.
//! The root of the density is given, in the output's unit per √Hz: the integral of its square over
//! the frequency is the variance.

use crate::problem::filter::{gain, ZeroPhase};
use crate::problem::spectrum::power_of_fit;
use crate::problem::Prepared;
use std::f64::consts::TAU;

/// Maximum number of bands.
const BANDS: usize = 140;
/// Highest frequency, in cut-offs: beyond it the filter passes less than a hundredth.
const HIGHEST: f64 = 1.8;

/// Roots of spectral densities.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// Middle of each band \[Hz\].
    pub frequency: Vec<f64>,
    /// One for each residual \[unit/√Hz\].
    pub residuals: Vec<Vec<f64>>,
    /// White noise of the noise floor's size after the filter; empty if the floor is unknown.
    pub floor: Vec<f64>,
}

impl Spectrum {
    /// The spectra of residuals on the fit segment.
    #[must_use]
    pub fn of(data: &Prepared, residuals: &[&[f64]]) -> Self {
        let bands = bands(data);
        let step = data.dt * data.stride as f64;
        let span = span(data) as f64 * step;
        let floor = |band: &Vec<usize>| {
            let rate = 1.0 / data.dt;
            let passed = gain(data.cutoff, rate, middle(band) / span);
            let whole = ZeroPhase::new(data.cutoff, rate).noise_gain().powi(2) * 0.5 * rate;
            data.noise_floor * passed / whole.sqrt()
        };
        Self {
            frequency: bands.iter().map(|band| middle(band) / span).collect(),
            residuals: residuals
                .iter()
                .map(|residual| {
                    let density = density(data, residual);
                    let of = |band: &Vec<usize>| {
                        let sum: f64 = band.iter().map(|&k| density[k]).sum();
                        (sum / band.len() as f64).sqrt()
                    };
                    bands.iter().map(of).collect()
                })
                .collect(),
            floor: match data.noise_floor > 0.0 {
                true => bands.iter().map(floor).collect(),
                false => Vec::new(),
            },
        }
    }
}

/// Samples from the first to the last of the fit segment.
fn span(data: &Prepared) -> usize {
    let fit = &data.split.fit;
    match (fit.first(), fit.last()) {
        (Some(first), Some(last)) => last - first + 1,
        _ => 0,
    }
}

/// Geometric middle of a band, in bins.
fn middle(band: &[usize]) -> f64 {
    let (first, last) = (band.first().copied(), band.last().copied());
    (first.unwrap_or(1) as f64 * last.unwrap_or(1) as f64).sqrt()
}

/// Bins of the periodogram in bands of equal logarithmic width.
fn bands(data: &Prepared) -> Vec<Vec<usize>> {
    let n = span(data);
    let seconds = n as f64 * data.dt * data.stride as f64;
    let highest = ((HIGHEST * data.cutoff * seconds) as usize).min(n / 2);
    let ratio = (highest.max(2) as f64).powf(1.0 / BANDS as f64);
    let mut bands: Vec<Vec<usize>> = Vec::new();
    let mut edge = 0.0;
    for k in 1..=highest {
        if k as f64 >= edge {
            edge = k as f64 * ratio;
            bands.push(Vec::new());
        }
        if let Some(band) = bands.last_mut() {
            band.push(k);
        }
    }
    bands
}

/// One-sided density at each bin of the fit segment \[unit²/Hz\].
fn density(data: &Prepared, residual: &[f64]) -> Vec<f64> {
    let hann = |at: f64, n: f64| 0.5 - 0.5 * (TAU * at / n).cos();
    let n = span(data);
    let first = data.split.fit.first().copied().unwrap_or(0);
    let weights = data.split.fit.iter();
    let weight: f64 = weights
        .map(|&i| hann((i - first) as f64 + 0.5, n as f64).powi(2))
        .sum();
    let scale = 2.0 * data.dt * data.stride as f64 / weight;
    let power = power_of_fit(data, residual, hann).unwrap_or_default();
    power.iter().map(|p| scale * p).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::problem::Preparation;
    use crate::record::{parse, Options};
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use std::fmt::Write as _;

    /// 200 s of a record with noise on its output.
    fn record() -> Prepared {
        let mut rng = ChaCha8Rng::seed_from_u64(9);
        let mut text = "t [s],x [mm],f [N]\n".to_owned();
        for i in 0..20_000 {
            let t = f64::from(i) / 100.0;
            let x = 10.0 * (TAU * 0.3 * t).sin();
            let _ = writeln!(text, "{t},{x},{}", 2.0 * x + rng.random_range(-1.0..1.0));
        }
        let record = parse(text.as_bytes(), "noise.csv", &Options::default()).unwrap();
        let cutoff = Some(10.0);
        Prepared::new(&record, Preparation { cutoff }).unwrap()
    }

    #[test]
    fn the_density_of_white_noise_is_twice_its_variance_times_the_step() {
        let data = record();
        let mut rng = ChaCha8Rng::seed_from_u64(2);
        let noise: Vec<f64> = data
            .target
            .iter()
            .map(|_| rng.random_range(-1.0..1.0))
            .collect();
        let density = density(&data, &noise);
        let mean = density[2..].iter().sum::<f64>() / (density.len() - 2) as f64;
        let expected = 2.0 / 3.0 * data.dt * data.stride as f64;
        // Exponential over some 2400 bins, of which the window makes two thirds: 2.5 %.
        assert!((mean / expected - 1.0).abs() < 0.08, "{}", mean / expected);
    }

    #[test]
    fn the_integral_over_a_sine_is_half_its_squared_amplitude() {
        let data = record();
        let step = data.dt * data.stride as f64;
        let sine: Vec<f64> = (0..data.target.len())
            .map(|i| 3.0 * (TAU * 1.7 * i as f64 * step).sin())
            .collect();
        let seconds = span(&data) as f64 * step;
        let sum: f64 = density(&data, &sine).iter().sum::<f64>() / seconds;
        assert!((sum / 4.5 - 1.0).abs() < 1e-3, "{sum}");
    }

    #[test]
    fn the_floor_is_what_noise_of_the_sensor_shows_and_bands_cover_all_bins_once() {
        let data = record();
        let noise: Vec<f64> = data.input.motion.iter().map(|m| 2.0 * m.position).collect();
        let rest: Vec<f64> = data.filtered(&noise);
        let rest: Vec<f64> = data.target.iter().zip(rest).map(|(y, p)| y - p).collect();
        let spectrum = Spectrum::of(&data, &[&rest]);
        let inner = spectrum.frequency.iter().zip(&spectrum.residuals[0]);
        let inner = inner
            .zip(&spectrum.floor)
            .filter(|((f, _), _)| (1.0..9.0).contains(*f));
        let (sums, count) = inner.fold((0.0, 0.0), |(s, n), ((_, r), f)| {
            (s + (r / f).ln(), n + 1.0)
        });
        let ratio = f64::exp(sums / count);
        // The floor is an estimate from the record's end of the spectrum.
        assert!((0.8..1.25).contains(&ratio), "{ratio}");
        let bins: Vec<usize> = bands(&data).into_iter().flatten().collect();
        assert_eq!(bins, (1..=bins.len()).collect::<Vec<_>>());
    }
}
