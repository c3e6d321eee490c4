//! The result of a search: every round, every rejection, and the unmodelled curve.

use crate::alteration::Suspicion;
use crate::fit::{Segments, Solution};
use crate::model::catalogue::Candidate;
use crate::model::mechanism::Mechanism;
use crate::model::structure::FitTerm;
use crate::model::Variable;
use crate::problem::Prepared;
use crate::score::binned::Bin;
use crate::score::blocks::Regime;
use bowden::model::Source;

/// Why a candidate was not added.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Gate {
    /// The sign-flip test.
    P,
    /// The effect reduced the error on too few blocks.
    Blocks,
    /// The effect raised the error on the selection segment.
    StopCheck,
    /// The effect was added, and later additions made it redundant.
    Superseded,
}

impl Gate {
    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::P => "not significant",
            Self::Blocks => "too few blocks improve",
            Self::StopCheck => "worse on the selection segment",
            Self::Superseded => "superseded by later terms",
        }
    }
}

/// The confidence in a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Grade {
    /// The model is within the noise, no parameter is at a bound, and there is no alternative.
    High,
    /// A candidate: one of these conditions does not hold.
    Low,
}

/// One accepted effect.
#[derive(Debug, Clone)]
pub struct Round {
    /// The effect that was added.
    pub candidate: Candidate,
    /// Exact sign-flip p-value; `None` if the blocks were too short for a test.
    pub p: Option<f64>,
    /// Effects that explain the record equally well once fitted: the record cannot separate them.
    pub rivals: Vec<Candidate>,
    /// Confidence in the name.
    pub grade: Grade,
    /// Share of the squared error that the refit removed.
    pub explained: f64,
    /// Number of the sixteen blocks on which it lowered the error.
    pub blocks_better: usize,
    /// Errors before.
    pub before: Segments,
    /// Errors after.
    pub after: Segments,
    /// The refitted model.
    pub solution: Solution,
}

impl Round {
    /// The effect as fitted in this round.
    #[must_use]
    pub fn term(&self) -> &FitTerm {
        let terms = &self.solution.structure.terms;
        terms.last().unwrap_or(&self.candidate.term)
    }

    /// Every effect that the rig may have: the named one, the one that is the same function under
    /// another name, and the alternatives.
    pub fn possible(&self) -> impl Iterator<Item = Candidate> + '_ {
        let own = [Some(self.candidate), Candidate::twin(&self.candidate.term)];
        own.into_iter().flatten().chain(self.rivals.iter().copied())
    }
}

/// A rejected candidate.
#[derive(Debug, Clone)]
pub struct Rejection {
    /// Which.
    pub candidate: Candidate,
    /// By which gate.
    pub gate: Gate,
    /// Its sign-flip p-value, if there was one.
    pub p: Option<f64>,
}

/// Adds rejections of effects that the list does not contain yet; for each effect, the first one is
/// kept.
pub(crate) fn reject(list: &mut Vec<Rejection>, those: impl IntoIterator<Item = Rejection>) {
    for one in those {
        if !list.iter().any(|r| r.candidate.is_like(&one.candidate)) {
            list.push(one);
        }
    }
}

/// A set of terms that describes a mechanism as well as the terms found.
#[derive(Debug, Clone)]
pub struct Description {
    /// Which.
    pub mechanism: Mechanism,
    /// The terms.
    pub terms: Vec<Candidate>,
    /// Rms error with them on the fit segment, over that with the terms found.
    pub error_ratio: f64,
}

/// The results table of a search.
#[derive(Debug, Clone)]
pub struct Ledger {
    /// The baseline model, fitted.
    pub declared: Solution,
    /// What was added.
    pub rounds: Vec<Round>,
    /// Later rounds, without which the model is as good on left-out blocks: they are not part of
    /// the delivered model.
    pub beyond: Vec<Round>,
    /// Candidates that were rejected.
    pub rejected: Vec<Rejection>,
    /// The mechanisms that the record supports; `None` if nothing was added.
    pub supported: Option<Supported>,
    /// Other sets of terms that describe a mechanism as well as those found; none if the model is
    /// complete.
    pub descriptions: Vec<Description>,
    /// A further dependence that no effect in the catalogue explains.
    pub unknown: Option<Unknown>,
    /// Whether the blocks were long enough for p-values, in the last linearisation and whenever
    /// an effect was added.
    pub regime: Regime,
    /// Correlation time of the last residual \[s\].
    pub correlation_time: f64,
    /// Whether the output follows the integral of the input: there is then no search for effects.
    pub integrates: bool,
    /// Files with another ratio of output to input than the others.
    pub apart: Vec<FileApart>,
    /// Files that do not come from one rig, if the ratio alone does not explain the difference.
    pub rigs_apart: Option<RigsApart>,
    /// A suspected error in the logging of the records.
    pub suspicion: Option<Suspicion>,
    /// Lead \[s\] of the output over the input, from a delay fitted to the last model.
    pub lead: Option<f64>,
    /// Channels whose steps affect the final model.
    pub coarse: Vec<CoarseChannel>,
    /// The requested number of effects if it ended the search: further effects may be missing.
    /// `None` if the search ended by itself.
    pub stopped_by_request: Option<usize>,
    /// The requested time \[s\] if it ended the search.
    pub stopped_by_budget: Option<f64>,
}

