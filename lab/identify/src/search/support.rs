//! Which mechanisms a record supports: blocks of columns, judged on blocks of the record that were
//! left out.
//!
//! The block of a mechanism is everything that belongs to it: the candidates of the catalogue at
//! their trial shapes, and a curve over each of its variables. So a mechanism is compared with
//! another one before any formula is chosen. Every comparison is a ridge regression (Hoerl and
//! Kennard, 1970) on the Gram matrices of one linearisation, fitted on half of the record and
//! judged on the other half.

use super::asked_of;
use super::carries_over::halves;
use super::gram::DEPENDENT;
use super::linear::{Group, Linear, Member};
use super::{is_at_noise, policy};
use crate::algebra::{coefficients, dot};
use crate::fit::settle::settle;
use crate::fit::{fit, Solution};
use crate::ledger::{Ledger, Share, Support, Supported};
use crate::model::mechanism::Mechanism;
use crate::model::structure::Structure;
use crate::model::Variable;
use crate::problem::Prepared;
use crate::score::binned::{binned, Bin};
use crate::score::blocks::{blocks, Regime};
use crate::score::hats::HATS;
use bowden::effect::Motion;
use bowden::model::Source;
use nalgebra::DMatrix;
use rayon::prelude::*;
use std::f64::consts::LN_2;

/// Ridge on a column of a mechanism, as a share of its squared norm.
const RIDGE: f64 = 1e-3;

/// The mechanisms that a record supports in addition to a baseline model. `None` if the search added
/// nothing, or if the model cannot be evaluated.
///
/// If the residual of the last model of the search is only noise, its terms identify the
/// mechanisms, which are compared as they are. Otherwise the mechanisms are found before any term:
/// they are added one after another while the squared error on left-out blocks falls by a factor of
/// 1.25. The hysteresis is that of the baseline or of the last model, whichever has the smaller
/// error.
pub(super) fn supported(data: &Prepared, ledger: &Ledger) -> Option<Supported> {
    let own = ledger.mechanisms(data);
    if own.is_empty() {
        return None;
    }
    let is_complete = is_at_noise(data, ledger.last());
    let of = |solution: &Solution| {
        let answer = |linear: &mut Linear| {
            let comparison = Comparison::new(linear);
            let mut found = comparison.found();
            if is_complete || found.is_empty() {
                found = own.iter().map(|&m| Found::given(m, &mut found)).collect();
            }
            comparison.answer(found)
        };
        asked_of(data, solution, answer)
    };
    let at_last = moved(data, &ledger.declared, ledger.last()).and_then(|solution| of(&solution));
    let at_own = of(&ledger.declared);
    at_own
        .into_iter()
        .chain(at_last)
        .min_by(|a, b| a.error.total_cmp(&b.error))
}

/// The mechanisms that a record supports by itself in addition to a baseline model, before any term
/// is sought. `None` if the baseline model cannot be fitted to it.
pub fn alone(data: &Prepared, structure: &Structure) -> Option<Supported> {
    let declared = fit(data, structure, None, 0.0)?;
    asked_of(data, &declared, |linear| {
        let comparison = Comparison::new(linear);
        comparison.answer(comparison.found())
    })
}

/// The baseline model with the parameters that it has in the last one.
fn moved(data: &Prepared, declared: &Solution, last: &Solution) -> Option<Solution> {
    let values = declared.free.iter().zip(&declared.values);
    let values: Vec<f64> = values
        .map(|(free, &value)| last.value(free.role).unwrap_or(value))
        .collect();
    (values != declared.values)
        .then(|| settle(data, &declared.structure, &declared.free, values))
        .flatten()
}

/// A mechanism of a set.
struct Found {
    mechanism: Mechanism,
    is_clear: bool,
    alternatives: Vec<Mechanism>,
}

impl Found {
    /// A mechanism that its terms identify, with its results if it was also found without terms.
    fn given(mechanism: Mechanism, found: &mut Vec<Self>) -> Self {
        let known = found.iter().position(|own| own.mechanism == mechanism);
        known.map_or(
            Self {
                mechanism,
                is_clear: false,
                alternatives: Vec::new(),
            },
            |k| found.swap_remove(k),
        )
    }
}

fn set_of(found: &[Found]) -> Vec<Mechanism> {
    found.iter().map(|one| one.mechanism).collect()
}

/// The source that a column of a mechanism reads.
struct Column {
    mechanism: Mechanism,
    source: Source,
}

/// All columns of one linearisation, and their products on the halves.
struct Comparison<'a> {
    linear: &'a Linear<'a>,
    /// The mechanism that each column belongs to; `None` for columns of the baseline model.
    columns: Vec<Option<Column>>,
    /// Positions in the linearisation of the columns and, last, of the target.
    places: Vec<usize>,
    /// Precision of each coefficient if all rows of the record are fitted.
    precision: Vec<f64>,
    /// Products of all columns and the target on all rows ...
    whole: DMatrix<f64>,
    /// ... and on each half, with its share of the rows.
    halves: Vec<(DMatrix<f64>, f64)>,
}

