//! The facts about an identified record.

use super::hand_over::{price, useless, warning, HandOverFacts};
use super::model::{FinalFacts, ModelFacts};
use super::record::{channel_name, RecordFacts};
use super::round::{fits, size, RoundFacts};
use crate::conclude::by_file::{worse, Worse};
use crate::conclude::curve::{curve, Knot};
use crate::conclude::final_fit::FinalFit;
use crate::conclude::finding::{Severity, Told};
use crate::conclude::findings::{findings, no_name, summary};
use crate::conclude::intervals::term_title;
use crate::conclude::mechanisms::{mechanisms, Complete, FileAlone, Lack};
use crate::conclude::unneeded::{unneeded, Unneeded};
use crate::conclude::verdict::{falls_up_to, verdict, Verdict};
use crate::export::hand_over::HandOver;
use crate::fit::Segments;
use crate::ledger::{Gate, Ledger, Unknown};
use crate::model::Table;
use crate::problem::Prepared;
use crate::record::Mode;
use crate::score::blocks::{Regime, BLOCKS};
use crate::score::explains::{explained, segments_differ, Explained};

/// All facts about one run.
#[derive(Debug, Clone)]
pub struct Facts {
    /// The name of the record, or the names of several records.
    pub label: String,
    /// The record as it was read.
    pub record: RecordFacts,
    /// Number of independent blocks of the fit segment, at most [`BLOCKS`].
    pub blocks: usize,
    /// The baseline model.
    pub declared: ModelFacts,
    /// The mechanisms that the baseline model lacks.
    pub lacks: Vec<Lack>,
    /// The result for each of several files by itself; empty for one file, or if nothing was added.
    pub files_alone: Vec<FileAlone>,
    /// Whether the final model is complete.
    pub complete: Complete,
    /// The added effects, in order.
    pub rounds: Vec<RoundFacts>,
    /// Later terms that are not in the final model, because the model predicts half-records that
    /// were not used for the fit equally well without them.
    pub beyond: Vec<RoundFacts>,
    /// Number of terms, from the first, that reduce the held-out error before a term increases it.
    pub falls_up_to: usize,
    /// The final model.
    pub last: FinalFacts,
    /// The exported model, or the reason why there is none.
    pub hand_over: Result<HandOverFacts, String>,
    /// Rejected candidates.
    pub rejected: Vec<RejectedFacts>,
    /// Redundant parts of the baseline model.
    pub unneeded: Vec<Unneeded>,
    /// The dependence that no effect in the catalogue explains.
    pub unknown: Option<UnknownFacts>,
    /// Standard deviation of the filtered output on each segment.
    pub deviation: Segments,
    /// Whether these differ so much that percentages on two segments are not comparable.
    pub segments_differ: bool,
    /// Shares of the variance of the held-out output.
    pub explains: Explained,
    /// Files on which the final model is worse than the baseline model.
    pub worse: Vec<Worse>,
    /// The requested number of effects, if this number ended the search.
    pub stopped_by_request: Option<usize>,
    /// The requested time limit \[s\], if this limit ended the search.
    pub stopped_by_budget: Option<f64>,
    /// Correlation time of the residual \[s\], if it is too long for tests.
    pub correlated_for: Option<f64>,
    /// The verdict.
    pub verdict: Verdict,
    /// The findings besides the missing mechanisms, the most important first.
    pub findings: Vec<Told>,
    /// The verdict in a few sentences.
    pub sentence: String,
}

/// The level of detail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// All facts except the models after each term.
    Ledger,
    /// All facts, including the model after each term, which costs one fit for each term.
    EachRound,
}

/// A rejected candidate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RejectedFacts {
    /// Its name in words.
    pub title: String,
    /// Its family.
    pub family: &'static str,
    /// Its own name.
    pub effect: &'static str,
    /// The channel that it reads.
    pub channel: String,
    /// The gate that rejected it.
    pub gate: Gate,
}

/// A dependence that no effect in the catalogue explains.
#[derive(Debug, Clone)]
pub struct UnknownFacts {
    /// Name of the variable.
    pub variable: &'static str,
    /// The variable in words.
    pub words: String,
    /// Its unit, if the record states it.
    pub unit: Option<String>,
    /// The channel that it is computed from.
    pub channel: String,
    /// Share of the squared error that the free-form curve removes.
    pub share: f64,
    /// Exact sign-flip p-value of the curve.
    pub p: f64,
    /// Reduction of the squared error by the best one or two terms, divided by the reduction by the
    /// curve.
    pub q: f64,
    /// The curve.
    pub curve: Vec<Knot>,
    /// Rms errors without the curve.
    pub before: Segments,
    /// Rms errors with the curve.
    pub after: Segments,
    /// The sentence about it.
    pub sentence: String,
    /// The models that contain the curve.
    pub kept: &'static str,
}

/// Number of independent blocks of the fit segment, at most sixteen.
fn block_count(data: &Prepared, ledger: &Ledger) -> usize {
    if ledger.regime == Regime::Blocks {
        return BLOCKS;
    }
    let seconds = data.split.fit.len() as f64 * data.dt * data.stride as f64;
    ((seconds / (3.0 * ledger.correlation_time)) as usize).min(BLOCKS - 1)
}

impl UnknownFacts {
    fn new(data: &Prepared, ledger: &Ledger, unknown: &Unknown, done: &FinalFit) -> Self {
        Self {
            variable: unknown.variable.name(data),
            words: unknown.variable.words(data),
            unit: unknown.variable.unit(data),
            channel: channel_name(data, unknown.variable.source()),
            share: unknown.share,
            p: unknown.p,
            q: unknown.q,
            curve: curve(&done.data, &done.solution),
            kept: match done.solution.structure.table.as_ref().and_then(Table::over) {
                Some(_) => {
                    "the final model contains the curve, and the exported model approximates it with fewer points"
                }
                None => "the final model contains the curve, but the exported model does not",
            },
            before: unknown.before,
            after: unknown.after,
            sentence: no_name(data, ledger).map_or_else(String::new, |own| own.words()),
        }
    }
}

