//! The findings on a run, the most important first.

use super::ballast::Part;
use super::by_file::worse;
use super::changes::{
    begins, extrapolates, made_without_input, other_line, other_rig, stands_for_output,
    starts_apart, unseen_motion, velocity,
};
use super::errors::{
    before_after, falls_up_to, floors, held_out_ratio, is_noise, is_worse, names, poor,
};
use super::files_apart::{another_zero, files_scaled, several_rigs};
use super::final_fit::FinalFit;
use super::finding::{Finding, Severity};
use super::intervals::term_title;
use super::lacks::lacks;
use super::no_model::no_model;
use super::resolution::coarse;
use super::rivals::each_pair_once;
use super::signs::{falls, of_temperature, of_tension, of_the_motion, turns_against};
use super::verdict::{self, is_one_stroke, spoils, Verdict};
use crate::ledger::Ledger;
use crate::model::catalogue::Candidate;
use crate::problem::Prepared;
use crate::record::Mode;
use crate::scale::NOISE;
use crate::score::explains::{deviations, segments_differ};
use crate::score::whiteness::is_white;
use bowden::model::Source;

/// The findings on a run with this verdict, besides the missing mechanisms.
#[must_use]
pub fn findings(
    data: &Prepared,
    ledger: &Ledger,
    done: &FinalFit,
    verdict: Verdict,
) -> Vec<Finding> {
    let mut all = Vec::new();
    match verdict {
        Verdict::NoInputDependence => {
            all.push(no_model(data, ledger, done));
            all.extend(velocity(data));
            return all;
        }
        Verdict::NotTransferable => {
            all.push(no_transfer(data, ledger, done));
            all.extend(other_line(data, done));
        }
        verdict => all.extend(rest(data, ledger, done, verdict)),
    }
    all.extend(velocity(data));
    let says_no_size = matches!(
        verdict,
        Verdict::UnmodelledDependence | Verdict::Ambiguous | Verdict::UnderExcited
    );
    if says_no_size && floors(data, done).is_some_and(|errors| !is_noise(data, errors)) {
        all.extend(size(data, ledger, done));
    }
    if verdict == Verdict::DefectiveRecord {
        all.extend(files_scaled(data, ledger));
    }
    if verdict != Verdict::NotTransferable {
        all.extend(poor(data, done));
    }
    if verdict != Verdict::UnderExcited {
        all.extend(one_stroke(data, done));
    }
    all.extend(of_record(data, ledger, done));
    all.extend(of_model(data, ledger, done));
    all.extend(of_rounds(data, ledger, done, verdict));
    // What questions the data comes before what they say.
    all.sort_by_key(|finding| finding.severity() != Severity::Error);
    all
}

