//! Plants each effect of the catalogue and prints what the loop finds.
//!
//! `cargo run --release -p bowden-lab --example planted [-- torque|displacement STRENGTH SEEDS COLOUR EFFECT…]`
//! The records come from a generator that shares no code with the fit. STRENGTH is the
//! rms of the effect's contribution over that of the sensor's noise (0: nothing is
//! planted), COLOUR the AR(1) coefficient of the noise. Columns: the held-out error of
//! the declared and of the final model over the error that the noise alone leaves, then
//! what was found (rivals in parentheses) and the time taken.
#![allow(clippy::unwrap_used)]

#[allow(dead_code)]
#[path = "../tests/identification/rig.rs"]
mod rig;

use bowden_lab::conclude::intervals::term_name;
use bowden_lab::fit::Solution;
use bowden_lab::ledger::{Ledger, Round};
use bowden_lab::problem::Prepared;
use bowden_lab::search::close;
use bowden_synth::{effects, Mode, Planted, Recipe};
use rig::Made;

/// &'static str of an effect by its own name.
fn family_of(name: &str) -> &'static str {
    bowden::effect::CATALOGUE
        .iter()
        .find(|i| i.name == name)
        .map_or("", |i| i.family)
}

/// What is asked for.
struct Arguments {
    modes: &'static [Mode],
    strength: f64,
    seeds: u64,
    colour: f64,
    /// The effects that are planted; all of the mode where it is empty.
    only: Vec<String>,
}

impl Arguments {
    fn read() -> Self {
        let words: Vec<String> = std::env::args().skip(1).collect();
        let word = |i: usize, default: &str| {
            let word = words.get(i).cloned();
            word.unwrap_or_else(|| default.to_owned())
        };
        Self {
            modes: match word(0, "both").as_str() {
                "torque" => &[Mode::Torque],
                "displacement" => &[Mode::Displacement],
                _ => &[Mode::Torque, Mode::Displacement],
            },
            strength: word(1, "3").parse().unwrap(),
            seeds: word(2, "1").parse().unwrap(),
            colour: word(3, "0").parse().unwrap(),
            only: words.iter().skip(4).cloned().collect(),
        }
    }

    fn names(&self, mode: Mode) -> Vec<&'static str> {
        if self.strength == 0.0 {
            return vec![""];
        }
        let wanted = |name: &&str| self.only.is_empty() || self.only.iter().any(|o| o == name);
        effects(mode).iter().copied().filter(wanted).collect()
    }

    fn recipe(&self, mode: Mode, name: &str, seed: u64) -> Recipe {
        let loaded = ["load", "capstan", "drive", "gain"];
        let mut recipe = Recipe::new(mode);
        recipe.seed = 1000 + seed;
        recipe.colour = self.colour;
        recipe.load = mode == Mode::Displacement && loaded.iter().any(|w| name.contains(w));
        recipe.temperature = name == "temperature";
        if self.strength > 0.0 {
            recipe.effects = vec![Planted {
                strength: self.strength,
                ..Planted::new(name)
            }];
        }
        recipe
    }
}

/// What was planted and what was fitted, for a reader who sets `TRUTH`.
fn print_truth(made: &Made, last: &Solution) {
    let truth = &made.synthetic.truth;
    for e in &truth.effects {
        println!(
            "truth {} on {:?}: gain {} shapes {:?}; base {:?}",
            e.effect, e.channel, e.gain, e.shapes, truth.base
        );
    }
    for p in made.parameters(last) {
        println!("   {} = {:.5} {:?} {:?}", p.name, p.value, p.ci95, p.unit);
    }
}

/// What was found of a family.
struct Found {
    /// Whether the family was named, or stands among the rivals of a name.
    hit: bool,
    /// How many other names there are.
    extra: usize,
    names: Vec<String>,
}

impl Found {
    fn new(data: &Prepared, ledger: &Ledger, family: &str) -> Self {
        let is_right = |round: &&Round| {
            let mut possible = round.possible();
            possible.any(|one| one.family == family)
        };
        let right = ledger.rounds.iter().filter(is_right).count();
        let mut names: Vec<String> = ledger.rounds.iter().map(|r| named(data, r)).collect();
        if let Some(unknown) = &ledger.unknown {
            names.push(format!("UNKNOWN {}", unknown.variable.words(data)));
        }
        Self {
            hit: right > 0,
            extra: names.len() - right,
            names,
        }
    }
}

/// The name of a round, with its rivals in parentheses.
fn named(data: &Prepared, round: &Round) -> String {
    let rivals: Vec<_> = round.rivals.iter().map(|c| c.term.effect.name()).collect();
    let name = term_name(data, &round.candidate.term);
    match rivals.is_empty() {
        true => name,
        false => format!("{name}({})", rivals.join(" ")),
    }
}

fn turned_down(ledger: &Ledger) -> String {
    let rejected = ledger.rejected.iter().map(|r| {
        let effect = r.candidate.term.effect.name();
        format!("{effect}:{:?}{:.5}", r.gate, r.p.unwrap_or(-1.0))
    });
    rejected.collect::<Vec<String>>().join(" ")
}

#[derive(Default)]
struct Totals {
    right: usize,
    total: usize,
    extra: usize,
    at_floor: usize,
}

/// Closes one record and prints its line.
fn close_one(recipe: &Recipe, name: &str, seed: u64, totals: &mut Totals) {
    let made = Made::new(recipe);
    let (data, floor) = (&made.data, made.noise_floor());
    let declared = made.declare(&["bouc-wen"]);
    let started = std::time::Instant::now();
    let ledger = close(data, &declared, |_| ()).unwrap();
    let seconds = started.elapsed().as_secs_f64();
    let found = Found::new(data, &ledger, family_of(name));
    let ratio = ledger.last().rmse.held_out / floor;
    totals.total += 1;
    totals.right += usize::from(found.hit);
    totals.extra += found.extra;
    totals.at_floor += usize::from(ratio < 1.1);
    if std::env::var("TRUTH").is_ok() {
        print_truth(&made, ledger.last());
    }
    let base = &made.synthetic.truth.base;
    println!(
        "{:?} {name:22} {seed} {} {:7.2} -> {ratio:5.2} ({:?}, f_c {}, rho {:.3} sig {:.2} n {:.2}) {} | {} | {seconds:.2} s",
        recipe.mode,
        if found.hit { "ok  " } else { "MISS" },
        ledger.declared.rmse.held_out / floor,
        ledger.regime,
        data.cutoff,
        base.rho,
        base.sigma,
        base.n,
        found.names.join(", "),
        turned_down(&ledger),
    );
}

fn main() {
    let arguments = Arguments::read();
    let mut totals = Totals::default();
    for &mode in arguments.modes {
        for name in arguments.names(mode) {
            for seed in 1..=arguments.seeds {
                let recipe = arguments.recipe(mode, name, seed);
                close_one(&recipe, name, seed, &mut totals);
            }
        }
    }
    let Totals {
        right,
        total,
        extra,
        at_floor,
    } = totals;
    println!("found {right} of {total}, other names {extra}, within 10 % of the floor {at_floor}");
}
