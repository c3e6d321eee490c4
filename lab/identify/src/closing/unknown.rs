//! What the catalogue does not explain: the residual depends on something, unnamed.
//!
//! A local bump (one bad tooth, a kinked cable, a worn spot) and a knock after each
//! reversal are in no catalogue. Eight effects together imitate any of them, and one of
//! them alone takes a part, under a wrong name. So the residual is laid over each measured
//! variable as a free curve of ten hats, tested by the same sign flips as the effects, and
//! the curve is compared with the best that one or two refitted names do. Where they
//! clearly fall short, the verdict is *unknown*: the variable is named, the curve is
//! printed, and it stays in the model as a table so that the error still falls.
//!
//! Two names may each be poor and together right: a friction and a drag make one curve over
//! the velocity, of which a viscous term takes the best part. So the pairs over the curve's
//! variable are tried as pairs.

use super::attempt::{Accepted, Attempt};
use super::gates::{judge, on_blocks};
use super::joint::these;
use crate::fit::projection::{rows, Span};
use crate::fit::{fit, fit_from, glance_from, Known, Solution};
use crate::ledger::Unknown;
use crate::model::catalogue::{candidates, Candidate};
use crate::model::structure::Structure;
use crate::model::{Table, Variable};
use crate::problem::Prepared;
use crate::score::hats::{is_phase, score, Scored, HATS};
use crate::score::scan::{blocks, correlation_samples, pairs, scan, Pair, Regime};

/// Level of the curve's test, divided among the variables.
const LEVEL: f64 = 0.01;
/// A curve takes at least this share of the squared error.
const SHARE: f64 = 0.2;
/// Names that take this share of what the curve takes explain it.
const EXPLAINED: f64 = 0.93;
/// A curve comes into question if to first order it takes this share of what the best takes.
const CLOSE: f64 = 0.7;
/// At most this many curves are refitted.
const CURVES: usize = 3;
/// A curve that passes the test is drawn with more hats where that leaves clearly less.
const FINER: [usize; 2] = [20, 40];
/// Clearly less: this factor for each ten more.
const CLEARLY: f64 = 1.1;
/// Names that leave more than this many times what the curve leaves do not explain it.
const LEFT: f64 = 2.0;
/// So many names are tried alone and by twos.
const NAMES: usize = 4;
/// What leaves more than this, in units of the noise floor, leaves more than noise.
const MUCH_LEFT: f64 = 2.0;
/// So many others are tried beside a pair.
const COMPANY: usize = 2;
/// So many pairs over the curve's variable are refitted.
const PAIRS: usize = 6;

/// What is behind a curve that passes the test.
pub(crate) enum Behind {
    /// Nothing that has a name.
    Unknown(Box<Unknown>),
    /// Names that were not found by themselves, through all gates beside each other.
    Names(Vec<Accepted>),
}

/// Once the library has nothing more: the curve that it does not explain, or the two of it
/// that do.
pub(crate) fn unnamed(data: &Prepared, now: &Solution, tried: &Attempt) -> Option<Behind> {
    let all = Variable::all(data, now.structure.hysteresis);
    let moved = moved(data, now);
    let found = curves(data, now, &moved, &all);
    let (solution, p) = fitted(data, now, &moved, &found, tried)?;
    let forward: Vec<Candidate> = tried.forward.iter().map(|(c, _)| *c).collect();
    let names = best_names(data, now, &forward, &now.structure)?;
    let two = best_pair(data, now, &solution);
    let least = two.as_ref().map_or(names, |(left, _)| left.min(names));
    let curve = rest(data, solution.sse(data), &solution, now);
    let Some(unknown) = finish(data, now, solution, p, least) else {
        return two.map(|(_, pair)| Behind::Names(these(data, now, &pair)));
    };
    if is_much(data, curve) {
        // Much is missing beside it: then the names are compared when they, too, have company.
        let more = two.and_then(|(_, pair)| with_company(data, now, &pair));
        if let Some((_, names)) = more.filter(|(left, _)| *left <= curve) {
            return Some(Behind::Names(names));
        }
    }
    Some(Behind::Unknown(Box::new(unknown)))
}

