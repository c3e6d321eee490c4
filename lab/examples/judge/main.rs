//! The loop and the one search side by side on the same records.
//!
//! ```text
//! cargo run --release -p bowden-lab --example judge
//!     [-- --seeds K --first SEED --cell NAME --strength S --effect NAME --shared FOLDER --lines]
//! ```
//! Cells: `nulls` (three colours of noise), `single` (one effect a family and strength),
//! `three` and `long` (three effects in 20 s and in 60 s), `outside` (what is in no
//! catalogue), `shared` (measured records, where the folder is given). K records a row,
//! 10 by default, from SEED on; both input modes take turns. Records run one after the other,
//! so that processor time and evaluations of the model belong to one method.
//!
//! An effect is found if its family is named or is a rival of a name; a name is false if
//! neither it nor a rival was planted, and so is a curve without a name unless the effect is
//! in no catalogue. The error is held out, over what the noise leaves (median).
#![allow(clippy::unwrap_used)]

mod planted;
mod shared;

use bowden_synth::{effects, outsiders, Mode};
use planted::{can_be_missing, families, is_right, recipe, three_of, Judged, Planting, MODES};
use std::collections::BTreeMap;

/// What is to be run.
pub struct Wanted {
    seeds: u64,
    first: u64,
    cells: Vec<String>,
    strengths: Vec<f64>,
    only: Vec<String>,
    shared: Option<String>,
    lines: bool,
}

impl Wanted {
    fn read() -> Self {
        let mut wanted = Self {
            seeds: 10,
            first: 20_000,
            cells: Vec::new(),
            strengths: vec![0.3, 1.0, 3.0],
            only: Vec::new(),
            shared: None,
            lines: false,
        };
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            let mut next = || words.next().unwrap();
            match word.as_str() {
                "--seeds" => wanted.seeds = next().parse().unwrap(),
                "--first" => wanted.first = next().parse().unwrap(),
                "--cell" => wanted.cells.push(next()),
                "--strength" => wanted.strengths = vec![next().parse().unwrap()],
                "--effect" => wanted.only.push(next()),
                "--shared" => wanted.shared = Some(next()),
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

    fn chose(&self, name: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|o| o == name)
    }

    /// Both modes take turns, so that a row of K seeds has K records.
    fn seeds(&self) -> impl Iterator<Item = (Mode, u64)> + '_ {
        (0..self.seeds).map(|k| (MODES[(k % 2) as usize], self.first + k))
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let all: Vec<f64> = values.collect();
    all.iter().sum::<f64>() / all.len().max(1) as f64
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut all: Vec<f64> = values.collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Runs the records of a row by both methods.
fn run(
    wanted: &Wanted,
    colour: f64,
    seconds: f64,
    records: impl Iterator<Item = (Mode, u64, Planting)>,
) -> Vec<[Judged; 2]> {
    records
        .map(|(mode, seed, planting)| {
            let both = planted::both(&recipe(mode, &planting, colour, seconds, seed), &planting);
            if wanted.lines {
                for judged in &both {
                    println!("  {}", judged.line);
                }
            }
            both
        })
        .collect()
}

fn head(title: &str) {
    println!("\n{title}");
    print!("{:20} {:>4}", "", "n");
    for name in ["loop", "one search"] {
        print!(" | {name:10} found false error   CPU s  evals");
    }
    println!();
}

fn row(name: &str, all: &[[Judged; 2]]) {
    print!("{name:20} {:4}", all.len());
    for method in 0..2 {
        let own = || all.iter().map(move |both| &both[method]);
        print!(
            " | {:16.3} {:5.3} {:5.3} {:7.2} {:6.0}",
            mean(own().map(|j| j.found)),
            mean(own().map(|j| j.wrong)),
            median(own().map(|j| j.error)),
            mean(own().map(|j| j.seconds)),
            mean(own().map(|j| j.evaluations)),
        );
    }
    println!();
}

fn nulls(wanted: &Wanted) {
    head("nothing missing");
    for (name, colour) in [("white", 0.0), ("AR(0.9)", 0.9), ("AR(0.99)", 0.99)] {
        let records = wanted.seeds().map(|(mode, seed)| (mode, seed, Vec::new()));
        row(name, &run(wanted, colour, 20.0, records));
    }
}

fn single(wanted: &Wanted) {
    for &strength in &wanted.strengths {
        head(&format!("one effect, {strength} times the noise"));
        let mut total = Vec::new();
        let mut members: BTreeMap<&str, Vec<(Mode, &'static str)>> = BTreeMap::new();
        for mode in MODES {
            for name in effects(mode).iter().filter(|n| can_be_missing(mode, n)) {
                for family in families(&[(*name, strength)]) {
                    members.entry(family.name()).or_default().push((mode, name));
                }
            }
        }
        for (family, kinds) in members.iter().filter(|(f, _)| wanted.chose(f)) {
            let seeds = wanted.first..wanted.first + wanted.seeds;
            let records = seeds
                .zip(kinds.iter().cycle())
                .map(|(seed, &(mode, name))| (mode, seed, vec![(name, strength)]));
            let own = run(wanted, 0.0, 20.0, records);
            row(family, &own);
            total.extend(own);
        }
        row("all", &total);
    }
}

fn three(wanted: &Wanted, seconds: f64) {
    head(&format!(
        "three effects, 1 to 3 times the noise, {seconds} s"
    ));
    let mut total = Vec::new();
    for mode in MODES {
        let seeds = wanted.first..wanted.first + wanted.seeds;
        let records = seeds.map(|seed| (mode, seed, three_of(mode, seed)));
        let own = run(wanted, 0.0, seconds, records);
        row(&format!("{mode:?}").to_lowercase(), &own);
        total.extend(own);
    }
    row("all", &total);
}

fn outside(wanted: &Wanted) {
    println!("\nin no catalogue, 3 times the noise: every name is false");
    for &name in outsiders().iter().filter(|n| wanted.chose(n)) {
        let records = wanted
            .seeds()
            .map(|(mode, seed)| (mode, seed, vec![(name, 3.0)]));
        let all = run(wanted, 0.0, 20.0, records);
        for (method, title) in ["loop", "one search"].into_iter().enumerate() {
            let own = || all.iter().map(move |both| &both[method]);
            let share = |of: &dyn Fn(&Judged) -> bool| mean(own().map(|j| f64::from(of(j))));
            println!(
                "{name:20} {:4} | {title:10} unknown {:.2} right {:.2} a name {:.2} error {:.3} CPU {:.2} s evals {:.0}",
                all.len(),
                share(&|j| j.unknown.is_some()),
                share(&|j| j.unknown.as_ref().is_some_and(|(v, c)| is_right(name, v, c))),
                share(&|j| j.names > 0),
                median(own().map(|j| j.error)),
                mean(own().map(|j| j.seconds)),
                mean(own().map(|j| j.evaluations)),
            );
        }
    }
}

fn main() {
    let wanted = Wanted::read();
    if wanted.shows("nulls") {
        nulls(&wanted);
    }
    if wanted.shows("single") {
        single(&wanted);
    }
    if wanted.shows("three") {
        three(&wanted, 20.0);
    }
    if wanted.shows("long") {
        three(&wanted, 60.0);
    }
    if wanted.shows("outside") {
        outside(&wanted);
    }
    match &wanted.shared {
        Some(folder) if wanted.shows("shared") => shared::all(folder, &wanted.only),
        None if wanted.shows("shared") => println!("\nshared: skipped, no --shared FOLDER"),
        _ => {}
    }
}
