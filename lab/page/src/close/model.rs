//! The parameters, ready to copy.

use crate::document::{data, table};
use crate::words::{unit, value};
use bowden_lab::facts::{percent, Facts, FinalFacts, Form, Handed, Parameter};
use maud::{html, Markup};

/// The parameters of a model, with their intervals.
fn parameters(model: &FinalFacts, name: &str) -> Markup {
    let row = |(parameter, title): (&Parameter, &String)| {
        html! { tr {
            th scope="row" { (title) }
            td class="number" { (data(parameter.value, &value(parameter))) }
            td { (unit(parameter)) }
            td {
                @if let Some(refused) = &parameter.not_identified { "to identify it: " (refused.excitation) }
            }
        } }
    };
    let all = model.parameters.iter().zip(&model.titles);
    let rows: Vec<Markup> = all.map(row).collect();
    let caption = format!("Parameters of the {name} model with 95 % intervals");
    table(&caption, &["parameter", "value", "unit", ""], 1..2, &rows)
}

pub(super) fn section(facts: &Facts, models: &[Handed]) -> Markup {
    let texts = models.iter().map(|model| {
        let text = model
            .file(Form::Toml)
            .map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        text.unwrap_or_else(|because| format!("# {because}"))
    });
    let texts: Vec<String> = texts.collect();
    html! {
        p { code { (facts.equation()) } }
        @match facts.constrained() {
            Some(exported) => {
                (parameters(exported, "exported"))
                (parameters(&facts.last, "unconstrained"))
            }
            None => { (parameters(&facts.last, "final")) }
        }
        @match &facts.hand_over {
            Ok(handed) => {
                p {
                    "On a controller (sample by sample, with causal velocities) the held-out error of the model is "
                    (percent(handed.causal.held_out)) ". With the zero-phase velocities of the fit, the error is "
                    (percent(handed.nrmse.held_out)) ". As a feed-forward: " (handed.feed_forward.words()) "."
                }
            }
            Err(because) => { p { "No model can be exported: " (because) } }
        }
        @for (k, text) in texts.iter().enumerate() {
            details {
                summary {
                    "The model as TOML, to copy"
                    @if texts.len() > 1 { ", file " (k + 1) }
                }
                p class="note" { code { "bowden validate model.toml RECORD.csv" } " tests whether the model is still valid. Firmware reads the same file." }
                pre tabindex="0" aria-label="The model as TOML" { code { (text) } }
            }
        }
    }
}