/// A variable on which a residual depends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dependence {
    /// Which.
    pub variable: Variable,
    /// Share of the squared error that a free curve of ten hats over it takes.
    pub share: f64,
    /// Exact sign-flip p-value of that curve; `None` where what it leaves is correlated for
    /// too long to be tested on sixteen blocks.
    pub p: Option<f64>,
}

/// On what a residual depends beside what is held fixed, the strongest first: variables
/// whose curve passes the test, and takes nearly as much as the best.
pub(crate) fn dependences(data: &Prepared, now: &Solution, held: &[Vec<f64>]) -> Vec<Dependence> {
    let all = Variable::all(data, now.structure.hysteresis);
    let held = Span::of(data, held.iter());
    let found = curves(data, now, &held, &all);
    found
        .into_iter()
        .filter_map(|scored| {
            let mut span = held.clone();
            for column in scored.table.columns(data, &now.eta)? {
                span.add(rows(data, &data.filtered(&column)));
            }
            let rest = span.off(rows(data, &now.residual));
            let tested = has_blocks(data, rest.as_slice());
            Some(Dependence {
                variable: scored.table.variable,
                share: scored.share,
                p: tested.then_some(scored.p),
            })
        })
        .collect()
}

/// In the place of a name that is about to be added: the curve over the same variable,
/// where neither that name nor a second one beside it comes near.
pub(crate) fn instead(
    data: &Prepared,
    now: &Solution,
    accepted: &Accepted,
    tried: &Attempt,
) -> Option<Unknown> {
    let own = accepted.candidate.variables();
    let taken = 1.0 - accepted.solution.sse(data) / now.sse(data);
    let moved = moved(data, now);
    let found: Vec<Scored> = curves(data, now, &moved, &own)
        .into_iter()
        .filter(|c| c.share >= 0.5 * taken)
        .collect();
    let (solution, p) = fitted(data, now, &moved, &found, tried)?;
    let alone = rest(data, accepted.solution.sse(data), &accepted.solution, now);
    let curve = rest(data, solution.sse(data), &solution, now);
    if is_much(data, curve) {
        // Let the name bring to light what else is missing.
        return None;
    }
    if alone <= LEFT * curve || !on_blocks(data, &accepted.solution, &solution, Regime::Blocks).1 {
        return None;
    }
    let beside = &accepted.solution;
    let others = candidates(data, &beside.structure, &beside.residual);
    let forward: Vec<Candidate> = scan(data, beside, &others)
        .forward
        .iter()
        .map(|(c, _)| *c)
        .collect();
    let beside = best_names(data, now, &forward, &beside.structure)?;
    let two = best_pair(data, now, &solution).map_or(beside, |(left, _)| left.min(beside));
    // Where much else is missing the curve, too, leaves most of it: then a name is no worse.
    if two <= LEFT * curve {
        return None;
    }
    finish(data, now, solution, p, two.min(alone))
}

/// The finding, unless the names explain the curve; `names` is the error that they leave.
fn finish(
    data: &Prepared,
    now: &Solution,
    solution: Solution,
    p: f64,
    names: f64,
) -> Option<Unknown> {
    let before = now.sse(data);
    let after = rest(data, solution.sse(data), &solution, now);
    let q = ((before - names) / (before - after)).max(0.0);
    (!explains(before, names, after)).then(|| Unknown {
        variable: solution
            .structure
            .table
            .as_ref()
            .map_or(Variable::Time, |t| t.variable),
        share: 1.0 - solution.sse(data) / before,
        p,
        q,
        before: now.rmse,
        after: solution.rmse,
        solution,
    })
}

/// Whether what names leave of an error is as good as what the curve leaves.
fn explains(before: f64, names: f64, curve: f64) -> bool {
    before - names >= EXPLAINED * (before - curve) && names <= LEFT * curve
}

/// All that a model can move.
fn moved(data: &Prepared, now: &Solution) -> Span {
    Span::of(data, now.columns.iter().chain(&now.tangents))
}

