//! The motion to record next.

use super::asked::{label, Asked};
use crate::conclude::final_fit::FinalFit;
use crate::conclude::findings::sentence;
use crate::conclude::intervals::term_name;
use crate::conclude::rivals::each_pair_once;
use crate::conclude::verdict::{verdict, Verdict};
use crate::foresight::plan::{
    separate_first, strengthen, trajectory, unidentified, Aim, Experiment,
};
use crate::ledger::Round;
use crate::model::catalogue::Candidate;
use crate::model::structure::FitTerm;
use crate::problem::Prepared;
use crate::record::Record;

/// A planned experiment that resolves what the records leave open.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The experiment; `None` if no known motion would help.
    pub planned: Option<Planned>,
    /// The verdict and its summary if the model does not describe the record. In this case, a
    /// motion that determines the parameters of the model does not help.
    pub undescribed: Option<String>,
    /// Ambiguous effects, each with the alternatives that the planned motion does not separate from
    /// it ("presliding from backlash"), each pair once.
    pub inseparable: Vec<String>,
    /// Channels that such effects and their alternatives read, if there are two.
    pub together: Vec<[String; 2]>,
    /// Parameters that the record does not identify.
    pub unidentified: Vec<String>,
}

/// A planned experiment.
#[derive(Debug, Clone)]
pub struct Planned {
    /// Its motion, and its expected result.
    pub experiment: Experiment,
    /// Whether the experiment separates ambiguous effects. Otherwise it identifies parameters that
    /// the record does not identify.
    pub confounded: bool,
    /// Its motion as CSV.
    pub csv: String,
}

/// Plans an experiment that resolves what one or several records of one rig leave open.
///
/// # Errors
/// A message if no model can be identified from the records.
pub fn plan(records: &[Record], asked: &Asked, tell: &dyn Fn(&str)) -> Result<Plan, String> {
    let (data, structure) = asked.prepare_moving(records)?;
    let label = label(records);
    let ledger = asked
        .search(&data, &structure, tell)
        .map_err(|message| format!("{label}: {message}"))?;
    tell("planning");
    let done = FinalFit::new(&data, &ledger);
    let found = verdict(&data, &ledger, &done);
    let said = || sentence(&data, &ledger, &done);
    if found == Verdict::NoInputDependence {
        return Err(format!(
            "{label}: no motion can be planned without a model. {}",
            said()
        ));
    }
    let is_described = !matches!(
        found,
        Verdict::NotTransferable | Verdict::UnmodelledDependence | Verdict::DefectiveRecord
    );
    let undescribed = (!is_described).then(|| format!("{}: {}", found.name(), said()));
    let separated = separate_first(&data, &ledger);
    let confounded = separated.is_some();
    let aims = separated.as_ref().map_or(&[][..], |one| &one.aims);
    let open = ledger.rounds.iter().map(|r| still_open(&data, r, aims));
    let (open, together): (Vec<(String, Vec<String>)>, Vec<Vec<_>>) = open.unzip();
    let inseparable = each_pair_once(open);
    let mut together: Vec<[String; 2]> = together.concat();
    together.sort();
    together.dedup();
    let planned = separated.or_else(|| strengthen(&done.data, &done.solution));
    let planned = planned.map(|experiment| Planned {
        csv: trajectory(&data, experiment.way).csv(),
        experiment,
        confounded,
    });
    Ok(Plan {
        planned,
        undescribed,
        inseparable,
        together,
        unidentified: unidentified(&done.data, &done.solution),
    })
}

/// An effect with the alternatives that are not aims, and the pairs of channels that they and the
/// effect read.
fn still_open(
    data: &Prepared,
    round: &Round,
    aims: &[Aim],
) -> ((String, Vec<String>), Vec<[String; 2]>) {
    let own = term_name(data, round.term());
    let name = |rival: &Candidate| term_name(data, &rival.term);
    let is_aim = |rival: &Candidate| {
        let rival = name(rival);
        // An aim of another round may be the same pair, named the other way round.
        aims.iter().any(|aim| {
            let pair = (Some(&aim.what), aim.rival.as_ref());
            pair == (Some(&own), Some(&rival)) || pair == (Some(&rival), Some(&own))
        })
    };
    let rivals: Vec<&Candidate> = round.rivals.iter().filter(|r| !is_aim(r)).collect();
    let channel = |term: &FitTerm| data.channel(term.source).map(|c| c.name.clone());
    let apart = rivals.iter().filter_map(|rival| {
        let pair = [channel(round.term())?, channel(&rival.term)?];
        (pair[0] != pair[1]).then_some(pair)
    });
    let names = rivals.iter().copied().map(name).collect();
    let apart = apart.collect();
    ((own, names), apart)
}
