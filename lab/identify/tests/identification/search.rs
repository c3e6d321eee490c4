//! The algebra of the search against direct computation on the samples.

use bowden_lab::problem::Stretch;
use bowden_lab::score::blocks::{flips, sign_flip_p, sign_flip_p_above, BLOCKS};
use bowden_lab::search::gram::Grams;
use bowden_lab::search::partial::{Entries, Partial};
use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::ops::Range;
use std::sync::Arc;

const ROWS: usize = 320;

/// Random columns of very unlike size; the last one is the target.
fn columns(count: usize, seed: u64) -> Vec<Arc<Stretch>> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..count)
        .map(|k| {
            let size = 10.0_f64.powi(k as i32 % 5 - 2);
            let own = (0..ROWS).map(|_| size * rng.random_range(-1.0..1.0));
            Arc::new(own.collect())
        })
        .collect()
}

fn rows() -> Vec<usize> {
    (0..ROWS).collect()
}

fn blocks() -> Vec<Range<usize>> {
    let length = ROWS / BLOCKS;
    (0..BLOCKS).map(|b| b * length..(b + 1) * length).collect()
}

fn matrix(columns: &[Arc<Stretch>], chosen: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(ROWS, chosen.len(), |i, j| columns[chosen[j]][i])
}

fn vector(column: &Arc<Stretch>) -> DVector<f64> {
    DVector::from_column_slice(column.values())
}

/// Coefficients and residual of a direct least-squares solve on the samples.
fn direct(
    columns: &[Arc<Stretch>],
    chosen: &[usize],
    target: usize,
) -> (DVector<f64>, DVector<f64>) {
    let (x, y) = (matrix(columns, chosen), vector(&columns[target]));
    // By QR: the iterations of nalgebra's SVD stop at a few parts in a hundred thousand here.
    let qr = x.clone().qr();
    let gains = qr
        .r()
        .solve_upper_triangular(&(qr.q().transpose() * &y))
        .unwrap();
    let rest = y - x * &gains;
    (gains, rest)
}

/// Products of 320 numbers near one are right to 1e-13; a well conditioned elimination of
/// ten columns loses two more digits.
const ROUNDING: f64 = 1e-10;

#[test]
fn the_error_and_the_gains_of_a_set_are_those_of_a_direct_solve() {
    let all = columns(9, 7);
    let grams = Grams::new(&all, &rows(), &blocks());
    let (set, target) = ([0, 2, 3, 5, 7], 8);
    let (gains, rest) = direct(&all, &set, target);
    let error = grams.squared_error(&set, target) * grams.unit(target);
    assert!((error / rest.norm_squared() - 1.0).abs() < ROUNDING);
    for (own, direct) in grams.coefficients(&set, target).iter().zip(gains.iter()) {
        assert!(
            (own / direct - 1.0).abs() < 1e3 * ROUNDING,
            "{own} {direct}"
        );
    }
}

#[test]
fn the_gain_of_a_group_is_what_it_takes_of_the_error_of_a_direct_solve() {
    let all = columns(9, 8);
    let grams = Grams::new(&all, &rows(), &blocks());
    let (set, target) = ([0, 1, 6], 8);
    let swept = grams.without(&set);
    let before = direct(&all, &set, target).1.norm_squared();
    for group in [vec![2], vec![3, 4], vec![2, 5, 7]] {
        let wider = [&set[..], &group].concat();
        let taken = before - direct(&all, &wider, target).1.norm_squared();
        let gain = swept.gain(&group, target) * grams.unit(target);
        assert!((gain - taken).abs() < ROUNDING * before, "{group:?}");
    }
    for (a, b) in [(2, 3), (4, 7)] {
        let taken = before - direct(&all, &[0, 1, 6, a, b], target).1.norm_squared();
        let gain = swept.gain_of_pair(a, b, target).unwrap() * grams.unit(target);
        assert!((gain - taken).abs() < ROUNDING * before);
    }
}