fn owner(data: &Prepared, group: &Group) -> Column {
    match &group.member {
        Member::Name(candidate) => Column {
            mechanism: Mechanism::of(candidate.term.effect.name(), candidate.family),
            source: candidate.term.source,
        },
        Member::Curve(variable) => Column {
            mechanism: Mechanism::of_variable(data, *variable),
            source: variable.source(),
        },
    }
}

/// The hysteresis state times the square of each position: friction that rises towards both ends of
/// a stroke. No effect of the catalogue is even in the position and odd in the direction.
fn by_place(linear: &Linear) -> Vec<(Source, Vec<f64>)> {
    let (data, eta) = (linear.seen, &linear.now.eta);
    if eta.iter().all(|eta| *eta == 0.0) {
        return Vec::new();
    }
    let sources = Variable::all(data, false)
        .into_iter()
        .filter_map(|variable| match variable {
            Variable::DirectedPosition(source) => Some(source),
            _ => None,
        });
    let column = |source| {
        let channel = data.channel(source)?;
        let far = |m: &Motion<f64>| (m.position - channel.middle).powi(2);
        let pairs = channel.motion.iter().zip(eta);
        Some((source, pairs.map(|(m, eta)| far(m) * eta).collect()))
    };
    sources.filter_map(column).collect()
}

/// The products of some columns and, last, the target. Only the lower triangle is used.
#[derive(Clone)]
struct Lower(DMatrix<f64>);

impl Lower {
    fn of(products: &DMatrix<f64>, columns: &[usize], target: usize) -> Self {
        let all: Vec<usize> = columns.iter().copied().chain([target]).collect();
        let mut own = DMatrix::zeros(all.len(), all.len());
        for (k, &j) in all.iter().enumerate() {
            let column = products.column(j);
            for (product, &i) in own.column_mut(k).iter_mut().zip(&all).skip(k) {
                *product = column[i];
            }
        }
        Self(own)
    }

    /// Squared norm of the sum of all columns with these weights.
    fn squared_error(&self, weights: &[f64]) -> f64 {
        let of = |(k, own): (usize, &f64)| {
            let products = &self.0.column(k).data.into_slice()[k..];
            own * (2.0 * dot(products, &weights[k..]) - own * products[0])
        };
        weights.iter().enumerate().map(of).sum()
    }
}

impl<'a> Comparison<'a> {
    fn new(linear: &'a mut Linear<'_>) -> Self {
        let (sources, by_place): (Vec<Source>, Vec<Vec<f64>>) =
            by_place(linear).into_iter().unzip();
        let by_place = linear.add(&by_place);
        let linear = &*linear;
        let (own, target) = linear.baseline();
        let grams = &linear.grams;
        let rows = linear.seen.split.fit.len().max(1) as f64;
        // A step of one on the unbounded scale of a parameter has unit variance.
        let rest = grams.squared_error(&own, target) * grams.unit(target) / rows;
        let of_own = |column: &usize| match linear.free.contains(column) {
            true => rest / grams.unit(*column),
            // Columns that depend on each other share their gain.
            false => DEPENDENT,
        };
        let mut places = own.clone();
        let mut columns: Vec<Option<Column>> = own.iter().map(|_| None).collect();
        let mut precision: Vec<f64> = own.iter().map(of_own).collect();
        for group in &linear.groups {
            // Of a name the column at its trial shapes; its slopes are columns of other names.
            let most = if group.is_curve() {
                group.columns.len()
            } else {
                1
            };
            for &place in &group.columns[..most] {
                if !places.contains(&place) {
                    places.push(place);
                    columns.push(Some(owner(linear.data, group)));
                    precision.push(RIDGE);
                }
            }
        }
        for (place, source) in by_place.into_iter().zip(sources) {
            places.push(place);
            let mechanism = Mechanism::HysteresisShape;
            columns.push(Some(Column { mechanism, source }));
            precision.push(RIDGE);
        }
        places.push(target);
        let size = places.len();
        let parts: Vec<DMatrix<f64>> = (0..grams.blocks())
            .into_par_iter()
            .map(|block| {
                DMatrix::from_fn(size, size, |i, j| {
                    grams.on_block(block, places[i], places[j])
                })
            })
            .collect();
        let lengths: Vec<f64> = blocks(linear.data).iter().map(|b| b.len() as f64).collect();
        let sum = |some: &[usize]| {
            let zero = DMatrix::zeros(size, size);
            some.iter().fold(zero, |sum, &block| sum + &parts[block])
        };
        let halves = halves(parts.len(), policy::HALVES);
        let of_half = |half: &Vec<usize>| {
            let own: f64 = half.iter().map(|&block| lengths[block]).sum();
            (sum(half), own / rows)
        };
        Self {
            linear,
            columns,
            whole: sum(&(0..parts.len()).collect::<Vec<_>>()),
            halves: halves.par_iter().map(of_half).collect(),
            places,
            precision,
        }
    }

