//! The model after each round, for a program that stops where it likes.

use crate::conclude::final_fit::FinalFit;
use crate::export::hand_over::handed_over;
use crate::export::ModelFile;
use crate::fit::Segments;
use crate::ledger::{Ledger, Round};
use crate::problem::Prepared;
use serde::Serialize;

/// The model that would be handed over if the rounds ended here: as the final one it is fitted
/// once more on the fit and stop-check segments together.
#[derive(Debug, Clone, Serialize)]
pub(super) struct RoundModel {
    /// The content of a model file.
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<ModelFile>,
    /// The same for each file, where each has gains of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    models: Option<Vec<ModelFile>>,
    /// Whether the parameters have seen the stop-check segment.
    refitted: bool,
    /// Why the model still has what belongs to the record, if it has.
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

/// One for each round.
pub(super) fn models(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Vec<RoundModel> {
    use rayon::prelude::*;
    let last = ledger.rounds.len();
    let of = |(index, round): (usize, &Round)| match &ledger.unknown {
        // The final model is that of the last round.
        None if index + 1 == last => RoundModel::new(data, done),
        _ => RoundModel::new(data, &FinalFit::of(data, &round.solution)),
    };
    ledger.rounds.par_iter().enumerate().map(of).collect()
}
