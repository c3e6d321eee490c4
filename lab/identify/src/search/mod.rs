//! Which effects are missing: one search over sets of effects.
//!
//! Every candidate is a column, computed and filtered once (`bank`). The products of the
//! columns, one matrix for each of sixteen blocks (`gram`), answer all questions but one
//! without another pass over the samples: the squared error of a set, its reduction by each
//! effect and each pair, the exact sign-flip p-value of a member (`linear`, `moves`). A
//! forward selection updates only the entries that it reads (`partial`, `sought`, `forward`).
//! The remaining question, the error with all shapes refitted, is asked for the three best
//! moves of a round only (`refit`). `run` accepts or rejects the refitted move, linearises the
//! accepted model again, and stops when no move lowers the criterion. `readoff` derives rounds,
//! alternatives and the unmodelled curve from the final set; `carries_over` decides how many names
//! are delivered. Every threshold is in `policy`.

mod bank;
pub mod carries_over;
mod coarse;
mod exchange;
mod forward;
pub mod gram;
mod hidden;
mod instead;
mod kept;
mod linear;
mod members;
mod moves;
pub mod partial;
pub mod policy;
mod present;
mod readoff;
mod refit;
mod run;
mod sought;
pub mod support;
mod told;

use crate::fit::{fit, glance, Solution};
use crate::ledger::{Grade, Ledger};
use crate::model::declared::declared as baseline_term;
use crate::model::structure::{FitTerm, Structure};
use crate::problem::clock::Moment;
use crate::problem::Prepared;
use crate::scale::{HALF, LEVEL, NOISE};
use crate::score::blocks::Regime;
use crate::score::explains::integrates;
use bank::Bank;
use coarse::Coarse;
use linear::Linear;
pub use policy::MOST_NAMES;
use refit::on;
use run::Search;

/// Finds the effects that are missing from a baseline model. `progress` receives one message per
/// step.
///
/// # Errors
/// A message if the baseline model cannot be fitted at all.
pub fn close(
    data: &Prepared,
    structure: &Structure,
    progress: impl FnMut(&str),
) -> Result<Ledger, String> {
    close_within(data, structure, MOST_NAMES, progress)
}

/// Limits that end a search although more effects may be missing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Maximum number of effects that are added, itself at most [`MOST_NAMES`]. With 0 the
    /// baseline model is fitted, and neither an effect nor an unmodelled curve is sought.
    pub names: usize,
    /// Time \[s\] after which no further model is tried. The result then depends on the speed of
    /// the machine.
    pub seconds: Option<f64>,
}

impl From<usize> for Limits {
    fn from(names: usize) -> Self {
        let seconds = None;
        Self { names, seconds }
    }
}

/// As [`close`], within limits.
///
/// # Errors
/// A message if the baseline model cannot be fitted at all.
pub fn close_within(
    data: &Prepared,
    structure: &Structure,
    limits: impl Into<Limits>,
    mut progress: impl FnMut(&str),
) -> Result<Ledger, String> {
    let begun = Moment::now();
    let cannot = "the baseline model cannot be fitted to this record";
    let limits = limits.into();
    let most = limits.names.min(MOST_NAMES);
    progress("fitting the baseline model");
    let declared = fit(data, structure, None, 0.0).ok_or(cannot)?;
    if integrates(data, &declared) {
        return Ok(Ledger {
            integrates: true,
            ..Ledger::of(declared)
        });
    }
    if most == 0 {
        let mut ledger = Ledger::of(declared);
        (ledger.regime, ledger.correlation_time) = independence(data, &ledger.declared);
        ledger.stopped_by_request = Some(0);
        return Ok(ledger);
    }
    let (coarse, fine) = (data.for_search(true), data.for_search(false));
    let coarse = Coarse::new(&coarse);
    let mut search = Search::new((data, &coarse, &fine), &declared, most);
    let budget = limits.seconds.map(|seconds| (begun, seconds));
    let out_of_time = search.run(budget, &mut progress);
    progress("searching for alternatives");
    let limited = (most < MOST_NAMES && search.is_cut).then_some(most);
    let mut ledger = search.ledger().ok_or(cannot)?;
    ledger.lead = lead(data, &fine, &ledger);
    ledger.supported = support::supported(data, &ledger);
    if ledger.lead.is_some() {
        // The clocks explain as much as the terms.
        let rounds = ledger.rounds.iter_mut().chain(&mut ledger.beyond);
        rounds.for_each(|round| round.grade = Grade::Low);
    }
    ledger.stopped_by_request = limited;
    ledger.stopped_by_budget = limits.seconds.filter(|_| out_of_time);
    Ok(ledger)
}

