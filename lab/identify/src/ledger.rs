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
    /// It did not help on enough blocks.
    Blocks,
    /// It made the stop-check segment worse.
    StopCheck,
    /// It was added, and later additions made it redundant.
    Superseded,
}

impl Gate {
    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::P => "not significant",
            Self::Blocks => "not on enough blocks",
            Self::StopCheck => "worse on the selection segment",
            Self::Superseded => "superseded by later ones",
        }
    }
}

/// How far a name can be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Grade {
    /// Part of a model within the noise, on no bound, and without a rival.
    High,
    /// A candidate: one of these does not hold.
    Low,
}

/// One accepted effect.
#[derive(Debug, Clone)]
pub struct Round {
    /// The effect that was added.
    pub candidate: Candidate,
    /// Exact sign-flip p-value; `None` if the blocks were too short for a test.
    pub p: Option<f64>,
    /// Effects that explain the same as well once fitted: the record cannot tell them apart.
    pub rivals: Vec<Candidate>,
    /// Grade of the name.
    pub grade: Grade,
    /// Share of the squared error that the refit removed.
    pub explained: f64,
    /// Blocks of sixteen on which it helped.
    pub blocks_better: usize,
    /// Errors before.
    pub before: Segments,
    /// Errors after.
    pub after: Segments,
    /// The refitted model.
    pub solution: Solution,
}

impl Round {
    /// The effect as it was fitted in this round.
    #[must_use]
    pub fn term(&self) -> &FitTerm {
        let terms = &self.solution.structure.terms;
        terms.last().unwrap_or(&self.candidate.term)
    }

    /// Every effect that may be the one in the rig: the named one, the one that is the same function
    /// under another name, and the rivals.
    pub fn possible(&self) -> impl Iterator<Item = Candidate> + '_ {
        let own = [Some(self.candidate), Candidate::twin(&self.candidate.term)];
        own.into_iter().flatten().chain(self.rivals.iter().copied())
    }
}

/// A candidate that was turned down.
#[derive(Debug, Clone)]
pub struct Rejection {
    /// Which.
    pub candidate: Candidate,
    /// By which gate.
    pub gate: Gate,
    /// Its sign-flip p-value, where there was one.
    pub p: Option<f64>,
}

/// Adds rejections of effects that the list does not have yet: of each the first one stands.
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

/// The whole ledger.
#[derive(Debug, Clone)]
pub struct Ledger {
    /// The baseline model, fitted.
    pub declared: Solution,
    /// What was added.
    pub rounds: Vec<Round>,
    /// Rounds after these, without which the model does as well on left-out blocks: they are not
    /// part of the delivered model.
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
    /// Whether the output follows the integral of the input: then no effect is sought.
    pub integrates: bool,
    /// Files in which the output is another multiple of the input than in the others.
    pub apart: Vec<FileApart>,
    /// Files that are not of one rig, where none of them is only another multiple.
    pub rigs_apart: Option<RigsApart>,
    /// A suspected error in the logging of the records.
    pub suspicion: Option<Suspicion>,
    /// Lead \[s\] of the output before the input, as a delay fitted to the last model says.
    pub lead: Option<f64>,
    /// Channels whose steps matter to the final model.
    pub coarse: Vec<CoarseChannel>,
    /// The requested number of effects if it ended the search: further effects may be missing.
    /// `None` if the search ended by itself.
    pub stopped_by_request: Option<usize>,
    /// The requested time \[s\] if it ended the search.
    pub stopped_by_budget: Option<f64>,
}

impl Ledger {
    /// The ledger of a baseline model before the search.
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

    /// The mechanisms of what was added, in the order of the rounds.
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
    /// The channel with which it removes most.
    pub source: Source,
    /// What it removes by itself.
    pub alone: Share,
    /// What it removes beyond all others that are supported.
    pub beyond: Share,
    /// Whether, together with those found before it, it leaves at most half of the squared error that
    /// any other mechanism leaves.
    pub is_clear: bool,
    /// Other mechanisms that leave less than twice as much in its place.
    pub alternatives: Vec<Mechanism>,
    /// What it is a function of.
    pub variable: Variable,
    /// That function: its means over the variable, with what all mechanisms leave.
    pub curve: Vec<Bin>,
}

/// The mechanisms that a record supports, and what they leave.
#[derive(Debug, Clone)]
pub struct Supported {
    /// In the order in which they were found.
    pub all: Vec<Support>,
    /// Mean logarithm of the squared error on the halves that were left out.
    pub error: f64,
}

/// A file whose output is a multiple of what the gains of another one say.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct FileApart {
    /// The file.
    pub path: String,
    /// The file whose gains it is compared with.
    pub than: String,
    /// By what the output of those gains is to be multiplied.
    pub gain: f64,
    /// What is to be added to it, in the output's unit.
    pub offset: f64,
    /// The error of those gains on the file, as a share of its output's standard deviation.
    pub before: f64,
    /// The same with gain and offset.
    pub after: f64,
}

/// What gains of its own for each file make of files that are not of one rig.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigsApart {
    /// The error of the delivered model on the fit segment, as a share of the output's standard
    /// deviation there.
    pub together: f64,
    /// The same of the baseline model with gains of its own for each file.
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
    /// What the steps do to the model: rms of its output on the fit segment.
    pub error: f64,
    /// The names that the steps may account for.
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
