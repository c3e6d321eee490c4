//! One try: scan what a model leaves, and take the first finding that passes all gates.

use crate::catalogue::{candidates, Candidate};
use crate::channels::Prepared;
use crate::closing::{Gate, Rejection};
use crate::duel::duel;
use crate::fit::{fit, Solution};
use crate::gates::{judge, Evidence};
use crate::scan::{scan, Regime};

/// An effect that passed all gates, and the model with it.
#[derive(Debug, Clone)]
pub(crate) struct Accepted {
    pub(crate) candidate: Candidate,
    pub(crate) p: Option<f64>,
    pub(crate) rivals: Vec<Candidate>,
    pub(crate) blocks_better: usize,
    pub(crate) solution: Solution,
}

/// What came of it.
#[derive(Debug, Clone)]
pub(crate) struct Attempt {
    pub(crate) accepted: Option<Accepted>,
    pub(crate) rejected: Vec<Rejection>,
    pub(crate) regime: Regime,
    pub(crate) correlation_time: f64,
    /// What the scan chose before any test, with the coefficient each has by itself.
    pub(crate) forward: Vec<(Candidate, f64)>,
    /// Share of the squared error that all of these take together.
    pub(crate) forward_share: f64,
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
        forward: result.forward,
        forward_share: result.forward_share,
    };
    let evidence = Evidence {
        regime: result.regime,
        correlation_time: result.correlation_time,
        level: result.level,
    };
    let near = 1.0 - 0.5 * evidence.least_share(data, 1);
    for finding in &result.findings {
        progress(&format!("trying {}", finding.candidate.term.effect.name()));
        let Some(duel) = duel(data, now, finding) else {
            attempt.rejected.push(Rejection {
                candidate: finding.candidate,
                gate: Gate::Refit,
                p: finding.p,
            });
            continue;
        };
        // The whole set of starts is worth its time only where the quick one came near.
        let fitted = (duel.rest <= near)
            .then(|| fit(data, &duel.structure, Some(now), duel.stage_gain))
            .ok_or(Gate::Share);
        let verdict = fitted
            .and_then(|new| new.ok_or(Gate::Refit))
            .and_then(|new| {
                let better = judge(data, now, &new, &evidence)?;
                Ok((new, better))
            });
        match verdict {
            Ok((solution, blocks_better)) => {
                attempt.accepted = Some(Accepted {
                    candidate: duel.candidate,
                    p: finding.p,
                    rivals: duel.rivals,
                    blocks_better,
                    solution,
                });
                break;
            }
            Err(gate) => attempt.rejected.push(Rejection {
                candidate: duel.candidate,
                gate,
                p: finding.p,
            }),
        }
    }
    attempt
}
