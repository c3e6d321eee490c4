//! Records, and fits of a model that is told.

use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::export::hand_over::HandOver;
use bowden_lab::fit::fit;
use bowden_lab::ledger::Ledger;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::{parse, Options, Record};
use bowden_synth::{generate, Planted, Recipe};
use std::path::Path;

/// A record, as a user's program reads it.
pub fn record(recipe: &Recipe) -> Record {
    let csv = generate(recipe).unwrap().to_csv();
    parse(csv.as_bytes(), "made.csv", &Options::default()).unwrap()
}

pub fn with(recipe: Recipe, effects: &[&str]) -> Recipe {
    Recipe {
        effects: effects.iter().map(|e| Planted::new(e)).collect(),
        ..recipe
    }
}

/// A model that is told, fitted to a record: the loop has nothing to look for.
pub struct Told {
    pub records: Vec<Record>,
    pub data: Prepared,
    pub ledger: Ledger,
    pub done: FinalFit,
}

impl Told {
    pub fn new(record: Record, list: &[&str], cutoff: Option<f64>) -> Self {
        let data = Prepared::new(&record, Preparation { cutoff }).unwrap();
        let list: Vec<String> = list.iter().map(|s| (*s).to_owned()).collect();
        let declared = fit(&data, &structure(&list, &data).unwrap(), None, 0.0).unwrap();
        let ledger = Ledger::of(declared);
        Self {
            records: vec![record],
            done: FinalFit::new(&data, &ledger),
            data,
            ledger,
        }
    }

    pub fn hand_over(&self, invertible: bool) -> HandOver {
        let (data, ledger) = (&self.data, &self.ledger);
        HandOver::new(&self.records, data, ledger, &self.done, invertible, |_| ()).unwrap()
    }
}

/// Names of the files in a folder, sorted.
pub fn files(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let name = |e: std::fs::DirEntry| e.file_name().to_string_lossy().into_owned();
    let mut names: Vec<String> = entries.map(|e| name(e.unwrap())).collect();
    names.sort();
    names
}
