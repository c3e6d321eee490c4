//! The set of planted records that decides whether a change of the search is kept.
//!
//! ```text
//! cargo run --release -p bowden-lab --example judge [-- nulls single three outside]
//! ```
//! Run it at the end of a change and report what it prints: no threshold is ever set by these
//! seeds, strengths and colours. The figures of each commit are in `docs/results/judged.md`.
//!
//! - **found**: planted families that are a term, or an alternative to one; a share of all.
//! - **false**: terms that are neither, and a curve where nothing was planted; per record.
//! - **names**: terms of high confidence of a planted family, of all terms of high confidence.
//! - **mechanisms**: missing mechanisms of high confidence that were planted, of all of high
//!   confidence.
//! - **error**: held-out error of the delivered model over the noise, median.
//! - **fits**: evaluations of a model, mean.
#![allow(clippy::unwrap_used)]

#[path = "../operating_characteristics/planting.rs"]
mod planting;
#[allow(dead_code)]
#[path = "../../tests/identification/rig.rs"]
mod rig;

use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::conclude::mechanisms::mechanisms;
use bowden_lab::ledger::Grade;
use bowden_lab::model::mechanism::Mechanism;
use bowden_lab::search::close;
use bowden_synth::{effects, outsiders, Mode};
use planting::{can_be_missing, family_of, recipe};
use rand::seq::SliceRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use rig::{Made, MODES};

/// The first seed of all cells.
const FIRST: u64 = 41_000_000;
/// Strengths in units of the noise, log-uniform.
const STRENGTHS: (f64, f64) = (0.5, 5.0);
/// Colours of the noise where nothing is missing: the pole of an autoregression.
const COLOURS: [f64; 3] = [0.0, 0.8, 0.97];

