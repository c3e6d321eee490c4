//! Records to identify, and what is known of them.

use bowden_lab::conclude::intervals::{parameters, Parameter};
use bowden_lab::fit::{Segments, Solution};
use bowden_lab::ledger::Ledger;
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

/// A record with that effect, of that strength in units of the noise.
pub fn with_effect(mode: Mode, effect: &str, strength: f64, seed: u64) -> Recipe {
    Recipe {
        seed,
        effects: vec![Planted {
            strength,
            ..Planted::new(effect)
        }],
        ..Recipe::new(mode)
    }
}
