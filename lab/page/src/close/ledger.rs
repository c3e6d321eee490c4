//! The results table: errors term by term, terms, parts, and rejected effects.

use crate::chart::scale::Scale;
use crate::chart::{Axis, Chart};
use crate::document::{data, share_bar, table};
use crate::words::{in_brackets, quantity, unit, value};
use bowden_lab::facts::{
    across, number, percent, Across, Experiment, Facts, Figures, Grade, Lack, Parameter,
    RoundFacts, Segments, Share, Size, BLOCKS,
};
use maud::{html, Markup};

/// The remark on a coefficient whose interval contains zero.
const SIZE_UNKNOWN: &str = "present, size unknown";

fn grade(grade: Grade) -> &'static str {
    match grade {
        Grade::High => "high",
        Grade::Low => "low",
    }
}

/// The cells fit, stop, held out, and held out in noise floors.
fn errors(facts: &Facts, rmse: &Segments) -> Markup {
    let cell = |v: f64| data(v, &number(v, Some(0.05 * v)));
    let floors = facts.record.held_out_floors(rmse.held_out);
    html! {
        td class="number" { (cell(rmse.fit)) }
        td class="number" { (cell(rmse.selection)) }
        td class="number" { (cell(rmse.held_out)) }
        td class="number" { (floors.map_or_else(|| "–".to_owned(), |f| format!("{f:.1}"))) }
    }
}

fn label(text: &str, facts: &Facts, rmse: &Segments) -> Markup {
    html! { tr { th scope="row" { (text) } td {} td {} (errors(facts, rmse)) } }
}

fn round(k: usize, round: &RoundFacts, facts: &Facts) -> Markup {
    let beyond = k >= facts.rounds.len();
    let number = if beyond {
        format!("({})", k + 1)
    } else {
        format!("+{}", k + 1)
    };
    html! { tr class=[beyond.then_some("beyond")] {
        th scope="row" { (number) " " (round.title) @if round.raises_held_out { " ↑" } }
        td { (grade(round.grade)) }
        td class="number" {
            (share_bar(round.explained))
            (data(round.explained, &format!("{:.1} %", 100.0 * round.explained)))
        }
        (errors(facts, &round.after))
    } }
}

fn all(facts: &Facts) -> impl Iterator<Item = (usize, &RoundFacts)> {
    facts.rounds.iter().chain(&facts.beyond).enumerate()
}

/// The section on rounds, names and parts.
pub(super) fn section(facts: &Facts, figures: &Figures) -> Markup {
    let unit = facts.record.unit.as_deref();
    let mut rows = vec![label("baseline", facts, &facts.declared.rmse)];
    rows.extend(all(facts).map(|(k, one)| round(k, one, facts)));
    if facts.last.refitted {
        rows.push(label("final (refitted)", facts, &facts.last.rmse));
    }
    if let Some(exported) = facts.constrained() {
        rows.push(label("exported (--invertible)", facts, &exported.rmse));
    }
    let caption = format!(
        "Errors{}: RMS residual of the filtered output",
        in_brackets(unit)
    );
    let head = [
        "",
        "confidence",
        "removes",
        "fit",
        "selection",
        "held-out",
        "vs noise",
    ];
    html! {
        (mechanisms(facts))
        p { "Baseline: " (facts.declared.effects.join(", ")) "." }
        div class="errors" { (table(&caption, &head, 2..7, &rows)) }
        p class="note" {
            "Removes: share of the squared error on the fit segment that the term removes. Vs noise: held-out error in multiples of the sensor noise. Confidence refers to the choice of the term, not to its coefficient."
            @if !facts.beyond.is_empty() { " In brackets: found, but not in the final model." }
            @if facts.rounds.iter().any(|r| r.raises_held_out) { " ↑: the term raises the held-out error." }
        }
        (names(facts))
        (parts(figures))
        p class="note" { "The sum of the parts is the " (figures.signals.models[1].name) " model. Parts that cancel may each be larger than the sum." }
        (turned_down(facts))
    }
}