#[test]
fn a_column_that_depends_on_the_set_gains_nothing() {
    let mut all = columns(4, 9);
    let sum = all[0]
        .values()
        .iter()
        .zip(all[1].values().iter())
        .map(|(a, b)| 3.0 * a - b);
    all.insert(2, Arc::new(sum.collect()));
    let grams = Grams::new(&all, &rows(), &blocks());
    let swept = grams.without(&[0, 1]);
    assert!(!swept.is_excited(2));
    assert_eq!(swept.gain(&[2], 4), 0.0);
    // Nor does it change the error of a set that has it already.
    let (with, without) = (
        grams.squared_error(&[0, 1, 2], 4),
        grams.squared_error(&[0, 1], 4),
    );
    assert!((with - without).abs() < ROUNDING);
}

/// The target, less what `others` explain, scored by a column, less what they explain of it.
fn scores(all: &[Arc<Stretch>], own: usize, others: &[usize], target: usize) -> [f64; BLOCKS] {
    let (column, rest) = (direct(all, others, own).1, direct(all, others, target).1);
    let mut scores = [0.0; BLOCKS];
    for (score, block) in scores.iter_mut().zip(blocks()) {
        *score = block.map(|i| column[i] * rest[i]).sum();
    }
    scores
}

/// A target that holds a share of column 0, so that p-values of all sizes come up.
fn with_effect(seed: u64, size: f64) -> Vec<Arc<Stretch>> {
    let mut all = columns(6, seed);
    let scale = all[5].values().iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let own = all[0].values().iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let sum = all[5]
        .values()
        .iter()
        .zip(all[0].values().iter())
        .map(|(y, x)| y + size * scale / own * x);
    all[5] = Arc::new(sum.collect());
    all
}

#[test]
fn the_p_value_of_one_column_is_the_share_of_all_patterns_counted_on_the_samples() {
    for (seed, size) in [(1, 0.0), (2, 0.05), (3, 0.15), (4, 0.5)] {
        let all = with_effect(seed, size);
        let grams = Grams::new(&all, &rows(), &blocks());
        let expected = sign_flip_p(&scores(&all, 0, &[1, 2, 3], 5));
        let p = grams.p_value(&[0], &[1, 2, 3], 5);
        // Two patterns may tie up to rounding and be counted differently.
        assert!((p - expected).abs() <= 2.0 / 32768.0, "{p} {expected}");
    }
}

#[test]
fn the_p_value_of_two_columns_is_a_brute_force_count_of_the_whitened_length() {
    let all = with_effect(5, 0.1);
    let grams = Grams::new(&all, &rows(), &blocks());
    let (others, own, target) = ([1, 2], [0, 3], 5);
    let left = [own[0], own[1]].map(|c| direct(&all, &others, c).1);
    let inner = DMatrix::from_fn(2, 2, |i, j| left[i].dot(&left[j]));
    let inverse = inner.try_inverse().unwrap();
    let both = own.map(|c| scores(&all, c, &others, target));
    let length = |pattern: u32| {
        let sign = |b: usize| if pattern >> b & 1 == 1 { -1.0 } else { 1.0 };
        let sum = |c: usize| (0..BLOCKS).map(|b| sign(b) * both[c][b]).sum::<f64>();
        let s = DVector::from_vec(vec![sum(0), sum(1)]);
        s.dot(&(&inverse * &s))
    };
    let real = length(0) * (1.0 - 1e-9);
    let patterns = 1_u32 << (BLOCKS - 1);
    let count = (0..patterns).filter(|&p| length(p) >= real).count();
    let expected = count as f64 / f64::from(patterns);
    let p = grams.p_value(&own, &others, target);
    assert!(
        (p - expected).abs() <= 2.0 / f64::from(patterns),
        "{p} {expected}"
    );
    assert!(p > 1e-4 && p < 0.9, "the case must not be trivial: {p}");
}

