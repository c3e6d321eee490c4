//! A model and all candidates to first order: one Gram matrix.

use super::bank::{Bank, Identity, Slope};
use super::gram::{Grams, Swept};
use super::kept::Kept;
use super::policy;
use super::present::Present;
use super::sought::{Choice, Sought};
use crate::fit::Solution;
use crate::model::catalogue::Candidate;
use crate::model::Variable;
use crate::problem::{Prepared, Stretch};
use crate::scale::{LEVEL, TWENTIETH};
use crate::score::blocks::{blocks, Regime};
use crate::score::hats::HATS;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::collections::HashMap;
use std::sync::Arc;

/// Slopes of a candidate, and curves, are computed from this share of the least reduction on:
/// at a lattice shape a candidate reaches 0.4 of its reduction at the fitted shape.
const WORTH: f64 = 0.4;
/// Number of best pairs whose members may get their slopes.
const PAIRED: usize = 24;

/// A candidate that is added as one piece. A name holds its starts in all files by value, as
/// every term does: there are a few hundred members, half a kilobyte each.
#[allow(clippy::large_enum_variant)]
#[derive(Debug, Clone)]
pub(super) enum Member {
    Name(Candidate),
    Curve(Variable),
}

/// Columns that are added and removed together.
#[derive(Debug, Clone)]
pub(super) struct Group {
    pub(super) member: Member,
    pub(super) columns: Vec<usize>,
    /// For a name: the slopes in `columns[1..]`.
    pub(super) slopes: Vec<Slope>,
    pub(super) freedoms: usize,
}

impl Group {
    pub(super) fn identity(&self) -> Identity {
        match &self.member {
            Member::Name(c) => Identity::of(&c.term),
            Member::Curve(v) => Identity::Curve(*v),
        }
    }

    pub(super) fn is_curve(&self) -> bool {
        matches!(self.member, Member::Curve(_))
    }

    pub(super) fn candidate(&self) -> Option<Candidate> {
        match &self.member {
            Member::Name(c) => Some(*c),
            Member::Curve(_) => None,
        }
    }

    /// Whether both have the same identity, with any shapes; any two curves are alike.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        self.identity() == other.identity() || (self.is_curve() && other.is_curve())
    }
}

/// The columns, without repetition.
#[derive(Default)]
pub(super) struct Places {
    pub(super) all: Vec<Arc<Stretch>>,
    /// Index by address.
    known: HashMap<usize, usize>,
}

impl Places {
    fn of(all: Vec<Arc<Stretch>>) -> Self {
        let address = |(place, column)| (Arc::as_ptr(column) as usize, place);
        let known = all.iter().enumerate().map(address).collect();
        Self { all, known }
    }

    /// The index of a column, which is added if it is new.
    fn place(&mut self, column: Arc<Stretch>) -> usize {
        let next = self.all.len();
        let place = *self
            .known
            .entry(Arc::as_ptr(&column) as usize)
            .or_insert(next);
        if place == next {
            self.all.push(column);
        }
        place
    }
}

/// Prices of the members of a set in the criterion.
pub(super) struct Prices {
    /// Least reduction of ln SSE, by degrees of freedom.
    by_freedoms: Vec<f64>,
    /// Least reduction of ln SSE by an unmodelled curve.
    pub(super) curve: f64,
    /// Level of one sign-flip test.
    pub(super) level: f64,
}

impl Prices {
    /// The chi-square quantile divided by the number of independent values of the fit segment;
    /// without a test that number is one value every two correlation times.
    fn new(level: f64, regime: Regime, (band, values): (f64, f64), curve: f64) -> Self {
        let (low, high) = policy::LEAST_UNTESTED;
        let of = |d: usize| {
            let chance = ChiSquared::new(d.max(1) as f64)
                .map_or(f64::INFINITY, |c| c.inverse_cdf(1.0 - level));
            match regime {
                // An effect that removes less than a twentieth of the SSE is not worth a term.
                Regime::Blocks => TWENTIETH.max(chance / band),
                Regime::Effect => (chance / values).clamp(low, high),
            }
        };
        Self {
            by_freedoms: (0..=4 * HATS).map(of).collect(),
            curve,
            level,
        }
    }

    pub(super) fn of_name(&self, freedoms: usize) -> f64 {
        self.by_freedoms[freedoms.min(4 * HATS)]
    }

