//! Identification: finds the effects that the baseline model lacks.

use super::asked::{label, Asked};
use super::cost::{CostFacts, Meter, Stage};
use super::figures::Figures;
use super::ledger::{Detail, Facts};
use crate::alteration::Suspicion;
use crate::conclude::files_apart::{judge_files, with_own_gains};
use crate::conclude::final_fit::FinalFit;
use crate::conclude::logged::Run;
use crate::conclude::mechanisms::FileAlone;
use crate::conclude::resolution::{coarse_channels, told};
use crate::conclude::trace::trace;
use crate::export::hand_over::HandOver;
use crate::export::{postcard, vector, ModelFile};
use crate::fit::Solution;
use crate::ledger::Ledger;
use crate::model::structure::Structure;
use crate::problem::Prepared;
use crate::record::Record;
use crate::scale::HALF;
use std::cell::Cell;

/// A request for one or several records.
#[derive(Debug, Clone)]
pub struct Close {
    /// Columns, filter, baseline model and length of the search.
    pub asked: Asked,
    /// Whether each file has separate gains.
    pub own_gains: bool,
    /// Whether the exported model is fitted within the range that has an inverse.
    pub invertible: bool,
    /// Whether the models are requested as files.
    pub models: bool,
    /// Whether the signals over time are requested.
    pub trace: bool,
    /// Whether the data of a page are requested: [`Figures`], and the models if there are any.
    pub figures: bool,
    /// Detail of each round.
    pub detail: Detail,
    /// The meter, started before the records were read.
    pub meter: Meter,
}

/// The result of an identification.
#[derive(Debug, Clone)]
pub struct Closed {
    /// The findings.
    pub facts: Facts,
    /// The exported models: one model, or one model for each file with separate gains. The list is
    /// empty if neither models nor figures were requested, or if no model can be exported.
    pub models: Vec<Handed>,
    /// The signals over time as CSV, if requested.
    pub trace: Option<String>,
    /// The data of a page, if requested.
    pub figures: Option<Figures>,
    /// Cost of the run.
    pub cost: CostFacts,
}

/// An exported model, with its test vector.
#[derive(Debug, Clone)]
pub struct Handed {
    model: ModelFile,
    vector: Result<String, String>,
}

/// The form of a model file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// For tools.
    Toml,
    /// For firmware, as source.
    Rust,
    /// For firmware, as bytes with a checksum.
    Postcard,
}

impl Handed {
    /// The bytes of the model's file.
    ///
    /// # Errors
    /// A message with the part that cannot be written.
    pub fn file(&self, form: Form) -> Result<Vec<u8>, String> {
        match form {
            Form::Toml => {
                let text = self.model.toml().map_err(|e| e.to_string())?;
                Ok(text.into_bytes())
            }
            Form::Rust => self.model.rust().map(String::into_bytes),
            Form::Postcard => postcard(&self.model),
        }
    }

    /// Samples and the expected outputs of the model, as CSV.
    ///
    /// # Errors
    /// A message with the part of the model that the core rejects.
    pub fn vector(&self) -> Result<&str, String> {
        self.vector.as_deref().map_err(Clone::clone)
    }
}

impl Close {
    /// A request for the facts without models, trace or figures. The meter starts now.
    #[must_use]
    pub fn new(asked: Asked) -> Self {
        Self {
            asked,
            own_gains: false,
            invertible: false,
            models: false,
            trace: false,
            figures: false,
            detail: Detail::Ledger,
            meter: Meter::start(),
        }
    }

    /// The final model; remarks on its signals go to the notes and the results table.
    fn concluded(&self, records: &[Record], data: &mut Prepared, ledger: &mut Ledger) -> FinalFit {
        if ledger.integrates {
            // What lags by a quarter of a period is no friction, with either sign.
            data.unsay_against();
        }
        let done = FinalFit::new(data, ledger);
        let on_grids = |finer: &[Record]| self.on_grids(finer, data.cutoff);
        let coarse = coarse_channels(records, &done, on_grids);
        told(data, ledger, coarse);
        done
    }

    /// A suspected error in the logging of the records.
    fn suspicion(
        &self,
        records: &[Record],
        (data, ledger, done): (&Prepared, &Ledger, &FinalFit),
        structure: &Structure,
    ) -> Option<Suspicion> {
        let run = Run {
            records,
            data,
            ledger,
            done,
            prepare: &|records| self.on_grids(records, data.cutoff),
            search: &|data| self.asked.search(data, structure, &|_| {}).ok(),
        };
        run.suspicion()
    }