    /// The columns of the baseline model and those for which `holds` is true.
    fn used(&self, holds: impl Fn(&Column) -> bool) -> Vec<usize> {
        let is_used = |i: &usize| self.columns[*i].as_ref().is_none_or(&holds);
        (0..self.columns.len()).filter(is_used).collect()
    }

    /// Gains of some columns, and −1 for the target, from their products on a share of the rows.
    fn weights(&self, used: &[usize], mut products: Lower, share: f64) -> Option<Vec<f64>> {
        for (k, &i) in used.iter().enumerate() {
            let share = match self.columns[i] {
                Some(_) => share,
                None => 1.0,
            };
            products.0[(k, k)] += share * self.precision[i];
        }
        let size = products.0.nrows();
        let mut weights = coefficients(products.0.as_mut_slice(), size)?;
        weights.push(-1.0);
        Some(weights)
    }

    /// Squared error on the rows left out of each half, per row, with the columns for which
    /// `holds` is true added to the baseline model.
    fn errors(&self, holds: impl Fn(&Column) -> bool) -> Vec<f64> {
        let used = self.used(holds);
        let target = self.columns.len();
        let whole = Lower::of(&self.whole, &used, target);
        let of = |(half, share): &(DMatrix<f64>, f64)| {
            let mut rest = whole.clone();
            let half = Lower::of(half, &used, target);
            rest.0 -= &half.0;
            let weights = self.weights(&used, half, *share);
            weights.map_or(f64::INFINITY, |weights| {
                rest.squared_error(&weights).max(f64::MIN_POSITIVE) / (1.0 - share)
            })
        };
        self.halves.par_iter().map(of).collect()
    }

    fn error(&self, set: &[Mechanism]) -> f64 {
        mean_log(&self.errors(|column| set.contains(&column.mechanism)))
    }

    /// Forward selection of mechanisms, each step followed by a backward one. Mechanisms that are
    /// functions of time alone come last.
    fn found(&self) -> Vec<Found> {
        let mut found = Vec::new();
        let mut now = self.error(&[]);
        let (others, time) = Mechanism::ALL.split_at(Mechanism::ALL.len() - 1);
        for pool in [others, time] {
            while let Some((error, next)) = self.next(&set_of(&found), now, pool) {
                found.push(next);
                now = self.without_needless(&mut found, error);
            }
        }
        found
    }

    /// The mechanism with the smallest error together with a set, if it is worth adding.
    fn next(&self, set: &[Mechanism], now: f64, pool: &[Mechanism]) -> Option<(f64, Found)> {
        let is_new = |m: &&Mechanism| {
            let is_own = |column: &Column| column.mechanism == **m;
            !set.contains(m) && self.columns.iter().flatten().any(is_own)
        };
        let with = |&m: &Mechanism| (self.error(&[set, &[m]].concat()), m);
        let mut with: Vec<(f64, Mechanism)> = pool.iter().filter(is_new).map(with).collect();
        with.sort_by(|a, b| a.0.total_cmp(&b.0));
        let &(best, mechanism) = with.first()?;
        let is_worth = |error: f64| now - error >= policy::CURVE_AFTER_NAMES;
        let near = with[1..].iter().filter(|other| other.0 < best + LN_2);
        let is_clear = near.clone().next().is_none() && now - best >= LN_2;
        let near = near.filter(|other| is_worth(other.0));
        is_worth(best).then(|| {
            let own = Found {
                mechanism,
                is_clear: is_clear && self.linear.regime == Regime::Blocks,
                alternatives: near.map(|other| other.1).collect(),
            };
            (best, own)
        })
    }

    /// Removes mechanisms before the last one that no longer reduce the error enough; returns the
    /// error.
    fn without_needless(&self, found: &mut Vec<Found>, mut now: f64) -> f64 {
        while found.len() > 1 {
            let without = |k: usize| {
                let mut rest = set_of(found);
                rest.remove(k);
                (self.error(&rest), k)
            };
            let all = (0..found.len() - 1).map(without);
            match all.min_by(|a, b| a.0.total_cmp(&b.0)) {
                Some((error, k)) if error < now + policy::CURVE_AFTER_NAMES => {
                    found.remove(k);
                    now = error;
                }
                _ => break,
            }
        }
        now
    }