/// Lead \[s\] of the output relative to the input: a delay, which may be negative here, fitted to
/// the baseline model and to the last model, if they do not reach the noise.
///
/// `None` if it is less than a sample, or if it removes less than half of the squared error, both of
/// the model without it and of the model with the first term.
fn lead(data: &Prepared, fine: &Prepared, ledger: &Ledger) -> Option<f64> {
    let first = ledger
        .rounds
        .first()
        .map_or(&ledger.declared, |round| &round.solution);
    let of = |model: &Solution| {
        let is_delay = |term: &FitTerm| term.effect.name() == "delay";
        if is_at_noise(data, model) || model.structure.terms.iter().any(is_delay) {
            return None;
        }
        let mut structure = Structure {
            may_lead: true,
            ..model.structure.clone()
        };
        structure.terms.push(baseline_term("delay", data).ok()?);
        let (sse, _, delay) = glance(fine, &structure, model, 0.0)?;
        let most = HALF * f64::min(model.sse(data), first.sse(data));
        (-delay * data.rate >= 1.0 && sse <= most).then_some(-delay)
    };
    let found = of(&ledger.declared);
    let is_other = !ledger.rounds.is_empty() || ledger.unknown.is_some();
    found.or_else(|| is_other.then(|| of(ledger.last())).flatten())
}

/// Whether the residual of a model on the fit segment is noise.
pub(crate) fn is_at_noise(data: &Prepared, model: &Solution) -> bool {
    model.rmse.fit <= NOISE * data.noise_floor
}

/// Whether the blocks are long enough to test the residual, and its correlation time \[s\].
fn independence(data: &Prepared, solution: &Solution) -> (Regime, f64) {
    let rows = data.split.fit.iter();
    let rest: Vec<f64> = rows.map(|&i| solution.residual[i]).collect();
    let (regime, samples) = Regime::of(data, &rest);
    (regime, samples * data.dt * data.stride as f64)
}

/// Evaluates a query on the linearisation of a model. `None` if the model cannot be evaluated.
fn asked_of<R>(
    data: &Prepared,
    solution: &Solution,
    question: impl FnOnce(&mut Linear) -> R,
) -> Option<R> {
    let declared = solution.structure.terms.len();
    let fine = data.for_search(false);
    let seen = on(&fine, data, solution)?;
    let mut bank = Bank::new((data, &fine), solution);
    let price = policy::CURVE_AGAINST_NAMES;
    let mut linear = Linear::new(&mut bank, (solution, seen), declared, price);
    Some(question(&mut linear))
}

/// The squared error of a model, to first order, after the names that a forward selection finds; in
/// a unit of the output. `None` if the model cannot be evaluated.
pub(crate) fn left_by_names(data: &Prepared, solution: &Solution) -> Option<f64> {
    asked_of(data, solution, |linear| linear.left_by_names())
}

/// Whether the blocks of the record are long enough for the tests of a search from this model,
/// and the level of one test.
///
/// [`Regime::Effect`] if the model cannot be evaluated.
pub(crate) fn tests(data: &Prepared, solution: &Solution) -> (Regime, f64) {
    asked_of(data, solution, |linear| {
        (linear.regime, linear.prices.level)
    })
    .unwrap_or((Regime::Effect, LEVEL))
}
