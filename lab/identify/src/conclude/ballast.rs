//! A redundant hysteresis: over the record its state is a linear function of the input, and its
//! gain is large only because the gains of a spring and an offset cancel it.
//!
//! Such a part explains nothing, and outside the recorded motion the gains no longer cancel.

use crate::algebra::line;
use crate::fit::{fit_from, Known, Segments, Solution};
use crate::model::declared::declared;
use crate::model::structure::{FitTerm, Structure};
use crate::model::{Table, Variable};
use crate::problem::Prepared;
use crate::scale::TRACE;
use bowden::model::Source;

/// The part of a hysteresis, and how much of it spring and offset cannot imitate.
pub(super) struct Part {
    /// RMS of the part on the fit segment, in standard deviations of the output there.
    size: f64,
    /// The same for the remainder that spring and offset cannot imitate.
    pub(super) own: f64,
}

impl Part {
    /// `None` without hysteresis, and if each file has its own gains.
    pub(super) fn of(data: &Prepared, solution: &Solution) -> Option<Self> {
        let structure = &solution.structure;
        if !structure.hysteresis || structure.own_gains > 0 {
            return None;
        }
        let rows = &data.split.fit;
        let (input, eta) = (&solution.columns[0], &solution.columns[1]);
        let points = rows.iter().map(|&row| (input[row], eta[row]));
        let (slope, offset) = line(points.clone());
        let output = Segments::deviation(data, &data.target).fit;
        let size = |of: &dyn Fn((f64, f64)) -> f64| {
            let squares = points.clone().map(|point| of(point).powi(2));
            let rms = (squares.sum::<f64>() / rows.len().max(1) as f64).sqrt();
            solution.gains[1].abs() * rms / output
        };
        Some(Self {
            size: size(&|(_, eta)| eta),
            own: size(&|(x, eta)| eta - slope * x - offset),
        })
    }

    /// Whether the part is larger than the output, and spring and offset cancel nearly all of it.
    /// The gains of a smaller part are harmless.
    pub(super) fn is_cancelled(&self) -> bool {
        self.size > 1.0 && self.own < TRACE * self.size
    }

    /// Whether almost none of the output is due to the hysteresis alone.
    pub(super) fn is_ballast(&self) -> bool {
        self.is_cancelled() && self.own < TRACE
    }
}

/// Whether a model has parts that must be removed with its hysteresis.
pub(super) fn has_parts_of_hysteresis(solution: &Solution) -> bool {
    let structure = &solution.structure;
    structure.table.as_ref().is_some_and(is_over_eta) || structure.terms.iter().any(goes_with)
}

fn is_over_eta(table: &Table) -> bool {
    table.variable == Variable::Eta
}

/// Whether an effect has no meaning without hysteresis.
fn goes_with(term: &FitTerm) -> bool {
    term.effect.reads_eta() || term.effect.is_input_stage()
}

/// The model as a line (gain and offset), without the terms that read the hysteresis state.
pub(super) fn without_hysteresis(data: &Prepared, full: &Solution) -> Option<Solution> {
    let mut structure = full.structure.clone();
    structure.hysteresis = false;
    if structure.table.as_ref().is_some_and(is_over_eta) {
        structure.table = None;
    }
    structure.terms.retain(|t| !goes_with(t));
    for name in ["offset", "stiffness-linear"] {
        add_to_input(data, &mut structure, name)?;
    }
    fit_from(data, &structure, Some(&Known::of(full)), 0.0)
}

fn add_to_input(data: &Prepared, structure: &mut Structure, name: &str) -> Option<()> {
    let mut terms = structure.terms.iter();
    if !terms.any(|t| t.effect.name() == name && t.source == Source::Input) {
        let mut term = declared(name, data).ok()?;
        term.source = Source::Input;
        term.origin = data.input.origin;
        structure.terms.push(term);
    }
    Some(())
}
