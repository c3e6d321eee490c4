//! Records of one rig on different motions, the way of a user's files.

use bowden_lab::ledger::Ledger;
use bowden_lab::model::declared::structure;
use bowden_lab::model::structure::Structure;
use bowden_lab::problem::{HeldOut, Preparation, Prepared};
use bowden_lab::record::{parse, Options, Record};
use bowden_lab::search::close;
use bowden_synth::{generate, Base, Mode, Recipe};

/// A record of a transmission; the seed changes motion and noise alone.
pub fn on(base: Base, mode: Mode, seed: u64) -> Recipe {
    Recipe {
        base: Some(base),
        seed,
        ..Recipe::new(mode)
    }
}

/// Files that a user could have recorded.
pub struct Files {
    pub records: Vec<Record>,
}

impl Files {
    pub fn new(recipes: &[Recipe]) -> Self {
        let records = recipes.iter().enumerate().map(|(index, recipe)| {
            let csv = generate(recipe).unwrap().to_csv();
            parse(csv.as_bytes(), &format!("{index}.csv"), &Options::default()).unwrap()
        });
        Self {
            records: records.collect(),
        }
    }

    pub fn joined(&self, held_out: HeldOut) -> Prepared {
        Prepared::joined(&self.records, Preparation::default(), held_out).unwrap()
    }
}

/// The baseline model: the transmission alone.
pub fn declared(data: &Prepared) -> Structure {
    structure(&["bouc-wen".to_owned()], data).unwrap()
}

pub fn closed(data: &Prepared) -> Ledger {
    close(data, &declared(data), |_| ()).unwrap()
}

/// Effects that a run added, by name.
pub fn added(ledger: &Ledger) -> Vec<&'static str> {
    let rounds = ledger.rounds.iter();
    rounds.map(|r| r.candidate.term.effect.name()).collect()
}
