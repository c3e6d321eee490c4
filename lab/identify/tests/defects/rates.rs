//! How often each defect is found, and how often something is told of a record without it, on
//! records whose faults are drawn at random, down to small ones.

use super::*;
use bowden_lab::record::{of_columns, Column};
use rand::Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

/// Records of each kind with its fault, and as many with what only resembles the fault.
const RECORDS: u64 = 60;

/// What is damaged, and how many of the records are found: none is false. Those that are not found
/// have faults too small to be told.
const KINDS: [(&str, usize); 8] = [
    ("stuck", 53),
    ("clipping", 35),
    ("spike", 60),
    ("quantisation", 60),
    ("gap", 60),
    ("jitter", 55),
    ("held", 60),
    ("wrapped", 60),
];

/// A record that no other test reads.
fn sound(seed: u64, rate: Option<f64>) -> Vec<Column> {
    let of = |all: &[f64]| all[(seed / 3) as usize % all.len()];
    let mode = match seed % 2 {
        0 => Mode::Torque,
        _ => Mode::Displacement,
    };
    let rate = rate.unwrap_or_else(|| of(&[200.0, 500.0, 1000.0]));
    let recipe = Recipe {
        seed: 770_000 + seed,
        seconds: (4000.0 / rate).max(8.0),
        rate,
        holds: seed % 4 == 1,
        effects: vec![Planted::new(
            ["viscous", "coulomb"][(seed / 7) as usize % 2],
        )],
        ..Recipe::new(mode)
    };
    let noise = recipe.noise * of(&[0.0, 0.3, 1.0, 3.0]);
    let recipe = Recipe {
        effects: recipe.effects.into_iter().filter(|_| noise > 0.0).collect(),
        noise,
        ..recipe
    };
    let all = generate(&recipe).unwrap().columns.into_iter();
    all.map(|own| Column {
        name: own.name.to_owned(),
        unit: Some(own.unit.to_owned()),
        values: own.values,
        definition: None,
    })
    .collect()
}

fn span(values: &[f64]) -> (f64, f64) {
    let low = values.iter().copied().fold(f64::MAX, f64::min);
    (low, values.iter().copied().fold(f64::MIN, f64::max))
}

/// Every `every`-th row with its stamp and its values so many rows later.
fn shifted(all: &[Column], every: usize, late: impl Fn(usize, usize) -> usize) -> Vec<Column> {
    let rows = 1..all[0].values.len() / every - 1;
    let thin = |(place, own): (usize, &Column)| {
        let values = rows.clone().map(|k| own.values[late(place, k)]).collect();
        Column {
            values,
            ..own.clone()
        }
    };
    all.iter().enumerate().map(thin).collect()
}

/// Rounds to steps, as a coarse sensor does.
fn rounded(own: &mut [f64], step: f64) {
    own.iter_mut().for_each(|v| *v = (*v / step).round() * step);
}

/// Damages a column whose values extend over this range.
fn damage(kind: &str, rng: &mut ChaCha8Rng, own: &mut [f64], range: f64) {
    let rows = own.len();
    match kind {
        "stuck" => {
            for _ in 0..rng.random_range(1..4) {
                let from = rng.random_range(200..rows - 500);
                let length = (30.0 * 10.0_f64.powf(rng.random::<f64>())) as usize;
                let level = own[from];
                own[from..from + length].fill(level);
            }
        }
        "clipping" => {
            let mut sorted = own.to_vec();
            sorted.sort_by(f64::total_cmp);
            let share = 0.003 * 30.0_f64.powf(rng.random::<f64>());
            let level = sorted[((1.0 - share) * rows as f64) as usize];
            own.iter_mut().for_each(|v| *v = v.min(level));
        }
        "spike" => {
            for _ in 0..rng.random_range(1..8) {
                let (from, length) = (rng.random_range(50..rows - 50), rng.random_range(1..4));
                let sign = [-1.0, 1.0][rng.random_range(0..2)];
                let height = sign * range * 0.05 * 40.0_f64.powf(rng.random::<f64>());
                own[from..from + length]
                    .iter_mut()
                    .for_each(|v| *v += height);
            }
        }
        "quantisation" => rounded(own, range / rng.random_range(6.0..16.0_f64).round()),
        "held" => {
            let period = rng.random_range(4.0..25.0_f64);
            let true_values = own.to_vec();
            for (row, value) in own.iter_mut().enumerate() {
                *value = true_values[((row as f64 / period).floor() * period).ceil() as usize];
            }
        }
        "wrapped" => {
            let turn = [TAU, 360.0][rng.random_range(0..2)];
            let turns = rng.random_range(1.3..12.0);
            own.iter_mut()
                .for_each(|v| *v = (turn * turns * *v / range).rem_euclid(turn));
        }
        _ => unreachable!("{kind}"),
    }
}