    pub(super) fn of_curve(&self, hats: usize) -> f64 {
        let own = self.of_name(hats);
        match self.curve >= policy::CURVE_AGAINST_NAMES {
            true => self.curve + own,
            false => self.curve.max(own),
        }
    }
}

/// One linearisation of a model.
pub(super) struct Linear<'a> {
    pub(super) data: &'a Prepared,
    /// The part of the record that the fit sees; all columns are computed on it.
    pub(super) seen: &'a Prepared,
    /// The model on `seen`.
    pub(super) now: Solution,
    pub(super) declared: usize,
    pub(super) grams: Grams,
    /// The Gram matrix swept by the baseline part.
    base: Swept,
    /// The candidates of a forward selection.
    pub(super) sought: Sought,
    pub(super) groups: Vec<Group>,
    /// A number for each group; groups of one name have the same number.
    pub(super) kinds: Vec<usize>,
    pub(super) prices: Prices,
    pub(super) regime: Regime,
    /// Correlation time of the residual of the best set \[s\].
    pub(super) correlation_time: f64,
    /// The baseline part: gains and slopes.
    own: Vec<usize>,
    /// Gain and slopes of each term.
    terms: Vec<Vec<usize>>,
    table: Vec<usize>,
    /// The column of each free parameter's slope.
    pub(super) free: Vec<usize>,
    target: usize,
    /// Targets of sets without some of the stages, to first order.
    unstaged: Vec<(Vec<usize>, usize)>,
    pub(super) columns: Places,
}

impl<'a> Linear<'a> {
    pub(super) fn new(
        bank: &mut Bank<'a>,
        (whole, now): (&Solution, Solution),
        declared: usize,
        curve: f64,
    ) -> Self {
        let (data, seen) = (bank.data, bank.seen);
        let (known, grams) = std::mem::take(&mut bank.products);
        let present = Present::new(known, seen, &now);
        let mut columns = Places::of(present.columns);
        let mut groups = Vec::new();
        for (candidate, column) in bank.names(whole, &now) {
            let past = usize::from(candidate.term.has_past());
            let in_time = usize::from(candidate.term.has_moment());
            groups.push(Group {
                member: Member::Name(candidate),
                columns: vec![columns.place(column)],
                slopes: Vec::new(),
                freedoms: 1 + past + in_time,
            });
        }
        let rows = &seen.split.fit;
        let level = level(&groups);
        let (regime, correlation) = (Regime::Blocks, 0.0);
        let step = data.dt * data.stride as f64;
        let band = rows.len() as f64 * step * 2.0 * data.cutoff;
        let mut linear = Self {
            data,
            seen,
            now,
            declared,
            grams,
            base: Swept::default(),
            sought: Sought::default(),
            groups,
            kinds: Vec::new(),
            prices: Prices::new(level, regime, (band, band), curve),
            regime,
            correlation_time: correlation,
            own: present.own,
            terms: present.terms,
            table: present.table,
            free: present.free,
            target: present.target,
            unstaged: present.unstaged,
            columns,
        };
        linear.multiply();
        linear.refine(bank);
        linear.base = linear.grams.without(&linear.own);
        linear.sought = Sought::of(&linear.choices());
        linear.kinds = kinds(&linear.groups);
        linear.judge_blocks(level, (band, curve));
        linear
    }

    /// Adds unfiltered columns that belong to no candidate; returns their places.
    pub(super) fn add(&mut self, columns: &[Vec<f64>]) -> Vec<usize> {
        let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let filtered = self.seen.filtered_all(&columns).into_iter();
        let place = |column: Vec<f64>| self.columns.place(Arc::new(column.into()));
        let places = filtered.map(place).collect();
        self.multiply();
        places
    }

    fn multiply(&mut self) {
        let (rows, blocks) = (&self.seen.split.fit, blocks(self.data));
        self.grams.extend(&self.columns.all, rows, &blocks);
    }