impl Ledger {
    /// The results table of a baseline model before the search.
    #[must_use]
    pub fn of(declared: Solution) -> Self {
        Self {
            declared,
            rounds: Vec::new(),
            beyond: Vec::new(),
            rejected: Vec::new(),
            supported: None,
            descriptions: Vec::new(),
            unknown: None,
            regime: Regime::Blocks,
            correlation_time: 0.0,
            integrates: false,
            apart: Vec::new(),
            rigs_apart: None,
            suspicion: None,
            lead: None,
            coarse: Vec::new(),
            stopped_by_request: None,
            stopped_by_budget: None,
        }
    }

    /// Whether a requested limit ended the search.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.stopped_by_request.is_some() || self.stopped_by_budget.is_some()
    }

    /// The mechanisms of the added terms, in the order of the rounds.
    #[must_use]
    pub fn mechanisms(&self, data: &Prepared) -> Vec<Mechanism> {
        let terms = self
            .rounds
            .iter()
            .map(|round| Mechanism::of_term(round.term()));
        let curve = self.unknown.as_ref();
        let curve = curve.map(|own| Mechanism::of_variable(data, own.variable));
        let mut all = Vec::new();
        for mechanism in terms.chain(curve) {
            if !all.contains(&mechanism) {
                all.push(mechanism);
            }
        }
        all
    }

    /// The last accepted model, including the table of an unmodelled curve.
    #[must_use]
    pub fn last(&self) -> &Solution {
        match &self.unknown {
            Some(unknown) => &unknown.solution,
            None => self.named(),
        }
    }

    /// The last accepted model without an unmodelled curve.
    #[must_use]
    pub fn named(&self) -> &Solution {
        self.rounds.last().map_or(&self.declared, |r| &r.solution)
    }
}

/// A share of the baseline's squared error.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Share {
    /// The share.
    pub value: f64,
    /// The first and the third quartile of the shares on the halves of the record.
    pub quartiles: [f64; 2],
}

/// A mechanism that a record supports.
#[derive(Debug, Clone)]
pub struct Support {
    /// Which.
    pub mechanism: Mechanism,
    /// The channel with the largest share.
    pub source: Source,
    /// The share that it removes by itself.
    pub alone: Share,
    /// The share that it removes beyond all other supported mechanisms.
    pub beyond: Share,
    /// Whether, together with those found before it, it leaves at most half of the squared error that
    /// any other mechanism leaves.
    pub is_clear: bool,
    /// Other mechanisms that, instead of it, leave less than twice as much squared error.
    pub alternatives: Vec<Mechanism>,
    /// The variable of its function.
    pub variable: Variable,
    /// Its function: means over the variable, including the residual of all mechanisms.
    pub curve: Vec<Bin>,
}

/// The mechanisms that a record supports, and their residual error.
#[derive(Debug, Clone)]
pub struct Supported {
    /// In the order in which they were found.
    pub all: Vec<Support>,
    /// Mean logarithm of the squared error on the halves that were left out.
    pub error: f64,
}

/// A file whose output is a multiple of the output with another file's gains.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct FileApart {
    /// The file.
    pub path: String,
    /// The file whose gains it is compared with.
    pub than: String,
    /// The factor on the output with those gains.
    pub gain: f64,
    /// The offset to add, in the output's unit.
    pub offset: f64,
    /// The error of those gains on the file, as a share of its output's standard deviation.
    pub before: f64,
    /// The same error with gain and offset.
    pub after: f64,
}

/// The effect of separate gains on files that do not come from one rig.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigsApart {
    /// The error of the delivered model on the fit segment, as a share of the output's standard
    /// deviation there.
    pub together: f64,
    /// The same error of the baseline model with separate gains for each file.
    pub own: f64,
}

/// A channel of a coarse sensor, whose steps account for much of the residual.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct CoarseChannel {
    /// The channel.
    pub channel: String,
    /// One step of its sensor, in its unit.
    pub step: f64,
    /// Its range, in steps.
    pub counts: f64,
    /// The rms change of the model's output by the steps, on the fit segment.
    pub error: f64,
    /// The terms that the steps may explain.
    pub names: Vec<String>,
}

/// A dependence of the residual that no effect in the catalogue explains.
#[derive(Debug, Clone)]
pub struct Unknown {
    /// The variable that the residual depends on.
    pub variable: Variable,
    /// Share of the squared error that the curve removes.
    pub share: f64,
    /// Exact sign-flip p-value of the curve.
    pub p: f64,
    /// Reduction of the SSE by the best one or two names over that by the curve.
    pub q: f64,
    /// Errors before.
    pub before: Segments,
    /// Errors after.
    pub after: Segments,
    /// The model with the curve as its table.
    pub solution: Solution,
}
