//! Means of residuals over the bins of a variable, with their 95 % intervals.
//!
//! Residuals are correlated in time, so neighbouring samples are not independent. The interval is
//! that of a ratio over sixteen stretches of the record, each taken as one draw (cluster-robust
//! variance with G/(G − 1); Student's t with G − 1 degrees, where G stretches have samples in the
//! bin).

use super::blocks::BLOCKS;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Least number of stretches that give an interval.
const LEAST: usize = 4;

/// A mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mean {
    /// The mean.
    pub value: f64,
    /// Its 95 % interval; `None` if too few stretches of the record have samples in the bin.
    pub ci95: Option<[f64; 2]>,
}

/// One bin of a variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Bin {
    /// Mean of the variable in it.
    pub at: f64,
    /// Number of samples in it.
    pub count: usize,
    /// The mean of each residual in it.
    pub means: Vec<Mean>,
}

/// Sums of one residual in one bin and one stretch.
#[derive(Clone, Copy, Default)]
struct Sums {
    count: f64,
    sum: f64,
}

/// Bins with about equally many samples each, at most the given number of bins.
///
/// `values` and each of the residuals have one entry for each sample, in the order of time.
#[must_use]
pub fn binned(values: &[f64], residuals: &[Vec<f64>], most: usize) -> Vec<Bin> {
    let edges = edges(values, most);
    let bins = edges.len() + 1;
    let mut sums = vec![vec![[Sums::default(); BLOCKS]; residuals.len()]; bins];
    let mut places = vec![Sums::default(); bins];
    for (i, value) in values.iter().enumerate() {
        let bin = edges.partition_point(|edge| edge < value);
        let stretch = i * BLOCKS / values.len();
        places[bin].count += 1.0;
        places[bin].sum += value;
        for (own, residual) in sums[bin].iter_mut().zip(residuals) {
            own[stretch].count += 1.0;
            own[stretch].sum += residual[i];
        }
    }
    let filled = places.iter().zip(&sums).filter(|(p, _)| p.count > 0.0);
    filled
        .map(|(place, sums)| Bin {
            at: place.sum / place.count,
            count: place.count as usize,
            means: sums.iter().map(mean).collect(),
        })
        .collect()
}

/// Upper edges of all bins but the last: quantiles, without repetition.
fn edges(values: &[f64], most: usize) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.last().copied() else {
        return Vec::new();
    };
    let quantile = |k: usize| sorted[(sorted.len() * k / most).saturating_sub(1)];
    let mut edges: Vec<f64> = (1..most).map(quantile).filter(|e| *e < last).collect();
    edges.dedup();
    edges
}

fn mean(stretches: &[Sums; BLOCKS]) -> Mean {
    let own = || stretches.iter().filter(|s| s.count > 0.0);
    let (count, groups) = (own().map(|s| s.count).sum::<f64>(), own().count());
    let value = own().map(|s| s.sum).sum::<f64>() / count;
    let squares: f64 = own().map(|s| (s.sum - value * s.count).powi(2)).sum();
    let g = groups as f64;
    let half = (groups >= LEAST)
        .then(|| StudentsT::new(0.0, 1.0, g - 1.0).ok())
        .flatten()
        .map(|t| t.inverse_cdf(0.975) * (g / (g - 1.0) * squares).sqrt() / count);
    Mean {
        value,
        ci95: half.map(|h| [value - h, value + h]),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn uniform(seed: u64, n: usize) -> Vec<f64> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        (0..n).map(|_| rng.random_range(-1.0..1.0)).collect()
    }

    #[test]
    fn the_means_of_a_line_lie_on_it_and_bins_have_equally_many_samples() {
        let values = uniform(1, 4800);
        let line: Vec<f64> = values.iter().map(|v| 3.0 * v - 1.0).collect();
        let bins = binned(&values, &[line, vec![2.0; 4800]], 24);
        assert_eq!(bins.len(), 24);
        for bin in &bins {
            assert_eq!(bin.count, 200);
            assert!((bin.means[0].value - (3.0 * bin.at - 1.0)).abs() < 1e-12);
            let [low, high] = bin.means[1].ci95.unwrap();
            assert!((low - 2.0).abs() < 1e-12 && (high - 2.0).abs() < 1e-12);
        }
    }

    #[test]
    fn equal_values_are_in_one_bin() {
        let values: Vec<f64> = (0..900).map(|i| f64::from(i % 3)).collect();
        let bins = binned(&values, std::slice::from_ref(&values), 20);
        let of: Vec<(f64, usize)> = bins.iter().map(|b| (b.at, b.count)).collect();
        assert_eq!(of, [(0.0, 300), (1.0, 300), (2.0, 300)]);
        assert!(binned(&[], &[Vec::new()], 20).is_empty());
    }

    #[test]
    fn the_interval_of_white_noise_is_t_times_the_standard_error_and_holds_zero_at_95_percent() {
        let (mut inside, mut widths, mut all) = (0.0, 0.0, 0.0);
        for seed in 0..100 {
            let values = uniform(1000 + seed, 3200);
            for bin in binned(&values, &[uniform(seed, 3200)], 10) {
                let [low, high] = bin.means[0].ci95.unwrap();
                inside += f64::from(u8::from(low <= 0.0 && high >= 0.0));
                widths += 0.5 * (high - low);
                all += 1.0;
            }
        }
        // Binomial over 1000 bins: standard deviation 0.007.
        assert!((0.925..0.975).contains(&(inside / all)), "{}", inside / all);
        // sd 1/√3, 320 samples, t(15) = 2.131; a small sample's sd is 2 % low on average.
        let expected = 2.131 / 3.0_f64.sqrt() / 320.0_f64.sqrt();
        let ratio = widths / all / expected;
        assert!((0.95..1.01).contains(&ratio), "{ratio}");
    }

    #[test]
    fn a_residual_that_is_alike_for_long_has_a_wide_interval() {
        // One value for each stretch: sixteen draws, however many samples.
        let draws = uniform(3, BLOCKS);
        let slow: Vec<f64> = (0..16_000).map(|i| draws[i / 1000]).collect();
        let bins = binned(&uniform(4, 16_000), &[slow], 1);
        let [low, high] = bins[0].means[0].ci95.unwrap();
        let mean = draws.iter().sum::<f64>() / 16.0;
        let sd = (draws.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / 15.0).sqrt();
        assert!((0.5 * (high - low) / (2.1314 * sd / 4.0) - 1.0).abs() < 1e-3);
    }
}
