//! Closing the loop: fit, scan, add one effect, refit, compare, again.

use crate::catalogue::{candidates, declared, simplicity, Candidate};
use crate::channels::Prepared;
use crate::fit::{fit, glance, Segments, Solution};
use crate::scan::{blocks, scan, Finding, Regime, BLOCKS};
use crate::structure::Structure;
use nalgebra::{DMatrix, DVector};

/// At most this many effects are added.
pub const MOST_ROUNDS: usize = 8;

/// Why a candidate was not added.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Gate {
    /// The sign-flip test.
    P,
    /// It removed too little of the squared error after the joint refit.
    Share,
    /// It did not help on enough blocks.
    Blocks,
    /// It made the stop-check segment worse.
    StopCheck,
    /// The joint refit did not converge.
    Refit,
}

impl Gate {
    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::P => "not significant",
            Self::Share => "too small a share",
            Self::Blocks => "not on enough blocks",
            Self::StopCheck => "worse on the stop-check",
            Self::Refit => "no fit",
        }
    }
}

/// How far a name can be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Grade {
    /// A large share, no rival, on nearly all blocks, in the first three rounds.
    Strong,
    /// In between.
    Likely,
    /// A small share, rivals, a late round, or no p-value.
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
    /// Errors before.
    pub before: Segments,
    /// Errors after.
    pub after: Segments,
    /// The refitted model.
    pub solution: Solution,
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
    /// What was turned down in the last scan of each round.
    pub rejected: Vec<Rejection>,
    /// Whether the record had blocks enough for p-values, in the last scan.
    pub regime: Regime,
    /// Correlation time of the last residual \[s\].
    pub correlation_time: f64,
}

impl Ledger {
    /// The last accepted model.
    #[must_use]
    pub fn last(&self) -> &Solution {
        self.rounds.last().map_or(&self.declared, |r| &r.solution)
    }
}

/// The structure that a `--declare` list means.
///
/// # Errors
/// One sentence where a name is not known or comes twice.
pub fn structure(list: &[String], data: &Prepared) -> Result<Structure, String> {
    let mut structure = Structure::default();
    for name in list {
        if name == "bouc-wen" {
            structure.hysteresis = true;
        } else {
            let term = declared(name, data)?;
            if structure
                .terms
                .iter()
                .any(|t| t.effect.name() == term.effect.name() && t.source == term.source)
            {
                return Err(format!("--declare {name}: named twice"));
            }
            structure.terms.push(term);
        }
    }
    if structure.hysteresis {
        // The transmission brings its own constant.
        structure.terms.retain(|t| t.effect.name() != "offset");
    }
    Ok(structure)
}

/// Runs the loop. `progress` is told what is being done.
///
/// # Errors
/// One sentence where the declared model cannot be fitted at all.
pub fn close(
    data: &Prepared,
    structure: &Structure,
    mut progress: impl FnMut(&str),
) -> Result<Ledger, String> {
    progress("fitting the declared model");
    let declared = fit(data, structure, None, 0.0)
        .ok_or("the declared model cannot be fitted to this record")?;
    let mut ledger = Ledger {
        declared,
        rounds: Vec::new(),
        rejected: Vec::new(),
        regime: Regime::Blocks,
        correlation_time: 0.0,
    };
    while ledger.rounds.len() < MOST_ROUNDS {
        let now = ledger.last().clone();
        progress(&format!("round {}: scanning", ledger.rounds.len() + 1));
        let candidates = candidates(data, &now.structure, &now.residual);
        let result = scan(data, &now, &candidates);
        ledger.regime = result.regime;
        ledger.correlation_time = result.correlation_time;
        ledger.rejected = result
            .dropped
            .iter()
            .map(|&(candidate, p)| Rejection {
                candidate,
                gate: Gate::P,
                p: Some(p),
            })
            .collect();
        let mut accepted = None;
        for finding in &result.findings {
            progress(&format!(
                "round {}: trying {}",
                ledger.rounds.len() + 1,
                finding.candidate.term.effect.name()
            ));
            let Some(duel) = duel(data, &now, finding) else {
                ledger.rejected.push(Rejection {
                    candidate: finding.candidate,
                    gate: Gate::Refit,
                    p: finding.p,
                });
                continue;
            };
            // The whole set of starts is worth its time only where the quick one came near.
            let near = duel.rest <= 1.0 - 0.5 * least_share(result.regime);
            let tried = near
                .then(|| fit(data, &duel.structure, Some(&now), duel.stage_gain))
                .ok_or(Gate::Share);
            let verdict = tried
                .and_then(|new| new.ok_or(Gate::Refit))
                .and_then(|new| {
                    let better = judge(data, &now, &new, result.regime)?;
                    Ok((new, better))
                });
            match verdict {
                Ok((solution, blocks_better)) => {
                    accepted = Some((finding.p, duel, solution, blocks_better));
                    break;
                }
                Err(gate) => ledger.rejected.push(Rejection {
                    candidate: duel.candidate,
                    gate,
                    p: finding.p,
                }),
            }
        }
        let Some((p, duel, solution, blocks_better)) = accepted else {
            break;
        };
        let explained = 1.0 - solution.sse(data) / now.sse(data);
        let grade = grade(
            explained,
            p,
            &duel.rivals,
            blocks_better,
            ledger.rounds.len() + 1,
        );
        ledger.rounds.push(Round {
            candidate: duel.candidate,
            p,
            rivals: duel.rivals,
            grade,
            explained,
            blocks_better,
            before: now.rmse,
            after: solution.rmse,
            solution,
        });
    }
    Ok(ledger)
}

