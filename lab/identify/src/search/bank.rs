//! Columns of all candidates, computed once and kept between rounds.
//!
//! A candidate of the catalogue is one column at a trial shape. A candidate that reduces the SSE
//! also has the derivatives of that column with respect to its shapes: a linear step along them
//! replaces a finer grid. A curve over one variable is twenty hat functions.

use super::gram::Grams;
use crate::fit::projection::{rows, Span};
use crate::fit::Solution;
use crate::model::catalogue::{candidates, Candidate};
use crate::model::structure::{FitTerm, Range, Role};
use crate::model::Variable;
use crate::problem::filter::ABREAST;
use crate::problem::{Prepared, Stretch};
use crate::score::hats::{hats, is_phase, HATS};
use crate::score::tones;
use bowden::effect::Effect;
use bowden::model::Source;
use rayon::prelude::*;
use std::collections::HashSet;
use std::sync::Arc;

/// Number of step times that are tried in addition to the catalogue's.
const STEPS: usize = 4;
/// Step of the difference quotients, on the unbounded scale that a range is mapped to.
const DIFFERENCE: f64 = 1e-3;

/// Identity of a member of a set, independent of its shapes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Identity {
    /// An effect that reads a channel.
    Name(&'static str, Source),
    /// A free curve over a variable.
    Curve(Variable),
}

impl Identity {
    pub(super) fn of(term: &FitTerm) -> Self {
        Self::Name(term.effect.name(), term.source)
    }
}

/// The parameter that a slope is the derivative in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Own {
    Shape(usize),
    Origin,
}

/// Derivative of a candidate's column in one of its parameters, per unit of the unbounded
/// scale that the range of the parameter is mapped to.
#[derive(Debug, Clone)]
pub(super) struct Slope {
    pub(super) own: Own,
    pub(super) range: Range,
    pub(super) column: Arc<Stretch>,
}

/// A variable and the filtered hat functions over it.
pub(super) type Curve = (Variable, Vec<Arc<Stretch>>);

/// Keeps the columns that depend neither on the hysteresis state nor on the output.
pub(super) struct Bank<'a> {
    /// The whole record, which determines the candidates and the ranges of their shapes.
    pub(super) data: &'a Prepared,
    /// The part of it that the fit sees; all columns are computed on it.
    pub(super) seen: &'a Prepared,
    variables: Vec<Variable>,
    values: Vec<(FitTerm, Arc<Stretch>)>,
    slopes: Vec<(FitTerm, Vec<Slope>)>,
    curves: Vec<Curve>,
    /// Candidates of the latest linearisation.
    asked: Vec<FitTerm>,
    /// Columns of the latest linearisation that are the same in the next one, with their
    /// products.
    pub(super) products: (Vec<Arc<Stretch>>, Grams),
}

/// Whether the column of a term is the same for all models of this record.
fn is_fixed(term: &FitTerm) -> bool {
    let effect = &term.effect;
    !effect.reads_eta() && !effect.is_input_stage() && !effect.is_output_stage()
}

fn is_finite(column: &[f64]) -> bool {
    column.iter().all(|v| v.is_finite())
}

impl<'a> Bank<'a> {
    pub(super) fn new((data, seen): (&'a Prepared, &'a Prepared), declared: &Solution) -> Self {
        let all = Variable::all(data, declared.structure.hysteresis);
        Self {
            data,
            seen,
            variables: all
                .into_par_iter()
                .filter(|v| !is_phase(data, declared, *v))
                .collect(),
            values: Vec::new(),
            slopes: Vec::new(),
            curves: Vec::new(),
            asked: Vec::new(),
            products: Default::default(),
        }
    }

    /// Every candidate at its trial shapes with its column, for a model on the whole record
    /// (`now`) and on the rows that the fit sees (`seen`).
    pub(super) fn names(
        &mut self,
        now: &Solution,
        seen: &Solution,
    ) -> Vec<(Candidate, Arc<Stretch>)> {
        let mut tried = candidates(self.data, &now.structure, &now.residual);
        tried.extend(steps(self.data, now, &tried));
        tried.extend(tone(self.data, now));
        self.asked = tried.iter().map(|c| c.term).collect();
        let known = |c: &Candidate| self.values.iter().find(|(t, _)| *t == c.term);
        let mut made: Vec<Option<Arc<Stretch>>> = tried
            .iter()
            .map(|c| known(c).map(|(_, column)| Arc::clone(column)))
            .collect();
        let anew: Vec<usize> = (0..tried.len()).filter(|&i| made[i].is_none()).collect();
        let columns = filtered(self.seen, &anew, |&i| seen.adds(self.seen, &tried[i].term));
        for (i, column) in anew.into_iter().zip(columns) {
            made[i] = column;
        }
        let pairs = tried.into_iter().zip(made);
        let all: Vec<_> = pairs.filter_map(|(c, column)| Some((c, column?))).collect();
        for (c, column) in all.iter().filter(|(c, _)| is_fixed(&c.term)) {
            if self.values.iter().all(|(t, _)| *t != c.term) {
                self.values.push((c.term, Arc::clone(column)));
            }
        }
        all
    }

