//! The smallest effect that the search would have found in this record.
//!
//! "Nothing found" is informative only together with the size of the effects that would have been
//! found. Therefore every effect of the catalogue is planted into the user's own record, and the
//! same search is run again:
//!
//! 1. A model is identified from the record. The last model represents the rig, and its residual
//!    the noise.
//! 2. A trial's output is that model's prediction, plus the residual under a circular shift (and
//!    every other time a change of sign), plus the effect: at the middle one of its trial shapes,
//!    on the record's own motion, computed by the core. A shift keeps the residual's colour, but
//!    removes its relation to the motion. The output is the one after the smoother at 2.5 f_c, on
//!    the work grid; the filter at f_c follows as for the record.
//! 3. Linear theory predicts the amplitude at which nine of ten trials pass the sign-flip test with
//!    a twentieth of the squared error (`screen`).
//! 4. From there the amplitude changes by the square root of two, and at the end by the fourth
//!    root. **Every trial is a complete identification**, with search, refits and tests. The effect
//!    counts as found if its family is named as a term or as an alternative. The smallest amplitude
//!    at which nine of ten trials find it is reported; at the next smaller one, at least one in ten
//!    failed.
//!
//! Trials without a planted effect show how often an effect is named by mistake. Nothing is random;
//! the same record gives the same table.

mod planted;
mod screen;

use crate::fit::Solution;
use crate::ledger::Ledger;
use crate::model::catalogue::candidates;
use crate::model::effects::rank;
use crate::model::structure::FitTerm;
use crate::problem::Prepared;
use crate::record::nearest;
use crate::search::close;
use planted::Trials;
use screen::Screen;

/// Share of the trials in which an effect must be found.
pub const SHARE: f64 = 0.9;

/// Default number of trials of each amplitude.
pub const TRIALS: usize = 10;

/// Smallest number of trials that can distinguish nine of ten from less, and the largest useful
/// number.
pub const TRIALS_RANGE: std::ops::RangeInclusive<usize> = 5..=200;

/// Steps by the square root of two, up or down.
const STEPS: usize = 10;

/// What is asked.
#[derive(Debug, Clone)]
pub struct Question {
    /// Effects or families by name; all if empty.
    pub effects: Vec<String>,
    /// Trials of each amplitude.
    pub trials: usize,
}

impl Default for Question {
    fn default() -> Self {
        Self {
            effects: Vec::new(),
            trials: TRIALS,
        }
    }
}

/// The result for one effect.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// Found from this amplitude on.
    Found {
        /// Rms of the contribution about its mean, in the output's unit.
        amplitude: f64,
        /// The gain that makes it.
        gain: f64,
        /// In how many of the trials at this amplitude.
        times: usize,
        /// What linear theory had said.
        screened: f64,
    },
    /// Not found at the largest tested amplitude: the rms of the output, or 32 times the prediction
    /// of linear theory.
    NotFound {
        /// That amplitude.
        tried: f64,
    },
    /// The motion does not excite the effect independently of the model's parameters.
    NotExcited,
    /// The model already contains the effect.
    InModel,
}

/// One row of the table.
#[derive(Debug, Clone)]
pub struct Row {
    /// The effect with the planted shapes, and its source.
    pub term: FitTerm,
    /// What came out.
    pub answer: Answer,
}

/// The whole table.
#[derive(Debug, Clone)]
pub struct Power {
    /// By family, from the simplest on, then by name and channel.
    pub rows: Vec<Row>,
    /// Trials of each amplitude.
    pub trials: usize,
    /// Trials without a planted effect in which an effect was named.
    pub named_without: usize,
}

/// Effects in the order of the table, each with the middle one of its trial shapes.
fn targets(data: &Prepared, solution: &Solution, names: &[String]) -> Result<Vec<Row>, String> {
    let tried = candidates(data, &solution.structure, &solution.residual);
    let mut groups: Vec<Vec<FitTerm>> = Vec::new();
    for candidate in &tried {
        let term = candidate.term;
        let same = |g: &&mut Vec<FitTerm>| {
            g[0].effect.name() == term.effect.name() && g[0].source == term.source
        };
        match groups.iter_mut().find(same) {
            Some(group) => group.push(term),
            None => groups.push(vec![term]),
        }
    }
    let there = &solution.structure.terms;
    let open = |term: &FitTerm| Row {
        term: *term,
        answer: if there
            .iter()
            .any(|t| t.effect.name() == term.effect.name() && t.source == term.source)
        {
            Answer::InModel
        } else {
            Answer::NotExcited
        },
    };
    let mut rows: Vec<Row> = there.iter().map(open).collect();
    for group in &groups {
        let row = open(&group[group.len() / 2]);
        if row.answer != Answer::InModel {
            rows.push(row);
        }
    }
    let asked = |term: &FitTerm, name: &str| {
        name == term.effect.name()
            || name == term.effect.info().family
            || name == crate::conclude::intervals::term_name(data, term)
    };
    if let Some(name) = names
        .iter()
        .find(|n| rows.iter().all(|row| !asked(&row.term, n)))
    {
        let mut known: Vec<&str> = rows.iter().map(|r| r.term.effect.name()).collect();
        known.sort_unstable();
        known.dedup();
        return Err(format!(
            "--effects {name}: this record allows only {}{}",
            known.join(", "),
            nearest(name, known.iter().copied())
        ));
    }
    rows.retain(|row| names.is_empty() || names.iter().any(|n| asked(&row.term, n)));
    rows.sort_by_cached_key(|row| {
        (
            rank(row.term.effect.name()),
            row.term.effect.name(),
            crate::conclude::intervals::term_name(data, &row.term),
        )
    });
    Ok(rows)
}