/// Squared error as it would be without what parameters take by chance: each takes the
/// noise of one independent value, of which the filter leaves two a period of its cut-off.
fn rest(data: &Prepared, sse: f64, model: &Solution, now: &Solution) -> f64 {
    let more = model.free.len() + model.gains.len();
    penalised(
        data,
        sse,
        more.saturating_sub(now.free.len() + now.gains.len()),
    )
}

fn penalised(data: &Prepared, sse: f64, parameters: usize) -> f64 {
    let step = data.dt * data.stride as f64;
    let values = data.split.fit.len() as f64 * step * 2.0 * data.cutoff;
    sse * (1.0 + parameters as f64 / (values - parameters as f64).max(1.0))
}

/// The curves that pass the test, the largest first.
fn curves(data: &Prepared, now: &Solution, moved: &Span, variables: &[Variable]) -> Vec<Scored> {
    use rayon::prelude::*;
    if now.structure.table.is_some() {
        return Vec::new();
    }
    let level = LEVEL / Variable::all(data, now.structure.hysteresis).len() as f64;
    let scored: Vec<Option<Scored>> = variables
        .par_iter()
        .map(|&variable| score(data, now, moved, variable, HATS))
        .collect();
    let mut found: Vec<Scored> = scored
        .into_iter()
        .flatten()
        .filter(|s| s.p <= level && !is_phase(data, now, s.table.variable))
        .collect();
    found.sort_by(|a, b| b.share.total_cmp(&a.share));
    let best = found.first().map_or(0.0, |s| s.share);
    found.retain(|s| s.share >= CLOSE * best && s.share >= 0.5 * SHARE);
    found.truncate(CURVES);
    found
}

/// The best of the curves, refitted beside the model, where it passes the gates.
fn fitted(
    data: &Prepared,
    now: &Solution,
    moved: &Span,
    found: &[Scored],
    tried: &Attempt,
) -> Option<(Solution, f64)> {
    use rayon::prelude::*;
    let coarse = data.for_search(true);
    let with = |table: &Table| Structure {
        table: Some(table.clone()),
        ..now.structure.clone()
    };
    // What is finer keeps the p-value of the curve that was tested.
    let drawn: Vec<Scored> = found
        .iter()
        .flat_map(|tested| {
            let variable = tested.table.variable;
            let finer = FINER.map(|count| score(data, now, moved, variable, count));
            let finer = finer.into_iter().flatten();
            let finer = finer.map(|scored| Scored {
                p: tested.p,
                ..scored
            });
            std::iter::once(tested.clone()).chain(finer)
        })
        .collect();
    let rests: Vec<Option<f64>> = drawn
        .par_iter()
        .map(|scored| {
            let structure = with(&scored.table);
            let (sse, ..) = glance_from(&coarse, &structure, &Known::of(now), 0.0)?;
            Some(penalised(data, sse, scored.table.shapes.len()))
        })
        .collect();
    let (best, _) = drawn
        .iter()
        .zip(rests)
        .filter_map(|(scored, rest)| Some((scored, rest?)))
        .map(|(scored, rest)| {
            (
                scored,
                rest * CLEARLY.powi(scored.table.knots.len().div_ceil(HATS) as i32),
            )
        })
        .min_by(|a, b| a.1.total_cmp(&b.1))?;
    let solution = fit(data, &with(&best.table), Some(now), 0.0)?;
    let mut evidence = tried.evidence();
    evidence.regime = regime(data, &solution);
    let share = 1.0 - solution.sse(data) / now.sse(data);
    let passes = evidence.regime == Regime::Blocks
        && share >= SHARE
        && judge(data, now, &solution, &evidence).is_ok();
    passes.then_some((solution, best.p))
}

/// Whether there are blocks enough for a test beside the curve: before it is taken off,
/// it counts as correlation itself.
fn regime(data: &Prepared, solution: &Solution) -> Regime {
    let rest: Vec<f64> = data
        .split
        .fit
        .iter()
        .map(|&i| solution.residual[i])
        .collect();
    match has_blocks(data, &rest) {
        true => Regime::Blocks,
        false => Regime::Effect,
    }
}

