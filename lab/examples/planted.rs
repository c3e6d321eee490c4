//! Plants each effect of the catalogue and prints what the loop finds.
//!
//! `cargo run --release -p bowden-lab --example planted [-- torque|displacement STRENGTH SEEDS COLOUR EFFECT…]`
//! The records come from a generator that shares no code with the fit. STRENGTH is the
//! rms of the effect's contribution over that of the sensor's noise (0: nothing is
//! planted), COLOUR the AR(1) coefficient of the noise. Columns: the held-out error of
//! the declared and of the final model over the error that the noise alone leaves, then
//! what was found (rivals in parentheses) and the time taken.
#![allow(clippy::unwrap_used)]

use bowden_lab::closing::close;
use bowden_lab::conclude::intervals::term_name;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::{parse, Options};
use bowden_synth::{effects, generate, Mode, Planted, Recipe};

/// Family of an effect by its own name.
fn family_of(name: &str) -> &'static str {
    bowden::effect::CATALOGUE
        .iter()
        .find(|i| i.name == name)
        .map_or("", |i| i.family.name())
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let word = |i: usize, default: &str| {
        arguments
            .get(i)
            .cloned()
            .unwrap_or_else(|| default.to_owned())
    };
    let modes: &[Mode] = match word(0, "both").as_str() {
        "torque" => &[Mode::Torque],
        "displacement" => &[Mode::Displacement],
        _ => &[Mode::Torque, Mode::Displacement],
    };
    let strength: f64 = word(1, "3").parse().unwrap();
    let seeds: u64 = word(2, "1").parse().unwrap();
    let colour: f64 = word(3, "0").parse().unwrap();
    let only: Vec<String> = arguments.iter().skip(4).cloned().collect();
    let (mut right, mut total, mut extra, mut at_floor) = (0, 0, 0, 0);
    for &mode in modes {
        let names: Vec<&str> = if strength == 0.0 {
            vec![""]
        } else {
            effects(mode).to_vec()
        };
        for name in names
            .into_iter()
            .filter(|n| only.is_empty() || only.iter().any(|o| o == n))
        {
            for seed in 1..=seeds {
                let mut recipe = Recipe::new(mode);
                recipe.seed = 1000 + seed;
                recipe.colour = colour;
                recipe.load = mode == Mode::Displacement
                    && ["load", "capstan", "drive", "gain"]
                        .iter()
                        .any(|w| name.contains(w));
                recipe.temperature = name == "temperature";
                if strength > 0.0 {
                    recipe.effects = vec![Planted {
                        strength,
                        ..Planted::new(name)
                    }];
                }
                let made = generate(&recipe).unwrap();
                let mut options = Options::default();
                if name == "crosstalk" {
                    options.channels.push(("aux".to_owned(), "aux".to_owned()));
                }
                let record = parse(made.to_csv().as_bytes(), name, &options).unwrap();
                let data = Prepared::new(&record, Preparation::default()).unwrap();
                let mut clean = record.clone();
                clean.output.values.clone_from(&made.truth.output);
                let clean = Prepared::new(
                    &clean,
                    Preparation {
                        cutoff: Some(data.cutoff),
                    },
                )
                .unwrap();
                let noise: Vec<f64> = data
                    .target
                    .iter()
                    .zip(&clean.target)
                    .map(|(a, b)| a - b)
                    .collect();
                let floor = bowden_lab::fit::Segments::of(&data, &noise).held_out;
                let started = std::time::Instant::now();
                let ledger = close(
                    &data,
                    &structure(&["bouc-wen".to_owned()], &data).unwrap(),
                    |_| (),
                )
                .unwrap();
                let seconds = started.elapsed().as_secs_f64();
                let family = family_of(name);
                let mut hit = false;
                let mut found: Vec<String> = ledger
                    .rounds
                    .iter()
                    .map(|r| {
                        let rivals: Vec<_> =
                            r.rivals.iter().map(|c| c.term.effect.name()).collect();
                        let ok = r.candidate.family.name() == family
                            || r.rivals.iter().any(|c| c.family.name() == family);
                        if ok {
                            hit = true;
                        } else {
                            extra += 1;
                        }
                        format!(
                            "{}{}",
                            term_name(&data, &r.candidate.term),
                            if rivals.is_empty() {
                                String::new()
                            } else {
                                format!("({})", rivals.join(" "))
                            }
                        )
                    })
                    .collect();
                if let Some(unknown) = &ledger.unknown {
                    extra += 1;
                    found.push(format!("UNKNOWN {}", unknown.variable.words(&data)));
                }
                let ratio = ledger.last().rmse.held_out / floor;
                total += 1;
                right += i32::from(hit);
                at_floor += i32::from(ratio < 1.1);
                let reject: Vec<String> = ledger
                    .rejected
                    .iter()
                    .map(|r| {
                        format!(
                            "{}:{:?}{:.5}",
                            r.candidate.term.effect.name(),
                            r.gate,
                            r.p.unwrap_or(-1.0)
                        )
                    })
                    .collect();
                if std::env::var("TRUTH").is_ok() {
                    let last = ledger.last();
                    for e in &made.truth.effects {
                        println!(
                            "truth {} on {:?}: gain {} shapes {:?}; base {:?}",
                            e.effect, e.channel, e.gain, e.shapes, made.truth.base
                        );
                    }
                    for p in bowden_lab::conclude::intervals::parameters(&data, last) {
                        println!("   {} = {:.5} {:?} {:?}", p.name, p.value, p.ci95, p.unit);
                    }
                }
                println!(
                    "{mode:?} {name:22} {seed} {} {:7.2} -> {:5.2} ({:?}, f_c {}, rho {:.3} sig {:.2} n {:.2}) {} | {} | {seconds:.2} s",
                    if hit { "ok  " } else { "MISS" },
                    ledger.declared.rmse.held_out / floor,
                    ratio,
                    ledger.regime,
                    data.cutoff,
                    made.truth.base.rho,
                    made.truth.base.sigma,
                    made.truth.base.n,
                    found.join(", "),
                    reject.join(" "),
                );
            }
        }
    }
    println!("found {right} of {total}, other names {extra}, within 10 % of the floor {at_floor}");
}
