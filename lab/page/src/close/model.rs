//! The parameters, ready to copy.

use crate::document::{data, table};
use crate::words::{unit, value};
use bowden_lab::facts::{percent, Facts, Form, Handed, Parameter};
use maud::{html, Markup};

pub(super) fn section(facts: &Facts, models: &[Handed]) -> Markup {
    let last = &facts.last;
    let row = |(parameter, title): (&Parameter, &String)| {
        html! { tr {
            th scope="row" { (title) }
            td class="number" { (data(parameter.value, &value(parameter))) }
            td { (unit(parameter)) }
            td {
                @if let Some(refused) = &parameter.refused { "to identify it: " (refused.excitation) }
            }
        } }
    };
    let rows: Vec<Markup> = last.parameters.iter().zip(&last.titles).map(row).collect();
    let texts = models.iter().map(|model| {
        let text = model
            .file(Form::Toml)
            .map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        text.unwrap_or_else(|because| format!("# {because}"))
    });
    let texts: Vec<String> = texts.collect();
    html! {
        (table("Parameters of the final model with 95 % intervals", &["parameter", "value", "unit", ""], 1..2, &rows))
        @match &facts.hand_over {
            Ok(handed) => {
                p {
                    "On a chip, sample by sample with causal velocities, the model errs by "
                    (percent(handed.causal.held_out)) " on held-out data; with those of the fit by "
                    (percent(handed.nrmse.held_out)) "."
                }
            }
            Err(because) => { p { "No model can be handed over: " (because) } }
        }
        @for (k, text) in texts.iter().enumerate() {
            h3 {
                "To copy: the model as TOML"
                @if texts.len() > 1 { ", file " (k + 1) }
            }
            p class="note" { code { "bowden check model.toml RECORD.csv" } " tells whether it still holds; firmware reads the same file." }
            pre tabindex="0" aria-label="The model as TOML" { code { (text) } }
        }
    }
}
