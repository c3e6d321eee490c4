//! The JSON of `bowden close --json`, schema `bowden.close/1`.

use super::cost::Cost;
use super::curve::UnknownPart;
use super::hand_over::HandOverPart;
use super::rounds::{models, RoundModel};
use super::words::{block_count, effects};
use crate::conclude::by_file::{nrmse_by_file, rmse_by_file, worse, FileErrors, Worse};
use crate::conclude::final_fit::FinalFit;
use crate::conclude::intervals::{parameters, Parameter};
use crate::conclude::unneeded::{unneeded, Unneeded};
use crate::conclude::verdict::{raises, sentence, verdict};
use crate::export::hand_over::HandOver;
use crate::fit::{Segments, Solution};
use crate::foresight::plan::{separate, Experiment};
use crate::ledger::{Gate, Grade, Ledger, Round};
use crate::model::catalogue::Candidate;
use crate::problem::{Piece, Prepared};
use crate::record::{Defect, Mode};
use crate::score::explains::{explained, Explained};
use serde::Serialize;

/// The whole object.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    schema: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    record: Option<RecordPart>,
    #[serde(skip_serializing_if = "Option::is_none")]
    records: Option<Vec<RecordPart>>,
    declared: ModelPart,
    rounds: Vec<RoundPart>,
    r#final: FinalPart,
    rejected: Vec<RejectedPart>,
    defects: Vec<Defect>,
    unneeded: Vec<Unneeded>,
    unknown: Option<UnknownPart>,
    noise_floor: f64,
    /// Standard deviation of the filtered output on each segment.
    deviation: Segments,
    /// Shares of the held-out output's variance.
    explains: Explained,
    integrates: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    worse_files: Option<Vec<Worse>>,
    /// The largest number of effects that was asked for, where that ended the search.
    stopped_by_request: Option<usize>,
    verdict: &'static str,
    sentence: String,
    /// Absent where nobody has measured it.
    #[serde(skip_serializing_if = "Option::is_none")]
    cost: Option<Cost>,
}

#[derive(Debug, Clone, Serialize)]
struct RecordPart {
    path: String,
    samples: usize,
    rate_hz: f64,
    mode: &'static str,
    cutoff_hz: f64,
    blocks: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    held_out: Option<&'static str>,
}

#[derive(Debug, Clone, Serialize)]
struct ModelPart {
    effects: Vec<String>,
    parameters: Vec<Parameter>,
    rmse: Segments,
    nrmse: Segments,
    nrmse_raw: Segments,
    #[serde(flatten)]
    by_file: ByFile,
}

/// Present where there are several records.
#[derive(Debug, Clone, Serialize)]
struct ByFile {
    #[serde(skip_serializing_if = "Option::is_none")]
    rmse_by_file: Option<Vec<FileErrors>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    nrmse_by_file: Option<Vec<FileErrors>>,
}

impl ByFile {
    fn new(data: &Prepared, solution: &Solution) -> Self {
        Self {
            rmse_by_file: rmse_by_file(data, solution),
            nrmse_by_file: nrmse_by_file(data, solution),
        }
    }
}

#[derive(Debug, Clone, Serialize)]
struct FinalPart {
    effects: Vec<String>,
    /// Whether the parameters have seen the stop-check segment as well.
    refitted: bool,
    parameters: Vec<Parameter>,
    rmse: Segments,
    nrmse: Segments,
    #[serde(flatten)]
    hand_over: HandOverPart,
    #[serde(flatten)]
    by_file: ByFile,
}

#[derive(Debug, Clone, Serialize)]
struct RoundPart {
    family: &'static str,
    effect: &'static str,
    channel: String,
    grade: Grade,
    coefficients: Vec<Coefficient>,
    p: Option<f64>,
    explained: f64,
    confounded_with: Vec<Rival>,
    experiment: Option<Experiment>,
    rmse_before: Segments,
    rmse_after: Segments,
    raises_held_out: bool,
    #[serde(flatten)]
    model: RoundModel,
}

#[derive(Debug, Clone, Serialize)]
struct Coefficient {
    name: String,
    value: f64,
    unit: Option<String>,
    ci95: Option<[f64; 2]>,
}

#[derive(Debug, Clone, Serialize)]
struct Rival {
    family: &'static str,
    channel: String,
}

#[derive(Debug, Clone, Serialize)]
struct RejectedPart {
    family: &'static str,
    effect: &'static str,
    channel: String,
    gate: Gate,
}

/// The channel that a candidate reads, by name.
fn channel(data: &Prepared, candidate: &Candidate) -> String {
    data.channel(candidate.term.source)
        .map_or_else(String::new, |c| c.name.clone())
}

/// Errors against the output as recorded, as shares of its standard deviation.
fn raw(data: &Prepared, solution: &Solution) -> Segments {
    let prediction = solution.unfiltered.iter().step_by(data.stride);
    let residual: Vec<f64> = data
        .target_raw
        .iter()
        .zip(prediction)
        .map(|(y, p)| y - p)
        .collect();
    Segments::of(data, &residual).normalised(data, &data.target_raw)
}

