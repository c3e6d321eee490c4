//! Redundant parts of the baseline model.
//!
//! The criterion is size, not significance, because on a long record every part is significant.
//! Each part is removed from the final model and the others are refitted. If the error on held-out
//! data grows by less than a tenth, the part is redundant. Without its hysteresis a transmission is
//! a line, gain and offset; effects that read the hysteresis state and stages before it go with it.
//! Parts are judged one at a time: of two parts that can replace each other both are listed,
//! although one of them is needed.

use super::ballast::without_hysteresis;
use super::final_fit::FinalFit;
use super::intervals::term_name;
use crate::fit::{fit_from, Known, Solution};
use crate::ledger::Ledger;
use crate::problem::Prepared;
use crate::scale::PART;
use serde::Serialize;

/// A part of the baseline that the data do not need.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Unneeded {
    /// Its name; `bouc-wen` for the hysteresis.
    pub effect: String,
    /// RMSE on the held-out segment without it, the others refitted.
    pub held_out_without: f64,
    /// RMSE on the held-out segment with it.
    pub held_out_with: f64,
    /// Whether the final model omits it: the hysteresis, if it is redundant.
    pub removed: bool,
}

/// The parts of the baseline model without which the final model is as good.
#[must_use]
pub fn unneeded(ledger: &Ledger, done: &FinalFit) -> Vec<Unneeded> {
    use rayon::prelude::*;
    let (data, last) = (&done.data, &done.solution);
    let own = ledger.declared.structure.terms.len();
    let hysteresis = last.structure.hysteresis.then_some(None);
    let parts: Vec<Option<usize>> = hysteresis.into_iter().chain((0..own).map(Some)).collect();
    let judged: Vec<Option<Unneeded>> = parts
        .into_par_iter()
        .map(|part| {
            let without = match part {
                Some(term) => without_term(data, last, term),
                None => without_hysteresis(data, last),
            }?;
            let held_out_without = without.rmse.held_out;
            let name = |term: usize| term_name(data, &last.structure.terms[term]);
            (held_out_without < (1.0 + PART) * last.rmse.held_out).then(|| Unneeded {
                effect: part.map_or_else(|| "bouc-wen".to_owned(), name),
                held_out_without,
                held_out_with: last.rmse.held_out,
                removed: false,
            })
        })
        .collect();
    let hysteresis = done.without_hysteresis.map(|held_out_with| Unneeded {
        effect: "bouc-wen".to_owned(),
        held_out_without: done.rmse.held_out,
        held_out_with,
        removed: true,
    });
    hysteresis
        .into_iter()
        .chain(judged.into_iter().flatten())
        .collect()
}

fn without_term(data: &Prepared, full: &Solution, term: usize) -> Option<Solution> {
    let mut structure = full.structure.clone();
    structure.terms.remove(*structure.terms.ids().get(term)?);
    fit_from(data, &structure, Some(&Known::of(full)), 0.0)
}