/// Changes a column to what resembles a fault.
fn resemble(kind: &str, rng: &mut ChaCha8Rng, own: &mut [f64], range: f64) {
    let rows = own.len();
    match kind {
        // A coarse sensor, or one that is flat where nothing moves.
        "stuck" => rounded(own, range / rng.random_range(60.0..400.0_f64).round()),
        "clipping" => rounded(own, range / rng.random_range(100.0..2000.0_f64).round()),
        // Noise with long tails: its rms is one part in a hundred of the range.
        "spike" => {
            for value in own.iter_mut() {
                let (u, sign) = (rng.random::<f64>(), [-1.0, 1.0][rng.random_range(0..2)]);
                *value -= 0.007 * range * sign * (1.0 - u).ln();
            }
        }
        "quantisation" => {
            let counts = 100.0 * 10.0_f64.powf(rng.random::<f64>()).round();
            rounded(own, range / counts);
        }
        // Even motion over the counts of an encoder.
        "held" => {
            let counts = rng.random_range(40.0..160.0);
            for (row, value) in own.iter_mut().enumerate() {
                let phase = (row as f64 / rows as f64 * 4.0).rem_euclid(2.0);
                *value = (counts * (1.0 - (phase - 1.0).abs())).floor();
            }
        }
        // A sawtooth of no known turn.
        "wrapped" => {
            let turns = rng.random_range(1.3..6.0);
            own.iter_mut()
                .for_each(|v| *v = (5.0 * turns * *v / range).rem_euclid(5.0));
        }
        _ => unreachable!("{kind}"),
    }
}

/// A record with a fault, or with what resembles it, and the damaged column.
fn drawn(kind: &str, seed: u64, is_fault: bool, sound: &[Column]) -> (Vec<Column>, usize) {
    let mut rng = ChaCha8Rng::seed_from_u64(31 * seed + u64::from(is_fault));
    let mut all = sound.to_vec();
    let rows = all[0].values.len();
    let column = match kind {
        "gap" | "jitter" => 0,
        "clipping" => rng.random_range(1..3),
        // An angle wraps around, of a motor or of a slider.
        "wrapped" => all.len() - 2,
        _ => rng.random_range(1..all.len()),
    };
    let (low, high) = span(&all[column].values);
    let own = &mut all[column].values;
    match (kind, is_fault) {
        ("gap", true) => {
            for _ in 0..rng.random_range(1..4) {
                let length = (2.0 * 60.0_f64.powf(rng.random::<f64>())) as usize;
                let from = rng.random_range(100..rows - 600);
                all.iter_mut().for_each(|own| {
                    own.values.drain(from..from + length);
                });
            }
        }
        // Stamps off by up to a third of a step, or late by a random time.
        ("gap", false) => {
            let step = own[1] - own[0];
            let late = |rng: &mut ChaCha8Rng| match seed % 2 {
                0 => rng.random_range(0.0..0.33),
                _ => (-0.08 * (1.0 - rng.random::<f64>()).ln()).min(0.8),
            };
            own.iter_mut().for_each(|t| *t += step * late(&mut rng));
        }
        ("jitter", _) => {
            let every = rng.random_range(15..30);
            let most = f64::from(every as u32) * rng.random_range(0.1..0.45);
            let by: Vec<f64> = (0..rows)
                .map(|_| most * rng.random_range(-1.0..1.0_f64))
                .collect();
            // Of the fault the stamps alone move, else the samples with them.
            let late = |place: usize, k: usize| match is_fault && place > 0 {
                true => k * every,
                false => (k * every).saturating_add_signed(by[k].round() as isize),
            };
            all = shifted(&all, every, late);
        }
        (_, true) => damage(kind, &mut rng, own, high - low),
        (_, false) => resemble(kind, &mut rng, own, high - low),
    }
    (all, column)
}

/// Whether the fault was found in its column, and whether anything else was.
fn told(kind: &str, seed: u64, is_fault: bool, sound: &[Column]) -> (bool, bool) {
    let (columns, damaged) = drawn(kind, seed, is_fault, sound);
    let name = columns[damaged].name.clone();
    let record = match of_columns(columns, "r", &Options::default()) {
        Ok(record) => record,
        // Heavy clipping is refused.
        Err(error) => return (error.to_string().contains("clipped"), false),
    };
    let mut said: Vec<(&str, &str)> = record
        .defects
        .iter()
        .map(|own| (own.kind.name(), own.channel.as_str()))
        .collect();
    said.extend(record.held.iter().map(|own| ("held", own.as_str())));
    let wrapped = record.notes.iter().filter(|own| own.contains("wraps"));
    said.extend(wrapped.map(|own| ("wrapped", own.split('`').nth(1).unwrap_or(""))));
    let is_own = |own: &(&str, &str)| *own == (kind, name.as_str());
    (said.iter().any(is_own), !said.iter().all(is_own))
}

#[test]
#[ignore = "slow: bash .ci/run conclusions"]
fn faults_of_any_size_are_found_and_look_alikes_are_not() {
    let of = |rate: Option<f64>| -> Vec<Vec<Column>> {
        (0..RECORDS).map(|seed| sound(seed, rate)).collect()
    };
    let (any, fast) = (of(None), of(Some(1000.0)));
    let mut fails = Vec::new();
    for (kind, least) in KINDS {
        let sound = if kind == "jitter" { &fast } else { &any };
        let count = |is_fault: bool| {
            let all = (0..)
                .zip(sound)
                .map(|(seed, own)| told(kind, seed, is_fault, own));
            all.fold((0, 0), |(own, other), (is_own, is_other)| {
                (own + usize::from(is_own), other + usize::from(is_other))
            })
        };
        let ((found, besides), (own, other)) = (count(true), count(false));
        println!("{kind:12} found {found}, besides {besides}; without: {own}, else {other}");
        if found < least || own > 0 {
            fails.push(kind);
        }
    }
    assert!(fails.is_empty(), "{fails:?}");
}