/// Whether a run names that family, or holds it possible.
fn names(ledger: &Ledger, family: &'static str) -> bool {
    let mut rounds = ledger.rounds.iter();
    rounds.any(|round| round.possible().any(|one| one.family == family))
}

/// The trials of one record, and the question that is put to each.
struct Search<'a> {
    data: &'a Prepared,
    solution: &'a Solution,
    trials: &'a Trials,
    needed: usize,
}

impl Search<'_> {
    /// In how many trials it is found; `None` as soon as too many have failed.
    fn found(&self, contribution: &[f64], family: &'static str, amplitude: f64) -> Option<usize> {
        let count = self.trials.count();
        let mut times = 0;
        for trial in 0..count {
            let output = self.trials.output(trial, contribution, amplitude);
            let ledger = close(
                &self.data.with_output(output),
                &self.solution.structure,
                |_| (),
            );
            if ledger.is_ok_and(|l| names(&l, family)) {
                times += 1;
            }
            if trial + 1 - times > count - self.needed {
                return None;
            }
        }
        Some(times)
    }

    fn answer(&self, screen: &Screen, term: &FitTerm) -> Answer {
        let Some(planted) = planted::contribution(self.data, self.solution, term) else {
            return Answer::NotExcited;
        };
        let most = screen.largest();
        let (screened, mut low) = match screen.amplitude(self.data, &planted.unit) {
            screen::Outcome::NotExcited => return Answer::NotExcited,
            screen::Outcome::Never => return Answer::NotFound { tried: most },
            screen::Outcome::From(a) => (a, 0.0),
        };
        let family = term.effect.info().family;
        let at = |amplitude: f64| self.found(&planted.unit, family, amplitude);
        let root = std::f64::consts::SQRT_2;
        let mut now = screened;
        let mut best: Option<(f64, usize)> = None;
        for _ in 0..STEPS {
            match at(now) {
                Some(times) => {
                    best = Some((now, times));
                    if low > 0.0 {
                        break;
                    }
                    now /= root;
                }
                None => {
                    low = now;
                    if best.is_some() || now >= most {
                        break;
                    }
                    now *= root;
                }
            }
        }
        let Some((mut amplitude, mut times)) = best else {
            return Answer::NotFound { tried: low };
        };
        if low > 0.0 {
            let middle = (amplitude * low).sqrt();
            if let Some(more) = at(middle) {
                (amplitude, times) = (middle, more);
            }
        }
        Answer::Found {
            amplitude,
            gain: amplitude / planted.rms,
            times,
            screened,
        }
    }
}

/// The table for an identified record. `progress` receives the number of completed rows and of all
/// rows, from any thread.
///
/// # Errors
/// A message if a requested effect cannot be tested on the record.
pub fn power(
    data: &Prepared,
    ledger: &Ledger,
    question: &Question,
    progress: impl Fn(usize, usize) + Sync,
) -> Result<Power, String> {
    use rayon::prelude::*;
    use std::sync::atomic::{AtomicUsize, Ordering};
    let solution = ledger.last();
    let mut rows = targets(data, solution, &question.effects)?;
    let trials = Trials::new(data, solution, question.trials);
    let screen = Screen::new(data, solution, &trials);
    let search = Search {
        data,
        solution,
        trials: &trials,
        needed: needed(question.trials),
    };
    let (done, all) = (AtomicUsize::new(0), rows.len());
    progress(0, all);
    rows.par_iter_mut().for_each(|row| {
        if row.answer != Answer::InModel {
            row.answer = search.answer(&screen, &row.term);
        }
        progress(done.fetch_add(1, Ordering::Relaxed) + 1, all);
    });
    let named_without = (0..question.trials)
        .into_par_iter()
        .filter(|&trial| {
            let output = trials.output(trial, &[], 0.0);
            close(&data.with_output(output), &solution.structure, |_| ())
                .is_ok_and(|ledger| !ledger.rounds.is_empty())
        })
        .count();
    Ok(Power {
        rows,
        trials: question.trials,
        named_without,
    })
}

/// The number of trials that is at least nine tenths of the given number.
fn needed(trials: usize) -> usize {
    (SHARE * trials as f64).ceil() as usize
}
