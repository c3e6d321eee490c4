//! Noise and the moved conduit: their statistics, and that a seed decides everything.

use bowden_rig::{Drift, Noise, Rig, RigConfig};

/// Mean, standard deviation, skewness, kurtosis.
fn moments(values: &[f64]) -> [f64; 4] {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let about = |power: i32| values.iter().map(|v| (v - mean).powi(power)).sum::<f64>() / n;
    let sd = about(2).sqrt();
    [mean, sd, about(3) / sd.powi(3), about(4) / sd.powi(4)]
}

#[test]
fn the_noise_is_normal_and_white() {
    let mut noise = Noise::new(11);
    let n = 400_000;
    let values: Vec<f64> = (0..n).map(|_| noise.normal()).collect();
    let [mean, sd, skewness, kurtosis] = moments(&values);
    // Five standard errors of each: 1, sqrt(1/2), sqrt(6), sqrt(24) over sqrt(n).
    let five = 5.0 / (n as f64).sqrt();
    assert!(mean.abs() < five);
    assert!((sd - 1.0).abs() < five * 0.5_f64.sqrt());
    assert!(skewness.abs() < five * 6.0_f64.sqrt());
    assert!((kurtosis - 3.0).abs() < five * 24.0_f64.sqrt());
    for lag in [1, 2, 3, 7, 100] {
        let correlation = values.windows(lag + 1).map(|w| w[0] * w[lag]).sum::<f64>() / n as f64;
        assert!(correlation.abs() < five, "lag {lag}: {correlation}");
    }
    // The share beyond 3 is 2.6998e-3.
    let beyond = values.iter().filter(|v| v.abs() > 3.0).count() as f64 / n as f64;
    assert!((beyond - 2.6998e-3).abs() < five * 2.7e-3_f64.sqrt());
}

#[test]
fn single_precision_has_the_same_deviates_rounded() {
    let (mut single, mut double) = (Noise::new(11), Noise::new(11));
    let n = 100_000;
    let mut sum = 0.0;
    for k in 0..n {
        let (a, b) = (single.normal::<f32>(), double.normal::<f64>());
        let difference = (f64::from(a) - b).abs();
        // A square within 2^-24 of 1 loses its logarithm: sqrt(2)·2^-12.
        assert!(difference < 3.5e-4, "{k}: {a} and {b}");
        sum += difference;
    }
    // A deviate of size 1 is rounded to 6e-8, a few times.
    assert!(sum / f64::from(n) < 5e-7, "{}", sum / f64::from(n));
}

#[test]
fn a_deviate_that_waits_is_the_same_after_other_draws() {
    let (mut one, mut other) = (Noise::new(3), Noise::new(3));
    let (first, second) = (one.normal::<f64>(), one.normal::<f64>());
    assert_eq!(other.normal::<f64>(), first);
    other.bits();
    assert_eq!(other.normal::<f64>(), second);
}

#[test]
fn the_integers_are_those_of_the_published_generator() {
    // First outputs of SplitMix64 from seed 1234567, as in its reference implementation.
    let mut noise = Noise::new(1_234_567);
    for expected in [
        6_457_827_717_110_365_317_u64,
        3_203_168_211_198_807_973,
        9_817_491_932_198_370_423,
        4_593_380_528_125_082_431,
        16_408_922_859_458_223_821,
    ] {
        assert_eq!(noise.bits(), expected);
    }
}

#[test]
fn the_sensors_noise_is_what_was_asked_for() {
    let config = RigConfig {
        noise: 0.28,
        input_noise: 0.1,
        ..RigConfig::<f64>::reference()
    };
    let rig = Rig::<f64, 0>::try_new(config, &[]).unwrap();
    let mut state = rig.start(5);
    let (mut output, mut input) = (Vec::new(), Vec::new());
    for _ in 0..20_000 {
        let now = rig.step(&mut state, 0.0, 1e-3);
        output.push(now.measured);
        input.push(now.measured_input);
    }
    // Five standard errors of a standard deviation: 2.5 %.
    assert!((moments(&output)[1] / 0.28 - 1.0).abs() < 0.025);
    assert!((moments(&input)[1] / 0.1 - 1.0).abs() < 0.025);
}

#[test]
fn the_moved_conduit_follows_its_three_processes() {
    let drift = Drift {
        time: 0.2,
        ..Drift::reference()
    };
    let config = RigConfig {
        drift: Some(drift),
        ..RigConfig::<f64>::reference()
    };
    let rig = Rig::<f64, 0>::try_new(config, &[]).unwrap();
    let mut state = rig.start(5);
    let (mut b, mut kappa, mut t0) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..200_000 {
        let now = rig.step(&mut state, 0.0, 0.01);
        assert!((0.85..=1.0).contains(&now.b));
        assert!((now.kappa_eta / 7.004 - 1.0).abs() <= 0.5);
        b.push(now.b);
        kappa.push(now.kappa_eta / 7.004 - 1.0);
        t0.push(now.t0 - 0.05174);
    }
    // 2000 s at a correlation time of 0.2 s are 5000 independent samples: sd to 5 %.
    assert!((moments(&t0)[1] / 0.2 - 1.0).abs() < 0.05);
    assert!((moments(&kappa)[1] / 0.1 - 1.0).abs() < 0.05);
    // The mean of |N(0, 1)| is sqrt(2/pi).
    let fall = 0.9978 - moments(&b)[0];
    let expected = 0.02 * (2.0 / std::f64::consts::PI).sqrt();
    assert!((fall / expected - 1.0).abs() < 0.05);
    // After one correlation time the correlation is 1/e.
    let product: f64 = t0.windows(21).map(|w| w[0] * w[20]).sum::<f64>();
    let correlation = product / t0.iter().map(|v| v * v).sum::<f64>();
    assert!(
        (correlation - (-1.0_f64).exp()).abs() < 0.05,
        "{correlation}"
    );
}

#[test]
fn a_seed_decides_everything() {
    let rig = Rig::<f32, 0>::try_new(RigConfig::varying(), &[]).unwrap();
    let run = |seed| {
        let mut state = rig.start(seed);
        (0..500)
            .map(|k| {
                rig.step(&mut state, k as f32 * 0.1, 1e-3)
                    .measured
                    .to_bits()
            })
            .collect::<Vec<_>>()
    };
    assert_eq!(run(4), run(4));
    assert_ne!(run(4), run(5));
}
