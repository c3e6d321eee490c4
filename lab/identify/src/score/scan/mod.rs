//! Which effect is missing? Block-score sign-flip selection.
//!
//! The residual of the fitted model is projected, with every candidate column, off all
//! that the model can already move. What is left is scored on sixteen blocks of equal
//! path length. Under the null a block's score is as likely positive as negative, for
//! whatever colour the residual has inside a block, so the exact distribution over all
//! 2^15 sign patterns is the test. Nothing here is random.

use crate::fit::Solution;
use crate::model::catalogue::Candidate;
use crate::problem::Prepared;
use bowden::effect::Family;
use nalgebra::DVector;

mod blocks;
mod pairs;
pub(crate) use blocks::share_of_patterns;
pub use blocks::{blocks, correlation_samples, sign_flip_p, BLOCKS};
pub(crate) use pairs::{pairs, Pair};

/// A candidate with less of its squared norm left after projection is not excited.
const EXCITED: f64 = 1e-4;
/// Forward selection goes on while a candidate takes this share of the squared error.
const FORWARD_SHARE: f64 = 0.01;
/// Forward selection takes at most this many.
const FORWARD_TERMS: usize = 8;
/// A candidate that is tested by itself takes at least this share.
const ALONE_SHARE: f64 = 0.05;
/// Level of the test, before division by families and channels.
const LEVEL: f64 = 0.01;
/// A contender explains at least this share of what the best explains, at its trial
/// shape: once refitted it may still be the better one ...
const CONTENDER_GAIN: f64 = 0.40;
/// ... and its contribution has at least this squared correlation with the best's.
const CONTENDER_CORRELATION: f64 = 0.30;
/// At most this many contend.
const CONTENDERS: usize = 8;

/// Whether the record has blocks enough for a test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// Sixteen blocks, each at least three correlation times long: p-values.
    Blocks,
    /// Fewer: effects are accepted by size and repetition, the verdict is under-excited.
    Effect,
}

/// A candidate that survived, and those that could take its place.
#[derive(Debug, Clone)]
pub struct Finding {
    /// The effect to be tried.
    pub candidate: Candidate,
    /// Exact sign-flip p-value; `None` in effect mode.
    pub p: Option<f64>,
    /// Share of the squared error that the column takes, given the other findings.
    pub share: f64,
    /// Candidates that may explain the same, itself first, each with its coefficient.
    pub contenders: Vec<(Candidate, f64)>,
}

/// Result of one scan.
#[derive(Debug, Clone)]
pub struct Scan {
    /// With or without p-values.
    pub regime: Regime,
    /// Survivors, the largest first.
    pub findings: Vec<Finding>,
    /// What was chosen in the forward pass and dropped by the test.
    pub dropped: Vec<(Candidate, f64)>,
    /// Correlation time of what the forward set leaves \[s\].
    pub correlation_time: f64,
    /// Level of one test: what is left of the whole level for each family and channel.
    pub level: f64,
    /// What was chosen before any test, with the coefficient that each has by itself.
    pub forward: Vec<(Candidate, f64)>,
    /// Share of the squared error that the forward set takes at its trial shapes.
    pub forward_share: f64,
}

/// Columns on the fit rows, orthogonal to all that the model can move.
struct Workspace {
    /// Of unit norm before the projection.
    columns: Vec<DVector<f64>>,
    norms: Vec<f64>,
    kept: Vec<usize>,
    residual: DVector<f64>,
    blocks: Vec<std::ops::Range<usize>>,
}

/// Modified Gram-Schmidt, twice, with columns that depend on others left out.
fn basis(columns: impl Iterator<Item = DVector<f64>>) -> Vec<DVector<f64>> {
    let mut basis: Vec<DVector<f64>> = Vec::new();
    for mut v in columns {
        let norm = v.norm();
        if !(norm > 0.0 && norm.is_finite()) {
            continue;
        }
        for _ in 0..2 {
            off(&mut v, &basis);
        }
        let left = v.norm();
        if left > 1e-6 * norm {
            basis.push(v / left);
        }
    }
    basis
}

fn off(v: &mut DVector<f64>, basis: &[DVector<f64>]) {
    for q in basis {
        let dot = q.dot(v);
        v.axpy(-dot, q, 1.0);
    }
}

