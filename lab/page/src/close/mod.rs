//! The page of `bowden identify`: its sections in the order of a reader's questions.

mod ledger;
mod model;
mod residual;
mod signals;

use crate::document::{data, page, Opening, Provenance, Section};
use bowden_lab::facts::{percent, Facts, Figures, Handed, Verdict};
use maud::{html, Markup};

pub(crate) use ledger::parts;
pub(crate) use residual::{noise_of, over_all};
pub(crate) use signals::{
    hysteresis_loop, loops_of_files, of_files, residual_over_time, shares, trace,
};

/// What the page shows.
#[derive(Debug, Clone, Copy)]
pub struct Close<'a> {
    /// The results table.
    pub facts: &'a Facts,
    /// The signals and the tests of the residuals.
    pub figures: &'a Figures,
    /// The exported models; empty if there are none.
    pub models: &'a [Handed],
}

impl Close<'_> {
    /// The page.
    #[must_use]
    pub fn page(&self, from: &Provenance) -> String {
        let (facts, figures) = (self.facts, self.figures);
        let section = |id, title, body| Section { id, title, body };
        let mut sections = vec![
            section("loop", "Loop and residual", signals::loops(facts, figures)),
            section("ledger", "What is missing", ledger::section(facts, figures)),
        ];
        if let Some(unknown) = &facts.unknown {
            let body = residual::unknown(facts, unknown);
            sections.push(section("unknown", "The unmodelled dependence", body));
        }
        let blocks = ledger::blocks(facts, figures);
        sections.extend([
            section(
                "parameters",
                "The model",
                model::section(facts, self.models),
            ),
            section(
                "signals",
                "Signals over time",
                signals::section(facts, figures),
            ),
            section(
                "residual",
                "Residual versus each variable",
                residual::over_variables(facts, figures),
            ),
            section(
                "blocks",
                "Terms and their alternatives, block by block",
                blocks,
            ),
            section(
                "noise",
                "Is the residual noise?",
                residual::noise(facts, figures),
            ),
        ]);
        let badge = match facts.constrained() {
            Some(_) => format!("unconstrained model: {}", facts.verdict.name()),
            None => facts.verdict.name().to_owned(),
        };
        let opening = Opening {
            title: format!("bowden identify: {}", facts.label),
            verdict: Some((&badge, colour(facts))),
            sentence: facts.sentence.clone(),
            body: numbers(facts),
        };
        page(&opening, &sections, from)
    }
}

fn colour(facts: &Facts) -> &'static str {
    match facts.verdict {
        // What explains the record is not what is exported.
        Verdict::Explained if facts.constrained().is_none() => "good",
        Verdict::Explained
        | Verdict::StructuredResidual
        | Verdict::UnmodelledDependence
        | Verdict::Ambiguous
        | Verdict::Stopped
        | Verdict::UnderExcited => "mid",
        Verdict::NoInputDependence | Verdict::NotTransferable | Verdict::DefectiveRecord => "bad",
    }
}

/// The error before and after.
fn numbers(facts: &Facts) -> Markup {
    let shown = facts.shown();
    let (before, after) = (&facts.declared.nrmse, &shown.nrmse);
    let floors = facts.record.held_out_floors(shown.rmse.held_out);
    let unconstrained = facts.constrained().map(|_| &facts.last.nrmse);
    let name = if unconstrained.is_some() {
        "exported"
    } else {
        "final"
    };
    let pair = |before: f64, after: f64| {
        html! {
            span class="was" { (data(before, &percent(before))) }
            " → "
            span class="is" { (data(after, &percent(after))) }
        }
    };
    html! {
        dl class="numbers" {
            div id="held-out" {
                dt { "Error on held-out data (used neither for the fit nor for the selection)" }
                dd { (pair(before.held_out, after.held_out)) }
            }
            div id="fitted" {
                dt { "Error on the fitted data" }
                dd { (pair(before.fit, after.fit)) }
            }
            @if let Some(nrmse) = unconstrained {
                div id="unconstrained" {
                    dt { "Held-out error of the unconstrained model, which has no inverse" }
                    dd { (data(nrmse.held_out, &percent(nrmse.held_out))) }
                }
            }
            @if let Some(floors) = floors {
                div {
                    dt { "Held-out error of the " (name) " model, in multiples of the noise floor" }
                    dd { (format!("{floors:.1}")) }
                }
            }
        }
        p class="note" {
            "Baseline model → " (name) " model. Each error is the RMS residual of the filtered output, relative to the standard deviation of this output."
        }
    }
}
