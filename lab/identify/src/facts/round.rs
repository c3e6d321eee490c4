//! One round of the search: the added effect, its tests, the model after it.

use super::record::channel_name;
use crate::conclude::by_file::{removed, FileShare};
use crate::conclude::final_fit::FinalFit;
use crate::conclude::intervals::{parameters, term_name, term_title, Parameter};
use crate::conclude::verdict::raises;
use crate::export::hand_over::handed_over;
use crate::export::ModelFile;
use crate::fit::{Segments, Solution};
use crate::foresight::plan::{separate, Experiment};
use crate::ledger::{Grade, Ledger, Round};
use crate::problem::Prepared;
use serde::Serialize;

/// One accepted effect.
#[derive(Debug, Clone)]
pub struct RoundFacts {
    /// Its printed name, as in the final model.
    pub title: String,
    /// Its family.
    pub family: &'static str,
    /// Its own name.
    pub effect: &'static str,
    /// The channel that it reads.
    pub channel: String,
    /// Confidence in the name.
    pub grade: Grade,
    /// Its size in the [reported](super::Facts::shown) model.
    pub size: Size,
    /// Exact sign-flip p-value; `None` if the blocks were too short for a test.
    pub p: Option<f64>,
    /// Share of the squared error on the fit segment that the round removed.
    pub explained: f64,
    /// The same share for each of several files; empty for a single record.
    pub by_file: Vec<FileShare>,
    /// Number of blocks, of [`BLOCKS`](super::BLOCKS), on which it lowers the error.
    pub blocks_better: usize,
    /// Effects that explain the record equally well.
    pub rivals: Vec<RivalFacts>,
    /// The motion that would separate these effects, if one is known.
    pub experiment: Option<Experiment>,
    /// Rms errors before the round.
    pub before: Segments,
    /// Rms errors after the round.
    pub after: Segments,
    /// Whether the round raises the held-out error.
    pub raises_held_out: bool,
    /// The model after the round, if [`Detail::EachRound`](super::Detail) was requested.
    pub fit: Option<RoundFit>,
}

/// An effect that this record cannot separate from the term.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RivalFacts {
    /// Its printed name.
    pub title: String,
    /// Its family.
    pub family: &'static str,
    /// The channel that it reads.
    pub channel: String,
}

/// The number that is reported for an effect.
#[derive(Debug, Clone, PartialEq)]
pub enum Size {
    /// Its gain.
    Gain(Parameter),
    /// The width of an input stage, which has no gain.
    Width(Parameter),
    /// The reported model does not contain the effect.
    Gone,
}

/// The model after a round.
#[derive(Debug, Clone)]
pub struct RoundFit {
    /// The parameters of the effect that the round added, as the round fitted them.
    pub coefficients: Vec<Parameter>,
    /// The model that would be exported if the search ended here.
    pub model: RoundModel,
}

/// The model that would be exported if the search ended here. Like the final model, this model is
/// refitted to the fit and selection segments together.
#[derive(Debug, Clone, Serialize)]
pub struct RoundModel {
    /// The content of a model file.
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<ModelFile>,
    /// The content of a model file for each record, if the records have separate gains.
    #[serde(skip_serializing_if = "Option::is_none")]
    models: Option<Vec<ModelFile>>,
    /// Whether the parameters were fitted to the selection segment.
    refitted: bool,
    /// The reason why the model is not refitted without the effects that belong to the record and
    /// not to the rig.
    #[serde(skip_serializing_if = "Option::is_none")]
    not_refitted_without: Option<String>,
    /// Its errors, as shares of the output's standard deviation.
    nrmse: Segments,
}

impl RoundModel {
    fn new(data: &Prepared, done: &FinalFit) -> Self {
        let (handed, not_refitted_without) = match handed_over(done, false) {
            Ok(handed) => (handed, None),
            Err(because) => (done.solution.clone(), Some(because)),
        };
        let own = handed.structure.own_gains;
        let of = |record| ModelFile::of_record(&done.data, &handed, record);
        Self {
            model: (own == 0).then(|| of(0)),
            models: (own > 0).then(|| (0..own).map(of).collect()),
            refitted: done.refitted,
            not_refitted_without,
            nrmse: Segments::of(data, &handed.residual).normalised(data, &data.target),
        }
    }
}

/// The fitted model after each round. Rounds whose terms are not in the final model are last.
pub(super) fn rounds_in_order(ledger: &Ledger) -> impl Iterator<Item = &Solution> {
    let rounds = ledger.rounds.iter().chain(&ledger.beyond);
    rounds.map(|round| &round.solution)
}

/// The models of all rounds. Rounds whose terms are not in the final model are last.
pub(super) fn fits(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Vec<RoundFit> {
    use rayon::prelude::*;
    let last = ledger.rounds.len();
    let of = |(index, round): (usize, &Round)| {
        let term = round.solution.structure.terms.len() - 1;
        let own = parameters(data, &round.solution).into_iter();
        RoundFit {
            coefficients: own.filter(|p| p.term == Some(term)).collect(),
            model: match &ledger.unknown {
                // The final model is that of the last round.
                None if index + 1 == last => RoundModel::new(data, done),
                _ => RoundModel::new(data, &FinalFit::of(data, &round.solution)),
            },
        }
    };
    let rounds = ledger.rounds.par_iter().chain(&ledger.beyond);
    rounds.enumerate().map(of).collect()
}

impl RoundFacts {
    pub(super) fn new(
        data: &Prepared,
        done: &FinalFit,
        size: Size,
        (before, round): (&Solution, &Round),
        fit: Option<RoundFit>,
    ) -> Self {
        let rivals = round.rivals.iter().map(|r| RivalFacts {
            title: term_title(data, &r.term),
            family: r.family,
            channel: channel_name(data, r.term.source),
        });
        Self {
            title: done.title_of(round),
            family: round.candidate.family,
            effect: round.candidate.term.effect.name(),
            channel: channel_name(data, round.candidate.term.source),
            grade: round.grade,
            size,
            p: round.p,
            explained: round.explained,
            by_file: removed(data, before, &round.solution),
            blocks_better: round.blocks_better,
            rivals: rivals.collect(),
            experiment: separate(data, round),
            before: round.before,
            after: round.after,
            raises_held_out: raises(round),
            fit,
        }
    }
}

/// The size of the added term in a model with these parameters.
pub(super) fn size(data: &Prepared, shown: &FinalFit, all: &[Parameter], round: &Round) -> Size {
    let name = term_name(data, round.term());
    let term = shown.term_of(round);
    let own = |wanted: &str| {
        let mut own = all.iter().filter(|p| p.term.is_some() && p.term == term);
        own.find(|p| p.name == wanted).cloned()
    };
    match (own(&name), own(&format!("{name}.r"))) {
        (Some(gain), _) => Size::Gain(gain),
        (None, Some(width)) => Size::Width(width),
        (None, None) => Size::Gone,
    }
}
