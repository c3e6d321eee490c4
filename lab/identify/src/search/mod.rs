//! Which effects are missing: one search over sets of effects.
//!
//! Every candidate is a column, computed and filtered once (`bank`). The products of the
//! columns, one matrix for each of sixteen blocks (`gram`), answer all questions but one
//! without another pass over the samples: the squared error of a set, its reduction by each
//! effect and each pair, the exact sign-flip p-value of a member (`linear`, `moves`). A
//! forward selection updates only the entries that it reads (`partial`, `sought`, `forward`).
//! The remaining question, the error with all shapes refitted, is asked for the three best
//! moves of a round only (`refit`). `run` accepts or rejects the refitted move, linearises the
//! accepted model again, and stops when no move lowers the criterion. `readoff` reads rounds,
//! rivals and the unmodelled curve off the final set; `carries_over` decides how many names
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
mod moves;
pub mod partial;
pub mod policy;
mod present;
mod readoff;
mod refit;
mod run;
mod sought;

use crate::fit::{fit, Solution};
use crate::ledger::Ledger;
use crate::model::structure::Structure;
use crate::problem::Prepared;
use crate::score::blocks::Regime;
use crate::score::explains::integrates;
use bank::Bank;
use coarse::Coarse;
use linear::Linear;
pub use policy::{MOST_NAMES, RECURRENCES};
use refit::on;
use run::Search;
use std::time::Instant;

/// Finds the effects that a declared model lacks. `progress` receives one message a step.
///
/// # Errors
/// One sentence where the declared model cannot be fitted at all.
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
    /// declared model is fitted, and neither an effect nor an unmodelled curve is sought.
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
/// One sentence where the declared model cannot be fitted at all.
pub fn close_within(
    data: &Prepared,
    structure: &Structure,
    limits: impl Into<Limits>,
    mut progress: impl FnMut(&str),
) -> Result<Ledger, String> {
    let begun = Instant::now();
    let cannot = "the declared model cannot be fitted to this record";
    let limits = limits.into();
    let most = limits.names.min(MOST_NAMES);
    progress("fitting the declared model");
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
    progress("looking for what would do as well");
    let limited = (most < MOST_NAMES && search.is_cut).then_some(most);
    let mut ledger = search.ledger().ok_or(cannot)?;
    ledger.stopped_by_request = limited;
    ledger.stopped_by_budget = limits.seconds.filter(|_| out_of_time);
    Ok(ledger)
}

/// Whether the blocks are long enough to test the residual, and its correlation time \[s\].
fn independence(data: &Prepared, solution: &Solution) -> (Regime, f64) {
    let rows = data.split.fit.iter();
    let rest: Vec<f64> = rows.map(|&i| solution.residual[i]).collect();
    let (regime, samples) = Regime::of(data, &rest);
    (regime, samples * data.dt * data.stride as f64)
}

/// A question to the linearisation of a model. `None` if the model cannot be evaluated.
fn asked_of<R>(
    data: &Prepared,
    solution: &Solution,
    question: impl FnOnce(&Linear) -> R,
) -> Option<R> {
    let declared = solution.structure.terms.len();
    let fine = data.for_search(false);
    let seen = on(&fine, data, solution)?;
    let mut bank = Bank::new((data, &fine), solution);
    let price = policy::CURVE_AGAINST_NAMES;
    let linear = Linear::new(&mut bank, (solution, seen), declared, price);
    Some(question(&linear))
}

/// The squared error that names leave of a model, to first order, as a forward selection finds
/// them; in a unit of the output's own. `None` if the model cannot be evaluated.
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
    .unwrap_or((Regime::Effect, policy::LEVEL))
}
