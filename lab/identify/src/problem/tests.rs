//! Grids, gaps and the noise floor.

use super::*;
use crate::record::{Column, Record};

fn record(time: Vec<f64>, f: impl Fn(f64) -> f64) -> Record {
    let column = |name: &str, values: Vec<f64>| Column {
        name: name.to_owned(),
        unit: None,
        values,
        definition: None,
    };
    let x: Vec<f64> = time
        .iter()
        .map(|t| (2.0 * t).sin() + 0.5 * (0.7 * t).sin())
        .collect();
    let y = time.iter().map(|&t| f(t)).collect();
    Record {
        path: "test".to_owned(),
        mode: Mode::Displacement,
        input: column("x", x),
        output: column("f", y),
        channels: Vec::new(),
        notes: Vec::new(),
        defects: Vec::new(),
        dropped: 0,
        held: Vec::new(),
        time,
    }
}

fn prepared(time: Vec<f64>, f: impl Fn(f64) -> f64) -> Prepared {
    Prepared::new(&record(time, f), Preparation { cutoff: Some(5.0) }).unwrap()
}

#[test]
fn uneven_time_gives_the_same_columns_as_even_time() {
    let even: Vec<f64> = (0..6000).map(|i| f64::from(i) * 0.005).collect();
    // Up to 30 % of a step off, deterministic.
    let jitter = |i: usize| 0.0015 * ((i * 7919 % 101) as f64 / 50.0 - 1.0);
    let uneven: Vec<f64> = even
        .iter()
        .enumerate()
        .map(|(i, t)| t + if i == 0 { 0.0 } else { jitter(i) })
        .collect();
    let (a, b) = (prepared(even, f64::cos), prepared(uneven, f64::cos));
    assert_eq!(a.target.len(), b.target.len());
    for &i in &a.split.fit {
        // Linear interpolation of a curve of curvature 1 over 5 ms: 3e-6; the last
        // stamp moves the mean step by 5e-8, which is 1.5e-3 s at the end.
        assert!((a.target[i] - b.target[i]).abs() < 2e-3);
    }
}

#[test]
fn a_long_gap_is_left_out_and_a_short_one_is_bridged() {
    let time: Vec<f64> = (0..6000)
        .map(|i| f64::from(i) * 0.005)
        .filter(|t| !(10.0..11.0).contains(t) && !(4.0..4.02).contains(t))
        .collect();
    let data = prepared(time, |t| t.sin());
    let step = data.dt * data.stride as f64;
    let inside = |from: f64, to: f64| {
        data.split
            .fit
            .iter()
            .filter(|&&i| (from..to).contains(&(i as f64 * step)))
            .count()
    };
    assert_eq!(inside(9.9, 11.1), 0);
    assert!(inside(3.9, 4.1) > 2);
}

#[test]
fn a_time_stamp_from_another_age_is_refused_without_filling_the_memory() {
    let mut time: Vec<f64> = (0..1000).map(|i| f64::from(i) * 0.005).collect();
    time.push(1e12);
    assert!(
        Prepared::new(&record(time, f64::sin), Preparation::default())
            .unwrap_err()
            .contains("gap")
    );
}

#[test]
fn the_noise_floor_of_white_noise_is_found_under_a_signal() {
    let time: Vec<f64> = (0..20_000).map(|i| f64::from(i) * 0.001).collect();
    let mut seed = 1_u64;
    let noise: Vec<f64> = (0..20_000)
        .map(|_| {
            seed = seed
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        })
        .collect();
    let data = prepared(time, |t| {
        3.0 * t.sin() + noise[(t * 1000.0).round() as usize]
    });
    // Uniform noise of unit width has rms 1/sqrt(12); sampling error of 20 000: 1 %.
    let expected = ZeroPhase::new(5.0, 1000.0).noise_gain() / 12.0_f64.sqrt();
    assert!(
        (data.noise_floor / expected - 1.0).abs() < 0.03,
        "{} {expected}",
        data.noise_floor
    );
}

#[test]
fn the_search_grid_sees_the_same_target() {
    let time: Vec<f64> = (0..20_000).map(|i| f64::from(i) * 0.001).collect();
    let data = prepared(time, |t| (2.0 * t).sin() + (9.0 * t).cos());
    let coarse = data.for_search(true);
    assert!(coarse.work_len() < data.work_len() / 2);
    for &i in &data.split.fit {
        // The same analogue filter at two rates: bilinear warping near the cut-off.
        assert!((coarse.target[i] - data.target[i]).abs() < 5e-3, "{i}");
    }
}

/// Of x = sin 2t + 0.5 sin 0.7t: the velocity and the acceleration tell a spring, a mass and a
/// damper apart, and each of them from one whose force is measured with the other sign.
#[test]
fn a_force_with_the_other_sign_counts_against_the_motion() {
    let x = |t: f64| (2.0 * t).sin() + 0.5 * (0.7 * t).sin();
    let v = |t: f64| 2.0 * (2.0 * t).cos() + 0.35 * (0.7 * t).cos();
    let a = |t: f64| -4.0 * (2.0 * t).sin() - 0.245 * (0.7 * t).sin();
    let is_against = |f: &dyn Fn(f64) -> f64| {
        let time = (0..6000).map(|i| f64::from(i) * 0.005).collect();
        prepared(time, f).against
    };
    type Force<'a> = &'a dyn Fn(f64) -> f64;
    let rigs: [(&str, Force); 3] = [
        ("damper", &v),
        ("spring and damper", &|t| 3.0 * x(t) + 0.3 * v(t)),
        ("mass and dry friction", &|t| a(t) + 0.4 * v(t).signum()),
    ];
    for (rig, force) in rigs {
        assert!(!is_against(force), "{rig}");
        assert!(is_against(&|t| 5.0 - 7.0 * force(t)), "{rig}, turned");
    }
    let pole = |t: f64| a(t) - 2.0 * x(t) + 0.2 * v(t);
    assert!(!is_against(&pole));
    // A spring that is felt 50 ms late seems to give energy, but counts along; so does one that
    // is turned, where nothing else tells.
    assert!(!is_against(&|t| x(t - 0.05)));
    assert!(!is_against(&|t| -x(t - 0.05)));
    assert!(!is_against(&|_| 5.0));
    assert!(!is_against(&|t| (1.3 * t).sin()));
}

#[test]
fn in_torque_mode_nothing_counts_against_anything() {
    let time = (0..6000).map(|i| f64::from(i) * 0.005).collect();
    let mut turned = record(time, |t| -2.0 * (2.0 * t).cos());
    turned.mode = Mode::Torque;
    let data = Prepared::new(&turned, Preparation { cutoff: Some(5.0) }).unwrap();
    assert!(!data.against && data.notes.is_empty());
}
