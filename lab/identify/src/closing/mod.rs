//! Closing the loop: fit, scan, add one effect, refit, compare, again.

use crate::fit::{fit, Solution};
use crate::ledger::{Gate, Grade, Ledger, Rejection, Round};
use crate::model::catalogue::Candidate;
use crate::model::structure::Structure;
use crate::problem::Prepared;
use crate::score::explains::integrates;
use crate::score::scan::{blocks, correlation_samples, Regime};
use attempt::{attempt, Accepted, Attempt};
use duel::is_noise;
use joint::{is_cut, joint, superseded};
use revisit::revisited;
use tones::tone;

use unknown::{instead, unnamed, Behind};

mod attempt;
mod duel;
mod gates;
mod joint;
mod revisit;
mod tones;
mod unknown;

pub(crate) use unknown::dependences;
pub use unknown::Dependence;

/// At most this many effects are added.
pub const MOST_ROUNDS: usize = 8;

/// So often the rounds are looked at again, and others looked for.
const PASSES: usize = 3;

/// Beside a table for what has no name an effect removes at least this share of the squared
/// error: the table's steps leave a rest that effects would fill.
const BESIDE_TABLE: f64 = 0.5;

/// Runs the loop. `progress` is told what is being done.
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
    let most = most.min(MOST_ROUNDS);
    progress("fitting the declared model");
    let declared = fit(data, structure, None, 0.0)
        .ok_or("the declared model cannot be fitted to this record")?;
    let integrates = integrates(data, &declared);
    let mut ledger = Ledger {
        integrates,
        ..Ledger::of(declared)
    };
    if integrates {
        return Ok(ledger);
    }
    if most == 0 {
        (ledger.regime, ledger.correlation_time) = independence(data, &ledger.declared);
        ledger.stopped_by_request = Some(0);
        return Ok(ledger);
    }
    let mut gone = Vec::new();
    for _ in 0..PASSES {
        grow(data, &mut ledger, most, &mut progress);
        progress("looking for what later effects have made superfluous");
        let taken_back = take_back(data, &mut ledger);
        let room = ledger.stopped_by_request.is_some() && !taken_back.is_empty();
        gone.extend(taken_back);
        progress("looking at each name beside the others");
        let Some(anew) = revisited(data, &ledger) else {
            // One effect fewer than was asked for: the search may go on.
            if room {
                continue;
            }
            break;
        };
        replace(data, &mut ledger, anew.rounds);
        if anew.gone.is_empty() {
            break;
        }
        gone.extend(anew.gone);
    }
    let is_back = |one: &Candidate| ledger.rounds.iter().any(|r| r.candidate.is_like(one));
    gone.retain(|rejection: &Rejection| !is_back(&rejection.candidate));
    ledger.rejected.extend(gone);
    // A later scan may find blocks enough: that does not test what came in before.
    if ledger.rounds.iter().any(|round| round.p.is_none()) {
        ledger.regime = Regime::Effect;
    }
    Ok(ledger)
}

/// Adds rounds until nothing passes or there are `most`.
fn grow(data: &Prepared, ledger: &mut Ledger, most: usize, mut progress: impl FnMut(&str)) {
    let limited = (most < MOST_ROUNDS).then_some(most);
    ledger.stopped_by_request = None;
    while ledger.rounds.len() < most {
        let round = ledger.rounds.len() + 1;
        let now = ledger.last().clone();
        let tried = attempt(data, &now, |what| {
            progress(&format!("round {round}: {what}"))
        });
        ledger.regime = tried.regime;
        ledger.correlation_time = tried.correlation_time;
        if ledger.unknown.is_some() {
            if !beside_table(data, ledger, tried) {
                break;
            }
            continue;
        }
        if only_noise(data, &now) {
            ledger.rejected = tried.rejected;
            ledger.rejected.extend(tried.accepted.map(|one| Rejection {
                candidate: one.candidate,
                gate: Gate::AtNoise,
                p: one.p,
            }));
            break;
        }
        let left = most - ledger.rounds.len();
        let mut accepted = proposed(data, ledger, &now, (&tried, left), |what| {
            progress(&format!("round {round}: {what}"))
        });
        if accepted.is_empty() {
            // Several at once were tried only as far as there was room for them.
            let mut cut = is_cut(&tried, left);
            progress("looking for what has no name");
            match unnamed(data, &now, &tried) {
                Some(Behind::Unknown(unknown)) => ledger.unknown = Some(*unknown),
                Some(Behind::Names(names)) if names.len() <= left => accepted = names,
                Some(Behind::Names(_)) => cut = true,
                None => {}
            }
            if accepted.is_empty() {
                ledger.stopped_by_request = limited.filter(|_| cut);
                return;
            }
        }
        for one in accepted {
            ledger.unknown = instead(data, ledger.last(), &one, &tried);
            if ledger.unknown.is_some() {
                break;
            }
            let round = add(data, ledger.last(), one, ledger.rounds.len() + 1);
            ledger.rounds.push(round);
        }
    }
    if ledger.rounds.len() >= most && !only_noise(data, ledger.last()) {
        ledger.stopped_by_request = limited;
    }
}