/// A cell's name, and its records.
type Cell = (&'static str, fn() -> Vec<Job>);

/// A record and what is planted in it.
struct Job {
    mode: Mode,
    seed: u64,
    colour: f64,
    planted: Vec<(&'static str, f64)>,
}

/// Counts over the records of a cell.
#[derive(Default)]
struct Outcome {
    planted: usize,
    found: usize,
    wrong: usize,
    /// Right and all, of high confidence.
    names: [usize; 2],
    mechanisms: [usize; 2],
    curve: bool,
    error: f64,
    line: String,
}

/// The family of an effect, `None` outside the catalogue; and its mechanism.
fn effect(name: &str) -> (Option<&'static str>, Mechanism) {
    match family_of(name) {
        Some(family) => (Some(family), Mechanism::of(name, family)),
        None if name.starts_with("bump") => (None, Mechanism::Elastic),
        None => (None, Mechanism::ContactMemory),
    }
}

fn run(job: &Job) -> Outcome {
    let recipe = recipe(job.mode, &job.planted, job.colour, job.seed);
    let made = Made::new(&recipe);
    let ledger = close(&made.data, &made.declare(&["bouc-wen"]), |_| ()).unwrap();
    let truth: Vec<_> = job.planted.iter().map(|(name, _)| effect(name)).collect();
    let families: Vec<&'static str> = truth.iter().filter_map(|(family, _)| *family).collect();
    let done = FinalFit::new(&made.data, &ledger);
    let mut outcome = Outcome {
        planted: families.len(),
        curve: ledger.unknown.is_some(),
        error: done.rmse.held_out / made.noise_floor(),
        ..Outcome::default()
    };
    let mut seen: Vec<&'static str> = Vec::new();
    for round in &ledger.rounds {
        let own: Vec<&'static str> = round.possible().map(|one| one.family).collect();
        let right = families.iter().any(|family| own.contains(family));
        outcome.wrong += usize::from(!right);
        if round.grade == Grade::High {
            outcome.names[0] += usize::from(right);
            outcome.names[1] += 1;
        }
        seen.extend(own);
    }
    for lack in mechanisms(&made.data, &ledger, &done) {
        if lack.confidence == Grade::High {
            let right = truth.iter().any(|(_, planted)| *planted == lack.mechanism);
            outcome.mechanisms[0] += usize::from(right);
            outcome.mechanisms[1] += 1;
        }
    }
    outcome.found = families.iter().filter(|f| seen.contains(f)).count();
    outcome.wrong += usize::from(outcome.curve && job.planted.is_empty());
    let names = ledger.rounds.iter();
    let names = names.map(|r| format!("{} ({:?})", r.candidate.term.effect.name(), r.grade));
    outcome.line = format!(
        "{:?} {} {:?}: {} of {}, false {}, {:.2}: {}{}",
        job.mode,
        job.seed,
        job.planted,
        outcome.found,
        outcome.planted,
        outcome.wrong,
        outcome.error,
        names.collect::<Vec<_>>().join(" "),
        if outcome.curve { " +curve" } else { "" },
    );
    outcome
}

fn strength(rng: &mut ChaCha8Rng) -> f64 {
    let (low, high) = STRENGTHS;
    low * (high / low).powf(rng.random_range(0.0..1.0))
}

/// Whether the effect is of the catalogue, and no part of the baseline model.
fn is_missing(mode: Mode, name: &str) -> bool {
    can_be_missing(mode, name) && family_of(name).is_some()
}

fn nulls() -> Vec<Job> {
    let job = |k: u64| Job {
        mode: MODES[(k % 2) as usize],
        seed: FIRST + k,
        colour: COLOURS[(k % 3) as usize],
        planted: Vec::new(),
    };
    (0..300).map(job).collect()
}

/// Every effect in every mode, in turn.
fn single() -> Vec<Job> {
    let kinds: Vec<(Mode, &'static str)> = MODES
        .into_iter()
        .flat_map(|mode| effects(mode).iter().map(move |&name| (mode, name)))
        .filter(|(mode, name)| is_missing(*mode, name))
        .collect();
    let job = |(k, &(mode, name)): (u64, &(Mode, &'static str))| {
        let seed = FIRST + 1000 + k;
        let strength = strength(&mut ChaCha8Rng::seed_from_u64(seed));
        let planted = vec![(name, strength)];
        Job {
            mode,
            seed,
            colour: 0.0,
            planted,
        }
    };
    (0..400).zip(kinds.iter().cycle()).map(job).collect()
}

/// Three effects of different families.
fn three() -> Vec<Job> {
    let job = |k: u64| {
        let (mode, seed) = (MODES[(k % 2) as usize], FIRST + 2000 + k);
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut names: Vec<&'static str> = effects(mode).to_vec();
        names.retain(|name| is_missing(mode, name));
        names.shuffle(&mut rng);
        let mut planted: Vec<(&'static str, f64)> = Vec::new();
        for name in names {
            let family = |n: &str| effect(n).0;
            if planted.len() < 3 && planted.iter().all(|(p, _)| family(p) != family(name)) {
                planted.push((name, strength(&mut rng)));
            }
        }
        Job {
            mode,
            seed,
            colour: 0.0,
            planted,
        }
    };
    (0..200).map(job).collect()
}

/// Dependences that match no effect of the catalogue.
fn outside() -> Vec<Job> {
    let job = |(k, &name): (u64, &&'static str)| {
        let seed = FIRST + 3000 + k;
        let strength = strength(&mut ChaCha8Rng::seed_from_u64(seed));
        Job {
            mode: MODES[(k % 2) as usize],
            seed,
            colour: 0.0,
            planted: vec![(name, strength)],
        }
    };
    let names = outsiders();
    (0..102).zip(names.iter().cycle()).map(job).collect()
}

fn share([right, all]: [usize; 2]) -> String {
    format!("{right} of {all}")
}

fn main() {
    let cells: [Cell; 4] = [
        ("nulls", nulls),
        ("single", single),
        ("three", three),
        ("outside", outside),
    ];
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    println!(
        "{:8} {:>7} {:>7} {:>7} {:>7} {:>12} {:>12} {:>6} {:>6}",
        "", "records", "found", "false", "curve", "names", "mechanisms", "error", "fits"
    );
    for (name, jobs) in cells {
        if !wanted.is_empty() && !wanted.iter().any(|w| w == name) {
            continue;
        }
        let before = bowden_lab::problem::cost::Counts::so_far().evaluations;
        let all: Vec<Outcome> = jobs().par_iter().map(run).collect();
        let fits = bowden_lab::problem::cost::Counts::so_far().evaluations - before;
        let sum = |of: fn(&Outcome) -> usize| all.iter().map(of).sum::<usize>();
        let pair = |of: fn(&Outcome) -> [usize; 2]| {
            all.iter()
                .map(of)
                .fold([0; 2], |[a, b], [c, d]| [a + c, b + d])
        };
        let mut errors: Vec<f64> = all.iter().map(|o| o.error).collect();
        errors.sort_by(f64::total_cmp);
        let count = all.len() as f64;
        let found = match sum(|o| o.planted) {
            0 => "-".to_owned(),
            planted => format!("{:.3}", sum(|o| o.found) as f64 / planted as f64),
        };
        println!(
            "{name:8} {:7} {found:>7} {:7.3} {:7} {:>12} {:>12} {:6.3} {:6.0}",
            all.len(),
            sum(|o| o.wrong) as f64 / count,
            sum(|o| usize::from(o.curve)),
            share(pair(|o| o.names)),
            share(pair(|o| o.mechanisms)),
            errors[all.len() / 2],
            fits as f64 / count,
        );
        for outcome in &all {
            eprintln!("{name} {}", outcome.line);
        }
    }
}