/// A rival removes at least this share of the squared error that the best removes ...
const RIVAL_SHARE: f64 = 0.90;
/// ... and leaves at most this many times what the best leaves. Where one effect is
/// right, it leaves noise, and what only resembles it leaves many times that.
const RIVAL_REST: f64 = 2.0;

/// Who explains it best once its shapes and the hysteresis are refitted.
struct Duel {
    candidate: Candidate,
    structure: Structure,
    stage_gain: f64,
    rivals: Vec<Candidate>,
    /// Squared error that is left, as a share of that before.
    rest: f64,
}

/// Refits every contender beside the present model; of those that do equally well the
/// simplest is named and the others are its rivals.
fn duel(data: &Prepared, now: &Solution, finding: &Finding) -> Option<Duel> {
    use rayon::prelude::*;
    let coarse = data.for_search(true);
    let (before, ..) = glance(&coarse, &now.structure, now, 0.0)?;
    let outcomes: Vec<Option<(f64, Structure, f64)>> = finding
        .contenders
        .par_iter()
        .map(|(candidate, coefficient)| {
            let mut structure = now.structure.clone();
            structure.terms.push(candidate.term);
            glance(&coarse, &structure, now, *coefficient)
        })
        .collect();
    let fitted: Vec<(Candidate, f64, Structure, f64)> = finding
        .contenders
        .iter()
        .zip(outcomes)
        .filter_map(|((candidate, _), outcome)| {
            outcome.map(|(sse, structure, gain)| (*candidate, sse, structure, gain))
        })
        .collect();
    let best = fitted
        .iter()
        .map(|(_, sse, ..)| *sse)
        .fold(f64::INFINITY, f64::min);
    let as_good =
        |sse: f64| before - sse >= RIVAL_SHARE * (before - best) && sse <= RIVAL_REST * best;
    let mut equals: Vec<(Candidate, f64, Structure, f64)> = fitted
        .into_iter()
        .filter(|(_, sse, ..)| as_good(*sse))
        .collect();
    equals.sort_by(|a, b| {
        simplicity(&a.0.term.effect)
            .cmp(&simplicity(&b.0.term.effect))
            .then(a.1.total_cmp(&b.1))
    });
    let mut equals = equals.into_iter();
    let (candidate, sse, structure, stage_gain) = equals.next()?;
    let mut rivals: Vec<Candidate> = Vec::new();
    for (rival, ..) in equals {
        let same = |other: &Candidate| {
            (other.family, other.term.source) == (rival.family, rival.term.source)
        };
        if !same(&candidate) && !rivals.iter().any(same) {
            rivals.push(rival);
        }
    }
    Some(Duel {
        candidate,
        structure,
        stage_gain,
        rivals,
        rest: sse / before,
    })
}

fn grade(
    explained: f64,
    p: Option<f64>,
    rivals: &[Candidate],
    blocks_better: usize,
    round: usize,
) -> Grade {
    let clear = rivals.is_empty() && p.is_some();
    if clear && explained >= 0.25 && blocks_better >= 13 && round <= 3 {
        Grade::Strong
    } else if rivals.len() <= 2 && explained >= 0.10 && blocks_better >= 11 && round <= 4 {
        Grade::Likely
    } else {
        Grade::Weak
    }
}