/// Whether the residual has blocks enough for a test, and its correlation time \[s\].
fn independence(data: &Prepared, solution: &Solution) -> (Regime, f64) {
    let rows = data.split.fit.iter();
    let rest: Vec<f64> = rows.map(|&i| solution.residual[i]).collect();
    let samples = correlation_samples(&rest);
    let shortest = blocks(data).iter().map(ExactSizeIterator::len).min();
    let regime = match shortest.unwrap_or(0) as f64 >= 3.0 * samples {
        true => Regime::Blocks,
        false => Regime::Effect,
    };
    (regime, samples * data.dt * data.stride as f64)
}

/// Whether nothing is left to be named: what a right model leaves is below the floor by what
/// its parameters have taken, and on the stop-check above it by as much.
fn only_noise(data: &Prepared, now: &Solution) -> bool {
    now.rmse.fit <= data.noise_floor && is_noise(data.noise_floor, now.rmse.stop)
}

/// What the library, alone or at most `most` at once, or else a tone would add.
fn proposed(
    data: &Prepared,
    ledger: &mut Ledger,
    now: &Solution,
    (tried, most): (&Attempt, usize),
    mut progress: impl FnMut(&str),
) -> Vec<Accepted> {
    ledger.rejected.clone_from(&tried.rejected);
    if let Some(accepted) = &tried.accepted {
        return vec![accepted.clone()];
    }
    progress("trying several at once");
    let accepted = joint(data, now, tried, most);
    if !accepted.is_empty() {
        return accepted;
    }
    progress("looking for a tone");
    match tone(data, now, tried) {
        Ok(accepted) => vec![accepted],
        Err(rejection) => {
            ledger.rejected.extend(rejection.map(|boxed| *boxed));
            Vec::new()
        }
    }
}

/// Adds a name beside the table of what has none, where it is not the table's own misfit.
fn beside_table(data: &Prepared, ledger: &mut Ledger, tried: Attempt) -> bool {
    let now = ledger.last().clone();
    let Some(accepted) = tried.accepted else {
        return false;
    };
    if accepted.solution.sse(data) > (1.0 - BESIDE_TABLE) * now.sse(data) {
        return false;
    }
    if let Some(unknown) = &mut ledger.unknown {
        unknown.solution = accepted.solution.clone();
    }
    let round = add(data, &now, accepted, ledger.rounds.len() + 1);
    ledger.rounds.push(round);
    true
}

/// Takes rounds back that the later ones, or the table, make superfluous; which they were.
fn take_back(data: &Prepared, ledger: &mut Ledger) -> Vec<Rejection> {
    let Some(kept) = superseded(data, ledger) else {
        return Vec::new();
    };
    replace(data, ledger, kept.rounds);
    let named = ledger.named().clone();
    if let Some(unknown) = &mut ledger.unknown {
        unknown.share = 1.0 - kept.full.sse(data) / named.sse(data);
        unknown.before = named.rmse;
        unknown.after = kept.full.rmse;
        unknown.solution = kept.full;
    }
    kept.gone
}

/// These rounds in the place of those that were.
fn replace(data: &Prepared, ledger: &mut Ledger, rounds: Vec<Accepted>) {
    ledger.rounds.clear();
    for one in rounds {
        let round = add(data, ledger.named(), one, ledger.rounds.len() + 1);
        ledger.rounds.push(round);
    }
}

fn add(data: &Prepared, now: &Solution, accepted: Accepted, round: usize) -> Round {
    let Accepted {
        candidate,
        p,
        rivals,
        blocks_better,
        solution,
    } = accepted;
    let explained = 1.0 - solution.sse(data) / now.sse(data);
    Round {
        grade: grade(explained, p, &rivals, blocks_better, round),
        candidate,
        p,
        rivals,
        explained,
        blocks_better,
        before: now.rmse,
        after: solution.rmse,
        solution,
    }
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
