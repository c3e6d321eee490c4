//! What a search has found: every round, every rejection, and what has no name.

use crate::fit::{Segments, Solution};
use crate::model::catalogue::Candidate;
use crate::model::structure::FitTerm;
use crate::model::Variable;
use crate::score::blocks::Regime;

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
    /// It had been added, but what was added later does its work as well.
    Superseded,
}

impl Gate {
    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::P => "not significant",
            Self::Blocks => "not on enough blocks",
            Self::StopCheck => "worse on the stop-check",
            Self::Superseded => "superseded by later ones",
        }
    }
}

/// How far a name can be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Grade {
    /// Found again in at least half of the half-records, and nothing does as well in its place.
    Firm,
    /// One of several effects that would explain this.
    Weak,
}

/// One accepted effect.
#[derive(Debug, Clone)]
pub struct Round {
    /// The effect that was added.
    pub candidate: Candidate,
    /// Exact sign-flip p-value of the scan; `None` in effect mode.
    pub p: Option<f64>,
    /// Others that explain the same as well, once fitted: the data cannot tell.
    pub rivals: Vec<Candidate>,
    /// Grade of the name.
    pub grade: Grade,
    /// Share of the squared error that the refit removed.
    pub explained: f64,
    /// Blocks of sixteen on which it helped.
    pub blocks_better: usize,
    /// In how many of a hundred half-records a search finds it again.
    pub recurs: usize,
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

/// The whole ledger.
#[derive(Debug, Clone)]
pub struct Ledger {
    /// The declared model, fitted.
    pub declared: Solution,
    /// What was added.
    pub rounds: Vec<Round>,
    /// What was found after these and raises the error on blocks that are left out: it is no
    /// part of the model.
    pub beyond: Vec<Round>,
    /// What was turned down in the last scan of each round.
    pub rejected: Vec<Rejection>,
    /// What is there besides and has no name.
    pub unknown: Option<Unknown>,
    /// Whether the record had blocks enough for p-values, in the last scan and wherever
    /// an effect was added.
    pub regime: Regime,
    /// Correlation time of the last residual \[s\].
    pub correlation_time: f64,
    /// Whether the output follows the integral of the input: then no effect is looked for.
    pub integrates: bool,
    /// The largest number of effects that was asked for, where that ended the search: more
    /// may be missing, and nothing has looked for it. `None` where the search ended by itself.
    pub stopped_by_request: Option<usize>,
    /// The time \[s\] that was asked for, where that ended the search.
    pub stopped_by_budget: Option<f64>,
}

impl Ledger {
    /// The ledger of a declared model before any effect is looked for.
    #[must_use]
    pub fn of(declared: Solution) -> Self {
        Self {
            declared,
            rounds: Vec::new(),
            beyond: Vec::new(),
            rejected: Vec::new(),
            unknown: None,
            regime: Regime::Blocks,
            correlation_time: 0.0,
            integrates: false,
            stopped_by_request: None,
            stopped_by_budget: None,
        }
    }

    /// Whether a limit that was asked for ended the search.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.stopped_by_request.is_some() || self.stopped_by_budget.is_some()
    }

    /// That the search was ended by request, in a sentence; `None` where it ended by itself.
    #[must_use]
    pub fn stopped_words(&self) -> Option<String> {
        if let Some(seconds) = self.stopped_by_budget {
            return Some(format!(
                "The search stopped after {seconds} s, as asked: this is the best model so far, and what else is missing was not looked for."
            ));
        }
        Some(match self.stopped_by_request? {
            0 => "No effect was looked for, as asked.".to_owned(),
            1 => "The search stopped after one effect, as asked: what else is missing was not looked for.".to_owned(),
            most => format!(
                "The search stopped after {most} effects, as asked: what else is missing was not looked for."
            ),
        })
    }

    /// The last accepted model, a table for what has no name included.
    #[must_use]
    pub fn last(&self) -> &Solution {
        match &self.unknown {
            Some(unknown) => &unknown.solution,
            None => self.named(),
        }
    }

    /// The last accepted model of effects that have a name.
    #[must_use]
    pub fn named(&self) -> &Solution {
        self.rounds.last().map_or(&self.declared, |r| &r.solution)
    }
}

/// A dependence that has no name.
#[derive(Debug, Clone)]
pub struct Unknown {
    /// On what the residual depends.
    pub variable: Variable,
    /// Share of the squared error that the curve takes.
    pub share: f64,
    /// Exact sign-flip p-value of the curve.
    pub p: f64,
    /// What the best one or two names take, of what the curve takes.
    pub q: f64,
    /// Errors before.
    pub before: Segments,
    /// Errors after.
    pub after: Segments,
    /// The model with the curve as its table.
    pub solution: Solution,
}