#[test]
fn two_columns_explain_together_what_neither_shows_alone() {
    // y is the difference of two columns that are nearly the same.
    let mut all = columns(4, 11);
    let size = |c: &[f64]| c.iter().map(|v| v * v).sum::<f64>().sqrt();
    let (a, n) = (Arc::clone(&all[0]), Arc::clone(&all[1]));
    let part = 0.1 * size(a.values()) / size(n.values());
    let near: Vec<f64> = a
        .values()
        .iter()
        .zip(n.values())
        .map(|(a, n)| a + part * n)
        .collect();
    let along = a.values().iter().zip(&near).map(|(a, b)| a - b).collect();
    all[1] = Arc::new(near.into());
    all[3] = Arc::new(along);
    let grams = Grams::new(&all, &rows(), &blocks());
    let swept = grams.without(&[]);
    let sse = swept.at(3, 3);
    // y is a tenth of n, of which the first column has what chance gives to 320 numbers, and
    // the second a hundredth besides.
    let chance = 10.0 / ROWS as f64;
    for column in [0, 1] {
        assert!(swept.gain(&[column], 3) / sse < 0.01 + chance);
    }
    assert!(swept.gain_of_pair(0, 1, 3).unwrap() / sse > 1.0 - 1e-9);
}

#[test]
fn the_entries_that_are_kept_up_to_date_are_those_of_the_whole_matrix() {
    let all = columns(12, 21);
    let grams = Grams::new(&all, &rows(), &blocks());
    let groups: [&[usize]; 3] = [&[3, 4], &[5], &[6, 7, 8, 9, 10, 2]];
    let entries = Entries::of(groups);
    let (mut swept, from) = (grams.without(&[0]), grams.without(&[0]));
    let mut beside = Partial::beside(&from, &entries, 11);
    for more in [&[][..], &[1], &[5, 4]] {
        swept.sweep(more);
        beside.sweep(more);
        let sse = swept.at(11, 11);
        assert!((beside.squared_error() - sse).abs() < ROUNDING * sse);
        for (group, columns) in groups.iter().enumerate() {
            let expected = swept.gain(columns, 11);
            assert!((beside.gain(group) - expected).abs() < ROUNDING * sse);
        }
    }
}

#[test]
fn a_p_value_is_the_share_of_all_patterns_of_signs_that_are_as_long() {
    let mut rng = ChaCha8Rng::seed_from_u64(31);
    for directions in [1, 2, 5] {
        let drift = 0.4;
        let mut score = || rng.random_range(-1.0..1.0) + drift;
        let scores: Vec<Vec<f64>> = (0..BLOCKS)
            .map(|_| (0..directions).map(|_| score()).collect())
            .collect();
        let length = |pattern: u32| -> f64 {
            let sum = |d: usize| -> f64 {
                let sign = |b: usize| f64::from(1 - 2 * (pattern >> b & 1) as i32);
                (0..BLOCKS).map(|b| sign(b) * scores[b][d]).sum()
            };
            (0..directions).map(|d| sum(d).powi(2)).sum()
        };
        // Random lengths are not equal: a part in a billion is for the real pattern itself.
        let least = length(0) * (1.0 - 1e-9);
        let patterns = 0..1_u32 << BLOCKS;
        let counted = patterns.clone().filter(|&p| length(p) >= least).count();
        let expected = counted as f64 / patterns.len() as f64;
        assert_eq!(flips(&scores), expected, "{directions} directions");
        let mut bad = scores;
        bad[3][0] = f64::NAN;
        assert_eq!(
            flips(&bad),
            1.0,
            "a score that is not a number is no evidence"
        );
    }
}

#[test]
fn the_one_sided_sign_flip_test_counts_the_patterns_with_as_large_a_sum() {
    // Of equal scores only the observed pattern reaches their sum, and all reach its negative.
    assert_eq!(sign_flip_p_above(&[0.3; BLOCKS]), 0.5_f64.powi(16));
    assert_eq!(sign_flip_p_above(&[-0.3; BLOCKS]), 1.0);
    // Of 1 and 2 the sums are 3, 1, -1, -3.
    assert_eq!(sign_flip_p_above(&[1.0, 2.0]), 0.25);
    assert_eq!(sign_flip_p_above(&[-1.0, 2.0]), 0.5);
    // Fifteen equal scores against one as large: 17 patterns have at most one minus.
    let mut scores = [1.0; BLOCKS];
    scores[7] = -1.0;
    assert_eq!(sign_flip_p_above(&scores), 17.0 / 65536.0);
    assert_eq!(sign_flip_p_above(&[f64::NAN, 1.0]), 1.0);
}
