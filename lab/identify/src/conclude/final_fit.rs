//! The final model: the result of the search, with parameters fitted to all data not held out.
//!
//! During the search the selection segment tests each model, so no parameter may be fitted to it.
//! After the search it is data like the rest: a quarter more of them, next to the held-out segment.
//! The chosen model is therefore fitted again from its present parameters, on both segments. The
//! held-out segment stays unseen.

use super::ballast::{has_parts_of_hysteresis, without_hysteresis, Part};
use super::term_name::term_title;
use crate::fit::{refit, Segments, Solution};
use crate::ledger::{Ledger, Round};
use crate::model::structure::FitTerm;
use crate::problem::Prepared;
use crate::scale::TWENTIETH;

/// The model that is delivered.
#[derive(Debug, Clone)]
pub struct FinalFit {
    /// The record; its fit segment contains all data that the parameters were fitted to.
    pub data: Prepared,
    /// The model on this record: the source of the parameters, their intervals and the export.
    pub solution: Solution,
    /// Its errors on the segments of the search: only `held_out` is on unseen data.
    pub rmse: Segments,
    /// Whether the parameters were also fitted to the selection segment.
    pub refitted: bool,
    /// The held-out error with the hysteresis, if the hysteresis was redundant and is excluded.
    pub without_hysteresis: Option<f64>,
}

impl FinalFit {
    /// Fits the last model of a results table to the fit and selection segments together; if this
    /// fit is not better, the model remains unchanged. A redundant hysteresis is excluded.
    #[must_use]
    pub fn new(data: &Prepared, ledger: &Ledger) -> Self {
        let whole = Self::of(data, ledger.last());
        whole.without_ballast(data).unwrap_or(whole)
    }

    /// The model without its hysteresis, if the hysteresis is redundant, nothing else needs it, and
    /// the error without it does not rise by as much as an effect must gain to be worth a name.
    fn without_ballast(&self, data: &Prepared) -> Option<Self> {
        let part = Part::of(&self.data, &self.solution)?;
        if !part.is_cancelled() || has_parts_of_hysteresis(&self.solution) {
            return None;
        }
        let solution = without_hysteresis(&self.data, &self.solution)?;
        let gained = (solution.sse(&self.data) / self.solution.sse(&self.data)).ln();
        (gained < TWENTIETH).then(|| Self {
            rmse: Segments::of(data, &solution.residual),
            solution,
            without_hysteresis: Some(self.rmse.held_out),
            ..self.clone()
        })
    }

    /// The same for any solution.
    #[must_use]
    pub fn of(data: &Prepared, last: &Solution) -> Self {
        let wide = data.with_stop_fitted();
        let better = refit(&wide, last).filter(|one| {
            let error = |s: &Solution| Segments::of(&wide, &s.residual).fit;
            error(one) < error(last) && one.shapes_on_bound() <= last.shapes_on_bound()
        });
        match better {
            Some(solution) => Self {
                rmse: Segments::of(data, &solution.residual),
                refitted: true,
                without_hysteresis: None,
                solution,
                data: wide,
            },
            None => Self {
                rmse: last.rmse,
                refitted: false,
                without_hysteresis: None,
                solution: last.clone(),
                data: data.clone(),
            },
        }
    }

    /// Which term of the final model a round has added. Later rounds refine its shapes, so if two
    /// terms have the same effect and channel, it is the one with the nearest shapes. `None` if a
    /// later step removed the term.
    #[must_use]
    pub fn term_of(&self, round: &Round) -> Option<usize> {
        let own = round.term();
        let apart = |term: &FitTerm| -> f64 {
            let shapes = (0..term.effect.info().shapes.len()).filter_map(|i| {
                let (a, b) = (term.effect.shape(i)?, own.effect.shape(i)?);
                Some((a - b).powi(2) / (a * a + b * b).max(f64::MIN_POSITIVE))
            });
            shapes.sum()
        };
        let terms = self.solution.structure.terms.iter().enumerate();
        terms
            .filter(|(_, t)| t.effect.name() == own.effect.name() && t.source == own.source)
            .min_by(|(_, a), (_, b)| apart(a).total_cmp(&apart(b)))
            .map(|(index, _)| index)
    }

    /// The name of the term that a round has added, as in the final model.
    #[must_use]
    pub fn title_of(&self, round: &Round) -> String {
        let own = self.term_of(round);
        let term = own.and_then(|index| self.solution.structure.terms.get(index));
        term_title(&self.data, term.unwrap_or(round.term()))
    }
}