/// What the missing output depends on.
fn mechanisms(facts: &Facts) -> Markup {
    if facts.lacks.is_empty() {
        return html! {};
    }
    let row = |lack: &Lack| {
        html! { tr {
            th scope="row" { (lack.title) }
            td { (grade(lack.confidence)) }
            td class="number" {
                (share_bar(lack.share.alone.value))
                (share(lack.share.alone))
            }
            td class="number" { (share(lack.share.beyond_others)) }
            td {
                (lack.members.join(", "))
                @for other in &lack.described_by { br; "or " (other.words()) }
            }
        } }
    };
    let rows: Vec<Markup> = facts.lacks.iter().map(row).collect();
    let head = [
        "",
        "confidence",
        "by itself",
        "added to the others",
        "terms",
    ];
    let charts = facts.lacks.iter().enumerate();
    let charts: Vec<Markup> = charts
        .filter_map(|(k, lack)| curve(facts, k, lack))
        .collect();
    html! {
        (table("Missing mechanisms", &head, 2..4, &rows))
        p class="note" {
            "By itself / added to the others: share of the baseline's squared error that the mechanism removes on half of the record, after a fit to the other half. The brackets give the quartiles over twenty halves."
        }
        div class="grid-of" { @for chart in &charts { (chart) } }
        p class="note" {
            "Each figure shows the contribution of the mechanism to the output, plus the residual of the model with all mechanisms. The 95 % intervals are valid for the motion of this record."
        }
        (files_alone(facts))
    }
}

/// Which mechanisms each of several files supports by itself.
fn files_alone(facts: &Facts) -> Markup {
    let all = across(&facts.lacks, &facts.files_alone);
    let head: Vec<&str> = std::iter::once("")
        .chain(all.iter().map(|one| one.title))
        .collect();
    let row = |name: &str, cells: Vec<&str>| {
        html! { tr { th scope="row" { (name) } @for cell in &cells { td { (cell) } } } }
    };
    let joint = |one: &Across| {
        let own = facts.lacks.iter().find(|lack| lack.title == one.title);
        own.map_or("–", |lack| grade(lack.confidence))
    };
    let mut rows = vec![row("all files together", all.iter().map(joint).collect())];
    for file in &facts.files_alone {
        let of = |one: &Across| {
            let own = one.files.iter().find(|(path, _)| *path == file.path);
            own.map_or("too short", |(_, confidence)| confidence.map_or("–", grade))
        };
        rows.push(row(&file.path, all.iter().map(of).collect()));
    }
    html! {
        @if !facts.files_alone.is_empty() {
            (table("Confidence of each mechanism in each individual file", &head, 0..0, &rows))
        }
    }
}

/// A share with its quartiles.
fn share(share: Share) -> Markup {
    let [value, low, high] =
        [share.value, share.quartiles[0], share.quartiles[1]].map(|s| 100.0 * s);
    data(
        share.value,
        &format!("{value:.1} % ({low:.0} to {high:.0})"),
    )
}

/// The contribution of a mechanism over its variable; `None` if it cannot be drawn.
fn curve(facts: &Facts, k: usize, lack: &Lack) -> Option<Markup> {
    let points = &lack.curve.points;
    let all: Vec<_> = points
        .iter()
        .map(|knot| ([knot.at, knot.value], knot.ci95))
        .collect();
    let ends = points
        .iter()
        .flat_map(|knot| knot.ci95.unwrap_or([knot.value; 2]));
    let y = Axis {
        label: quantity("added output", facts.record.unit.as_deref()),
        scale: Scale::linear(ends),
    };
    let x = Axis {
        label: quantity(&lack.curve.over, lack.curve.unit.as_deref()),
        scale: Scale::linear(points.iter().map(|knot| knot.at)),
    };
    let description = format!(
        "Contribution of {} to the output, with 95 % intervals.",
        lack.title
    );
    (points.len() > 1).then(|| {
        Chart::new(&format!("mechanism-{k}"), &lack.title, &description, x, y)
            .low()
            .level("zero", 0.0)
            .dots("final", &all)
            .figure()
    })
}

fn names(facts: &Facts) -> Markup {
    if facts.rounds.is_empty() {
        return html! { p { "No effect was added." } };
    }
    let row = |round: &RoundFacts| {
        let size = match &round.size {
            Size::Gain(gain) if holds_zero(gain) => html! { (SIZE_UNKNOWN) },
            Size::Gain(gain) => html! { (data(gain.value, &value(gain))) " " (unit(gain)) },
            Size::Width(width) => {
                html! { "r = " (data(width.value, &value(width))) " " (unit(width)) }
            }
            Size::Gone => html! { "–" },
        };
        html! { tr {
            th scope="row" { (round.title) }
            td { (grade(round.grade)) }
            td class="number" { (size) }
            td class="number" { @if let Some(p) = round.p { (data(p, &format!("{p:.1e}"))) } @else { "–" } }
            td class="number" { (round.blocks_better) " of " (BLOCKS) }
        } }
    };
    let rows: Vec<Markup> = facts.rounds.iter().map(row).collect();
    let head = [
        "effect",
        "confidence",
        "coefficient (95 %)",
        "p",
        "blocks improved",
    ];
    let caption = match facts.constrained() {
        Some(_) => "Terms of the exported model",
        None => "Terms of the final model",
    };
    html! {
        (table(caption, &head, 2..5, &rows))
        p class="note" {
            "p: probability that chance alone gives an improvement at least this large. Blocks improved: blocks on which the effect reduces the error."
        }
    }
}