fn on_rows(rows: &[usize], column: &[f64]) -> DVector<f64> {
    DVector::from_iterator(rows.len(), rows.iter().map(|&i| column[i]))
}

impl Workspace {
    fn new(data: &Prepared, solution: &Solution, candidates: &[Candidate]) -> Self {
        use rayon::prelude::*;
        let rows = &data.split.fit;
        let tangent_space = solution
            .columns
            .iter()
            .chain(&solution.tangents)
            .map(|c| on_rows(rows, c));
        let moved = basis(tangent_space);
        let mut residual = on_rows(rows, &solution.residual);
        off(&mut residual, &moved);
        let projected: Vec<Option<(DVector<f64>, f64)>> = candidates
            .par_iter()
            .map(|candidate| {
                let term = &candidate.term;
                let raw = solution.adds(data, term)?;
                let mut column = on_rows(rows, &data.filtered(&raw));
                let norm = column.norm();
                if !(norm.is_finite() && norm > 0.0) {
                    return None;
                }
                // The constant part is no excitation: it must not hide behind the norm.
                let mean = column.mean();
                let varying = column.map(|v| v - mean).norm_squared();
                off(&mut column, &moved);
                off(&mut column, &moved);
                let measure = if varying > 1e-12 * norm * norm {
                    varying
                } else {
                    norm * norm
                };
                (column.norm_squared() > EXCITED * measure).then(|| (column / norm, norm))
            })
            .collect();
        let (mut columns, mut norms, mut kept) = (Vec::new(), Vec::new(), Vec::new());
        for (index, column) in projected.into_iter().enumerate() {
            if let Some((column, norm)) = column {
                columns.push(column);
                norms.push(norm);
                kept.push(index);
            }
        }
        Self {
            columns,
            norms,
            kept,
            residual,
            blocks: blocks(data),
        }
    }

    /// Greedy by gain; positions in `columns`.
    fn forward(&self, candidates: &[Candidate]) -> (Vec<usize>, DVector<f64>) {
        let mut residual = self.residual.clone();
        let mut columns = self.columns.clone();
        let mut chosen: Vec<usize> = Vec::new();
        while chosen.len() < FORWARD_TERMS {
            let sse = residual.norm_squared();
            let mut best: Option<(usize, f64)> = None;
            for (j, column) in columns.iter().enumerate() {
                let norm = column.norm_squared();
                if chosen.contains(&j) || norm < EXCITED * self.columns[j].norm_squared() {
                    continue;
                }
                let gain = column.dot(&residual).powi(2) / norm;
                if best.is_none_or(|(_, g)| gain > g) {
                    best = Some((j, gain));
                }
            }
            let Some((j, gain)) = best else { break };
            if !(sse > 0.0 && gain / sse >= FORWARD_SHARE) {
                break;
            }
            chosen.push(j);
            let q = columns[j].normalize();
            let dot = q.dot(&residual);
            residual.axpy(-dot, &q, 1.0);
            for column in &mut columns {
                let dot = q.dot(column);
                column.axpy(-dot, &q, 1.0);
            }
        }
        // Siblings kill each other in the backward pass: one candidate a family and channel.
        let mut single: Vec<usize> = Vec::new();
        for &j in &chosen {
            let of = |k: usize| {
                (
                    candidates[self.kept[k]].family,
                    candidates[self.kept[k]].term.source,
                )
            };
            if single.iter().all(|&k| of(k) != of(j)) {
                single.push(j);
            }
        }
        (single, residual)
    }

    /// Column `j` and the residual, both orthogonal to `others`.
    fn partial(
        &self,
        j: usize,
        others: &[DVector<f64>],
        residual: &DVector<f64>,
    ) -> (DVector<f64>, f64, f64) {
        let mut column = self.columns[j].clone();
        off(&mut column, others);
        off(&mut column, others);
        let norm = column.norm_squared();
        let score = column.dot(residual);
        (column, score, norm)
    }

    fn scores(&self, column: &DVector<f64>, residual: &DVector<f64>) -> [f64; BLOCKS] {
        let mut scores = [0.0; BLOCKS];
        for (score, block) in scores.iter_mut().zip(&self.blocks) {
            *score = block.clone().map(|k| column[k] * residual[k]).sum();
        }
        scores
    }

