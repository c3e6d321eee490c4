//! What the loop's answers are worth: how often it names what is there, and what is not.
//!
//! ```text
//! cargo run --release -p bowden-lab --example operating_characteristics
//!     [-- --seeds K --first SEED --seconds T --show CELL --strength S --effect NAME --lines]
//! ```
//! Records come from a generator that shares no code with the fit, twenty seconds at
//! 1 kHz (or T seconds, but for `intervals`), written as CSV and read back; the declared
//! model is Bouc-Wen alone. Both modes take turns, and so do the members of a family.
//! Cells: `nulls`, `single` (one a family and strength), `three`, `outside`, `intervals`, all
//! by default. K seeds a cell, 100 by default, from SEED on. `--lines` prints each record.
//!
//! An effect counts as found if its family is named or stands among the rivals of a name
//! (a confounded set); a name is false if neither it nor a rival of it was planted.
//! Beside the loop, on the same records: BIC forward selection and the 0.1 % ERR rule
//! (`criteria.rs` says what they get). Errors are held out, over what the noise leaves; in
//! the rows all three have fitted the same 60 % of the record.
#![allow(clippy::unwrap_used)]

mod coverage;
mod criteria;
mod planting;
mod record;
#[allow(dead_code)]
#[path = "../../tests/identification/rig.rs"]
mod rig;

use bowden_synth::{effects, outsiders, Mode, Recipe};
use criteria::Chosen;
use planting::{can_be_missing, family_of, recipe};
use rand::seq::SliceRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use record::{run, Outcome};
use std::collections::BTreeMap;

const MODES: [Mode; 2] = [Mode::Torque, Mode::Displacement];

struct Wanted {
    seeds: u64,
    first: u64,
    seconds: f64,
    cells: Vec<String>,
    strengths: Vec<f64>,
    only: Vec<String>,
    lines: bool,
}

impl Wanted {
    fn read() -> Self {
        let mut wanted = Self {
            seeds: 100,
            first: 20_000,
            seconds: 20.0,
            cells: Vec::new(),
            strengths: vec![0.3, 1.0, 3.0],
            only: Vec::new(),
            lines: false,
        };
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            let mut next = || words.next().unwrap();
            match word.as_str() {
                "--seeds" => wanted.seeds = next().parse().unwrap(),
                "--first" => wanted.first = next().parse().unwrap(),
                "--seconds" => wanted.seconds = next().parse().unwrap(),
                "--show" => wanted.cells.push(next()),
                "--strength" => wanted.strengths = vec![next().parse().unwrap()],
                "--effect" => wanted.only.push(next()),
                "--lines" => wanted.lines = true,
                other => {
                    eprintln!("{other}: not an option; see the head of this example");
                    std::process::exit(2);
                }
            }
        }
        wanted
    }

    fn shows(&self, cell: &str) -> bool {
        self.cells.is_empty() || self.cells.iter().any(|c| c == cell)
    }

    fn chose(&self, effect: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|o| o == effect)
    }

    /// Both modes take turns, so that a cell of K seeds has K records.
    fn seeds(&self) -> Vec<(Mode, u64)> {
        (0..self.seeds)
            .map(|k| (MODES[(k % 2) as usize], self.first + k))
            .collect()
    }
}

