//! The JSON of `bowden identify --json`, schema `bowden.identify/1`.

use super::curve::UnknownPart;
use super::hand_over::HandOverPart;
use bowden_lab::facts::{
    Complete, CostFacts, Defect, Experiment, Explained, Facts, FileAlone, FileErrors, FileShare,
    FinalFacts, Gate, Grade, HeldOutOf, Lack, ModelFacts, Parameter, RejectedFacts, RivalFacts,
    RoundFacts, RoundModel, Segments, Told, Unneeded,
};
use serde::Serialize;

/// The whole object.
#[derive(Serialize)]
struct Report<'a> {
    schema: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    record: Option<RecordPart<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    records: Option<Vec<RecordPart<'a>>>,
    baseline: ModelPart<'a>,
    /// The missing mechanisms, the largest share first.
    lacks: &'a [Lack],
    #[serde(skip_serializing_if = "Option::is_none")]
    files_alone: Option<&'a [FileAlone]>,
    complete: Complete,
    terms: Vec<RoundPart<'a>>,
    /// Later rounds, which are not delivered.
    undelivered: Vec<RoundPart<'a>>,
    r#final: FinalPart<'a>,
    rejected: Vec<RejectedPart<'a>>,
    defects: &'a [Defect],
    /// Remarks on how the record was read.
    notes: &'a [String],
    redundant: &'a [Unneeded],
    unknown: Option<UnknownPart<'a>>,
    noise_floor: f64,
    /// The noise floor of the held-out data.
    #[serde(skip_serializing_if = "Option::is_none")]
    held_out_floor: Option<f64>,
    /// Standard deviation of the filtered output on each segment.
    output_std: Segments,
    /// Shares of the held-out output's variance.
    explains: Explained,
    /// The requested number of effects, if it ended the search.
    stopped_by_max_terms: Option<usize>,
    /// The requested time [s], if it ended the search.
    stopped_by_time_limit: Option<f64>,
    verdict: &'static str,
    findings: &'a [Told],
    summary: &'a str,
    /// Absent if it was not measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    cost: Option<&'a CostFacts>,
}

#[derive(Serialize)]
struct RecordPart<'a> {
    path: &'a str,
    samples: usize,
    /// Rows that `--drop-bad` has left out.
    dropped: usize,
    rate_hz: f64,
    mode: &'static str,
    cutoff_hz: f64,
    blocks: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    held_out: Option<HeldOutOf>,
}

#[derive(Serialize)]
struct ModelPart<'a> {
    effects: &'a [String],
    parameters: &'a [Parameter],
    rmse: Segments,
    nrmse: Segments,
    nrmse_raw: Segments,
    #[serde(flatten)]
    by_file: ByFile<'a>,
}

/// Present if there are several records.
#[derive(Serialize)]
struct ByFile<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    rmse_by_file: Option<&'a [FileErrors]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    nrmse_by_file: Option<&'a [FileErrors]>,
}

#[derive(Serialize)]
struct FinalPart<'a> {
    effects: &'a [String],
    /// Whether the parameters were fitted to the selection segment too.
    refitted: bool,
    parameters: &'a [Parameter],
    rmse: Segments,
    nrmse: Segments,
    #[serde(flatten)]
    hand_over: HandOverPart<'a>,
    #[serde(flatten)]
    by_file: ByFile<'a>,
}

#[derive(Serialize)]
struct RoundPart<'a> {
    family: &'static str,
    effect: &'static str,
    channel: &'a str,
    confidence: Grade,
    coefficients: Vec<Coefficient<'a>>,
    p: Option<f64>,
    explained: f64,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    explained_by_file: &'a [FileShare],
    alternatives: Vec<Rival<'a>>,
    experiment: Option<&'a Experiment>,
    rmse_before: Segments,
    rmse_after: Segments,
    raises_held_out: bool,
    #[serde(flatten)]
    model: Option<&'a RoundModel>,
}

#[derive(Serialize)]
struct Coefficient<'a> {
    name: &'a str,
    value: f64,
    unit: Option<&'a str>,
    ci95: Option<[f64; 2]>,
}

#[derive(Serialize)]
struct Rival<'a> {
    family: &'static str,
    channel: &'a str,
}

#[derive(Serialize)]
struct RejectedPart<'a> {
    family: &'static str,
    effect: &'static str,
    channel: &'a str,
    gate: Gate,
}

impl<'a> RecordPart<'a> {
    fn new(
        facts: &'a Facts,
        path: &'a str,
        (samples, dropped, rate_hz): (usize, usize, f64),
        held_out: Option<HeldOutOf>,
    ) -> Self {
        Self {
            path,
            samples,
            dropped,
            rate_hz,
            mode: facts.record.mode.name(),
            cutoff_hz: facts.record.cutoff,
            blocks: facts.blocks,
            held_out,
        }
    }

