//! Which effects are missing: one search over sets of effects.
//!
//! Everything that may be missing is a column, computed and filtered once (`bank`). The
//! columns' products, one matrix for each of sixteen blocks (`gram`), answer every question
//! but one without touching a sample again: the error of a set, what each effect and each
//! pair would add to it, the exact sign-flip p-value of a member (`linear`, `moves`).
//! A forward selection keeps up to date only what it asks for (`partial`, `sought`, `forward`).
//! The one question that is left, the error with all shapes refitted, is asked of the three
//! best moves of a round only (`refit`). What is accepted is linearised again (`run`),
//! until no move lowers the criterion. Rounds, rivals and the curve of what has no name are
//! read off the set that remains (`readoff`).

mod bank;
pub mod carries_over;
mod forward;
pub mod gram;
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
use linear::Linear;
pub use policy::{MOST_NAMES, RECURRENCES};
use refit::on;
use run::Search;
use std::time::Instant;

/// Finds what a declared model lacks. `progress` is told what is being done.
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

/// When a search ends although it might find more.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Most effects that are added, [`MOST_NAMES`] at most. With 0 the declared model is fitted
    /// and nothing is looked for, no curve without a name either.
    pub names: usize,
    /// After this time \[s\] no further model is tried. The answer then depends on how fast the
    /// machine is.
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

/// Whether the residual has blocks enough for a test, and its correlation time \[s\].
fn independence(data: &Prepared, solution: &Solution) -> (Regime, f64) {
    let rows = data.split.fit.iter();
    let rest: Vec<f64> = rows.map(|&i| solution.residual[i]).collect();
    let (regime, samples) = Regime::of(data, &rest);
    (regime, samples * data.dt * data.stride as f64)
}

/// Whether the record has blocks enough to test what a model lacks, and the level of one test.
///
/// No test where the model cannot be evaluated.
pub(crate) fn tests(data: &Prepared, solution: &Solution) -> (Regime, f64) {
    let declared = solution.structure.terms.len();
    let fine = data.for_search(false);
    let Some(seen) = on(&fine, data, solution) else {
        return (Regime::Effect, policy::LEVEL);
    };
    let mut bank = Bank::new((data, &fine), solution);
    let price = policy::CURVE_AGAINST_NAMES;
    let linear = Linear::new(&mut bank, (solution, seen), declared, price);
    (linear.regime, linear.prices.level)
}