/// What of a file is held out.
fn held_out(data: &Prepared, piece: &Piece) -> &'static str {
    let whole = data.pieces.iter().any(|p| !p.fitted);
    match (piece.fitted, whole) {
        (false, _) => "whole",
        (true, true) => "nothing",
        (true, false) => "trailing",
    }
}

impl RecordPart {
    fn new(
        data: &Prepared,
        ledger: &Ledger,
        path: &str,
        (samples, rate_hz): (usize, f64),
        held_out: Option<&'static str>,
    ) -> Self {
        Self {
            path: path.to_owned(),
            samples,
            rate_hz,
            mode: match data.mode {
                Mode::Torque => "torque",
                Mode::Displacement => "displacement",
            },
            cutoff_hz: data.cutoff,
            blocks: block_count(data, ledger),
            held_out,
        }
    }
}

impl ModelPart {
    fn new(data: &Prepared, declared: &Solution) -> Self {
        Self {
            effects: effects(data, declared),
            parameters: parameters(data, declared),
            rmse: declared.rmse,
            nrmse: declared.rmse.normalised(data, &data.target),
            nrmse_raw: raw(data, declared),
            by_file: ByFile::new(data, declared),
        }
    }
}

impl FinalPart {
    fn new(data: &Prepared, done: &FinalFit, hand: Result<&HandOver, &str>) -> Self {
        let last = &done.solution;
        Self {
            effects: effects(data, last),
            refitted: done.refitted,
            parameters: parameters(&done.data, last),
            rmse: done.rmse,
            nrmse: done.rmse.normalised(data, &data.target),
            hand_over: HandOverPart::new(data, hand),
            by_file: ByFile::new(data, last),
        }
    }
}

impl RoundPart {
    fn new(data: &Prepared, round: &Round, model: RoundModel) -> Self {
        let term = round.solution.structure.terms.len() - 1;
        let own = parameters(data, &round.solution).into_iter();
        let own = own.filter(|p| p.term == Some(term));
        let rivals = round.rivals.iter();
        Self {
            family: round.candidate.family.name(),
            effect: round.candidate.term.effect.name(),
            channel: channel(data, &round.candidate),
            grade: round.grade,
            coefficients: own
                .map(|p| Coefficient {
                    name: p.name,
                    value: p.value,
                    unit: p.unit,
                    ci95: p.ci95,
                })
                .collect(),
            p: round.p,
            explained: round.explained,
            confounded_with: rivals
                .map(|r| Rival {
                    family: r.family.name(),
                    channel: channel(data, r),
                })
                .collect(),
            experiment: separate(data, round),
            rmse_before: round.before,
            rmse_after: round.after,
            raises_held_out: raises(round),
            model,
        }
    }
}

impl Report {
    /// Collects everything about one run.
    #[must_use]
    pub fn new(
        path: &str,
        data: &Prepared,
        ledger: &Ledger,
        done: &FinalFit,
        hand: Result<&HandOver, &str>,
    ) -> Self {
        let last = &done.solution;
        let several = data.pieces.len() > 1;
        let part = |path: &str, samples, rate_hz, held_out| {
            RecordPart::new(data, ledger, path, (samples, rate_hz), held_out)
        };
        let rounds = ledger.rounds.iter().zip(models(data, ledger, done));
        let rounds = rounds.map(|(round, model)| RoundPart::new(data, round, model));
        Self {
            schema: "bowden.close/1",
            record: (!several).then(|| part(path, data.samples, data.rate, None)),
            records: several.then(|| {
                let pieces = data.pieces.iter();
                pieces
                    .map(|p| part(&p.path, p.samples, p.rate, Some(held_out(data, p))))
                    .collect()
            }),
            declared: ModelPart::new(data, &ledger.declared),
            rounds: rounds.collect(),
            r#final: FinalPart::new(data, done, hand),
            rejected: ledger
                .rejected
                .iter()
                .map(|r| RejectedPart {
                    family: r.candidate.family.name(),
                    effect: r.candidate.term.effect.name(),
                    channel: channel(data, &r.candidate),
                    gate: r.gate,
                })
                .collect(),
            defects: data.defects.clone(),
            unneeded: unneeded(ledger, done),
            unknown: ledger
                .unknown
                .as_ref()
                .map(|u| UnknownPart::new(data, u, done)),
            noise_floor: data.noise_floor,
            deviation: Segments::deviation(data, &data.target),
            explains: explained(data, last),
            integrates: ledger.integrates,
            worse_files: several.then(|| worse(data, &ledger.declared, last)),
            stopped_by_request: ledger.stopped_by_request,
            verdict: verdict(data, ledger, done).name(),
            sentence: sentence(data, ledger, done),
            cost: None,
        }
    }

    /// The same report with what the run has cost.
    #[must_use]
    pub fn with_cost(self, cost: Cost) -> Self {
        Self {
            cost: Some(cost),
            ..self
        }
    }
}

/// The report as one line of JSON.
///
/// # Errors
/// Where a number is not finite, which no fitted model has.
pub fn json(report: &Report) -> Result<String, serde_json::Error> {
    serde_json::to_string(report)
}
