//! The motion to record next.

use super::asked::Asked;
use crate::conclude::final_fit::FinalFit;
use crate::conclude::intervals::term_name;
use crate::foresight::plan::{separate_first, strengthen, trajectory, Experiment};
use crate::ledger::Round;
use crate::problem::Prepared;
use crate::record::Record;

/// What can be done about what a record leaves open.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The experiment; `None` if none of the known motions would help.
    pub planned: Option<Planned>,
    /// Effects that the record confounds, each with its rivals ("presliding from backlash"), where
    /// no known motion separates any of them.
    pub inseparable: Vec<String>,
}

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

/// Plans an experiment that answers what a record leaves open.
///
/// # Errors
/// One line where the record cannot be closed.
pub fn plan(record: &Record, asked: &Asked, tell: &dyn Fn(&str)) -> Result<Plan, String> {
    let (data, structure) = asked.prepare_moving(record)?;
    let ledger = asked
        .search(&data, &structure, tell)
        .map_err(|message| format!("{}: {message}", record.path))?;
    tell("planning");
    let separated = separate_first(&data, &ledger);
    let confounded = separated.is_some();
    let rounds = ledger.rounds.iter().filter(|_| !confounded);
    let inseparable = rounds.filter_map(|round| from_rivals(&data, round));
    let inseparable = inseparable.collect();
    let planned = separated.or_else(|| {
        let done = FinalFit::new(&data, &ledger);
        strengthen(&done.data, &done.solution)
    });
    let planned = planned.map(|experiment| Planned {
        csv: trajectory(&data, experiment.kind).csv(),
        experiment,
        confounded,
    });
    Ok(Plan {
        planned,
        inseparable,
    })
}

/// "presliding from backlash"; `None` without rivals.
fn from_rivals(data: &Prepared, round: &Round) -> Option<String> {
    let rivals = round.rivals.iter().map(|r| term_name(data, &r.term));
    let rivals: Vec<String> = rivals.collect();
    (!rivals.is_empty()).then(|| {
        format!(
            "{} from {}",
            term_name(data, round.term()),
            rivals.join(", ")
        )
    })
}