impl Facts {
    /// Collects all facts about one run.
    #[must_use]
    pub fn new(
        label: &str,
        data: &Prepared,
        ledger: &Ledger,
        done: &FinalFit,
        hand: Result<&HandOver, &str>,
        detail: Detail,
    ) -> Self {
        let last = FinalFacts::new(data, done);
        let hand_over = hand
            .map(|hand| HandOverFacts::new(data, hand))
            .map_err(str::to_owned);
        let rejected = ledger.rejected.iter().map(|r| RejectedFacts {
            title: term_title(data, &r.candidate.term),
            family: r.candidate.family,
            effect: r.candidate.term.effect.name(),
            channel: channel_name(data, r.candidate.term.source),
            gate: r.gate,
        });
        let unknown = ledger.unknown.as_ref();
        let found = verdict(data, ledger, done);
        let is_model = !matches!(found, Verdict::NoInputDependence | Verdict::NotTransferable);
        let used = hand.ok().filter(|_| is_model);
        let in_firmware = used.and_then(|hand| warning(data, hand));
        let price = hand.ok().and_then(price);
        let mut words: Vec<String> = used.and_then(useless).into_iter().collect();
        let findings = findings(data, ledger, done, found);
        let sentence = summary(data, ledger, done, found, &findings);
        match price {
            Some(price) if is_model => {
                words.push(price);
                words.extend(in_firmware);
                words.push("The rest of this text describes the unconstrained model.".to_owned());
                words.push(sentence);
            }
            price => {
                words.push(sentence);
                words.extend(in_firmware.or(price));
            }
        }
        let exported = hand_over.as_ref().ok().and_then(|own| own.model.as_ref());
        let exported = hand.ok().map(|hand| &hand.fitted).zip(exported);
        let shown = exported.unwrap_or((done, &last));
        let mut rounds = rounds(data, ledger, done, shown, detail);
        let beyond = rounds.split_off(ledger.rounds.len());
        Self {
            label: label.to_owned(),
            record: RecordFacts::new(data),
            blocks: block_count(data, ledger),
            declared: ModelFacts::new(data, &ledger.declared),
            rounds,
            beyond,
            lacks: mechanisms(data, ledger, done),
            files_alone: Vec::new(),
            complete: Complete::new(data, ledger),
            falls_up_to: falls_up_to(ledger),
            hand_over,
            rejected: rejected.collect(),
            unneeded: unneeded(ledger, done),
            unknown: unknown.map(|u| UnknownFacts::new(data, ledger, u, done)),
            deviation: Segments::deviation(data, &data.target),
            segments_differ: segments_differ(data),
            explains: explained(data, &done.solution),
            worse: worse(data, &ledger.declared, &done.solution),
            stopped_by_request: ledger.stopped_by_request,
            stopped_by_budget: ledger.stopped_by_budget,
            correlated_for: (ledger.regime == Regime::Effect).then_some(ledger.correlation_time),
            verdict: found,
            findings: findings.into_iter().map(Told::from).collect(),
            sentence: words.join(" "),
            last,
        }
    }

    /// The findings that speak against the use of the model.
    pub fn errors(&self) -> impl Iterator<Item = &Told> {
        let all = self.findings.iter();
        all.filter(|told| told.severity == Severity::Error)
    }

    /// Whether the model can be used.
    #[must_use]
    pub fn is_usable(&self) -> bool {
        self.errors().next().is_none()
            && !matches!(
                self.verdict,
                Verdict::NoInputDependence | Verdict::NotTransferable | Verdict::DefectiveRecord
            )
    }

    /// The exported model, if `--invertible` has made it different from the final model.
    #[must_use]
    pub fn constrained(&self) -> Option<&FinalFacts> {
        self.hand_over.as_ref().ok()?.model.as_ref()
    }

    /// The output of the reported model, as the sum of its parts.
    #[must_use]
    pub fn equation(&self) -> String {
        let (input, output) = (&self.record.input, &self.record.output);
        let parts = &self.shown().effects;
        let cable = match self.record.mode {
            Mode::Torque => format!("B·{input} − kappa_eta·eta − T0"),
            Mode::Displacement => format!("kappa_x·{input} + kappa_eta·eta + offset"),
        };
        let part = |part: &String| match part.as_str() {
            "bouc-wen" => cable.clone(),
            _ => part.clone(),
        };
        let parts: Vec<String> = parts.iter().map(part).collect();
        format!("{output} = {}", parts.join(" + "))
    }

    /// The model that a report describes: the constrained model if there is one, otherwise the
    /// final model.
    #[must_use]
    pub fn shown(&self) -> &FinalFacts {
        self.constrained().unwrap_or(&self.last)
    }
}

fn rounds(
    data: &Prepared,
    ledger: &Ledger,
    done: &FinalFit,
    (shown, its): (&FinalFit, &FinalFacts),
    detail: Detail,
) -> Vec<RoundFacts> {
    let mut fits = match detail {
        Detail::Ledger => Vec::new(),
        Detail::EachRound => fits(data, ledger, done),
    }
    .into_iter();
    let rounds = || ledger.rounds.iter().chain(&ledger.beyond);
    let before = std::iter::once(&ledger.declared).chain(rounds().map(|round| &round.solution));
    before
        .zip(rounds())
        .map(|(before, round)| {
            let size = size(data, shown, &its.parameters, round);
            RoundFacts::new(data, done, size, (before, round), fits.next())
        })
        .collect()
}
