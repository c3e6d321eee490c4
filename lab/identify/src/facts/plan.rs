//! The motion to record next.

use super::asked::Asked;
use crate::conclude::final_fit::FinalFit;
use crate::foresight::plan::{separate_first, strengthen, trajectory, Experiment};
use crate::record::Record;

/// A planned experiment.
#[derive(Debug, Clone)]
pub struct Planned {
    /// How it moves, and what it is expected to show.
    pub experiment: Experiment,
    /// Whether it separates effects that this record confounds; otherwise it is for
    /// parameters that the record does not identify.
    pub confounded: bool,
    /// Its motion as CSV.
    pub csv: String,
}

/// Plans an experiment that answers what a record leaves open; `None` if nothing is open or if
/// none of the known motions would help.
///
/// # Errors
/// One line where the record cannot be closed.
pub fn plan(
    record: &Record,
    asked: &Asked,
    tell: &dyn Fn(&str),
) -> Result<Option<Planned>, String> {
    let (data, structure) = asked.prepare(record)?;
    let ledger = asked
        .search(&data, &structure, tell)
        .map_err(|message| format!("{}: {message}", record.path))?;
    tell("planning");
    let separated = separate_first(&data, &ledger);
    let confounded = separated.is_some();
    let planned = separated.or_else(|| {
        let done = FinalFit::new(&data, &ledger);
        strengthen(&done.data, &done.solution)
    });
    Ok(planned.map(|experiment| Planned {
        csv: trajectory(&data, experiment.kind).csv(),
        experiment,
        confounded,
    }))
}