type Planting = Vec<(&'static str, f64)>;

/// Runs all records of a cell; what was planted and what came out.
fn cell(
    wanted: &Wanted,
    colour: f64,
    records: Vec<(Mode, u64, Planting)>,
) -> Vec<(Vec<&'static str>, Outcome)> {
    let all: Vec<(Vec<&'static str>, Outcome)> = records
        .into_par_iter()
        .map(|(mode, seed, planting)| {
            let families = planting.iter().filter_map(|(e, _)| family_of(e)).collect();
            let recipe = Recipe {
                seconds: wanted.seconds,
                ..recipe(mode, &planting, colour, seed)
            };
            (families, run(&recipe))
        })
        .collect();
    for (families, outcome) in all.iter().filter(|_| wanted.lines) {
        let mark = match (outcome.found(families), outcome.wrong(families)) {
            (found, 0) if found == families.len() => "ok   ",
            (_, 0) => "MISS ",
            _ => "FALSE",
        };
        println!("{mark} {}", outcome.line);
    }
    all
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        sum += value;
        count += 1.0;
    }
    sum / f64::max(count, 1.0)
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut all: Vec<f64> = values.collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Found, false and error, of the loop and of the two criteria.
fn row(name: &str, all: &[(Vec<&'static str>, Outcome)]) {
    let loop_found = mean(all.iter().map(|(f, o)| o.found(f) as f64));
    let loop_wrong = mean(all.iter().map(|(f, o)| o.wrong(f) as f64));
    let runs = mean(all.iter().map(|(f, o)| f64::from(o.wrong(f) > 0)));
    let error = median(all.iter().map(|(_, o)| o.reached));
    let other = |of: fn(&Outcome) -> &Chosen| {
        format!(
            "{:5.2} {:5.2} {:5.2}",
            mean(all.iter().map(|(f, o)| of(o).found(f) as f64)),
            mean(all.iter().map(|(f, o)| of(o).wrong(f) as f64)),
            median(all.iter().map(|(_, o)| of(o).reached)),
        )
    };
    println!(
        "{name:24} {:6} | {loop_found:5.2} {loop_wrong:5.2} {:5.1}% {error:5.2} | {} | {}",
        all.len(),
        100.0 * runs,
        other(|o| &o.bic),
        other(|o| &o.err),
    );
}

fn head(title: &str) {
    println!("\n{title}");
    println!(
        "{:24} {:>6} | {:^25} | {:^17} | {:^17}",
        "", "", "loop", "BIC forward", "ERR 0.1 %"
    );
    println!(
        "{:24} {:>6} | {:>5} {:>5} {:>6} {:>5} | {:>5} {:>5} {:>5} | {:>5} {:>5} {:>5}",
        "",
        "runs",
        "found",
        "false",
        "runs",
        "error",
        "found",
        "false",
        "error",
        "found",
        "false",
        "error"
    );
}

fn nulls(wanted: &Wanted) {
    head("nothing missing");
    let mut columns = usize::MAX;
    for (name, colour) in [("white", 0.0), ("AR(0.9)", 0.9), ("AR(0.99)", 0.99)] {
        let records = wanted.seeds().into_iter().map(|(m, s)| (m, s, Vec::new()));
        let all = cell(wanted, colour, records.collect());
        columns = columns.min(all.iter().map(|(_, o)| o.columns).min().unwrap_or(0));
        row(name, &all);
    }
    println!("at least {columns} columns of the catalogue were tried on each");
}

fn single(wanted: &Wanted) {
    for &strength in &wanted.strengths {
        head(&format!("one effect, {strength} times the noise"));
        let mut total = Vec::new();
        let mut families: BTreeMap<&str, Vec<&'static str>> = BTreeMap::new();
        for name in effects(Mode::Torque).iter().filter(|n| wanted.chose(n)) {
            if let Some(family) = family_of(name) {
                families.entry(family).or_default().push(name);
            }
        }
        for (family, members) in families {
            // Members and modes take turns: a family is a cell, and has K records.
            let kinds: Vec<_> = MODES
                .iter()
                .flat_map(|mode| members.iter().map(move |name| (*mode, *name)))
                .filter(|(mode, name)| effects(*mode).contains(name) && can_be_missing(*mode, name))
                .collect();
            let records = (wanted.first..wanted.first + wanted.seeds)
                .zip(kinds.iter().cycle())
                .map(|(seed, &(mode, name))| (mode, seed, vec![(name, strength)]));
            let own = cell(wanted, 0.0, records.collect());
            if !own.is_empty() {
                row(family, &own);
            }
            total.extend(own);
        }
        row("all", &total);
    }
}

/// Three effects of three families, each at one to three times the noise.
fn three_of(mode: Mode, seed: u64) -> Planting {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut names: Vec<&'static str> = effects(mode)
        .iter()
        .copied()
        .filter(|name| can_be_missing(mode, name))
        .collect();
    names.shuffle(&mut rng);
    let mut planting: Planting = Vec::new();
    for name in names {
        let new = planting
            .iter()
            .all(|(p, _)| family_of(p) != family_of(name));
        if new && planting.len() < 3 {
            planting.push((name, 3.0_f64.powf(rng.random_range(0.0..1.0))));
        }
    }
    planting
}

fn three(wanted: &Wanted) {
    head("three effects of different families, 1 to 3 times the noise");
    let mut total = Vec::new();
    for mode in MODES {
        let records = (0..wanted.seeds)
            .map(|k| wanted.first + k)
            .map(|seed| (mode, seed, three_of(mode, seed)));
        let all = cell(wanted, 0.0, records.collect());
        row(&format!("{mode:?}").to_lowercase(), &all);
        total.extend(all);
    }
    row("all", &total);
    println!(
        "error of the final model, refitted with the stop-check: {:.3} (median); within 5 % of what the noise leaves in {:.0} % of runs",
        median(total.iter().map(|(_, o)| o.delivered)),
        100.0 * mean(total.iter().map(|(_, o)| f64::from(o.delivered <= 1.05)))
    );
    // What the noise leaves knows no parameters to be estimated; a fit that is told does.
    let told: Vec<(f64, [f64; 2])> = total
        .iter()
        .filter_map(|(_, o)| Some((o.delivered, o.told?)))
        .collect();
    println!(
        "a fit that is told which effects there are: {:.3}, refitted {:.3} (medians of {}); the final model is within 5 % of that in {:.0} %",
        median(told.iter().map(|(_, [told, _])| *told)),
        median(told.iter().map(|(_, [_, told])| *told)),
        told.len(),
        100.0 * mean(told.iter().map(|(done, [_, told])| f64::from(*done <= 1.05 * told)))
    );
}

/// Whether a variable is what the outsider is a function of; both channels are its usual ones.
fn is_right(outsider: &str, variable: &str, channel: &str) -> bool {
    match outsider {
        "bump-position" => variable == "position" && ["phi_p", "x"].contains(&channel),
        "bump-load" => variable == "load",
        _ => variable.starts_with("reversal-") && ["tau_i", "x"].contains(&channel),
    }
}

fn outside(wanted: &Wanted) {
    println!("\noutside the catalogue, 3 times the noise: every name is false");
    println!(
        "{:24} {:>6} | {:>8} {:>8} {:>8} {:>8} | {:>6}",
        "", "runs", "unknown", "right", "no word", "a name", "error"
    );
    for &name in outsiders().iter().filter(|name| wanted.chose(name)) {
        let records = wanted
            .seeds()
            .into_iter()
            .map(|(mode, seed)| (mode, seed, vec![(name, 3.0)]));
        let all = cell(wanted, 0.0, records.collect());
        let share = |of: &dyn Fn(&Outcome) -> bool| {
            100.0 * mean(all.iter().map(|(_, outcome)| f64::from(of(outcome))))
        };
        println!(
            "{name:24} {:6} | {:7.1}% {:7.1}% {:7.1}% {:7.1}% | {:6.2}",
            all.len(),
            share(&|o| o.unknown.is_some()),
            share(&|o| o
                .unknown
                .as_ref()
                .is_some_and(|(v, c)| is_right(name, v, c))),
            share(&|o| o.unknown.is_none() && o.rounds.is_empty()),
            share(&|o| o.wrong_names(&[]) > 0),
            median(all.iter().map(|(_, o)| o.reached)),
        );
    }
}

fn intervals(wanted: &Wanted) {
    println!("\nintervals of 95 %: share that holds the truth");
    for (name, colour) in [("white", 0.0), ("AR(0.95)", 0.95)] {
        let counts = wanted
            .seeds()
            .into_par_iter()
            .map(|(mode, seed)| coverage::of(mode, seed, colour))
            .reduce(coverage::Counts::new, coverage::merge);
        let (mut all, mut inside) = (0, 0);
        for (parameter, count) in &counts {
            println!(
                "{name:10} {parameter:20} {:5.1} % of {:4}, refused {}",
                100.0 * f64::from(count.inside) / f64::from(count.all.max(1)),
                count.all,
                count.refused
            );
            all += count.all;
            inside += count.inside;
        }
        println!(
            "{name:10} {:20} {:5.1} % of {all:4}",
            "all",
            100.0 * f64::from(inside) / f64::from(all.max(1))
        );
    }
}

/// A cell's name, and what prints it.
type Part = (&'static str, fn(&Wanted));

fn main() {
    let wanted = Wanted::read();
    let started = std::time::Instant::now();
    let parts: [Part; 5] = [
        ("nulls", nulls),
        ("single", single),
        ("three", three),
        ("outside", outside),
        ("intervals", intervals),
    ];
    for (name, part) in parts {
        if wanted.shows(name) {
            part(&wanted);
        }
    }
    eprintln!("{:.0} s", started.elapsed().as_secs_f64());
}