    /// The result for each of several records by itself, with the common filter. The list is empty
    /// if the search added nothing or ended early.
    fn files_alone(&self, records: &[Record], cutoff: f64, ledger: &Ledger) -> Vec<FileAlone> {
        use rayon::prelude::*;
        let is_cut = self.asked.budget.is_some() || ledger.is_stopped();
        if records.len() < 2 || ledger.supported.is_none() || is_cut {
            return Vec::new();
        }
        let of = |record: &Record| {
            let asked = self.asked.at(cutoff);
            FileAlone::new(&record.path, asked.prepare(record).ok())
        };
        records.par_iter().map(of).collect()
    }

    /// Records on the grids for this cut-off.
    fn on_grids(&self, records: &[Record], cutoff: f64) -> Option<Prepared> {
        let asked = self.asked.at(cutoff);
        let (data, _) = asked.prepare_all(records, self.own_gains).ok()?;
        Some(data)
    }
}

/// Identifies a model. `tell` receives one message per step.
///
/// # Errors
/// A message if the records cannot be prepared or the baseline model cannot be fitted, or if a
/// model is requested and no model can be exported.
pub fn close(records: &[Record], question: &Close, tell: &dyn Fn(&str)) -> Result<Closed, String> {
    let asked = &question.asked;
    let mut meter = question.meter;
    meter.begins(Stage::Preparing);
    let label = label(records);
    let (mut data, mut structure) = asked.prepare_all(records, question.own_gains)?;
    if question.own_gains {
        if !structure.hysteresis {
            return Err("--per-file gains needs bouc-wen, which --baseline omits".to_owned());
        }
        structure.own_gains = records.len();
    }
    let heard = Cell::new(meter);
    let hear = |what: &str| {
        tell(what);
        let mut meter = heard.get();
        meter.told();
        heard.set(meter);
    };
    let mut ledger = asked
        .search(&data, &structure, &hear)
        .map_err(|message| format!("{label}: {message}"))?;
    let mut meter = heard.get();
    let mut own = None;
    if !question.own_gains && records.len() > 1 {
        tell("fitting each file with its own gains");
        own = with_own_gains(&data, &ledger.declared);
        let hint = own.as_ref().and_then(|own| hint(&ledger.declared, own));
        data.notes.extend(hint);
    }
    meter.begins(Stage::Concluding);
    tell("fitting the final model");
    let done = question.concluded(records, &mut data, &mut ledger);
    judge_files(&data, own.as_ref(), &done, &mut ledger);
    let has_time = asked.budget.is_none();
    if ledger.apart.is_empty() && has_time {
        tell("testing whether columns are swapped or reversed");
        ledger.suspicion = question.suspicion(records, (&data, &ledger, &done), &structure);
    }
    let hand = HandOver::new(records, &data, &ledger, &done, question.invertible, tell);
    // The result stands even if nothing can be handed over to firmware.
    let hand = match hand {
        Err(message) if question.invertible || question.models => {
            return Err(format!("{label}: {message}"));
        }
        hand => hand,
    };
    tell("searching for redundant baseline parts");
    let told = hand.as_ref().map_err(String::as_str);
    let mut facts = Facts::new(&label, &data, &ledger, &done, told, question.detail);
    facts.files_alone = question.files_alone(records, data.cutoff, &ledger);
    // Before anything is drawn: the cost of an answer is not that of its figures.
    let cost = meter.read();
    let models = match &hand {
        Ok(hand) if question.models || question.figures => handed(&data, hand),
        _ => Vec::new(),
    };
    let trace = match question.trace {
        true => Some(trace(&data, &ledger, &done)?),
        false => None,
    };
    let figures = match question.figures {
        true => {
            let another = hand.as_ref().ok().filter(|hand| hand.is_another());
            let shown = another.map_or(("final", &done), |hand| ("exported", &hand.fitted));
            Some(Figures::of_close(&data, &ledger, shown)?)
        }
        false => None,
    };
    Ok(Closed {
        facts,
        models,
        trace,
        figures,
        cost,
    })
}

fn handed(data: &Prepared, hand: &HandOver) -> Vec<Handed> {
    let files = hand.files.iter().enumerate();
    files
        .map(|(record, model)| Handed {
            vector: vector::csv(data, record, model),
            model: model.clone(),
        })
        .collect()
}

/// A hint if the files do not seem to have the same configuration. `own` is the baseline model with
/// separate gains for each file.
fn hint(declared: &Solution, own: &Solution) -> Option<String> {
    let left = own.rmse.fit / declared.rmse.fit;
    (left < HALF).then(|| {
        format!(
            "with separate gains for each file, the error of the baseline model on the fit segments is {:.0} % of the error with common gains; try --per-file gains",
            100.0 * left
        )
    })
}
