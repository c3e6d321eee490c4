//! The step in bounded time, which `f32` takes: how far it is off, where and by how much.

use super::*;

/// What the motor of a rig's plant may have, and what the paper identified.
const SIGMAS: [f64; 4] = [0.5, 0.743, 3.0, 98.36];

/// Largest error of one step over 1000 jumps within `±size` \[N·m\], rho = 0.09582.
fn worst_jump(n: f64, sigma: f64, size: f64) -> f64 {
    let shape = shape(0.095_82, sigma, n);
    let mut random = Random(7);
    let (mut eta, mut last, mut most) = (0.0, 0.0, 0.0_f64);
    for _ in 0..1000 {
        let now = size * (2.0 * random.next() - 1.0);
        let short = shape.advance_bounded(eta, now - last);
        // Thirty increments of third order: an error of 1e-3/30³, far below what is measured here.
        eta = (0..30).fold(eta, |eta, _| shape.advance_split(eta, (now - last) / 30.0));
        most = most.max((short - eta).abs());
        last = now;
    }
    most
}

#[test]
fn a_jump_is_off_by_no_more_than_the_docs_say() {
    // The table of the module: n, then the greatest error of eta for jumps within 0.3, 3 and
    // 16 N·m, which are paths of 0.06, 0.6 and 3; 20 % above what 4000 jumps gave.
    let table = [
        (1.0, [1e-3, 1e-2, 3.5e-2]),
        (1.02, [7.5e-4, 9e-3, 3.3e-2]),
        (1.5, [1.3e-4, 3.6e-2, 9.3e-2]),
        (2.0, [1.1e-5, 1.5e-2, 3.6e-2]),
        (3.871, [3.6e-7, 1.7e-2, 8e-2]),
        (10.0, [3.6e-7, 3.2e-3, 1.8e-1]),
    ];
    for (n, bounds) in table {
        for (bound, size) in bounds.into_iter().zip([0.3, 3.0, 16.0]) {
            for sigma in SIGMAS {
                let error = worst_jump(n, sigma, size);
                assert!(
                    error < bound,
                    "{error:.2e}, n {n}, sigma {sigma}, {size} N·m"
                );
            }
        }
    }
}

#[test]
fn single_precision_steps_differ_from_double_ones_by_a_few_roundings() {
    let mut random = Random(23);
    for n in [1.0, 1.02, 1.5, 2.0, 3.871, 10.0] {
        for sigma in SIGMAS {
            let single = single(0.1, sigma, n);
            let double = widened(&single);
            for _ in 0..4000 {
                let eta = (2.0 * random.next() - 1.0) as f32;
                let change = (0.2 * random.next() - 0.1) as f32;
                let long = double.advance_bounded(f64::from(eta), f64::from(change));
                let short = single.advance(eta, change);
                // Six roundings of 6e-8 beside 1; c is large, and with it the slope.
                let bound = 4e-7 * (1.0 + sigma / 10.0);
                near(f64::from(short), long, bound);
            }
        }
    }
}

#[test]
fn at_n_one_and_two_it_follows_the_closed_forms() {
    for (n, bound) in [(1.0, 2e-6), (2.0, 6e-6)] {
        let (exact, short) = (shape(0.095_82, 0.743, n), single(0.095_82, 0.743, n));
        let (mut a, mut b, mut last) = (0.0, 0.0_f32, 0.0_f32);
        for k in 1..4000 {
            let now = sine(f64::from(k) * 1e-3) as f32;
            a = exact.advance(a, f64::from(now) - f64::from(last));
            b = short.advance(b, now - last);
            // Measured 1.1e-6 and 3.4e-6: rounding for n = 1, the step's third order for 2.
            near(f64::from(b), a, bound);
            last = now;
        }
    }
}

#[test]
fn standing_still_changes_nothing_to_the_bit() {
    for (_, sigma, n, _) in SETS {
        let shape = single(0.1, sigma, n);
        for eta in [-1.0, -0.3, -1e-12, 0.0, 1e-30, 1e-12, 0.3, 1.0_f32] {
            assert_eq!(shape.advance(eta, 0.0), eta);
            assert_eq!(shape.advance(eta, -0.0), eta);
        }
    }
}

proptest! {
    #![proptest_config(seeded(512, 1))]

    #[test]
    fn any_change_leaves_single_precision_within_one_and_not_behind(
        rho in prop::num::f32::POSITIVE,
        sigma in 0.0..9.2_f32,
        n in 0.0..9.0_f32,
        eta in -1.0..=1.0_f32,
        change in prop::num::f32::ANY,
    ) {
        let (sigma, n) = (0.5 * 10_f32.powf(sigma), 10_f32.powf(n));
        if let Ok(shape) = BoucWen::try_new(rho, sigma, n) {
            let next = shape.advance(eta, change);
            prop_assert!(next.abs() <= 1.0);
            let is_behind = (change > 0.0 && next < eta) || (change < 0.0 && next > eta);
            prop_assert!(!is_behind, "{} to {}", eta, next);
        }
    }
}

/// Least and greatest slope of the step along its path over `2·sigma`, between states a `part`
/// of the path apart, from states of either sign.
fn slopes<T: Real>(n: f64, sigma: f64, part: f64) -> [f64; 2] {
    let shape = BoucWen::try_new(T::ONE, T::from_f64(sigma), T::from_f64(n)).unwrap();
    let [mut least, mut greatest] = [f64::INFINITY, f64::NEG_INFINITY];
    for start in -40..=40 {
        let eta = T::from_f64(f64::from(start) / 40.0);
        let mut last = [0.0, eta.as_f64()];
        for i in 1..=150 {
            let path = T::from_f64(f64::from(i) * part);
            let now = [path.as_f64(), shape.advance_bounded(eta, path).as_f64()];
            let slope = (now[1] - last[1]) / (now[0] - last[0]) / (2.0 * sigma);
            (least, greatest) = (least.min(slope), greatest.max(slope));
            last = now;
        }
    }
    [least, greatest]
}

/// What the inverse of a transmission needs, and `theorems/Slope.v` has: eta does not fall
/// along the path and rises by at most 2·sigma of it, up to n = 4. Beyond about n = 12 the step
/// rises faster than that where it unloads, by up to 39 %.
#[test]
fn the_slope_of_the_step_stays_below_two_sigma() {
    for sigma in [0.5, 0.55, 0.6, 0.743, 1.2, 3.0, 98.36] {
        let kept = [1.0, 1.3, 2.0, 3.871, 4.0, 10.0].map(|n| (n, 1.0));
        for (n, most) in kept.into_iter().chain([(32.0, 1.22), (1000.0, 1.39)]) {
            for part in [0.02, 0.02 / sigma] {
                // Of rounding alone: some units in the last place of eta over a part.
                for (slopes, rounding) in [
                    (slopes::<f64>(n, sigma, part), 1e-11),
                    (slopes::<f32>(n, sigma, part), 1e-4),
                ] {
                    let [least, greatest] = slopes;
                    let is_kept = least > -rounding && greatest < most + rounding;
                    assert!(is_kept, "n {n}, sigma {sigma}: {slopes:?}");
                }
            }
        }
    }
    // The bounds of the greater n are reached.
    let greatest = |n: f64| slopes::<f64>(n, 0.5 + 1.5 / n, 0.02)[1];
    println!("{} {}", greatest(32.0), greatest(1000.0));
    assert!(greatest(32.0) > 1.15 && greatest(1000.0) > 1.3);
}
