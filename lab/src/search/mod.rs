//! Which effects are missing: one search over sets of effects.
//!
//! Everything that may be missing is a column, computed and filtered once ([`bank`]). The
//! columns' products, one matrix for each of sixteen blocks ([`gram`]), answer every question
//! but one without touching a sample again: the error of a set, what each effect and each
//! pair would add to it, the exact sign-flip p-value of a member ([`linear`], [`moves`]).
//! The one question that is left, the error with all shapes refitted, is asked of the three
//! best moves of a round only ([`refit`]). What is accepted is linearised again ([`run`]),
//! until no move lowers the criterion. Rounds, rivals and the curve of what has no name are
//! read off the set that remains ([`readoff`]).

mod bank;
pub mod carries_over;
pub mod gram;
mod linear;
mod moves;
pub mod policy;
mod present;
mod readoff;
mod refit;
mod run;

use crate::problem::Prepared;
use crate::closing::{independence, MOST_ROUNDS};
use crate::ledger::Ledger;
use crate::score::explains::integrates;
use crate::fit::fit;
use crate::model::structure::Structure;
use run::Search;

/// Finds what a declared model lacks. `progress` is told what is being done.
///
/// # Errors
/// One sentence where the declared model cannot be fitted at all.
pub fn close(
    data: &Prepared,
    structure: &Structure,
    progress: impl FnMut(&str),
) -> Result<Ledger, String> {
    close_within(data, structure, MOST_ROUNDS, progress)
}

/// As [`close`], with at most `most` effects added ([`MOST_ROUNDS`] at most). With 0 the
/// declared model is fitted and nothing is looked for, no curve without a name either.
///
/// # Errors
/// One sentence where the declared model cannot be fitted at all.
pub fn close_within(
    data: &Prepared,
    structure: &Structure,
    most: usize,
    mut progress: impl FnMut(&str),
) -> Result<Ledger, String> {
    let cannot = "the declared model cannot be fitted to this record";
    let most = most.min(MOST_ROUNDS);
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
    let mut search = Search::new(data, &declared, most);
    search.run(&mut progress);
    progress("looking for what would do as well");
    let limited = (most < MOST_ROUNDS && search.is_cut).then_some(most);
    let mut ledger = search.ledger().ok_or(cannot)?;
    ledger.stopped_by_request = limited;
    Ok(ledger)
}