/// The reason why the model does not transfer.
fn no_transfer(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Finding {
    let (before, after) = before_after(data, ledger, done);
    let terms = names(ledger, done);
    if is_worse(ledger, done) {
        return Finding::HeldOutRises {
            ratio: held_out_ratio(ledger, done),
            before,
            after,
            terms,
            falls_up_to: falls_up_to(ledger),
        };
    }
    match other_rig(data, done) {
        Some((fit, held_out)) => Finding::RigChanged {
            fit,
            held_out,
            since: begins(data, done),
            output: data.output_name.clone(),
            terms,
        },
        None => Finding::WorseThanConstant { before, after },
    }
}

/// The finding that belongs to a verdict.
fn rest(data: &Prepared, ledger: &Ledger, done: &FinalFit, verdict: Verdict) -> Option<Finding> {
    let terms = ledger.rounds.len();
    match verdict {
        Verdict::Explained => Some(Finding::ResidualIsNoise),
        Verdict::StructuredResidual => Some(above_noise(data, ledger, done)),
        Verdict::UnmodelledDependence => no_name(data, ledger),
        Verdict::Ambiguous => Some(confounded(data, ledger, done)),
        Verdict::UnderExcited => one_stroke(data, done).or(Some(Finding::TooFewBlocks { terms })),
        Verdict::DefectiveRecord => Some(Finding::DefectiveMeasurement {
            defects: spoils(data, ledger.last()).cloned().collect(),
        }),
        Verdict::Stopped => size(data, ledger, done),
        Verdict::NoInputDependence | Verdict::NotTransferable => None,
    }
}

/// The errors in multiples of the noise; `None` if the record does not show the noise.
fn size(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Option<Finding> {
    let (fit, held_out) = floors(data, done)?;
    Some(Finding::ResidualAboveNoise {
        floors: Some([fit, held_out]),
        is_white: None,
        terms: ledger.rounds.len(),
    })
}

fn above_noise(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Finding {
    match floors(data, done) {
        Some((fit, held_out)) if fit <= NOISE => Finding::HeldOutAboveNoise { held_out },
        floors => Finding::ResidualAboveNoise {
            floors: floors.map(|(fit, held_out)| [fit, held_out]),
            is_white: Some(is_white(data, ledger.last())),
            terms: ledger.rounds.len(),
        },
    }
}

/// The variable on which the residual depends in a way that matches no effect.
pub(crate) fn no_name(data: &Prepared, ledger: &Ledger) -> Option<Finding> {
    let unknown = ledger.unknown.as_ref()?;
    Some(Finding::NoNameForCurve {
        variable: unknown.variable.words(data),
        by_effects: unknown.q,
    })
}

fn confounded(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Finding {
    let rounds = ledger.rounds.iter().map(|round| {
        let rivals = round.rivals.iter();
        let rivals = rivals.map(|rival| term_title(data, &rival.term));
        (done.title_of(round), rivals.collect())
    });
    let pairs = each_pair_once(rounds);
    Finding::TermsConfounded { pairs }
}

/// A hysteresis that was fitted to a record without reversals.
fn one_stroke(data: &Prepared, done: &FinalFit) -> Option<Finding> {
    is_one_stroke(data, done).then(|| Finding::OneStroke {
        input: data.input.name.clone(),
    })
}

/// The findings about the record, its columns and its files.
fn of_record(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Vec<Finding> {
    let suspicion = ledger.suspicion.clone();
    let mut all: Vec<Finding> = suspicion
        .map(Finding::LoggedDifferently)
        .into_iter()
        .collect();
    all.extend(extrapolates(data, done));
    all.extend(unseen_motion(data, done));
    all.extend(several_rigs(ledger).or_else(|| another_zero(data, &done.solution)));
    all
}

/// The findings about the parts of the model.
fn of_model(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Vec<Finding> {
    let mut all: Vec<Finding> = one_function(data, done).into_iter().collect();
    all.extend(starts_apart(data, &done.solution));
    all.extend(ballast(done));
    all.extend(of_the_motion(data, &done.solution));
    all.extend(of_tension(data, &done.solution));
    all.extend(of_temperature(data, &done.solution));
    all.extend(falls(data, &done.solution));
    all.extend(turns_against(done));
    all.extend(coarse(data, ledger));
    all.extend(of_channel(data, ledger, done));
    all
}

/// A channel that repeats the output or the load; otherwise clocks that differ.
fn of_channel(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Option<Finding> {
    if let Some(channel) = stands_for_output(data, &ledger.declared, &done.solution) {
        let channel = channel.to_owned();
        return Some(Finding::ChannelRepeatsOutput { channel });
    }
    if let Some(channel) = made_without_input(data, &done.solution) {
        return Some(Finding::LoadFollowsChannel {
            channel: channel.to_owned(),
            input: data.input.name.clone(),
        });
    }
    // A lead that is due to a channel of the wrong sign says nothing about clocks.
    let lead = ledger.lead.filter(|_| ledger.suspicion.is_none());
    lead.map(|seconds| Finding::OutputLeads { seconds })
}

/// The findings about the error, from the search, its rounds and the files.
fn of_rounds(data: &Prepared, ledger: &Ledger, done: &FinalFit, verdict: Verdict) -> Vec<Finding> {
    let mut all = Vec::new();
    if ledger.is_stopped() {
        all.push(Finding::SearchStopped {
            seconds: ledger.stopped_by_budget,
            terms: ledger.stopped_by_request,
        });
    }
    if segments_differ(data) {
        let (fit, held_out) = deviations(data);
        all.push(Finding::SegmentsDiffer { fit, held_out });
    }
    let after = falls_up_to(ledger);
    if verdict != Verdict::NotTransferable && after < ledger.rounds.len() {
        let term = names(ledger, done).swap_remove(after);
        all.push(Finding::RoundRaises { term, after });
    }
    let files = worse(data, &ledger.declared, &done.solution).into_iter();
    all.extend(files.map(|file| Finding::FileWorse {
        path: file.path,
        before: file.before,
        after: file.after,
    }));
    let terms = ledger.rounds.len();
    if terms > 3 {
        all.push(Finding::ManyTerms { terms });
    }
    all
}

/// `backlash`, `play(x) - x`, is a multiple of `presliding`, `(x - play(x))/r`.
fn one_function(data: &Prepared, done: &FinalFit) -> Option<Finding> {
    let mut terms = done.solution.structure.terms.iter();
    let term = terms.find(|term| Candidate::twin(term).is_some())?;
    let is_on_the_spring = data.mode == Mode::Displacement && term.source == Source::Input;
    Some(Finding::PreslidingIsBacklash {
        sign_tells: is_on_the_spring && done.solution.structure.hysteresis,
    })
}

/// A hysteresis that the model does not need.
fn ballast(done: &FinalFit) -> Option<Finding> {
    if done.without_hysteresis.is_some() {
        return Some(Finding::HysteresisLeftOut);
    }
    let part = Part::of(&done.data, &done.solution).filter(Part::is_ballast)?;
    Some(Finding::HysteresisCancelled { share: part.own })
}

/// The verdict in a few sentences, the most important first.
#[must_use]
pub fn sentence(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> String {
    let found = verdict::verdict(data, ledger, done);
    let findings = findings(data, ledger, done, found);
    summary(data, ledger, done, found, &findings)
}

/// The findings in words, with the sentence on the missing mechanisms after the errors if the model
/// transfers.
pub(crate) fn summary(
    data: &Prepared,
    ledger: &Ledger,
    done: &FinalFit,
    found: Verdict,
    findings: &[Finding],
) -> String {
    let is_model = !matches!(found, Verdict::NoInputDependence | Verdict::NotTransferable);
    let mut all: Vec<String> = findings.iter().map(Finding::words).collect();
    if is_model {
        let errors = findings
            .iter()
            .take_while(|f| f.severity() == Severity::Error);
        all.insert(errors.count(), lacks(data, ledger, done));
    }
    all.join(" ")
}
