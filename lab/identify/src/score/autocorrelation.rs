//! Autocorrelation of residuals, with the band of filtered white noise.
//!
//! A filtered residual is correlated even if it is only noise. Its expected autocorrelation rho is
//! that of the filter's impulse response, and the variance of the estimate r over n samples is
//! Bartlett's (1946):
//!
//! ```text
//! n var r_k = sum_m (rho_m² + rho_{m+k} rho_{m−k} − 4 rho_k rho_m rho_{m−k} + 2 rho_m² rho_k²)
//! ```

use super::whiteness::impulse_response;
use crate::problem::{Piece, Prepared};
use crate::scale::{quantile, LEVEL_OF_ONE};

/// Number of lags.
const LAGS: usize = 64;

/// Autocorrelation at the lags 0, 1, 2, … of the estimation grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Autocorrelation {
    /// Step of the lags \[s\].
    pub step: f64,
    /// One estimate for each residual.
    pub residuals: Vec<Vec<f64>>,
    /// The autocorrelation of white noise after the filter.
    pub white: Vec<f64>,
    /// Half-width of the 95 % band about it.
    pub half_width: Vec<f64>,
}

impl Autocorrelation {
    /// The autocorrelation of residuals over the given rows, which are in ascending order.
    #[must_use]
    pub fn of(data: &Prepared, rows: &[usize], residuals: &[&[f64]]) -> Self {
        let lags = LAGS.min(rows.len() / 4);
        let rho = white(&impulse_response(data), data.stride);
        let at = |lag: usize| rho.get(lag).copied().unwrap_or(0.0);
        let variance = bartlett(&rho, lags);
        let n = rows.len().max(1) as f64;
        // Two-sided.
        let normal = quantile(LEVEL_OF_ONE / 2.0);
        let of = |residual: &&[f64]| estimate(residual, rows, &data.pieces, lags);
        Self {
            step: data.dt * data.stride as f64,
            residuals: residuals.iter().map(of).collect(),
            white: (0..=lags).map(at).collect(),
            half_width: variance.iter().map(|v| normal * (v / n).sqrt()).collect(),
        }
    }

    /// Share of the lags, without lag 0, at which a residual is outside of the band.
    #[must_use]
    pub fn outside(&self, residual: &[f64]) -> f64 {
        let lags = residual.iter().zip(&self.white).zip(&self.half_width);
        let out = lags.skip(1).filter(|((r, w), h)| (*r - *w).abs() > **h);
        out.count() as f64 / (residual.len().max(2) - 1) as f64
    }
}

/// Autocorrelation of a response at the lags of the estimation grid.
fn white(response: &[f64], stride: usize) -> Vec<f64> {
    let at = |lag: usize| -> f64 {
        let pairs = response.iter().zip(&response[lag..]);
        pairs.map(|(a, b)| a * b).sum()
    };
    let zero = at(0);
    (0..response.len())
        .step_by(stride.max(1))
        .map(|lag| at(lag) / zero)
        .collect()
}

/// n times the variance of the estimated autocorrelation at each lag, given the true one.
fn bartlett(rho: &[f64], lags: usize) -> Vec<f64> {
    let reach = rho.len() as isize;
    let at = |lag: isize| rho.get(lag.unsigned_abs()).copied().unwrap_or(0.0);
    let of = |k: isize| {
        let own = at(k);
        let term = |m: isize| {
            at(m) * at(m) + at(m + k) * at(m - k) - 4.0 * own * at(m) * at(m - k)
                + 2.0 * (at(m) * own).powi(2)
        };
        // Rounding may leave a little less than nothing at lag 0.
        (-reach..=reach).map(term).sum::<f64>().max(0.0)
    };
    (0..=lags as isize).map(of).collect()
}

