//! The verdict of a run, and its summary.
//!
//! The summary is written to be pasted into a report: it describes the delivered model with the
//! numbers printed above it, and states what the model must not be used for.

use super::changes::other_rig;
pub use super::errors::{falls_up_to, held_out_ratio, percent, raises, POOR};
use super::errors::{floors, is_noise, is_worse, worse_than_a_constant};
use super::excitation::without_reversals;
use super::final_fit::FinalFit;
use super::no_model::is_no_model;
use crate::fit::Solution;
use crate::ledger::Ledger;
use crate::problem::Prepared;
use crate::record::Defect;
use crate::score::blocks::Regime;

/// The verdict of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The input explains less than half of the output, the output integrates it, or one file has
    /// another gain than the others.
    NoInputDependence,
    /// The delivered model predicts held-out data worse than the baseline model, worse than a
    /// constant, or with many times the error of the fit segment.
    NotTransferable,
    /// The residual is sensor noise, on the fit segment and held out.
    Explained,
    /// The residual exceeds the noise, and no effect of the catalogue was found in it.
    StructuredResidual,
    /// The residual depends on a measured variable in a way that matches no effect.
    UnmodelledDependence,
    /// An added effect has alternatives that this record cannot distinguish from it.
    Ambiguous,
    /// The record has too few independent blocks for a test: names are proposals.
    UnderExcited,
    /// The conclusions rest on a defective measurement.
    DefectiveRecord,
    /// A limit of the user ended the search, and the residual exceeds the noise.
    Stopped,
}

impl Verdict {
    /// The name in the JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::NoInputDependence => "no-input-dependence",
            Self::NotTransferable => "not-transferable",
            Self::Explained => "explained",
            Self::StructuredResidual => "structured-residual",
            Self::UnmodelledDependence => "unmodelled-dependence",
            Self::Ambiguous => "ambiguous",
            Self::UnderExcited => "under-excited",
            Self::DefectiveRecord => "defective-record",
            Self::Stopped => "stopped",
        }
    }
}

/// Defects that invalidate the conclusions: severe defects of the time, the input, the output, and
/// the channels that the model reads.
pub(super) fn spoils<'a>(
    data: &'a Prepared,
    last: &'a Solution,
) -> impl Iterator<Item = &'a Defect> {
    let reads = |name: &str| {
        let mut sources = last
            .structure
            .terms
            .iter()
            .filter_map(|t| data.channel(t.source));
        sources.any(|channel| channel.name == name)
    };
    data.defects.iter().filter(move |defect| {
        let name = defect.channel.as_str();
        defect.grave && (data.channels.iter().all(|c| c.name != name) || reads(name))
    })
}

/// The verdict on a results table and the model that it delivers.
#[must_use]
pub fn verdict(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Verdict {
    let last = ledger.last();
    let untested = ledger.rounds.iter().any(|r| r.p.is_none());
    // Where nothing was looked for there are no names that a test could be too weak for.
    let only_fitted = ledger.is_stopped() && ledger.rounds.is_empty();
    if spoils(data, last).next().is_some() {
        Verdict::DefectiveRecord
    } else if is_no_model(data, ledger, done) {
        Verdict::NoInputDependence
    } else if is_worse(ledger, done)
        || worse_than_a_constant(data, done)
        || other_rig(data, done).is_some()
    {
        Verdict::NotTransferable
    } else if ledger.unknown.is_some() && !untested {
        Verdict::UnmodelledDependence
    } else if untested
        || (ledger.regime == Regime::Effect && !only_fitted)
        || is_one_stroke(data, done)
    {
        Verdict::UnderExcited
    } else if ledger.rounds.iter().any(|r| !r.rivals.is_empty()) {
        Verdict::Ambiguous
    } else if floors(data, done).is_some_and(|errors| is_noise(data, errors)) {
        Verdict::Explained
    } else if ledger.is_stopped() {
        Verdict::Stopped
    } else {
        Verdict::StructuredResidual
    }
}

/// Whether a hysteresis was fitted to a record without reversals.
pub(super) fn is_one_stroke(data: &Prepared, done: &FinalFit) -> bool {
    done.solution.structure.hysteresis && without_reversals(data).is_some()
}
