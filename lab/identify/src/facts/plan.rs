//! The motion to record next.

use super::asked::Asked;
use crate::conclude::final_fit::FinalFit;
use crate::conclude::intervals::term_name;
use crate::conclude::verdict::{sentence, verdict, Verdict};
use crate::foresight::plan::{separate_first, strengthen, trajectory, Experiment};
use crate::ledger::Round;
use crate::problem::Prepared;
use crate::record::Record;

/// What can be done about what a record leaves open.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The experiment; `None` if none of the known motions would help.
    pub planned: Option<Planned>,
    /// The verdict on the record and its sentence, where the model does not describe it: no motion that
    /// determines its parameters mends that.
    pub undescribed: Option<String>,
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
/// One line where the record cannot be closed, or has no model.
pub fn plan(record: &Record, asked: &Asked, tell: &dyn Fn(&str)) -> Result<Plan, String> {
    let (data, structure) = asked.prepare_moving(record)?;
    let ledger = asked
        .search(&data, &structure, tell)
        .map_err(|message| format!("{}: {message}", record.path))?;
    tell("planning");
    let done = FinalFit::new(&data, &ledger);
    let found = verdict(&data, &ledger, &done);
    let said = || sentence(&data, &ledger, &done);
    if found == Verdict::NoModel {
        return Err(format!(
            "{}: no motion can be planned without a model. {}",
            record.path,
            said()
        ));
    }
    let is_described = !matches!(
        found,
        Verdict::DoesNotCarryOver | Verdict::Unknown | Verdict::DataDefect
    );
    let undescribed = (!is_described).then(|| format!("{}: {}", found.name(), said()));
    let separated = separate_first(&data, &ledger);
    let confounded = separated.is_some();
    let rounds = ledger.rounds.iter().filter(|_| !confounded);
    let inseparable = rounds.filter_map(|round| from_rivals(&data, round));
    let inseparable = inseparable.collect();
    let planned = separated.or_else(|| strengthen(&done.data, &done.solution));
    let planned = planned.map(|experiment| Planned {
        csv: trajectory(&data, experiment.kind).csv(),
        experiment,
        confounded,
    });
    Ok(Plan {
        planned,
        undescribed,
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
