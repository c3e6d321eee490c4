//! Records to identify, and what is known of them.

use bowden_lab::conclude::intervals::{parameters, term_name, Parameter};
use bowden_lab::fit::{Segments, Solution};
use bowden_lab::ledger::{Ledger, Round};
use bowden_lab::model::declared::structure;
use bowden_lab::model::structure::Structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::{parse, Options, Record};
use bowden_lab::search::close;
use bowden_synth::{generate, Mode, Planted, Recipe, Synthetic};

pub const MODES: [Mode; 2] = [Mode::Torque, Mode::Displacement];

/// A record with its truth, prepared for the fit.
pub struct Made {
    pub synthetic: Synthetic,
    pub record: Record,
    pub data: Prepared,
}

impl Made {
    /// Generates, writes as CSV, reads and prepares: the way of a user's record.
    pub fn new(recipe: &Recipe) -> Self {
        let mut planted = recipe.effects.iter();
        let stretched = planted.any(|p| p.effect.starts_with("stretch"));
        Self::read(recipe, stretched)
    }

    /// The same with the stretch as a channel, whatever is planted.
    pub fn with_stretch(recipe: &Recipe) -> Self {
        Self::read(recipe, true)
    }

    fn read(recipe: &Recipe, stretched: bool) -> Self {
        let synthetic = generate(recipe).unwrap();
        let mut options = Options::default();
        if stretched {
            let difference = ("stretch".to_owned(), "phi_p-phi_d".to_owned());
            options.channels.push(difference);
        }
        if synthetic.column("aux").is_some() {
            options.channels.push(("aux".to_owned(), "aux".to_owned()));
        }
        let record = parse(synthetic.to_csv().as_bytes(), "made.csv", &options).unwrap();
        let data = Prepared::new(&record, Preparation::default()).unwrap();
        Self {
            synthetic,
            record,
            data,
        }
    }

    /// The same record with another output.
    pub fn with_output(&self, output: Vec<f64>) -> Prepared {
        let mut record = self.record.clone();
        record.output.values = output;
        let cutoff = Some(self.data.cutoff);
        Prepared::new(&record, Preparation { cutoff }).unwrap()
    }

    /// Rms on the held-out segment of what the sensor's noise and counts leave behind
    /// the filter: no model can be better, but by luck.
    pub fn noise_floor(&self) -> f64 {
        let clean = self.with_output(self.synthetic.truth.output.clone());
        let noise: Vec<f64> = self
            .data
            .target
            .iter()
            .zip(&clean.target)
            .map(|(measured, clean)| measured - clean)
            .collect();
        Segments::of(&self.data, &noise).held_out
    }

    pub fn declare(&self, list: &[&str]) -> Structure {
        let list: Vec<String> = list.iter().map(|s| (*s).to_owned()).collect();
        structure(&list, &self.data).unwrap()
    }

    /// What the search adds to a Bouc-Wen transmission.
    pub fn closed(&self) -> Ledger {
        close(&self.data, &self.declare(&["bouc-wen"]), |_| ()).unwrap()
    }

    pub fn parameters(&self, solution: &Solution) -> Vec<Parameter> {
        parameters(&self.data, solution)
    }
}

/// A record with these effects, each of that strength in units of the noise.
pub fn with_effects(mode: Mode, effects: &[(&str, f64)], seed: u64) -> Recipe {
    let planted = effects.iter().map(|&(effect, strength)| Planted {
        strength,
        ..Planted::new(effect)
    });
    Recipe {
        seed,
        effects: planted.collect(),
        ..Recipe::new(mode)
    }
}

pub fn with_effect(mode: Mode, effect: &str, strength: f64, seed: u64) -> Recipe {
    with_effects(mode, &[(effect, strength)], seed)
}

/// A record with nothing but the transmission.
pub fn bare(mode: Mode, seed: u64) -> Recipe {
    with_effects(mode, &[], seed)
}

/// A record that is not the generator's, prepared, with Bouc-Wen declared.
pub fn prepared(text: &str, preparation: Preparation) -> (Prepared, Structure) {
    let record = parse(text.as_bytes(), "made.csv", &Options::default()).unwrap();
    let data = Prepared::new(&record, preparation).unwrap();
    let declared = structure(&["bouc-wen".to_owned()], &data).unwrap();
    (data, declared)
}

/// The effects of the delivered rounds.
pub fn names(ledger: &Ledger) -> Vec<&'static str> {
    let rounds = ledger.rounds.iter();
    rounds.map(|r| r.candidate.term.effect.name()).collect()
}

/// The same with the channels that they read.
pub fn term_names(data: &Prepared, ledger: &Ledger) -> Vec<String> {
    let rounds = ledger.rounds.iter();
    rounds.map(|r| term_name(data, &r.candidate.term)).collect()
}

/// The families that each round may be.
pub fn families(ledger: &Ledger) -> Vec<Vec<&'static str>> {
    let families = |round: &Round| round.possible().map(|one| one.family).collect();
    ledger.rounds.iter().map(families).collect()
}

/// The parameter of that name.
pub fn named<'a>(all: &'a [Parameter], name: &str) -> &'a Parameter {
    all.iter().find(|p| p.name == name).unwrap()
}