fn holds_zero(parameter: &Parameter) -> bool {
    parameter
        .ci95
        .is_some_and(|[low, high]| low <= 0.0 && high >= 0.0)
}

/// The parts of the final model with their size.
pub(crate) fn parts(figures: &Figures) -> Markup {
    let parts = &figures.signals.parts;
    let largest = parts
        .iter()
        .map(|p| p.share)
        .fold(f64::MIN_POSITIVE, f64::max);
    let rows: Vec<Markup> = parts
        .iter()
        .map(|part| {
            html! { tr {
                th scope="row" { (part.signal.name) }
                td { (share_bar(part.share / largest)) (data(part.share, &percent(part.share))) }
            } }
        })
        .collect();
    table(
        "Standard deviation of each part of the model, relative to the standard deviation of the output",
        &["part", "share"],
        2..2,
        &rows,
    )
}

fn turned_down(facts: &Facts) -> Markup {
    html! {
        @if !facts.unneeded.is_empty() {
            h3 { "Redundant in the baseline model" }
            ul { @for part in &facts.unneeded {
                li { (part.effect) ": held-out error " (number(part.held_out_without, Some(0.01 * part.held_out_without)))
                    " without it, " (number(part.held_out_with, Some(0.01 * part.held_out_with))) " with it"
                    @if part.removed { "; excluded from the final model" } }
            } }
        }
        @if !facts.rejected.is_empty() {
            h3 { "Tried and rejected" }
            ul { @for one in &facts.rejected { li { (one.title) ": " (one.gate.words()) } } }
        }
    }
}

/// The effect of each term on each block, and its alternatives.
pub(super) fn blocks(facts: &Facts, figures: &Figures) -> Markup {
    html! {
        @if figures.blocks.is_empty() {
            p { "No effect was added, so there is no block-by-block comparison." }
        } @else {
            p {
                "The fit segment is divided into " (BLOCKS) " blocks of equal travel. Each bar is the share of the block's squared error "
                "that the term removes. A negative bar means that the term adds error. A real effect reduces the error of almost every block."
            }
        }
        div class="grid-of" {
            @for ((k, round), scores) in all(facts).zip(&figures.blocks) {
                (block_chart(k, round, &scores.removed).figure())
            }
        }
        @for round in facts.rounds.iter().filter(|r| !r.rivals.is_empty()) {
            p {
                b { (round.title) } " cannot be distinguished from "
                @for (k, rival) in round.rivals.iter().enumerate() { @if k > 0 { ", " } b { (rival.title) } }
                " on this record."
                @if let Some(experiment) = &round.experiment {
                    " To separate it from "
                    @for (k, rival) in rivals_of(experiment).enumerate() { @if k > 0 { ", " } b { (rival) } }
                    ": " (experiment.trajectory)
                }
            }
        }
        @if !facts.rounds.is_empty() && facts.rounds.iter().all(|r| r.rivals.is_empty()) {
            p { "No other effect in the catalogue explains as much as one of these terms." }
        }
    }
}

/// The alternatives that an experiment separates from the named effect, possibly not all of them.
fn rivals_of(experiment: &Experiment) -> impl Iterator<Item = &str> {
    experiment
        .aims
        .iter()
        .filter_map(|aim| aim.rival.as_deref())
}

fn block_chart(k: usize, round: &RoundFacts, removed: &[f64; BLOCKS]) -> Chart {
    // A block that a round spoils would take up the axis.
    let shown = removed.map(|share| 100.0 * share.max(-1.0));
    let x = Axis {
        label: "block".to_owned(),
        scale: Scale::counting(BLOCKS),
    };
    let y = Axis {
        label: "squared error removed [%]".to_owned(),
        scale: Scale::linear(shown.into_iter().chain([0.0, 100.0])),
    };
    let better = removed.iter().filter(|s| **s > 0.0).count();
    let description = format!(
        "{} reduces the squared error on {better} of {BLOCKS} blocks.",
        round.title
    );
    let rivals: Vec<&str> = round.rivals.iter().map(|r| r.title.as_str()).collect();
    let caption = match rivals.is_empty() {
        true => format!("{better} of {BLOCKS}; no alternative"),
        false => format!("{better} of {BLOCKS}; alternatives: {}", rivals.join(", ")),
    };
    let points: Vec<[f64; 2]> = shown
        .iter()
        .enumerate()
        .map(|(block, share)| [(block + 1) as f64, *share])
        .collect();
    Chart::new(&format!("blocks-{k}"), &round.title, &description, x, y)
        .low()
        .bars("bar", 0.7, &points)
        .level("zero", 0.0)
        .caption(&caption)
}