    /// The names of the model, then the candidates.
    fn choices(&self) -> Vec<Choice<'_>> {
        let names = self.declared..self.now.structure.terms.len();
        let own = names.map(|index| Choice {
            group: None,
            identity: Identity::of(&self.now.structure.terms[index]),
            columns: self.term(index),
            freedoms: self.term(index).len(),
        });
        let groups = self.groups.iter().enumerate();
        let groups = groups.filter(|(_, group)| !group.is_curve());
        let groups = groups.map(|(g, group)| Choice {
            group: Some(g),
            identity: group.identity(),
            columns: &group.columns,
            freedoms: group.freedoms,
        });
        own.chain(groups).collect()
    }

    /// Adds the slopes of the candidates that reduce the SSE, and the curves if any does.
    fn refine(&mut self, bank: &mut Bank<'a>) {
        let all = self.everything();
        let swept = self.grams.without(&self.columns_of(&all));
        let sse = swept.at(self.target, self.target).max(1e-14);
        let least = WORTH * self.prices.of_name(1);
        let reduces = |gain: f64| -(1.0 - gain / sse).max(1e-14).ln() >= least;
        let mut wanted: Vec<bool> = self
            .groups
            .iter()
            .map(|g| reduces(swept.gain(&g.columns, self.target)))
            .collect();
        let mut pairs = self.pairs(&swept, self.target);
        if pairs.len() > PAIRED {
            pairs.select_nth_unstable_by(PAIRED, |p, q| q.0.total_cmp(&p.0));
            pairs.truncate(PAIRED);
        }
        for &(_, a, b) in pairs.iter().filter(|(gain, ..)| reduces(*gain)) {
            (wanted[a], wanted[b]) = (true, true);
        }
        let any = wanted.iter().any(|w| *w);
        if self.now.structure.terms.len() > self.declared {
            // An exchange also needs candidates that gain nothing jointly with the present names.
            wanted.fill(true);
        }
        let chosen: Vec<usize> = (0..wanted.len()).filter(|&g| wanted[g]).collect();
        let terms: Vec<_> = chosen
            .iter()
            .filter_map(|&g| Some(self.groups[g].candidate()?.term))
            .collect();
        for (&g, slopes) in chosen.iter().zip(bank.slopes(&self.now, &terms)) {
            let group = &mut self.groups[g];
            for slope in &slopes {
                let place = self.columns.place(Arc::clone(&slope.column));
                group.columns.push(place);
            }
            group.freedoms += slopes.len();
            group.slopes = slopes;
        }
        if (any || self.now.structure.terms.len() > self.declared)
            && self.now.structure.table.is_none()
        {
            for (variable, hats) in bank.curves(&self.now) {
                let freedoms = hats.len();
                let places = hats.into_iter().map(|hat| self.columns.place(hat));
                self.groups.push(Group {
                    member: Member::Curve(variable),
                    columns: places.collect(),
                    slopes: Vec::new(),
                    freedoms,
                });
            }
        }
        self.multiply();
    }

    /// Decides whether the blocks are long enough for a test, from the residual of the best set
    /// of names: the residual of an incomplete model is correlated for longer than the noise.
    fn judge_blocks(&mut self, level: f64, (band, curve): (f64, f64)) {
        let all = self.everything();
        let mut columns = self.columns_of(&all);
        for g in self.greedy(&all, &[], policy::MOST_NAMES) {
            columns.extend(&self.groups[g].columns);
        }
        let gains = self.grams.coefficients(&columns, self.target);
        let rows = &self.seen.split.fit;
        let rest: Vec<f64> = rows
            .iter()
            .map(|&i| {
                let sum: f64 = columns
                    .iter()
                    .zip(&gains)
                    .map(|(&c, g)| g * self.columns.all[c][i])
                    .sum();
                self.seen.target[i] - sum
            })
            .collect();
        let (regime, samples) = Regime::of(self.data, &rest);
        self.regime = regime;
        self.correlation_time = samples * self.data.dt * self.data.stride as f64;
        let values = rows.len() as f64 / (2.0 * samples).max(1.0);
        self.prices = Prices::new(level, self.regime, (band, values), curve);
    }

    /// The whole present model.
    pub(super) fn everything(&self) -> Kept {
        Kept {
            dropped: Vec::new(),
            table: !self.table.is_empty(),
        }
    }

    /// The gains and slopes of the whole present model, and the target.
    pub(super) fn baseline(&self) -> (Vec<usize>, usize) {
        (self.columns_of(&self.everything()), self.target)
    }

    pub(super) fn has_table(&self) -> bool {
        !self.table.is_empty()
    }

    /// The kept columns.
    pub(super) fn columns_of(&self, kept: &Kept) -> Vec<usize> {
        let mut columns = self.own.clone();
        for (index, own) in self.terms.iter().enumerate() {
            if !kept.dropped.contains(&index) {
                columns.extend(own);
            }
        }
        if kept.table {
            columns.extend(&self.table);
        }
        columns
    }

    /// The Gram matrix swept by the kept columns.
    pub(super) fn without(&self, kept: &Kept) -> Swept {
        let mut swept = self.base.clone();
        swept.sweep(&self.columns_of(kept)[self.own.len()..]);
        swept
    }

    /// Gain and slopes of one term.
    pub(super) fn term(&self, index: usize) -> &[usize] {
        &self.terms[index]
    }

    /// The target of a set, and the square of its scale over that of the output.
    pub(super) fn target_of(&self, kept: &Kept) -> (usize, f64) {
        let gone = |terms: &Vec<usize>| terms.iter().all(|t| kept.dropped.contains(t));
        let without = self.unstaged.iter().filter(|(terms, _)| gone(terms));
        let target = without
            .max_by_key(|(terms, _)| terms.len())
            .map_or(self.target, |(_, target)| *target);
        let unit = self.grams.unit(target) / self.grams.unit(self.target);
        (target, unit)
    }

    /// Square of the output's scale: squared errors of sets are in units of it.
    pub(super) fn unit(&self) -> f64 {
        self.grams.unit(self.target)
    }

    /// Squared error of the kept part, to first order.
    pub(super) fn left(&self, kept: &Kept) -> f64 {
        let (target, unit) = self.target_of(kept);
        unit * self.grams.squared_error(&self.columns_of(kept), target)
    }

    /// Total price of the kept names and the kept curve.
    pub(super) fn price_of(&self, kept: &Kept) -> f64 {
        let names = self.terms.iter().enumerate().skip(self.declared);
        let names: f64 = names
            .filter(|(index, _)| !kept.dropped.contains(index))
            .map(|(_, own)| self.prices.of_name(own.len()))
            .sum();
        match kept.table && self.has_table() {
            true => names + self.prices.of_curve(self.table.len()),
            false => names,
        }
    }

    /// Price of a group; that of a curve is for the smallest number of hats that a refit tries.
    pub(super) fn price(&self, group: usize) -> f64 {
        let own = &self.groups[group];
        match own.is_curve() {
            true => self.prices.of_curve(HATS),
            false => self.prices.of_name(own.freedoms),
        }
    }

    /// The members of a set: the kept terms, the kept curve and the added groups.
    pub(super) fn identities(&self, kept: &Kept, added: &[usize]) -> Vec<Identity> {
        let terms = self.now.structure.terms.iter().enumerate();
        let mut all: Vec<Identity> = terms
            .filter(|(index, _)| !kept.dropped.contains(index))
            .map(|(_, term)| Identity::of(term))
            .collect();
        if kept.table {
            let table = self.now.structure.table.as_ref();
            all.extend(table.map(|t| Identity::Curve(t.variable)));
        }
        all.extend(added.iter().map(|&g| self.groups[g].identity()));
        all
    }

    /// All pairs of candidates with their joint gain, without slopes.
    pub(super) fn pairs(&self, swept: &Swept, target: usize) -> Vec<(f64, usize, usize)> {
        let usable: Vec<usize> = (0..self.groups.len())
            .filter(|&g| !self.groups[g].is_curve())
            .filter(|&g| swept.is_excited(self.groups[g].columns[0]))
            .collect();
        let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
        for (n, &a) in usable.iter().enumerate() {
            let i = self.groups[a].columns[0];
            for &b in &usable[n + 1..] {
                let j = self.groups[b].columns[0];
                let gain = swept.gain_of_pair(i, j, target);
                pairs.extend(gain.map(|gain| (gain, a, b)));
            }
        }
        pairs
    }
}

/// A number for each group, the same for groups that are alike.
fn kinds(groups: &[Group]) -> Vec<usize> {
    let mut first: Vec<&Group> = Vec::new();
    let mut number = |group| {
        let known = first.iter().position(|other| other.is_like(group));
        known.unwrap_or_else(|| {
            first.push(group);
            first.len() - 1
        })
    };
    groups.iter().map(&mut number).collect()
}

/// Level of one test: the family-wise level over families and channels.
fn level(groups: &[Group]) -> f64 {
    let candidates = || groups.iter().filter_map(Group::candidate);
    let mut families: Vec<_> = candidates().map(|c| c.family).collect();
    families.sort_unstable();
    families.dedup();
    let mut sources: Vec<_> = Vec::new();
    for source in candidates().map(|c| c.term.source) {
        if !sources.contains(&source) {
            sources.push(source);
        }
    }
    LEVEL / (families.len() * sources.len()).max(1) as f64
}