    fn of_all(facts: &'a Facts) -> Self {
        let dropped = facts.record.files.iter().map(|f| f.dropped).sum();
        let size = (facts.record.samples, dropped, facts.record.rate);
        Self::new(facts, &facts.label, size, None)
    }

    fn of_each(facts: &'a Facts) -> Vec<Self> {
        let files = facts.record.files.iter();
        files
            .map(|f| {
                Self::new(
                    facts,
                    &f.path,
                    (f.samples, f.dropped, f.rate),
                    Some(f.held_out),
                )
            })
            .collect()
    }
}

impl<'a> From<&'a ModelFacts> for ModelPart<'a> {
    fn from(declared: &'a ModelFacts) -> Self {
        Self {
            effects: &declared.effects,
            parameters: &declared.parameters,
            rmse: declared.rmse,
            nrmse: declared.nrmse,
            nrmse_raw: declared.nrmse_raw,
            by_file: ByFile {
                rmse_by_file: declared.rmse_by_file.as_deref(),
                nrmse_by_file: declared.nrmse_by_file.as_deref(),
            },
        }
    }
}

impl<'a> FinalPart<'a> {
    fn new(last: &'a FinalFacts, hand_over: HandOverPart<'a>) -> Self {
        Self {
            effects: &last.effects,
            refitted: last.refitted,
            parameters: &last.parameters,
            rmse: last.rmse,
            nrmse: last.nrmse,
            hand_over,
            by_file: ByFile {
                rmse_by_file: last.rmse_by_file.as_deref(),
                nrmse_by_file: last.nrmse_by_file.as_deref(),
            },
        }
    }
}

impl<'a> From<&'a RoundFacts> for RoundPart<'a> {
    fn from(round: &'a RoundFacts) -> Self {
        let fit = round.fit.as_ref();
        let coefficients = fit.map_or(&[][..], |fit| &fit.coefficients);
        Self {
            family: round.family,
            effect: round.effect,
            channel: &round.channel,
            confidence: round.grade,
            coefficients: coefficients.iter().map(Coefficient::from).collect(),
            p: round.p,
            explained: round.explained,
            explained_by_file: &round.by_file,
            alternatives: round.rivals.iter().map(Rival::from).collect(),
            experiment: round.experiment.as_ref(),
            rmse_before: round.before,
            rmse_after: round.after,
            raises_held_out: round.raises_held_out,
            model: fit.map(|fit| &fit.model),
        }
    }
}

impl<'a> From<&'a Parameter> for Coefficient<'a> {
    fn from(parameter: &'a Parameter) -> Self {
        Self {
            name: &parameter.name,
            value: parameter.value,
            unit: parameter.unit.as_deref(),
            ci95: parameter.ci95,
        }
    }
}

impl<'a> From<&'a RivalFacts> for Rival<'a> {
    fn from(rival: &'a RivalFacts) -> Self {
        Self {
            family: rival.family,
            channel: &rival.channel,
        }
    }
}

impl<'a> From<&'a RejectedFacts> for RejectedPart<'a> {
    fn from(rejected: &'a RejectedFacts) -> Self {
        Self {
            family: rejected.family,
            effect: rejected.effect,
            channel: &rejected.channel,
            gate: rejected.gate,
        }
    }
}

/// The facts and the cost of the run as one line of JSON.
///
/// # Errors
/// If a number is not finite, which does not occur in a fitted model.
pub fn json(facts: &Facts, cost: Option<&CostFacts>) -> Result<String, serde_json::Error> {
    let several = facts.record.files.len() > 1;
    serde_json::to_string(&Report {
        schema: "bowden.identify/1",
        record: (!several).then(|| RecordPart::of_all(facts)),
        records: several.then(|| RecordPart::of_each(facts)),
        baseline: ModelPart::from(&facts.declared),
        lacks: &facts.lacks,
        files_alone: several.then_some(&facts.files_alone[..]),
        complete: facts.complete,
        terms: facts.rounds.iter().map(RoundPart::from).collect(),
        undelivered: facts.beyond.iter().map(RoundPart::from).collect(),
        r#final: FinalPart::new(&facts.last, HandOverPart::new(&facts.hand_over)),
        rejected: facts.rejected.iter().map(RejectedPart::from).collect(),
        defects: &facts.record.defects,
        notes: &facts.record.notes,
        redundant: &facts.unneeded,
        unknown: facts.unknown.as_ref().map(UnknownPart::new),
        noise_floor: facts.record.noise_floor,
        held_out_floor: several.then_some(facts.record.held_out_floor),
        output_std: facts.deviation,
        explains: facts.explains,
        stopped_by_max_terms: facts.stopped_by_request,
        stopped_by_time_limit: facts.stopped_by_budget,
        verdict: facts.verdict.name(),
        findings: &facts.findings,
        summary: &facts.sentence,
        cost,
    })
}
