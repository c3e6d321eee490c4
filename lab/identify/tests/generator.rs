//! The generator of test records keeps its word, and keeps to itself.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use bowden_lab::record::{self, Options};
use bowden_synth::{effects, generate, Base, Mode, Planted, Recipe};
use std::path::Path;

const MODES: [Mode; 2] = [Mode::Torque, Mode::Displacement];

fn rms_about_mean(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares = values.iter().map(|value| (value - mean).powi(2));
    (squares.sum::<f64>() / count).sqrt()
}

/// Short enough to try every effect.
fn short(mode: Mode) -> Recipe {
    Recipe {
        seconds: 6.0,
        rate: 250.0,
        ..Recipe::new(mode)
    }
}

fn perfect(mode: Mode) -> Recipe {
    Recipe {
        noise: 0.0,
        quantisation: 0.0,
        resolution: 0.0,
        ..Recipe::new(mode)
    }
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_seed_another_record() {
    for mode in MODES {
        let recipe = Recipe {
            effects: vec![Planted::new("viscous")],
            ..short(mode)
        };
        let text = generate(&recipe).unwrap().to_csv();
        assert_eq!(text, generate(&recipe).unwrap().to_csv());
        let other = Recipe { seed: 2, ..recipe };
        assert_ne!(text, generate(&other).unwrap().to_csv());
    }
}

#[test]
fn the_header_names_the_columns_with_their_units() {
    let header = |recipe: &Recipe| {
        let text = generate(recipe).unwrap().to_csv();
        text.lines().next().unwrap().to_owned()
    };
    assert_eq!(
        header(&short(Mode::Torque)),
        "t [s],tau_i [N·m],tau_o [N·m],phi_p [rad],phi_d [rad]"
    );
    assert_eq!(header(&short(Mode::Displacement)), "t [s],x [mm],f [N]");
    let effects = ["load-friction", "temperature", "crosstalk"]
        .map(Planted::new)
        .to_vec();
    let recipe = Recipe {
        effects,
        ..short(Mode::Displacement)
    };
    assert_eq!(
        header(&recipe),
        "t [s],x [mm],f [N],load [N],temperature [°C],aux [V]"
    );
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn every_effect_contributes_as_strongly_as_asked() {
    for (mode, seed) in MODES.into_iter().zip([3, 4]) {
        let plain = Recipe {
            seed,
            ..short(mode)
        };
        let without = generate(&plain).unwrap().truth.output;
        for name in effects(mode) {
            let planted = Planted {
                strength: 2.5,
                ..Planted::new(name)
            };
            let recipe = Recipe {
                effects: vec![planted],
                ..plain.clone()
            };
            let record = generate(&recipe).unwrap_or_else(|error| panic!("{error}"));
            let truth = &record.truth.effects[0];
            let rms = match *name {
                "offset" => truth.contribution[0].abs(),
                _ => rms_about_mean(&truth.contribution),
            };
            // The time of a delay or lag is searched for, to 40 halvings.
            assert!((rms - 2.5 * recipe.noise).abs() < 1e-9, "{name}: {rms}");
            assert!((truth.rms - rms).abs() < 1e-9);
            // What it adds is the whole difference to the record without it.
            let sums = without.iter().zip(&truth.contribution).map(|(y, c)| y + c);
            for (sum, output) in sums.zip(&record.truth.output) {
                assert!((sum - output).abs() < 1e-9, "{name}");
            }
            let mut all = record.columns.iter().flat_map(|column| &column.values);
            assert!(all.all(|value| value.is_finite()), "{name}");
        }
    }
}

#[test]
fn several_effects_and_channels_can_be_asked_for() {
    let on = |effect: &str, channel: &str| Planted {
        channel: Some(channel.into()),
        ..Planted::new(effect)
    };
    let effects = vec![
        on("viscous", "phi_d"),
        Planted::new("delay"),
        on("saturation-upper", "tau_i"),
    ];
    let record = generate(&Recipe {
        effects,
        ..short(Mode::Torque)
    })
    .unwrap();
    let channels: Vec<_> = record
        .truth
        .effects
        .iter()
        .map(|effect| effect.channel)
        .collect();
    assert_eq!(channels, [Some("phi_d"), None, Some("tau_i")]);
    let unknown = Recipe {
        effects: vec![on("viscous", "psi")],
        ..short(Mode::Torque)
    };
    let error = generate(&unknown).unwrap_err().to_string();
    assert_eq!(error, "effect `viscous`: the record has no channel `psi`");
}

#[test]
fn a_recipe_that_cannot_be_followed_is_refused() {
    let set = |change: &dyn Fn(&mut Recipe)| {
        let mut recipe = short(Mode::Torque);
        change(&mut recipe);
        recipe
    };
    let planted = |effect: &str, strength: f64| {
        set(&|r| {
            r.effects = vec![Planted {
                strength,
                ..Planted::new(effect)
            }];
        })
    };
    let base = generate(&short(Mode::Torque)).unwrap().truth.base;
    for recipe in [
        planted("warp", 3.0),
        planted("viscous", f64::NAN),
        planted("viscous", 0.0),
        planted("delay", 1e5),
        set(&|r| r.seconds = f64::INFINITY),
        set(&|r| r.rate = 0.0),
        set(&|r| r.noise = -1.0),
        set(&|r| r.colour = 1.0),
        set(&|r| r.seconds = 1e6),
        set(&|r| r.bias = f64::NAN),
        set(&|r| r.base = Some(Base { sigma: 0.2, ..base })),
    ] {
        let line = generate(&recipe).unwrap_err().to_string();
        assert!(!line.contains('\n') && !line.is_empty());
    }
}

#[test]
fn the_hysteresis_follows_the_closed_form_of_dahl() {
    let base = Base {
        gain: 0.95,
        kappa_eta: 5.0,
        offset: 0.05,
        rho: 0.3,
        sigma: 1.0,
        n: 1.0,
    };
    let record = generate(&Recipe {
        base: Some(base),
        ..perfect(Mode::Torque)
    })
    .unwrap();
    let (input, eta) = (&record.truth.input, &record.truth.eta);
    let mut start = 0;
    let mut compared = 0;
    for k in 1..input.len() - 1 {
        let turns = (input[k + 1] - input[k]) * (input[k] - input[k - 1]) <= 0.0;
        if turns {
            // The reversal is somewhere between the neighbours of this sample.
            start = k + 1;
        } else if start < k {
            let path = input[k] - input[start];
            let limit = path.signum();
            let closed = limit + (eta[start] - limit) * (-base.rho * path.abs()).exp();
            assert!(
                (closed - eta[k]).abs() < 1e-6,
                "sample {k}: {closed} and {}",
                eta[k]
            );
            compared += 1;
        }
    }
    assert!(compared > 19_000);
    // And the output is the paper's (6) of it.
    for ((u, eta), y) in input.iter().zip(eta).zip(&record.truth.output) {
        assert!((0.95 * u - 5.0 * eta - 0.05 - y).abs() < 1e-12);
    }
}

#[test]
fn the_noise_is_as_large_and_as_coloured_as_asked() {
    for colour in [0.0, 0.8] {
        let recipe = Recipe {
            colour,
            quantisation: 0.0,
            ..Recipe::new(Mode::Torque)
        };
        let record = generate(&recipe).unwrap();
        let measured = &record.column("tau_o").unwrap().values;
        let error: Vec<_> = measured
            .iter()
            .zip(&record.truth.output)
            .map(|(m, y)| m - y)
            .collect();
        let rms = rms_about_mean(&error);
        let together: f64 = error.windows(2).map(|pair| pair[0] * pair[1]).sum();
        let correlation = together / error.iter().map(|e| e * e).sum::<f64>();
        // 20000 samples, of which about a ninth are independent at 0.8.
        assert!((rms / recipe.noise - 1.0).abs() < 0.06, "{rms}");
        assert!((correlation - colour).abs() < 0.03, "{correlation}");
        assert!((record.truth.noise_rms - rms).abs() < 1e-9);
    }
}

#[test]
fn sensors_report_whole_counts() {
    let record = generate(&short(Mode::Torque)).unwrap();
    for (name, count) in [
        ("tau_i", 200.0 / 65536.0),
        ("phi_p", std::f64::consts::TAU / 16384.0),
    ] {
        for value in &record.column(name).unwrap().values {
            let counts = value / count;
            assert!((counts - counts.round()).abs() < 1e-6, "{name}: {value}");
        }
    }
}

#[test]
fn holds_rest_and_the_input_fills_its_range() {
    for mode in MODES {
        for holds in [false, true] {
            let record = generate(&Recipe {
                holds,
                ..perfect(mode)
            })
            .unwrap();
            let input = &record.truth.input;
            let peak = input.iter().fold(0.0_f64, |peak, u| peak.max(u.abs()));
            let amplitude = Recipe::new(mode).amplitude;
            assert!(
                peak <= 1.001 * amplitude && peak > 0.7 * amplitude,
                "{peak}"
            );
            let still = input.windows(2).filter(|pair| pair[0] == pair[1]);
            assert_eq!(still.count() > 3000, holds);
        }
    }
}

#[test]
fn the_reader_reads_what_the_generator_writes() {
    for mode in MODES {
        for holds in [false, true] {
            for colour in [0.0, 0.9] {
                let effects = vec![Planted::new("temperature"), Planted::new("viscous")];
                let recipe = Recipe {
                    effects,
                    holds,
                    colour,
                    ..short(mode)
                };
                let written = generate(&recipe).unwrap();
                let read = record::parse(
                    written.to_csv().as_bytes(),
                    "synthetic",
                    &Options::default(),
                )
                .unwrap();
                assert_eq!(read.time, written.columns[0].values);
                assert_eq!(read.input.values, written.columns[1].values);
                assert_eq!(read.output.values, written.columns[2].values);
                assert_eq!(read.channels.len(), written.columns.len() - 3);
                assert_eq!(read.notes, Vec::<String>::new());
            }
        }
    }
}

#[test]
fn the_generator_shares_no_code_with_the_model() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../synth/src");
    let mut files = 0;
    for file in std::fs::read_dir(folder).unwrap() {
        let path = file.unwrap().path();
        if path.extension().is_some_and(|e| e == "bin") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let code = text
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"));
        for line in code {
            let foreign = ["bowden::", "use bowden", "crate::"]
                .iter()
                .any(|name| line.contains(name));
            assert!(!foreign, "{}: {line}", path.display());
        }
        files += 1;
    }
    assert!(files > 10);
}

/// Only an effect on the finished output needs the steps between the samples; the others are the
/// same to the bit where these are kept and where they are not.
#[test]
fn an_effect_is_the_same_beside_a_delay_and_alone() {
    let planted = |names: &[&str]| Recipe {
        effects: names.iter().map(|name| Planted::new(name)).collect(),
        ..short(Mode::Torque)
    };
    for name in ["viscous", "backlash", "creep"] {
        let alone = generate(&planted(&[name])).unwrap();
        let beside = generate(&planted(&[name, "delay"])).unwrap();
        let of = |made: &bowden_synth::Synthetic| made.truth.effects[0].contribution.clone();
        assert_eq!(of(&alone), of(&beside), "{name}");
        assert_eq!(alone.truth.eta, beside.truth.eta);
        assert_ne!(alone.truth.output, beside.truth.output);
    }
}

#[test]
#[ignore = "slow: bash .ci/run identification"]
fn a_record_of_a_million_samples_is_made() {
    let long = Recipe {
        seconds: 1000.0,
        rate: 1000.0,
        ..short(Mode::Torque)
    };
    let made = generate(&long).unwrap();
    assert!(made.columns.iter().all(|c| c.values.len() == 1_000_000));
    let with_a_lag = Recipe {
        seconds: 2000.0,
        effects: vec![Planted::new("lag")],
        ..long
    };
    let line = generate(&with_a_lag).unwrap_err().to_string();
    assert!(line.contains("too many with a delay or a lag"), "{line}");
}