    fn without(&self, set: &[usize], j: usize) -> (Vec<DVector<f64>>, DVector<f64>) {
        let others = basis(
            set.iter()
                .filter(|&&k| k != j)
                .map(|&k| self.columns[k].clone()),
        );
        let mut residual = self.residual.clone();
        off(&mut residual, &others);
        (others, residual)
    }
}

/// The best candidate of each family and channel, tested by itself.
fn alone(
    space: &Workspace,
    candidates: &[Candidate],
    tried: &[usize],
    level: f64,
) -> (Vec<usize>, Vec<Option<f64>>) {
    let of = |k: usize| {
        (
            candidates[space.kept[k]].family,
            candidates[space.kept[k]].term.source,
        )
    };
    let sse = space.residual.norm_squared();
    let gain = |k: usize| {
        let (_, score, norm) = space.partial(k, &[], &space.residual);
        score * score / norm
    };
    let mut best: Vec<(usize, f64)> = Vec::new();
    for k in 0..space.columns.len() {
        let now = gain(k);
        if now < ALONE_SHARE * sse || tried == [k] {
            continue;
        }
        match best.iter_mut().find(|(b, _)| of(*b) == of(k)) {
            Some(slot) if slot.1 < now => *slot = (k, now),
            Some(_) => {}
            None => best.push((k, now)),
        }
    }
    best.into_iter()
        .map(|(k, _)| {
            (
                k,
                sign_flip_p(&space.scores(&space.columns[k], &space.residual)),
            )
        })
        .filter(|(_, p)| *p <= level)
        .map(|(k, p)| (k, Some(p)))
        .unzip()
}

/// Periods over the range of motion up to which a ripple may be but a bent line.
const FEW_PERIODS: f64 = 5.0;

/// A ripple of few periods contends with every curve of the same position, however
/// little that curve does at its trial shape: its bends move when it is refitted.
fn lines(
    data: &Prepared,
    space: &Workspace,
    candidates: &[Candidate],
    j: usize,
    named: &[(Candidate, f64)],
) -> Vec<(Candidate, f64)> {
    let ripple = candidates[space.kept[j]].term;
    let range = 2.0 * data.channel(ripple.source).map_or(0.0, |c| c.reach);
    let periods = ripple.effect.shape(0).unwrap_or(0.0) * range / (2.0 * std::f64::consts::PI);
    if ripple.effect.family() != Family::Ripple || periods > FEW_PERIODS {
        return Vec::new();
    }
    let mut best: Vec<(f64, Candidate, f64)> = Vec::new();
    for k in 0..space.columns.len() {
        let candidate = candidates[space.kept[k]];
        let name = candidate.term.effect.name();
        let curve = matches!(candidate.family, Family::Stiffness | Family::Saturation)
            || name == "dead-zone";
        let known = named.iter().any(|(c, _)| c.is_like(&candidate));
        if !curve || known || candidate.term.source != ripple.source {
            continue;
        }
        let (_, score, norm) = space.partial(k, &[], &space.residual);
        let entry = (
            score * score / norm,
            candidate,
            score / norm / space.norms[k],
        );
        match best
            .iter_mut()
            .find(|(_, c, _)| c.term.effect.name() == name)
        {
            Some(slot) if slot.0 < entry.0 => *slot = entry,
            Some(_) => {}
            None => best.push(entry),
        }
    }
    best.into_iter().map(|(_, c, gain)| (c, gain)).collect()
}

