//! Whether a residual is filtered white noise.

use super::blocks::correlation_samples;
use crate::fit::Solution;
use crate::problem::filter::{gain, ZeroPhase};
use crate::problem::spectrum::power_of_fit;
use crate::problem::Prepared;
use crate::scale::{HALF, LEVEL, PART};

/// Whether the residual is compatible with filtered white noise: its correlation time is that
/// of the filter or up to half as long again, and its spectrum in the band is level.
pub(crate) fn is_white(data: &Prepared, solution: &Solution) -> bool {
    let fit = &data.split.fit;
    let rest: Vec<f64> = fit.iter().map(|&i| solution.residual[i]).collect();
    correlation_samples(&rest) <= (1.0 + HALF) * white_correlation(data).max(0.5)
        && is_level(&densities(data, &solution.residual))
}

/// Correlation time of filtered white noise, in estimation samples.
fn white_correlation(data: &Prepared) -> f64 {
    // The autocorrelation of filtered white noise is that of the impulse response.
    correlation_samples(&impulse_response(data)) / data.stride as f64
}

/// The filter's answer to one sample on the work grid.
pub(super) fn impulse_response(data: &Prepared) -> Vec<f64> {
    let rate = 1.0 / data.dt;
    let reach = (8.0 * rate / data.cutoff).ceil() as usize;
    let mut impulse = vec![0.0; 2 * reach + 1];
    impulse[reach] = 1.0;
    ZeroPhase::new(data.cutoff, rate).apply(&impulse)
}

/// Power at each frequency of the fit segment below the cut-off, with the filter's own
/// shape taken out; gaps count as zero.
fn densities(data: &Prepared, residual: &[f64]) -> Vec<f64> {
    let fit = &data.split.fit;
    let (Some(first), Some(last)) = (fit.first(), fit.last()) else {
        return Vec::new();
    };
    // No window: the test needs independent bins.
    let power = power_of_fit(data, residual, |_, _| 1.0).unwrap_or_default();
    let seconds = (last - first + 1) as f64 * data.stride as f64 * data.dt;
    // Beyond that the slope of the filter dominates.
    let highest = ((1.0 - PART) * data.cutoff * seconds) as usize;
    let bins = power.iter().enumerate().skip(1).take(highest);
    bins.map(|(k, power)| {
        let passed = gain(data.cutoff, 1.0 / data.dt, k as f64 / seconds);
        power / (passed * passed)
    })
    .collect()
}

/// Bartlett's test of the cumulative periodogram (1955). It also detects a single line,
/// which the correlation time does not show.
fn is_level(densities: &[f64]) -> bool {
    let (sum, count) = (densities.iter().sum::<f64>(), densities.len() as f64);
    if sum <= 0.0 {
        return true;
    }
    let mut below = 0.0;
    let mut farthest = 0.0_f64;
    for (k, density) in densities.iter().enumerate() {
        below += density;
        farthest = farthest.max((below / sum - (k + 1) as f64 / count).abs());
    }
    // The first term of Kolmogorov's distribution.
    farthest <= (-(LEVEL / 2.0).ln() / (2.0 * count)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// The power of white noise is exponential.
    fn noise(seed: u64) -> Vec<f64> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        (0..100)
            .map(|_| -rng.random_range(f64::EPSILON..1.0).ln())
            .collect()
    }

    #[test]
    fn noise_is_level_but_once_in_a_hundred_times() {
        let level = (0..1000).filter(|&seed| is_level(&noise(seed))).count();
        // Binomial with 0.01: mean 990, standard deviation 3; the asymptotic level is a
        // little on the safe side at a hundred bins.
        assert!((980..=999).contains(&level), "{level}");
    }

    #[test]
    fn a_line_a_slope_and_an_edge_are_not_level() {
        for seed in 0..100 {
            let mut line = noise(seed);
            line[70] += 100.0;
            assert!(!is_level(&line), "line, {seed}");
            let slope = |(k, v): (usize, &f64)| v / (1.0 + (k as f64 / 20.0).powi(2));
            let slope: Vec<f64> = noise(seed).iter().enumerate().map(slope).collect();
            assert!(!is_level(&slope), "slope, {seed}");
            let mut edge = noise(seed);
            edge[60..].iter_mut().for_each(|v| *v *= 5.0);
            assert!(!is_level(&edge), "edge, {seed}");
        }
    }
}