    /// Keeps the columns that are the same for all models, with their products. Candidates that
    /// were not asked for are dropped: tones and steps belong to one residual.
    pub(super) fn keep(&mut self, columns: &[Arc<Stretch>], grams: &Grams) {
        self.values.retain(|(t, _)| self.asked.contains(t));
        self.slopes.retain(|(t, _)| self.asked.contains(t));
        let values = self.values.iter().map(|(_, column)| column);
        let slopes = self
            .slopes
            .iter()
            .flat_map(|(_, own)| own.iter().map(|s| &s.column));
        let curves = self.curves.iter().flat_map(|(_, hats)| hats);
        let fixed: HashSet<usize> = values
            .chain(slopes)
            .chain(curves)
            .map(|column| Arc::as_ptr(column) as usize)
            .collect();
        let is_fixed = |&place: &usize| fixed.contains(&(Arc::as_ptr(&columns[place]) as usize));
        let places: Vec<usize> = (0..columns.len()).filter(is_fixed).collect();
        let kept = places.iter().map(|&place| Arc::clone(&columns[place]));
        self.products = (kept.collect(), grams.only(&places));
    }

    /// The slopes of some candidates in their shapes and origins.
    pub(super) fn slopes(&mut self, now: &Solution, wanted: &[FitTerm]) -> Vec<Vec<Slope>> {
        let mut made: Vec<Vec<Slope>> = Vec::with_capacity(wanted.len());
        let mut anew: Vec<(usize, Own, Range)> = Vec::new();
        for (index, term) in wanted.iter().enumerate() {
            let asked = parameters(self.data, now, term);
            let is_same = |(t, known): &&(FitTerm, Vec<Slope>)| {
                t == term && known.iter().map(|s| (s.own, s.range)).eq(asked.clone())
            };
            let known = self.slopes.iter().find(is_same);
            made.push(known.map_or_else(Vec::new, |(_, slopes)| slopes.clone()));
            if known.is_none() {
                anew.extend(asked.into_iter().map(|(own, range)| (index, own, range)));
            }
        }
        let columns = filtered(self.seen, &anew, |&(index, own, range)| {
            slope(self.seen, now, &wanted[index], own, range)
        });
        for ((index, own, range), column) in anew.into_iter().zip(columns) {
            made[index].extend(column.map(|column| Slope { own, range, column }));
        }
        for (term, own) in wanted.iter().zip(&made).filter(|(t, _)| is_fixed(t)) {
            self.slopes.retain(|(t, _)| t != term);
            self.slopes.push((*term, own.clone()));
        }
        made
    }

    /// The hat functions over each variable, except those that only encode the phase of the motion.
    pub(super) fn curves(&mut self, now: &Solution) -> Vec<Curve> {
        let made: Vec<Option<Curve>> = self
            .variables
            .par_iter()
            .map(|&v| {
                if let Some(known) = self.curves.iter().find(|(own, _)| *own == v) {
                    return Some(known.clone());
                }
                // Ten hats miss a bump of width 0.08 of the range.
                let raw = hats(self.seen, now, v, 2 * HATS)?.columns(self.seen, &now.eta)?;
                let raw: Vec<&[f64]> = raw.iter().map(|c| &c[..]).collect();
                let columns = self.seen.filtered_all(&raw);
                let is_usable = columns.iter().all(|c| is_finite(c));
                let columns = columns.into_iter().map(|c| Arc::new(c.into()));
                is_usable.then(|| (v, columns.collect()))
            })
            .collect();
        let made: Vec<_> = made.into_iter().flatten().collect();
        for (v, columns) in made.iter().filter(|(v, _)| *v != Variable::Eta) {
            if self.curves.iter().all(|(own, _)| own != v) {
                self.curves.push((*v, columns.clone()));
            }
        }
        made
    }
}

/// Free shapes and origin of a candidate that is added to a model, with their ranges.
fn parameters(data: &Prepared, now: &Solution, term: &FitTerm) -> Vec<(Own, Range)> {
    let mut structure = now.structure.clone();
    let last = structure.terms.push(*term);
    let free = structure.free(data).into_iter();
    free.filter_map(|f| match f.role {
        // A step in time has no derivative: the lattice of step times is refined instead.
        Role::Shape { term: of, index } if of == last && !term.is_moment(index) => {
            Some((Own::Shape(index), f.range))
        }
        Role::Origin { term: of } if of == last => Some((Own::Origin, f.range)),
        _ => None,
    })
    .collect()
}

