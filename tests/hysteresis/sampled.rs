//! On a sampled motion the step in bounded time differs from the one that splits by no more than
//! docs/reference/model-files.md says, and grows with the square of the input's change between two samples.

use super::*;
use std::{fs, path::Path};

const NS: [f64; 6] = [1.0, 1.02, 1.5, 2.0, 3.871, 10.0];

/// Motions of at most 1 input unit: tones, and tones with noise.
fn motion(kind: usize, t: f64, noise: f64) -> f64 {
    match kind {
        0 => t.sin(),
        1 => 0.7 * t.sin() + 0.3 * (2.7 * t + 0.4).sin(),
        2 => 0.5 * t.sin() + 0.3 * (3.3 * t).sin() + 0.2 * (7.1 * t + 1.0).sin(),
        _ => 0.9 * t.sin() + 1e-3 * noise,
    }
}

/// Four periods of a motion, whose largest change between two samples is `path` over rho.
fn sampled(kind: usize, amplitude: f64, path: f64) -> Vec<f64> {
    let of = |step: f64| -> Vec<f64> {
        let mut random = Random(5);
        let count = (4.0 * TAU / step) as usize;
        let mut at = |k| motion(kind, k as f64 * step, random.within(-1.0, 1.0));
        (0..count).map(|k| amplitude * at(k)).collect()
    };
    let largest = |all: &[f64]| {
        let changes = all.windows(2).map(|w| (w[1] - w[0]).abs());
        changes.fold(0.0, f64::max)
    };
    // The change grows with the step but for the noise, which no step makes smaller.
    let mut step = path / amplitude;
    for _ in 0..8 {
        let now = largest(&of(step));
        step *= (path / now).clamp(0.2, 5.0);
        if step < 1e-4 {
            break;
        }
    }
    of(step.max(1e-4))
}

/// Largest difference of eta over the motions: `f32` as it ships, and the fit's step in `f64`;
/// rho = 1. With it the largest `rho·|du|` that there was.
fn difference(n: f64, sigma: f64, path: f64) -> Vec<[f64; 2]> {
    let short = single(1.0, sigma, n);
    let long = widened(&short);
    let mut all = Vec::new();
    for kind in 0..4 {
        for amplitude in [0.3, 1.0, 4.0] {
            let inputs = sampled(kind, amplitude, path);
            let (mut eta, mut exact, mut most, mut du) = (0.0_f32, 0.0_f64, 0.0_f64, 0.0_f64);
            for pair in inputs.windows(2) {
                eta = short.advance(eta, pair[1] as f32 - pair[0] as f32);
                exact = long.advance(exact, pair[1] - pair[0]);
                most = most.max((f64::from(eta) - exact).abs());
                du = du.max((pair[1] - pair[0]).abs());
            }
            all.push([most, du]);
        }
    }
    all
}

/// What docs/reference/model-files.md and capi/README.md say, for a sigma up to 12.
fn stated(sigma: f64, path: f64) -> f64 {
    (0.5 + 0.2 * sigma) * path * path + 6e-5
}

/// The paths `rho·|du|` for which it is said.
const PATHS: [f64; 4] = [0.003, 0.01, 0.03, 0.3];

/// The largest difference over what is stated, for any n and path.
fn largest_share(sigma: f64) -> f64 {
    let pairs = NS.into_iter().flat_map(|n| PATHS.map(|path| (n, path)));
    let all = pairs.flat_map(|(n, path)| difference(n, sigma, path));
    let shares = all.map(|[most, du]| most / stated(sigma, du));
    shares.fold(0.0, f64::max)
}

#[test]
fn single_precision_differs_by_no_more_than_the_docs_say() {
    // Measured 0.54, 0.45 and 0.75: the statement is no empty one.
    for sigma in [0.5, 3.0, 12.0] {
        let share = largest_share(sigma);
        assert!((0.4..=1.0).contains(&share), "sigma {sigma}: {share}");
    }
    // The docs say four times as much for the paper's sigma; measured 3.0.
    let share = largest_share(98.36);
    assert!((2.0..=4.0).contains(&share), "{share}");
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    // A package has neither page.
    let packaged = !root.join("capi").exists();
    let files = ["docs/reference/model-files.md", "capi/README.md"];
    for file in &files[..if packaged { 0 } else { 2 }] {
        let text = fs::read_to_string(root.join(file)).unwrap_or_default();
        let states = text.contains("(0.5 + 0.2·sigma)·(rho·|du|)² + 6e-5");
        assert!(states, "{file}");
    }
}

#[test]
fn the_difference_grows_with_the_square_of_the_change_between_two_samples() {
    let largest = |path| {
        let all = difference(3.871, 3.0, path);
        all.iter().fold(0.0_f64, |most, [own, _]| most.max(*own))
    };
    // From 0.02 to 0.08, where neither rounding nor saturation counts; sixteen times, to
    // 40 %; measured 11.7.
    let grows = largest(0.08) / largest(0.02);
    assert!((9.6..22.4).contains(&grows), "{grows}");
}
