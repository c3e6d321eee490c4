//! The sign-flip test against closed forms, the correlation time.

use super::*;

#[test]
fn the_sign_flip_p_of_equal_scores_is_one_pattern_of_all() {
    assert_eq!(sign_flip_p(&[1.0; BLOCKS]), 1.0 / 32768.0);
}

#[test]
fn the_sign_flip_p_agrees_with_the_binomial_distribution() {
    // Scores of unit size, twelve of sixteen positive: |sum| = 8, so p is the chance
    // that a fair coin gives at least 12 or at most 4 heads in 16.
    let mut scores = [1.0; BLOCKS];
    scores[..4].fill(-1.0);
    let choose = [1.0, 16.0, 120.0, 560.0, 1820.0];
    let expected = 2.0 * choose.iter().sum::<f64>() / 65536.0;
    assert!((sign_flip_p(&scores) - expected).abs() < 1e-12);
}

#[test]
fn the_correlation_time_of_an_exponential_correlation_is_found() {
    // A decaying exponential has itself as autocorrelation.
    let tau = 40.0;
    let signal: Vec<f64> = (0..4000).map(|i| (-f64::from(i) / tau).exp()).collect();
    let found = correlation_samples(&signal);
    // The mean that is removed shifts the crossing by about tau·2/n.
    assert!((found - tau).abs() < 2.0, "{found}");
}
