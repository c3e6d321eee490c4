//! The frame of every page: head, skip link, contents, sections, origin.

use bowden_lab::facts::Source;
use maud::{html, Markup, PreEscaped};

/// The colours and lines of figures, on a page and in a separate file.
pub const STYLE_OF_A_FIGURE: &str = include_str!("style_of_a_figure.css");
const STYLE_OF_A_PAGE: &str = include_str!("style_of_a_page.css");

/// The origin of a page.
#[derive(Debug, Clone)]
pub struct Provenance {
    /// The command line.
    pub command: String,
    /// The program's version.
    pub version: String,
    /// The files that were read.
    pub sources: Vec<Source>,
}

/// A section with an anchor.
pub(crate) struct Section {
    pub(crate) id: &'static str,
    pub(crate) title: &'static str,
    pub(crate) body: Markup,
}

/// The opening of a page.
pub(crate) struct Opening<'a> {
    /// The question and the record.
    pub(crate) title: String,
    /// The verdict's name and its class: good, mid or bad.
    pub(crate) verdict: Option<(&'a str, &'static str)>,
    /// The verdict in a sentence.
    pub(crate) sentence: String,
    /// What follows it.
    pub(crate) body: Markup,
}

/// A formatted number with its exact value for programs.
pub(crate) fn data(value: f64, shown: &str) -> Markup {
    html! { data value=(value) { (shown) } }
}

/// A table in a region that scrolls by itself and by the keyboard.
pub(crate) fn table(
    label: &str,
    head: &[&str],
    numbers: std::ops::Range<usize>,
    rows: &[Markup],
) -> Markup {
    html! {
        div class="wide" role="region" aria-label=(label) tabindex="0" {
            table {
                caption { (label) }
                thead { tr {
                    @for (k, name) in head.iter().enumerate() {
                        th scope="col" class=[numbers.contains(&k).then_some("number")] { (name) }
                    }
                } }
                tbody { @for row in rows { (row) } }
            }
        }
    }
}

/// A bar for a share that is also written as a number.
pub(crate) fn share_bar(share: f64) -> Markup {
    let width = format!("{:.1}%", 100.0 * share.clamp(0.0, 1.0));
    html! {
        svg class="share" aria-hidden="true" {
            rect class="rest" width="100%" height="100%" {}
            rect class="bar" width=(width) height="100%" {}
        }
    }
}

/// The whole page. Every element is closed, so that it reads as XML, too.
pub(crate) fn page(opening: &Opening<'_>, sections: &[Section], from: &Provenance) -> String {
    let drawn = html! {
        html lang="en" {
            head {
                (PreEscaped("<meta charset=\"utf-8\"/>"))
                (PreEscaped("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>"))
                (PreEscaped("<meta name=\"color-scheme\" content=\"light dark\"/>"))
                title { (opening.title) }
                style { (PreEscaped(STYLE_OF_A_FIGURE)) (PreEscaped(STYLE_OF_A_PAGE)) }
            }
            body {
                a class="skip" href="#main" { "Skip to the verdict" }
                header { h1 { (opening.title) } }
                main id="main" tabindex="-1" {
                    section id="verdict" aria-label="Verdict" {
                        p class="lead" { (opening.sentence) }
                        @if let Some((name, class)) = opening.verdict {
                            p { span class={ "badge " (class) } { (name) } }
                        }
                        (opening.body)
                    }
                    nav aria-label="Sections" { ul {
                        @for section in sections { li { a href={ "#" (section.id) } { (section.title) } } }
                        li { a href="#origin" { "How these results were obtained" } }
                    } }
                    @for section in sections {
                        section id=(section.id) aria-labelledby={ (section.id) "-head" } {
                            h2 id={ (section.id) "-head" } { (section.title) }
                            (section.body)
                        }
                    }
                    (origin(from))
                }
                footer { p { "bowden " (from.version) ". This page is self-contained. It loads nothing and runs no script." } }
            }
        }
    };
    format!("<!DOCTYPE html>\n{}\n", drawn.into_string())
}

fn origin(from: &Provenance) -> Markup {
    let rows: Vec<Markup> = from
        .sources
        .iter()
        .map(|source| {
            html! { tr {
                th scope="row" { (source.path) }
                td class="number" { (source.bytes) }
                td { code { (source.sha256) } }
            } }
        })
        .collect();
    html! {
        section id="origin" aria-labelledby="origin-head" {
            h2 id="origin-head" { "How these results were obtained" }
            pre tabindex="0" { code { (from.command) } }
            p { "Program: bowden " (from.version) "." }
            @if !rows.is_empty() { (table("Input files", &["file", "bytes", "SHA-256"], 1..2, &rows)) }
        }
    }
}
