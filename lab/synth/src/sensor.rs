//! A sensor's noise and counts.

use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Noise of unit variance with correlation `colour` from sample to sample.
pub(super) fn noise(rng: &mut ChaCha8Rng, colour: f64, samples: usize) -> Vec<f64> {
    let fresh = (1.0 - colour * colour).sqrt();
    let mut draw = || -> f64 { StandardNormal.sample(rng) };
    // Starts in the stationary distribution, so the first samples are no quieter.
    let mut last = draw();
    let mut next = || {
        let value = last;
        last = colour * last + fresh * draw();
        value
    };
    (0..samples).map(|_| next()).collect()
}

/// The nearest whole count; a count of 0 is a perfect converter.
pub(super) fn quantise(value: f64, count: f64) -> f64 {
    if count > 0.0 {
        (value / count).round() * count
    } else {
        value
    }
}

/// Root mean square about the mean.
pub(super) fn spread(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    (values
        .iter()
        .map(|value| (value - mean).powi(2))
        .sum::<f64>()
        / values.len() as f64)
        .sqrt()
}
