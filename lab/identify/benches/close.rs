//! How long closing the loop takes: a 20 000-sample record with an undeclared effect.
//!
//! `cargo bench -p bowden-lab --bench close`. Reading, preparing and the whole loop are
//! timed apart; what was found is printed beside it.
#![allow(clippy::unwrap_used, missing_docs)]

use bowden_lab::conclude::intervals::term_name;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::{parse, Options};
use bowden_lab::search::close;
use bowden_synth::{generate, Mode, Planted, Recipe};
use criterion::{criterion_group, criterion_main, Criterion};
use std::hint::black_box;

fn bench(c: &mut Criterion) {
    for (name, mode, effect) in [
        ("torque, viscous", Mode::Torque, "viscous"),
        ("displacement, stribeck", Mode::Displacement, "stribeck"),
    ] {
        let recipe = Recipe {
            effects: vec![Planted::new(effect)],
            seed: 7,
            ..Recipe::new(mode)
        };
        let csv = generate(&recipe).unwrap().to_csv();
        let options = Options::default();
        let record = parse(csv.as_bytes(), name, &options).unwrap();
        let data = Prepared::new(&record, Preparation::default()).unwrap();
        let declared = structure(&["bouc-wen".to_owned()], &data).unwrap();
        let ledger = close(&data, &declared, |_| ()).unwrap();
        let found: Vec<String> = ledger
            .rounds
            .iter()
            .map(|r| term_name(&data, &r.candidate.term))
            .collect();
        println!(
            "{name}: {} samples, {} on the work grid, found {}",
            data.samples,
            data.work_len(),
            found.join(", ")
        );
        let mut group = c.benchmark_group(name);
        group.sample_size(10);
        group.bench_function("read", |b| {
            b.iter(|| parse(black_box(csv.as_bytes()), name, &options).unwrap());
        });
        group.bench_function("prepare", |b| {
            b.iter(|| Prepared::new(black_box(&record), Preparation::default()).unwrap());
        });
        group.bench_function("close", |b| {
            b.iter(|| close(black_box(&data), &declared, |_| ()).unwrap());
        });
        group.finish();
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
