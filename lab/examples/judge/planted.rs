//! One planted record through both methods.

use bowden::effect::{Family, CATALOGUE};
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::closing;
use bowden_lab::ledger::Ledger;
use bowden_lab::model::declared::structure;
use bowden_lab::model::structure::Structure;
use bowden_lab::fit::evaluations;
use bowden_lab::fit::Segments;
use bowden_lab::record::{parse, Options};
use bowden_lab::search;
use bowden_synth::{effects, generate, Mode, Planted, Recipe};
use rand::seq::SliceRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

pub const MODES: [Mode; 2] = [Mode::Torque, Mode::Displacement];

pub type Planting = Vec<(&'static str, f64)>;

/// What one method made of one record.
pub struct Judged {
    pub found: f64,
    pub wrong: f64,
    pub names: usize,
    pub unknown: Option<(&'static str, String)>,
    /// Held-out error of the last model over what the noise leaves.
    pub error: f64,
    /// Processor time of all threads \[s\].
    pub seconds: f64,
    pub evaluations: f64,
    pub line: String,
}

/// What is no part of the declared model under another name.
pub fn can_be_missing(mode: Mode, effect: &str) -> bool {
    let absorbed = match mode {
        Mode::Torque => ["offset", "gain", ""],
        // A gain on the load channel is that channel's crosstalk.
        Mode::Displacement => ["offset", "gain", "stiffness-linear"],
    };
    !absorbed.contains(&effect)
}

/// The families of what is planted and in the catalogue.
pub fn families(planting: &[(&str, f64)]) -> Vec<Family> {
    let of = |effect: &str| {
        CATALOGUE
            .iter()
            .find(|i| i.name == effect)
            .map(|i| i.family)
    };
    planting
        .iter()
        .filter_map(|(effect, _)| of(effect))
        .collect()
}

/// Three effects of three families, each at one to three times the noise.
pub fn three_of(mode: Mode, seed: u64) -> Planting {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let usable = effects(mode).iter().copied();
    let mut names: Vec<&'static str> = usable.filter(|n| can_be_missing(mode, n)).collect();
    names.shuffle(&mut rng);
    let mut planting: Planting = Vec::new();
    for name in names {
        let own = families(&[(name, 1.0)]);
        if planting.len() < 3 && planting.iter().all(|p| families(&[*p]) != own) {
            planting.push((name, 3.0_f64.powf(rng.random_range(0.0..1.0))));
        }
    }
    planting
}

/// A record of that kind with those effects at those strengths.
pub fn recipe(mode: Mode, planted: &Planting, colour: f64, seconds: f64, seed: u64) -> Recipe {
    let loaded = ["load", "capstan", "drive"];
    let reads_load = |(effect, _): &(&str, f64)| loaded.iter().any(|w| effect.contains(w));
    Recipe {
        seed,
        colour,
        seconds,
        effects: planted
            .iter()
            .map(|&(effect, strength)| Planted {
                strength,
                ..Planted::new(effect)
            })
            .collect(),
        load: mode == Mode::Displacement && planted.iter().any(reads_load),
        ..Recipe::new(mode)
    }
}

/// Whether a variable is what the outsider is a function of; both channels are its usual ones.
pub fn is_right(outsider: &str, variable: &str, channel: &str) -> bool {
    match outsider {
        "bump-position" => variable == "position" && ["phi_p", "x"].contains(&channel),
        "bump-load" => variable == "load",
        _ => variable.starts_with("reversal-") && ["tau_i", "x"].contains(&channel),
    }
}

/// Seconds of processor time so far, all threads; 0 where the system does not tell.
pub fn processor_time() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // Behind the name, in brackets, are the state and then numbers: the eleventh and twelfth
    // are user and system time in hundredths of a second.
    let numbers = text
        .rsplit(')')
        .next()
        .unwrap_or("")
        .split_whitespace()
        .skip(1);
    let numbers: Vec<f64> = numbers.filter_map(|word| word.parse().ok()).collect();
    numbers
        .get(10)
        .zip(numbers.get(11))
        .map_or(0.0, |(u, s)| (u + s) / 100.0)
}

/// The ledger of a method, with what it cost.
pub fn cost<T>(of: impl FnOnce() -> T) -> (T, f64, f64) {
    let (before, begun) = (evaluations(), processor_time());
    let made = of();
    let count = (evaluations() - before) as f64;
    (made, processor_time() - begun, count)
}

/// Generates, writes as CSV, reads, and closes twice.
pub fn both(recipe: &Recipe, planting: &Planting) -> [Judged; 2] {
    let made = generate(recipe).unwrap();
    let mut options = Options::default();
    if made.column("aux").is_some() {
        options.channels.push(("aux".to_owned(), "aux".to_owned()));
    }
    let record = parse(made.to_csv().as_bytes(), "planted", &options).unwrap();
    let data = Prepared::new(&record, Preparation::default()).unwrap();
    let mut clean = record.clone();
    clean.output.values.clone_from(&made.truth.output);
    let cutoff = Some(data.cutoff);
    let clean = Prepared::new(&clean, Preparation { cutoff }).unwrap();
    let pairs = data.target.iter().zip(&clean.target);
    let noise: Vec<f64> = pairs.map(|(measured, clean)| measured - clean).collect();
    let floor = Segments::of(&data, &noise).held_out;
    let declared = structure(&["bouc-wen".to_owned()], &data).unwrap();
    let planted = families(planting);
    let judged = |name: &str, (ledger, seconds, count): (Result<Ledger, String>, f64, f64)| {
        judge(
            name,
            &data,
            &ledger.unwrap(),
            (&planted, planting, floor),
            seconds,
            count,
        )
    };
    [
        judged("loop", cost(|| usual(&data, &declared))),
        judged("one ", cost(|| search::close(&data, &declared, |_| ()))),
    ]
}

fn judge(
    method: &str,
    data: &Prepared,
    ledger: &Ledger,
    (planted, planting, floor): (&[Family], &Planting, f64),
    seconds: f64,
    evaluations: f64,
) -> Judged {
    let rounds: Vec<Vec<Family>> = ledger
        .rounds
        .iter()
        .map(|r| {
            let rivals = r.rivals.iter().map(|c| c.family);
            std::iter::once(r.candidate.family).chain(rivals).collect()
        })
        .collect();
    let has = |f: &&Family| rounds.iter().any(|round| round.contains(f));
    let found = planted.iter().filter(has).count();
    let wrong = rounds
        .iter()
        .filter(|round| planted.iter().all(|f| !round.contains(f)));
    let wrong = wrong.count();
    let unknown = ledger.unknown.as_ref().map(|u| {
        let channel = data.channel(u.variable.source());
        (
            u.variable.name(data),
            channel.map_or_else(String::new, |c| c.name.clone()),
        )
    });
    let error = ledger.last().rmse.held_out / floor;
    let names: Vec<String> = ledger
        .rounds
        .iter()
        .map(|r| {
            let rivals: Vec<_> = r.rivals.iter().map(|c| c.term.effect.name()).collect();
            let name = r.candidate.term.effect.name();
            format!(
                "{name}{rivals:?} p {:.1e} {:.2}",
                r.p.unwrap_or(f64::NAN),
                r.explained
            )
        })
        .collect();
    let gates: Vec<String> = ledger
        .rejected
        .iter()
        .map(|r| format!("{}:{:?}", r.candidate.term.effect.name(), r.gate))
        .collect();
    let mark = match (
        found == planted.len(),
        wrong + usize::from(unknown.is_some()),
    ) {
        (true, 0) => "ok   ",
        (false, 0) => "MISS ",
        _ => "FALSE",
    };
    Judged {
        found: found as f64,
        wrong: (wrong + usize::from(unknown.is_some())) as f64,
        names: rounds.len(),
        line: format!(
            "{method} {mark} {:?} {planting:?} error {:.2} -> {error:.2} {seconds:.2} s {evaluations} evals ({:?}) {} beyond {} unknown {unknown:?} | {}",
            data.mode,
            ledger.declared.rmse.held_out / floor,
            ledger.regime,
            names.join(", "),
            ledger.beyond.iter().map(|r| r.candidate.term.effect.name()).collect::<Vec<_>>().join(" "),
            gates.join(" ")
        ),
        unknown,
        error,
        seconds,
        evaluations,
    }
}

/// The loop, or a search for nothing where only the one search is wanted (`ONE` is set).
pub fn usual(data: &Prepared, declared: &Structure) -> Result<Ledger, String> {
    let most = if std::env::var_os("ONE").is_some() { 0 } else { 99 };
    closing::close_within(data, declared, most, |_| ())
}