/// One pass over all candidates.
#[must_use]
#[allow(clippy::too_many_lines)] // The search that replaces it takes it apart.
pub fn scan(data: &Prepared, solution: &Solution, candidates: &[Candidate]) -> Scan {
    let space = Workspace::new(data, solution, candidates);
    let (mut set, rest) = space.forward(candidates);
    let of = |j: usize| candidates[space.kept[j]];

    let step = data.dt * data.stride as f64;
    let correlation = correlation_samples(rest.as_slice());
    let shortest = space
        .blocks
        .iter()
        .map(ExactSizeIterator::len)
        .min()
        .unwrap_or(0);
    let regime = if shortest as f64 >= 3.0 * correlation {
        Regime::Blocks
    } else {
        Regime::Effect
    };
    let forward: Vec<(Candidate, f64)> = set
        .iter()
        .map(|&j| {
            let (_, score, norm) = space.partial(j, &[], &space.residual);
            (of(j), score / norm / space.norms[j])
        })
        .collect();
    let forward_share = 1.0 - rest.norm_squared() / space.residual.norm_squared();

    let tests = {
        let mut families: Vec<_> = candidates.iter().map(|c| c.family).collect();
        families.sort_unstable();
        families.dedup();
        let mut sources: Vec<_> = candidates.iter().map(|c| c.term.source).collect();
        sources.sort_by_key(|s| format!("{s:?}"));
        sources.dedup();
        (families.len() * sources.len()).max(1) as f64
    };
    let p_of = |set: &[usize], j: usize| {
        let (others, residual) = space.without(set, j);
        let (column, ..) = space.partial(j, &others, &residual);
        sign_flip_p(&space.scores(&column, &residual))
    };
    let mut dropped = Vec::new();
    let mut p_values: Vec<Option<f64>> = vec![None; set.len()];
    let mut jointly = true;
    if regime == Regime::Blocks {
        let together = set.clone();
        loop {
            let p: Vec<f64> = set.iter().map(|&j| p_of(&set, j)).collect();
            let worst = (0..set.len()).max_by(|&a, &b| p[a].total_cmp(&p[b]));
            match worst {
                Some(w) if p[w] > LEVEL / tests => {
                    dropped.push((of(set[w]), p[w]));
                    set.remove(w);
                }
                _ => {
                    p_values = p.into_iter().map(Some).collect();
                    break;
                }
            }
        }
        if set.is_empty() {
            // Two that stand in for a third may have killed each other: each family's
            // best is tried once more by itself, still at the same corrected level.
            (set, p_values) = alone(&space, candidates, &together, LEVEL / tests);
            jointly = false;
            dropped.retain(|(candidate, _)| set.iter().all(|&j| of(j) != *candidate));
        }
    }

    let sse = space.residual.norm_squared();
    let mut findings: Vec<(f64, Finding)> = Vec::new();
    for (&j, p) in set.iter().zip(p_values) {
        let (others, residual) = space.without(if jointly { &set } else { &[] }, j);
        let (column, score, norm) = space.partial(j, &others, &residual);
        let gain = score * score / norm;
        // One effect is added at a time, so a contender may do as well either beside the
        // other findings or in their stead.
        let mut contenders: Vec<(f64, usize, f64)> = Vec::new();
        let alone = space.partial(j, &[], &space.residual);
        let alone_gain = alone.1 * alone.1 / alone.2;
        for k in 0..space.columns.len() {
            let close =
                |column: &DVector<f64>, norm: f64, least: f64, other: &(DVector<f64>, f64, f64)| {
                    let (other, score, other_norm) = other;
                    *other_norm >= EXCITED * space.columns[k].norm_squared()
                        && score * score / other_norm >= CONTENDER_GAIN * least
                        && column.dot(other).powi(2) >= CONTENDER_CORRELATION * norm * other_norm
                };
            let by_itself = space.partial(k, &[], &space.residual);
            let beside = space.partial(k, &others, &residual);
            if k == j
                || close(&alone.0, alone.2, alone_gain, &by_itself)
                || close(&column, norm, gain, &beside)
            {
                let coefficient = by_itself.1 / by_itself.2 / space.norms[k];
                contenders.push((by_itself.1 * by_itself.1 / by_itself.2, k, coefficient));
            }
        }
        contenders.sort_by(|a, b| (b.1 == j).cmp(&(a.1 == j)).then(b.0.total_cmp(&a.0)));
        let mut named: Vec<(Candidate, f64)> = Vec::new();
        for (_, k, coefficient) in contenders {
            let candidate = of(k);
            let known = named.iter().any(|(c, _)| c.is_like(&candidate));
            if !known && named.len() < CONTENDERS {
                named.push((candidate, coefficient));
            }
        }
        named.extend(lines(data, &space, candidates, j, &named));
        // One at a time: first the one that takes most when it comes alone.
        findings.push((
            alone_gain,
            Finding {
                candidate: of(j),
                p,
                share: gain / sse,
                contenders: named,
            },
        ));
    }
    findings.sort_by(|a, b| b.0.total_cmp(&a.0));
    Scan {
        regime,
        findings: findings.into_iter().map(|(_, f)| f).collect(),
        dropped,
        correlation_time: correlation * step,
        level: LEVEL / tests,
        forward,
        forward_share,
    }
}

#[cfg(test)]
mod tests;
