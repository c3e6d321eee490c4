//! From the fitted model to the motor: what is written is what runs, and says what it is.

mod c_file;
mod causal;
mod clockwork;
mod invertible;
mod postcard_file;
mod rust_file;
mod vector;

use crate::shell::{json, said, Folder};
use bowden_lab::conclude::final_fit::FinalFit;
use bowden_lab::export::hand_over::HandOver;
use bowden_lab::export::ModelFile;
use bowden_lab::fit::fit;
use bowden_lab::ledger::Ledger;
use bowden_lab::model::declared::structure;
use bowden_lab::problem::{Preparation, Prepared};
use bowden_lab::record::{parse, Options, Record};
use bowden_synth::{generate, Base, Mode, Planted, Recipe};
use serde_json::Value;
use std::sync::OnceLock;

fn recipe(mode: Mode, seed: u64, effects: &[(&str, f64)]) -> Recipe {
    let planted = |(effect, strength): &(&str, f64)| Planted {
        strength: *strength,
        ..Planted::new(effect)
    };
    Recipe {
        seed,
        effects: effects.iter().map(planted).collect(),
        ..Recipe::new(mode)
    }
}

/// A rig with a steep loop: 2·sigma·rho·kappa_eta is 3.4 times its gain.
const STEEP: Base = Base {
    gain: 0.95,
    kappa_eta: 4.0,
    offset: 0.05,
    rho: 0.3,
    sigma: 1.35,
    n: 1.6,
};

/// A model that is told, fitted to a record: the loop has nothing to look for.
struct Told {
    records: Vec<Record>,
    data: Prepared,
    ledger: Ledger,
    done: FinalFit,
}

impl Told {
    fn new(recipe: &Recipe, list: &[&str]) -> Self {
        Self::of(&generate(recipe).unwrap().to_csv(), list, None)
    }

    /// Of a record as a user's program reads it.
    fn of(csv: &str, list: &[&str], cutoff: Option<f64>) -> Self {
        let record = parse(csv.as_bytes(), "made.csv", &Options::default()).unwrap();
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

    fn hand_over(&self, invertible: bool) -> HandOver {
        let (data, ledger) = (&self.data, &self.ledger);
        HandOver::new(&self.records, data, ledger, &self.done, invertible, |_| ()).unwrap()
    }
}

/// All that the program says and writes of the built-in record.
struct Demo {
    file: ModelFile,
    vector: String,
    page: String,
    json: Value,
    ledger: String,
}

fn demo(invertible: bool) -> &'static Demo {
    static DEMO: [OnceLock<Demo>; 2] = [const { OnceLock::new() }; 2];
    DEMO[usize::from(invertible)].get_or_init(|| {
        let folder = Folder::new();
        let (model, page) = (folder.path("model.toml"), folder.path("page.html"));
        let asked = ["identify", "identify --invertible"][usize::from(invertible)];
        let files = format!("--model-out {model} --report {page}");
        let json = json(&format!("{asked} --json {files}"));
        let written = ["model.toml", "model.vector.csv", "page.html"];
        assert_eq!(folder.names(), written);
        Demo {
            file: toml::from_str(&folder.read("model.toml")).unwrap(),
            vector: folder.read("model.vector.csv"),
            page: folder.read("page.html"),
            json,
            ledger: said(asked),
        }
    })
}