    /// The shares and curves of a set.
    fn answer(&self, found: Vec<Found>) -> Supported {
        let set = set_of(&found);
        let base = self.errors(|_| false);
        let all = self.errors(|column| set.contains(&column.mechanism));
        let used = self.used(|column| set.contains(&column.mechanism));
        let products = Lower::of(&self.whole, &used, self.columns.len());
        let weights = self.weights(&used, products, 1.0).map(|own| {
            let mut all = vec![0.0; self.columns.len() + 1];
            let used = used.iter().copied().chain([self.columns.len()]);
            used.zip(own).for_each(|(i, weight)| all[i] = weight);
            all
        });
        let of = |own: Found| {
            let mechanism = own.mechanism;
            let alone = self.errors(|column| column.mechanism == mechanism);
            let without = self.errors(|c| c.mechanism != mechanism && set.contains(&c.mechanism));
            let source = self.source(&set, mechanism);
            let variable = mechanism.variable(source);
            let curve = weights
                .as_ref()
                .map(|weights| self.curve(weights, mechanism, variable));
            Support {
                mechanism,
                source,
                alone: share(&base, &alone, &base),
                beyond: share(&without, &all, &base),
                is_clear: own.is_clear,
                alternatives: own.alternatives,
                variable,
                curve: curve.unwrap_or_default(),
            }
        };
        Supported {
            all: found.into_iter().map(of).collect(),
            error: mean_log(&all),
        }
    }

    /// The channel whose columns alone give a mechanism of a set the smallest error.
    fn source(&self, set: &[Mechanism], mechanism: Mechanism) -> Source {
        if mechanism == Mechanism::HysteresisShape {
            return Source::Input;
        }
        let mut sources: Vec<Source> = Vec::new();
        let own = |column: &&Column| column.mechanism == mechanism;
        for column in self.columns.iter().flatten().filter(own) {
            if !sources.contains(&column.source) {
                sources.push(column.source);
            }
        }
        let with = |source: Source| {
            let errors = self.errors(|c| match c.mechanism == mechanism {
                true => c.source == source,
                false => set.contains(&c.mechanism),
            });
            (mean_log(&errors), source)
        };
        match sources[..] {
            [only] => only,
            _ => {
                let all = sources.into_iter().map(with);
                let best = all.min_by(|a, b| a.0.total_cmp(&b.0));
                best.map_or(Source::Input, |(_, source)| source)
            }
        }
    }

    /// The contribution of a mechanism's columns plus the residual, over the mechanism's variable.
    fn curve(&self, weights: &[f64], mechanism: Mechanism, variable: Variable) -> Vec<Bin> {
        let (linear, seen) = (self.linear, self.linear.seen);
        let Some(values) = variable.values(seen, &linear.now.eta) else {
            return Vec::new();
        };
        let rows = &seen.split.fit;
        let mut sum = vec![0.0; rows.len()];
        for (i, &place) in self.places.iter().enumerate() {
            let is_own = matches!(self.columns.get(i), Some(Some(c)) if c.mechanism == mechanism);
            // The residual is the target without all columns.
            let share = match is_own {
                true => 0.0,
                false => -weights[i] / linear.grams.unit(place).sqrt(),
            };
            if share != 0.0 {
                let column = &linear.columns.all[place];
                sum.iter_mut()
                    .zip(rows)
                    .for_each(|(s, &row)| *s += share * column[row]);
            }
        }
        let unit = linear.unit().sqrt();
        sum.iter_mut().for_each(|s| *s *= unit);
        let mean = sum.iter().sum::<f64>() / sum.len().max(1) as f64;
        sum.iter_mut().for_each(|s| *s -= mean);
        let values: Vec<f64> = rows.iter().map(|&row| values[row * seen.stride]).collect();
        binned(&values, &[sum], HATS)
    }
}

fn mean_log(errors: &[f64]) -> f64 {
    errors.iter().map(|e| e.ln()).sum::<f64>() / errors.len().max(1) as f64
}

/// Reduction of an error from `before` to `after`, as a share of the baseline's squared error. Both
/// errors are limited to that of the baseline.
fn share(before: &[f64], after: &[f64], baseline: &[f64]) -> Share {
    let capped = |errors: &[f64]| -> Vec<f64> {
        let pairs = errors.iter().zip(baseline);
        pairs.map(|(error, most)| (error / most).min(1.0)).collect()
    };
    let (before, after) = (capped(before), capped(after));
    let value = mean_log(&before).exp() - mean_log(&after).exp();
    let mut each: Vec<f64> = before.iter().zip(&after).map(|(b, a)| b - a).collect();
    each.sort_by(f64::total_cmp);
    let at = |quarter: usize| each.get(quarter * each.len() / 4).copied();
    Share {
        value,
        quartiles: [at(1), at(3)].map(|share| share.unwrap_or(value)),
    }
}