/// Filters columns of the work grid, several at once; `None` for a column that is absent or
/// not finite.
fn filtered<T: Sync>(
    data: &Prepared,
    wanted: &[T],
    raw: impl Fn(&T) -> Option<Vec<f64>> + Sync,
) -> Vec<Option<Arc<Stretch>>> {
    let few = |some: &[T]| {
        let raw: Vec<Option<Vec<f64>>> = some.iter().map(&raw).collect();
        let present: Vec<&[f64]> = raw.iter().flatten().map(Vec::as_slice).collect();
        let mut smooth = data.filtered_all(&present).into_iter();
        let mut of = |is: bool| is.then(|| smooth.next()).flatten();
        let all: Vec<_> = raw.iter().map(|column| of(column.is_some())).collect();
        all.into_iter()
            .map(|column| column.filter(|c| is_finite(c)).map(|c| Arc::new(c.into())))
            .collect::<Vec<_>>()
    };
    let all: Vec<Vec<_>> = wanted.par_chunks(ABREAST).map(few).collect();
    all.into_iter().flatten().collect()
}

/// A slope as a central difference, before the filter.
fn slope(
    data: &Prepared,
    now: &Solution,
    term: &FitTerm,
    own: Own,
    range: Range,
) -> Option<Vec<f64>> {
    let moved = |v: f64| match own {
        Own::Shape(index) => Some(FitTerm {
            effect: term.effect.with_shape(index, v).ok()?,
            ..*term
        }),
        Own::Origin => Some(FitTerm { origin: v, ..*term }),
    };
    let value = match own {
        Own::Shape(index) => term.effect.shape(index)?,
        Own::Origin => term.origin,
    };
    let u = range.on_line(value);
    let at = |u: f64| now.adds(data, &moved(range.decode(u))?);
    let (mut up, down) = (at(u + DIFFERENCE)?, at(u - DIFFERENCE)?);
    for (a, b) in up.iter_mut().zip(&down) {
        *a = (*a - b) / (2.0 * DIFFERENCE);
    }
    Some(up)
}

/// A tone at the strongest line of the residual's spectrum.
fn tone(data: &Prepared, now: &Solution) -> Option<Candidate> {
    if data.pieces.len() > 1 {
        // A tone has no common phase in records that were taken one after the other.
        return None;
    }
    let (frequency, _) = tones::strongest(data, &now.residual)?;
    let term = tones::term(data, &now.residual, frequency)?;
    Some(term.into())
}

/// Steps in time at the maxima of the SSE reduction over all rows.
///
/// The column of a step at row `k` is the sum of the unit vectors from `k` on, so its products
/// with the residual and with the model's columns are cumulative sums.
fn steps(data: &Prepared, now: &Solution, tried: &[Candidate]) -> Vec<Candidate> {
    let Some(like) = tried.iter().find(|c| c.family == "pretension") else {
        return Vec::new();
    };
    let span = Span::of(data, now.columns.iter().chain(&now.tangents));
    let residual = span.off(rows(data, &now.residual));
    let n = residual.len();
    let margin = n / 50;
    let mut gains = vec![0.0; n];
    let (mut score, mut sums) = (0.0, vec![0.0; span.basis().len()]);
    for k in (0..n).rev() {
        score += residual[k];
        let mut norm = (n - k) as f64;
        for (sum, q) in sums.iter_mut().zip(span.basis()) {
            *sum += q[k];
            norm -= *sum * *sum;
        }
        if k >= margin && k + margin < n && norm > 1e-3 * (n - k) as f64 {
            gains[k] = score * score / norm;
        }
    }
    let mut peaks: Vec<usize> = (1..n.saturating_sub(1))
        .filter(|&k| gains[k] > gains[k - 1] && gains[k] >= gains[k + 1])
        .collect();
    peaks.sort_by(|&a, &b| gains[b].total_cmp(&gains[a]));
    let mut apart: Vec<usize> = Vec::new();
    for k in peaks {
        if apart.len() < STEPS && apart.iter().all(|&other| k.abs_diff(other) > margin) {
            apart.push(k);
        }
    }
    apart
        .into_iter()
        .filter_map(|k| {
            let moment = data.moment(data.split.fit[k]);
            Some(Candidate {
                term: FitTerm {
                    effect: Effect::try_from_name("pretension", &[moment]).ok()?,
                    ..like.term
                },
                family: "pretension",
            })
        })
        .collect()
}