/// Whether sixteen blocks are long enough for what is correlated like that.
fn has_blocks(data: &Prepared, rest: &[f64]) -> bool {
    let shortest = blocks(data).iter().map(ExactSizeIterator::len).min();
    shortest.unwrap_or(0) as f64 >= 3.0 * correlation_samples(rest)
}

/// The pair over the variable of a curve that leaves least, and what it leaves.
fn best_pair(data: &Prepared, now: &Solution, curve: &Solution) -> Option<(f64, Pair)> {
    use rayon::prelude::*;
    let variable = curve.structure.table.as_ref()?.variable;
    let coarse = data.for_search(true);
    let tried = over(data, now, &[variable], PAIRS);
    let rests: Vec<Option<f64>> = tried
        .par_iter()
        .map(|pair| {
            left(
                data,
                &coarse,
                now,
                &now.structure,
                pair.iter().map(|(c, _)| *c),
            )
        })
        .collect();
    let rests = rests.into_iter().zip(tried);
    rests
        .filter_map(|(left, pair)| Some((left?, pair)))
        .min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Whether so much is left that something else must be missing.
fn is_much(data: &Prepared, sse: f64) -> bool {
    sse > data.split.fit.len() as f64 * (MUCH_LEFT * data.noise_floor).powi(2)
}

/// The pair and what the scan finds beside it, through all gates, and what they leave.
fn with_company(data: &Prepared, now: &Solution, pair: &Pair) -> Option<(f64, Vec<Accepted>)> {
    let mut structure = now.structure.clone();
    structure.terms.extend(pair.iter().map(|(c, _)| c.term));
    let both = fit_from(data, &structure, Some(&Known::of(now)), 0.0)?;
    let others = candidates(data, &both.structure, &both.residual);
    let beside = scan(data, &both, &others).forward;
    let set: Vec<(Candidate, f64)> = pair
        .iter()
        .copied()
        .chain(beside.into_iter().take(COMPANY))
        .collect();
    let names = these(data, now, &set);
    let model = &names.last()?.solution;
    Some((rest(data, model.sse(data), model, now), names))
}

/// The pairs of names over any of the variables that take most, at their trial shapes.
pub(crate) fn over(
    data: &Prepared,
    now: &Solution,
    variables: &[Variable],
    most: usize,
) -> Vec<Pair> {
    let mut over = candidates(data, &now.structure, &now.residual);
    over.retain(|candidate| {
        let own = candidate.variables();
        variables.iter().any(|variable| own.contains(variable))
    });
    pairs(data, now, &over, most)
}

/// What names leave beside what `base` has, after a short search.
fn left(
    data: &Prepared,
    coarse: &Prepared,
    now: &Solution,
    base: &Structure,
    names: impl Iterator<Item = Candidate>,
) -> Option<f64> {
    let mut structure = base.clone();
    structure.terms.extend(names.map(|c| c.term));
    let (sse, ..) = glance_from(coarse, &structure, &Known::of(now), 0.0)?;
    let added = structure.free(data).len() + structure.linear();
    let had = now.free.len() + now.gains.len();
    Some(penalised(data, sse, added.saturating_sub(had)))
}

/// The least that one or two names leave, beside what `base` has.
fn best_names(
    data: &Prepared,
    now: &Solution,
    names: &[Candidate],
    base: &Structure,
) -> Option<f64> {
    use rayon::prelude::*;
    let coarse = data.for_search(true);
    let names = &names[..names.len().min(NAMES)];
    let mut sets: Vec<Vec<Candidate>> = names.iter().map(|c| vec![*c]).collect();
    if base.terms.len() == now.structure.terms.len() {
        for (i, one) in names.iter().enumerate() {
            sets.extend(names[i + 1..].iter().map(|other| vec![*one, *other]));
        }
    }
    let before = now.sse(data);
    let rests: Vec<Option<f64>> = sets
        .par_iter()
        .map(|set| left(data, &coarse, now, base, set.iter().copied()))
        .collect();
    Some(rests.into_iter().flatten().fold(before, f64::min))
}