/// Estimated autocorrelation; pairs across a gap or across two records do not count.
fn estimate(signal: &[f64], rows: &[usize], pieces: &[Piece], lags: usize) -> Vec<f64> {
    let mean = rows.iter().map(|&i| signal[i]).sum::<f64>() / rows.len().max(1) as f64;
    let mut sums = vec![0.0; lags + 1];
    for piece in pieces {
        let mut own = vec![0.0; piece.rows.len()];
        for &i in rows.iter().filter(|i| piece.rows.contains(i)) {
            own[i - piece.rows.start] = signal[i] - mean;
        }
        for (lag, sum) in sums.iter_mut().enumerate().take(own.len()) {
            let pairs = own.iter().zip(&own[lag..]);
            *sum += pairs.map(|(a, b)| a * b).sum::<f64>();
        }
    }
    let zero = if sums[0] > 0.0 { sums[0] } else { 1.0 };
    sums.iter().map(|sum| sum / zero).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn piece(n: usize) -> Piece {
        Piece {
            path: String::new(),
            samples: n,
            dropped: 0,
            rate: 1.0,
            work: 0..n,
            rows: 0..n,
            since: 0.0,
            fitted: true,
            rests: false,
            shuffled: false,
        }
    }

    #[test]
    fn bartletts_variance_is_the_closed_form_of_white_noise_and_of_a_moving_average() {
        for v in &bartlett(&[1.0], 5)[1..] {
            assert!((v - 1.0).abs() < 1e-12);
        }
        // Box and Jenkins: rho_1 = p, all others zero.
        let p = 0.4_f64;
        let of = bartlett(&[1.0, p], 5);
        assert!(of[0] < 1e-12, "r_0 is one by definition: {}", of[0]);
        assert!((of[1] - (1.0 - 3.0 * p.powi(2) + 4.0 * p.powi(4))).abs() < 1e-12);
        for v in &of[2..] {
            assert!((v - (1.0 + 2.0 * p * p)).abs() < 1e-12);
        }
    }

    #[test]
    fn the_autocorrelation_of_a_sine_is_a_cosine() {
        let n = 20_000;
        let w = std::f64::consts::TAU / 40.0;
        let sine: Vec<f64> = (0..n).map(|i| (w * i as f64).sin()).collect();
        let rows: Vec<usize> = (0..n).collect();
        for (lag, r) in estimate(&sine, &rows, &[piece(n)], 60).iter().enumerate() {
            // 500 whole periods, of which `lag` samples are missing.
            assert!((r - (w * lag as f64).cos()).abs() < 4e-3, "{lag}: {r}");
        }
    }

    #[test]
    fn pairs_across_a_gap_do_not_count() {
        // Alternating signs in stretches of four with gaps of five: inside of a stretch there are
        // three pairs of neighbours for four samples. Those across a gap would have the other sign.
        let n = 900;
        let signal: Vec<f64> = (0..n).map(|i| [1.0, -1.0][i % 2]).collect();
        let rows: Vec<usize> = (0..n).filter(|i| i % 9 < 4).collect();
        let r = estimate(&signal, &rows, &[piece(n)], 2);
        assert!(
            (r[1] + 0.75).abs() < 1e-12 && (r[2] - 0.5).abs() < 1e-12,
            "{r:?}"
        );
    }

    #[test]
    fn white_noise_is_outside_of_the_band_at_one_lag_in_twenty() {
        let n = 2000;
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let rows: Vec<usize> = (0..n).collect();
        let mut outside = 0.0;
        for _ in 0..100 {
            let noise: Vec<f64> = (0..n).map(|_| rng.random_range(-1.0..1.0)).collect();
            let r = estimate(&noise, &rows, &[piece(n)], LAGS);
            let half = bartlett(&[1.0], LAGS);
            let band = Autocorrelation {
                step: 1.0,
                white: (0..=LAGS)
                    .map(|lag| f64::from(u8::from(lag == 0)))
                    .collect(),
                half_width: half
                    .iter()
                    .map(|v| quantile(LEVEL_OF_ONE / 2.0) * (v / n as f64).sqrt())
                    .collect(),
                residuals: Vec::new(),
            };
            outside += band.outside(&r) / 100.0;
        }
        // 6400 lags: binomial, standard deviation 0.003.
        assert!((0.04..0.06).contains(&outside), "{outside}");
    }
}
