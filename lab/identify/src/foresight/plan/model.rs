//! A fitted model on another motion: its columns, and the contribution of an effect.

use crate::fit::projection::{rows, Span};
use crate::fit::Solution;
use crate::model::columns::{effect_column, raw_columns, series_column, stage_column};
use crate::model::structure::{FitTerm, Free, Structure};
use crate::problem::{Prepared, Stretch};
use bowden::effect::Quantity;
use nalgebra::DVector;

/// A model with all its values, apart from any record.
#[derive(Clone)]
pub(super) struct Model {
    structure: Structure,
    free: Vec<Free>,
    values: Vec<f64>,
    gains: Vec<f64>,
}

/// The model on a motion.
pub(super) struct Placed<'a> {
    data: &'a Prepared,
    model: Model,
    eta: Vec<f64>,
    /// The prediction on the work grid.
    output: Vec<f64>,
    /// Linear columns, then the slopes in the free parameters, through the filter.
    pub(super) columns: Vec<Stretch>,
    /// All that the model can move.
    pub(super) span: Span,
}

/// An effect in addition to a model on a motion.
pub(super) struct Beside {
    /// What it adds for a gain of one that the model cannot imitate, on the rows of the fit
    /// segment.
    pub(super) own: DVector<f64>,
    /// All that the model with it can move, its shapes and origin included.
    pub(super) span: Span,
}

impl Model {
    /// The complete fitted model.
    pub(super) fn whole(solution: &Solution) -> Self {
        Self {
            structure: solution.structure.clone(),
            free: solution.free.clone(),
            values: solution.values.clone(),
            gains: solution.gains.clone(),
        }
    }

    /// A fitted model before its last term came in, with the values that it has now.
    pub(super) fn before_last(solution: &Solution) -> Option<Self> {
        let mut model = Self::whole(solution);
        let last = *model.structure.terms.ids().last()?;
        let gone = model.structure.terms.remove(last)?;
        if gone.is_linear() {
            let linear = model.gains.len() - model.structure.table_gains();
            model.gains.remove(linear.checked_sub(1)?);
        }
        let kept = solution.free.iter().zip(&solution.values);
        let kept = kept.filter(|(f, _)| f.role.term() != Some(last));
        (model.free, model.values) = kept.map(|(f, v)| (*f, *v)).unzip();
        Some(model)
    }

    /// The model along a motion.
    pub(super) fn on<'a>(&self, data: &'a Prepared) -> Option<Placed<'a>> {
        let raw = raw_columns(data, &self.structure, &self.free, &self.values)?;
        let moves = raw.moves(data, &self.structure, &self.free, &self.values)?;
        let tangents = raw.tangents(&moves, &self.gains);
        let all: Vec<&Stretch> = raw.columns.iter().map(|c| &**c).chain(&tangents).collect();
        let columns = data.filtered_stretches(&all);
        let output = raw.output(&self.gains);
        Some(Placed {
            span: Span::of(data, columns.iter()),
            data,
            model: self.clone(),
            eta: raw.eta,
            output,
            columns,
        })
    }
}

impl Placed<'_> {
    /// What an effect adds for a gain of one, on the rows of the fit segment.
    pub(super) fn column(&self, term: &FitTerm) -> Option<DVector<f64>> {
        let raw = if term.effect.is_output_stage() {
            stage_column(self.data, &term.effect, &self.output)
        } else if term.effect.is_input_stage() {
            let model = &self.model;
            let at = (model.free.as_slice(), model.values.as_slice());
            series_column(self.data, &model.structure, at, &model.gains, term)?
        } else {
            effect_column(self.data, term, &self.eta)?
        };
        Some(rows(self.data, &self.data.filtered(&raw)))
    }

    /// An effect in addition to the model.
    pub(super) fn beside(&self, term: &FitTerm) -> Option<Beside> {
        let column = self.column(term)?;
        Some(Beside {
            own: self.span.off(column.clone()),
            span: self.span_with(term, column)?,
        })
    }

    /// All that the model with that effect can move, its shapes and origin included.
    fn span_with(&self, term: &FitTerm, column: DVector<f64>) -> Option<Span> {
        let mut span = self.span.clone();
        span.add(column);
        for index in 0..term.effect.info().shapes.len() {
            let value = term.effect.shape(index)?;
            let h = 1e-4 * value.abs().max(1e-6);
            let at = |v: f64| {
                let effect = term.effect.with_shape(index, v).ok()?;
                self.column(&FitTerm { effect, ..*term })
            };
            if let (Some(up), Some(down)) = (at(value + h), at(value - h)) {
                span.add(up - down);
            }
        }
        if term.effect.info().reads.contains(&Quantity::Position) {
            let h = 1e-4 * self.data.channel(term.source)?.reach;
            let at = |origin: f64| self.column(&FitTerm { origin, ..*term });
            span.add(at(term.origin + h)? - at(term.origin - h)?);
        }
        Some(span)
    }
}
