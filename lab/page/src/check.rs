//! The page of `bowden validate`: a model on another record.

use crate::close::{loops_of_files, noise_of, of_files, over_all, parts};
use crate::document::{data, page, table, Opening, Provenance, Section};
use crate::words::{in_brackets, quantity};
use bowden_lab::facts::{number, percent, with_interval, CheckFacts, CheckVerdict, Figures};
use maud::{html, Markup};

/// What the page shows.
#[derive(Debug, Clone, Copy)]
pub struct Check<'a> {
    /// The file of the model.
    pub model: &'a str,
    /// The file of the record.
    pub record: &'a str,
    /// The result.
    pub facts: &'a CheckFacts,
    /// The signals and the tests of the residuals.
    pub figures: &'a Figures,
}

impl Check<'_> {
    /// The page.
    #[must_use]
    pub fn page(&self, from: &Provenance) -> String {
        let (facts, figures) = (self.facts, self.figures);
        let unit = facts.record.unit.as_deref();
        let section = |id, title, body| Section { id, title, body };
        let mut sections = vec![
            section("errors", "Errors", errors(facts)),
            section("signals", "Measured and model", signals(facts, figures)),
            section("loop", "Hysteresis loop", loops_of_files(&figures.signals)),
            section(
                "residual",
                "Residual versus each variable",
                over_all(figures, unit),
            ),
            section(
                "noise",
                "Is the residual noise?",
                noise_of(figures, unit, facts.record.cutoff),
            ),
            section("parts", "What each part adds", parts(figures)),
        ];
        if !(facts.outside.is_empty() && facts.depends_on.is_empty()) {
            sections.insert(1, section("reasons", "Why", reasons(facts)));
        }
        let opening = Opening {
            title: format!("bowden validate: {} on {}", self.model, self.record),
            verdict: Some((facts.verdict.name(), colour(facts.verdict))),
            sentence: facts.sentence.clone(),
            body: numbers(facts),
        };
        page(&opening, &sections, from)
    }
}

fn colour(verdict: CheckVerdict) -> &'static str {
    match verdict {
        CheckVerdict::Holds => "good",
        CheckVerdict::GainOrOffsetMoved | CheckVerdict::CannotTell => "mid",
        CheckVerdict::DoesNotHold | CheckVerdict::DefectiveRecord => "bad",
    }
}

/// The error where the model came from and here.
fn numbers(facts: &CheckFacts) -> Markup {
    let here = facts.rmse / facts.deviation;
    html! {
        dl class="numbers" {
            div id="held-out" {
                dt { "Held-out part of the model's own record → this record" }
                dd {
                    span class="was" {
                        @if let Some(own) = facts.reference { (data(own, &percent(own))) } @else { "unknown" }
                    }
                    " → "
                    span class="is" { (data(here, &percent(here))) }
                }
            }
        }
        p class="note" {
            "Nothing was refitted. Each error is the RMS residual of the filtered output, relative to the standard deviation of this output."
        }
    }
}

fn errors(facts: &CheckFacts) -> Markup {
    let record = &facts.record;
    let row = |name: String, rmse: f64| {
        let floors = record.floors(rmse);
        html! { tr {
            th scope="row" { (name) }
            td class="number" { (data(rmse, &number(rmse, Some(0.05 * rmse)))) }
            td class="number" { (percent(rmse / facts.deviation)) }
            td class="number" { (floors.map_or_else(|| "–".to_owned(), |f| format!("{f:.1}"))) }
        } }
    };
    let line = &facts.line;
    let fitted = format!(
        "with gain {} and offset {}{}",
        with_interval(line.gain.value, line.gain.ci95),
        with_interval(line.offset.value, line.offset.ci95),
        record
            .unit
            .as_deref()
            .map_or_else(String::new, |u| format!(" {u}"))
    );
    let rows = [
        row("unchanged".to_owned(), facts.rmse),
        row(fitted, facts.rmse_gain_offset),
    ];
    let rmse = format!("RMSE{}", in_brackets(record.unit.as_deref()));
    let head = ["", &rmse, "of the output's std", "vs noise"];
    html! {
        (table("Errors on this record", &head, 1..4, &rows))
        @if let Some(allowed) = facts.allowed {
            p class="note" {
                "The model holds up to an error of " (percent(allowed / facts.deviation)) ": " (facts.rule) "."
            }
        }
        @for note in &record.notes { p class="note" { (note) } }
        @for defect in &record.defects { p { b { "Defect. " } (defect.channel) ": " (defect.message) } }
    }
}

fn signals(facts: &CheckFacts, figures: &Figures) -> Markup {
    html! {
        @if facts.left_out > 0.0 {
            p {
                "The first " (format!("{:.1}", facts.left_out))
                " s are excluded, because the earlier input is unknown."
            }
        }
        (of_files(&figures.signals))
    }
}

fn reasons(facts: &CheckFacts) -> Markup {
    let pair = |[low, high]: [f64; 2]| {
        let digits = Some(0.01 * (high - low).abs());
        format!("{} to {}", number(low, digits), number(high, digits))
    };
    html! {
        @for one in &facts.depends_on {
            p {
                "The residual depends on " (one.words) ": a free-form curve removes "
                (format!("{:.0}", 100.0 * one.share)) " % of the squared error ("
                @if let Some(p) = one.p { "p " (format!("{p:.1e}")) } @else { "not tested: the correlation time of the residual is too long" }
                ")."
            }
        }
        @for one in &facts.outside {
            p {
                (quantity(&one.channel, one.unit.as_deref())) ": the " (one.quantity) " ranges from " (pair(one.here))
                ", but the fit covered " (pair(one.seen)) " (" (format!("{:.0}", 100.0 * one.share))
                " % of the samples are outside)."
            }
        }
    }
}
