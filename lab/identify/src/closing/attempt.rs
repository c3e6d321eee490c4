//! One try: scan what a model leaves, and take the first finding that passes all gates.

use super::duel::duel;
use super::gates::{judge, Evidence};
use crate::fit::{fit, Solution};
use crate::ledger::{Gate, Rejection, Round};
use crate::model::catalogue::{candidates, Candidate};
use crate::problem::Prepared;
use crate::score::scan::{scan, Finding, Regime};

/// An effect that passed all gates, and the model with it.
#[derive(Debug, Clone)]
pub(crate) struct Accepted {
    pub(crate) candidate: Candidate,
    pub(crate) p: Option<f64>,
    pub(crate) rivals: Vec<Candidate>,
    pub(crate) blocks_better: usize,
    pub(crate) solution: Solution,
}

impl From<&Round> for Accepted {
    fn from(round: &Round) -> Self {
        Self {
            candidate: round.candidate,
            p: round.p,
            rivals: round.rivals.clone(),
            blocks_better: round.blocks_better,
            solution: round.solution.clone(),
        }
    }
}

/// What came of it.
#[derive(Debug, Clone)]
pub(crate) struct Attempt {
    pub(crate) accepted: Option<Accepted>,
    pub(crate) rejected: Vec<Rejection>,
    pub(crate) regime: Regime,
    pub(crate) correlation_time: f64,
    /// Level of one test.
    pub(crate) level: f64,
    /// What the scan chose before any test, with the coefficient each has by itself.
    pub(crate) forward: Vec<(Candidate, f64)>,
    /// Share of the squared error that all of these take together.
    pub(crate) forward_share: f64,
}

impl Attempt {
    /// What its scan knows.
    pub(crate) fn evidence(&self) -> Evidence {
        Evidence {
            regime: self.regime,
            correlation_time: self.correlation_time,
            level: self.level,
        }
    }
}

/// Scans and tries.
pub(crate) fn attempt(data: &Prepared, now: &Solution, mut progress: impl FnMut(&str)) -> Attempt {
    progress("scanning");
    let tried = candidates(data, &now.structure, &now.residual);
    let result = scan(data, now, &tried);
    let mut attempt = Attempt {
        accepted: None,
        rejected: result
            .dropped
            .iter()
            .map(|&(candidate, p)| Rejection {
                candidate,
                gate: Gate::P,
                p: Some(p),
            })
            .collect(),
        regime: result.regime,
        correlation_time: result.correlation_time,
        level: result.level,
        forward: result.forward,
        forward_share: result.forward_share,
    };
    let evidence = attempt.evidence();
    'findings: for finding in &result.findings {
        progress(&format!("trying {}", finding.candidate.term.effect.name()));
        for finding in [Some(finding.clone()), by_itself(finding)]
            .into_iter()
            .flatten()
        {
            match passes(data, now, &finding, &evidence) {
                Ok(accepted) => {
                    attempt.accepted = Some(accepted);
                    break 'findings;
                }
                Err(rejection) => {
                    let own = rejection.candidate == finding.candidate;
                    attempt.rejected.push(*rejection);
                    if own {
                        break;
                    }
                }
            }
        }
    }
    attempt
}

/// The finding without those that contend with it, where there are such: who fits better
/// than it may be turned down where it stands.
fn by_itself(finding: &Finding) -> Option<Finding> {
    let mut own = finding.clone();
    own.contenders.truncate(1);
    (finding.contenders.len() > 1).then_some(own)
}

/// Puts who explains a finding best through the gates.
fn passes(
    data: &Prepared,
    now: &Solution,
    finding: &Finding,
    evidence: &Evidence,
) -> Result<Accepted, Box<Rejection>> {
    let rejected = |candidate: Candidate, gate: Gate| {
        let p = finding.p;
        Box::new(Rejection { candidate, gate, p })
    };
    let duel = duel(data, now, finding).ok_or(rejected(finding.candidate, Gate::Refit))?;
    // The whole set of starts is worth its time only where the quick one came near.
    let near = 1.0 - 0.5 * evidence.least_share(data, 1);
    if duel.rest > near {
        return Err(rejected(duel.candidate, Gate::Share));
    }
    let solution = fit(data, &duel.structure, Some(now), duel.stage_gain)
        .ok_or(rejected(duel.candidate, Gate::Refit))?;
    let blocks_better =
        judge(data, now, &solution, evidence).map_err(|gate| rejected(duel.candidate, gate))?;
    Ok(Accepted {
        candidate: duel.candidate,
        p: finding.p,
        rivals: duel.rivals,
        blocks_better,
        solution,
    })
}
