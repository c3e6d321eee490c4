//! Records of one rig, closed and checked.

use bowden_lab::check::{About, Check, Errors, Given};
use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::export::ModelFile;
use bowden_lab::ledger::Ledger;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::{parse, Options, Record};
use bowden_lab::search::close_within;
use bowden_synth::{generate, Recipe};

pub fn record(recipe: &Recipe) -> Record {
    let csv = generate(recipe).unwrap().to_csv();
    parse(csv.as_bytes(), "made.csv", &Options::default()).unwrap()
}

/// A record that was closed with at most so many rounds.
pub struct Closed {
    pub data: Prepared,
    pub ledger: Ledger,
    pub done: FinalFit,
}

impl Closed {
    pub fn new(recipe: &Recipe, declare: &[&str], most: usize) -> Self {
        let data = Prepared::new(&record(recipe), Preparation::default()).unwrap();
        let declare: Vec<String> = declare.iter().map(|s| (*s).to_owned()).collect();
        let ledger =
            close_within(&data, &structure(&declare, &data).unwrap(), most, |_| ()).unwrap();
        let done = FinalFit::new(&data, &ledger);
        Self { data, ledger, done }
    }

    /// The model as its file gives it back, with what it has to say of its record.
    pub fn given(&self) -> Given {
        let errors = self.done.rmse.normalised(&self.data, &self.data.target);
        Given {
            file: ModelFile::new(&self.done.data, &self.done.solution),
            left_out: Vec::new(),
            about: About {
                cutoff_hz: Some(self.data.cutoff),
                nrmse: Some(Errors {
                    fit: Some(errors.fit),
                    selection: Some(errors.selection),
                    held_out: Some(errors.held_out),
                }),
                ..About::default()
            },
        }
    }
}

/// A model on another record.
pub fn check(given: &Given, recipe: &Recipe) -> Check {
    Check::new(record(recipe), given, None).unwrap()
}

/// The error on the record, over its output's standard deviation.
pub fn nrmse(check: &Check) -> f64 {
    check.rmse / check.deviation
}