/// Of the share that an effect removes on the fit segment, so much it has to remove on
/// the stop-check.
const CARRIED_OVER: f64 = 0.25;

/// A share that searching a null has not been seen to reach.
const LARGE: f64 = 0.3;

/// Share of the squared error that an effect has to remove.
fn least_share(regime: Regime) -> f64 {
    match regime {
        Regime::Blocks => 0.05,
        Regime::Effect => 0.10,
    }
}

/// The gates of a round; the number of blocks on which the new model is better.
fn judge(data: &Prepared, old: &Solution, new: &Solution, regime: Regime) -> Result<usize, Gate> {
    if new.sse(data) > (1.0 - least_share(regime)) * old.sse(data) {
        return Err(Gate::Share);
    }
    let (before, after) = (left_out(data, old), left_out(data, new));
    let ratios: Vec<f64> = before
        .iter()
        .zip(&after)
        .map(|(b, a)| (b / a).ln())
        .collect();
    let better = ratios.iter().filter(|r| **r > 0.0).count();
    let enough = match regime {
        Regime::Blocks => {
            let n = ratios.len() as f64;
            let mean = ratios.iter().sum::<f64>() / n;
            let variance = ratios.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / (n - 1.0);
            mean > (variance / n).sqrt() && better >= 10
        }
        Regime::Effect => better >= 9,
    };
    if !enough {
        return Err(Gate::Blocks);
    }
    let holds = match regime {
        // The stop-check is the only part that no search has seen: what is real shows
        // there too. A mere "not worse" lets one coloured null in fifty through.
        Regime::Blocks => {
            let explained = 1.0 - new.sse(data) / old.sse(data);
            let there = 1.0 - (new.rmse.stop / old.rmse.stop).powi(2);
            // Where much is missing at once, one effect removed may uncover another just
            // there; what no null reaches need only not be worse.
            there >= CARRIED_OVER * explained
                || (explained >= LARGE && new.rmse.stop <= 1.02 * old.rmse.stop)
        }
        Regime::Effect => new.rmse.stop <= 1.10 * old.rmse.stop,
    };
    if !holds {
        return Err(Gate::StopCheck);
    }
    Ok(better)
}

/// Loss on each block with the gains fitted on the others, shapes frozen.
fn left_out(data: &Prepared, solution: &Solution) -> Vec<f64> {
    let rows = &data.split.fit;
    let blocks = blocks(data);
    let m = solution.columns.len();
    let scale: Vec<f64> = solution
        .columns
        .iter()
        .map(|c| {
            rows.iter()
                .map(|&i| c[i] * c[i])
                .sum::<f64>()
                .sqrt()
                .max(1e-300)
        })
        .collect();
    let parts: Vec<(DMatrix<f64>, DVector<f64>)> = blocks
        .iter()
        .map(|block| {
            let rows = &rows[block.clone()];
            let x = DMatrix::from_fn(rows.len(), m, |k, j| {
                solution.columns[j][rows[k]] / scale[j]
            });
            let y = DVector::from_iterator(rows.len(), rows.iter().map(|&i| solution.residual[i]));
            (x.tr_mul(&x), x.tr_mul(&y))
        })
        .collect();
    // Gains move from their fitted values by what the residual asks for.
    let mut losses = Vec::with_capacity(BLOCKS);
    for (out, block) in blocks.iter().enumerate() {
        let mut gram = DMatrix::zeros(m, m);
        let mut score = DVector::zeros(m);
        for (_, (g, s)) in parts.iter().enumerate().filter(|(b, _)| *b != out) {
            gram += g;
            score += s;
        }
        let change = nalgebra::SVD::new(gram, true, true)
            .solve(&score, 1e-10)
            .unwrap_or_else(|_| DVector::zeros(m));
        let loss: f64 = rows[block.clone()]
            .iter()
            .map(|&i| {
                let moved: f64 = (0..m)
                    .map(|j| change[j] * solution.columns[j][i] / scale[j])
                    .sum();
                (solution.residual[i] - moved).powi(2)
            })
            .sum();
        losses.push(loss.max(1e-300));
    }
    losses
}
