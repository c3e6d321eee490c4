//! The page of `bowden compare`: the paper's Figures 7 to 10.

use crate::chart::scale::Scale;
use crate::chart::{Axis, Chart};
use crate::document::{data, page, table, Opening, Provenance, Section};
use bowden_trials::facts::{told_of_limits, Compared, Heading, Line, Results, Row};
use maud::{html, Markup};

/// What the page shows: comparisons under one or several configurations.
#[derive(Debug, Clone, Copy)]
pub struct Compare<'a> {
    /// Each was traced.
    pub compared: &'a [Compared],
}

/// The lines of one comparison, and the remarks on them.
struct Part<'a> {
    compared: &'a Compared,
    lines: Vec<Line>,
    configuration: &'static str,
}

/// Estimates of the adaptive law, as in Figure 10.
const ESTIMATES: [(&str, &str); 5] = [
    ("beta_hat", ""),
    ("delta_hat", "N·m"),
    ("theta_hat_1", ""),
    ("theta_hat_2", ""),
    ("theta_hat_3", ""),
];

impl Compare<'_> {
    /// The page.
    #[must_use]
    pub fn page(&self, from: &Provenance) -> String {
        let part = |compared| Part::new(compared);
        let parts: Vec<Part<'_>> = self.compared.iter().map(part).collect();
        let section = |id, title, body| Section { id, title, body };
        let each = |of: fn(usize, &Part<'_>) -> Markup| {
            html! { @for (k, part) in parts.iter().enumerate() {
                h3 { (part.head()) }
                (of(k, part))
            } }
        };
        let gait = self.compared.first().is_some_and(|c| c.heading.gait);
        let tracking = match gait {
            true => "Tracking: the last three steps, and all errors",
            false => "Tracking, as in Figures 7 and 8",
        };
        let sections = [
            section("errors", "Errors", each(|_, part| part.errors())),
            section("tracking", tracking, each(Part::tracking)),
            section(
                "transient",
                "The first seconds, as in Figure 9",
                each(Part::transient),
            ),
            section(
                "estimates",
                "Estimates, as in Figure 10",
                each(Part::estimates),
            ),
        ];
        let sentence = self.compared.first().map(Compared::sentence);
        let own = self.compared.first().map(|compared| own(&compared.heading));
        let opening = Opening {
            title: "bowden compare: controllers on the simulated rig".to_owned(),
            verdict: None,
            sentence: sentence.unwrap_or_default(),
            body: html! {
                @for sentence in own.unwrap_or_default() { p { (sentence) } }
                p class="note" {
                    "The plots correspond to Figures 7 to 10 of "
                    cite { "Direct Torque Control for Cable Conduit Mechanisms for the Robotic Foot for Footwear Testing" }
                    ", but the plant here is simulated. Each plot shows the trial with the first seed. The tables cover all seeds."
                }
            },
        };
        page(&opening, &sections, from)
    }
}

/// What is not the paper's, a sentence each.
fn own(heading: &Heading) -> Vec<String> {
    let model = heading
        .model
        .as_ref()
        .map(|model| format!("The reference rig has the transmission and the effects of {model}."));
    model.into_iter().chain(heading.own()).collect()
}

fn time(until: f64) -> Axis {
    between(0.0, until)
}

fn between(from: f64, until: f64) -> Axis {
    Axis {
        label: "time [s]".to_owned(),
        scale: Scale::exactly(from, until),
    }
}

fn error(row: &Row) -> f64 {
    row.tau_o - row.reference
}

impl<'a> Part<'a> {
    fn new(compared: &'a Compared) -> Self {
        Self {
            compared,
            lines: compared.traced(),
            configuration: match compared.heading.varying {
                true => "varying",
                false => "fixed",
            },
        }
    }

    fn head(&self) -> String {
        let heading = &self.compared.heading;
        let trials = match heading.seeds {
            1 => "1 trial".to_owned(),
            several => format!("{several} trials"),
        };
        format!(
            "Configuration {}, noise {} N·m rms, {} of {} s",
            self.configuration, heading.noise, trials, heading.seconds
        )
    }

    fn errors(&self) -> Markup {
        let heading = &self.compared.heading;
        let is_lineup = matches!(self.compared.results, Results::Lineup(_));
        let row = |line: &Line| {
            let cell = |mean: f64, sd: f64| data(mean, &format!("{mean:.4} ± {sd:.4}"));
            let own = heading.paper(&line.controller).filter(|_| is_lineup);
            html! { tr {
                th scope="row" { (line.controller) }
                @if let Some(at) = line.ran_away {
                    td class="number" colspan="3" { "diverged at " (format!("{at:.2}")) " s" }
                } @else {
                    td class="number" { (cell(line.rmse_true.mean, line.rmse_true.sd)) }
                    td class="number" { (cell(line.rmse_measured.mean, line.rmse_measured.sd)) }
                    td class="number" { (data(line.peak, &format!("{:.3}", line.peak))) }
                }
                td class="number" { (own.map_or_else(|| "–".to_owned(), |[m, sd]| format!("{m:.4} ± {sd:.4}"))) }
            } }
        };
        let rows: Vec<Markup> = self.lines.iter().map(row).collect();
        let label = format!(
            "Errors [N·m] after {} s, {}",
            heading.from, self.configuration
        );
        let head = [
            "controller",
            "rmse, true",
            "rmse, measured",
            "peak",
            "paper, Table 3",
        ];
        html! {
            (table(&label, &head, 1..5, &rows))
            @if let Some(told) = told_of_limits(&self.lines) { p { (told) } }
        }
    }

    /// The axis of all errors but those of laws that diverged.
    fn error_axis(&self, until: f64, from: f64) -> Axis {
        let good = self.lines.iter().filter(|line| line.ran_away.is_none());
        let rows = good.flat_map(|line| &line.first.trace);
        let own = rows.filter(|row| row.time >= from && row.time <= until);
        Axis {
            label: "error [N·m]".to_owned(),
            scale: Scale::linear(own.map(error)),
        }
    }

    /// The axis of a torque, as far as the laws that did not diverge need it.
    fn torque_axis(&self, until: f64, of: fn(&Row) -> [f64; 2]) -> Axis {
        let good = self.lines.iter().filter(|line| line.ran_away.is_none());
        let rows = good.flat_map(|line| &line.first.trace);
        Axis {
            label: "torque [N·m]".to_owned(),
            scale: Scale::linear(rows.filter(|row| row.time <= until).flat_map(of)),
        }
    }

    fn tracking(k: usize, part: &Part<'_>) -> Markup {
        let heading = &part.compared.heading;
        let (seconds, from) = (heading.seconds, heading.from.min(0.5 * heading.seconds));
        let output = part.torque_axis(seconds, |row| [row.reference, row.tau_o]);
        let errors = part.error_axis(seconds, from);
        let both = part.torque_axis(seconds, |row| [row.tau_i, row.tau_o]);
        let first = match heading.gait {
            // Three seconds of a gait can be seen step by step.
            true => seconds - 3.0,
            false => 0.0,
        };
        html! {
            @for (n, line) in part.lines.iter().enumerate() {
                h4 { (line.controller) }
                div class="grid-of" {
                    (following(&format!("follow-{k}-{n}"), line, between(first, seconds), output.clone()).figure())
                    (tracking_error(&format!("error-{k}-{n}"), line, time(seconds), errors.clone()).figure())
                    (torques(&format!("torques-{k}-{n}"), line, between(first, seconds), both.clone()).figure())
                }
            }
        }
    }

    fn transient(k: usize, part: &Part<'_>) -> Markup {
        let until = part.compared.heading.transient;
        let output = part.torque_axis(until, |row| [row.reference, row.tau_o]);
        let errors = part.error_axis(until, 0.0);
        html! {
            div class="grid-of pairs" {
                @for (n, line) in part.lines.iter().enumerate() {
                    (following(&format!("early-{k}-{n}"), line, time(until), output.clone()).figure())
                    (tracking_error(&format!("early-error-{k}-{n}"), line, time(until), errors.clone()).figure())
                }
            }
        }
    }

    fn estimates(k: usize, part: &Part<'_>) -> Markup {
        let adaptive = part.lines.iter().enumerate();
        let adaptive: Vec<(usize, &Line)> = adaptive
            .filter(|(_, line)| line.first.trace.iter().any(|row| row.estimates.is_some()))
            .collect();
        let seconds = part.compared.heading.seconds;
        let of = |which: usize| {
            let (name, unit) = ESTIMATES[which];
            let points = |line: &Line| -> Vec<[f64; 2]> {
                let rows = line.first.trace.iter();
                rows.filter_map(|row| Some([row.time, row.estimates?[which]]))
                    .collect()
            };
            let all: Vec<(usize, &Line, Vec<[f64; 2]>)> = adaptive
                .iter()
                .map(|(n, line)| (*n, *line, points(line)))
                .collect();
            let moves = all.iter().any(|(_, _, p)| p.iter().any(|p| p[1] != 0.0));
            let good = all.iter().filter(|(_, line, _)| line.ran_away.is_none());
            let y = Axis {
                label: match unit {
                    "" => name.to_owned(),
                    unit => format!("{name} [{unit}]"),
                },
                scale: Scale::linear(good.flat_map(|(_, _, p)| p.iter().map(|p| p[1]))),
            };
            let text = format!("{name} over time, {} configuration", part.configuration);
            let chart = Chart::new(
                &format!("estimate-{k}-{which}"),
                name,
                &text,
                time(seconds),
                y,
            )
            .low();
            let drawn = all.iter().fold(chart, |chart, (n, line, points)| {
                let class = format!("c{}", n % 7);
                chart
                    .line(&class, points.iter().copied())
                    .key(&class, &line.controller)
            });
            (moves, drawn)
        };
        let charts = (0..ESTIMATES.len()).map(of);
        let charts: Vec<Chart> = charts
            .filter_map(|(moves, chart)| moves.then_some(chart))
            .collect();
        html! {
            @if charts.is_empty() { p { "None of these control laws adapts." } }
            div class="grid-of" { @for chart in &charts { (chart.figure()) } }
        }
    }
}

fn line_of(line: &Line, of: fn(&Row) -> f64) -> impl Iterator<Item = [f64; 2]> + '_ {
    line.first.trace.iter().map(move |row| [row.time, of(row)])
}

fn following(id: &str, line: &Line, x: Axis, y: Axis) -> Chart {
    let title = format!("{}: output", line.controller);
    let text = format!("Reference and output torque with {}.", line.controller);
    Chart::new(id, &title, &text, x, y)
        .low()
        .line("reference", line_of(line, |row| row.reference))
        .line("final", line_of(line, |row| row.tau_o))
        .key("reference", "reference")
        .key("final", "output")
}

fn tracking_error(id: &str, line: &Line, x: Axis, y: Axis) -> Chart {
    let title = format!("{}: error", line.controller);
    let text = format!(
        "Output minus reference with {}. The rms is {:.4} N·m over the steady part.",
        line.controller, line.first.steady.rmse_true
    );
    Chart::new(id, &title, &text, x, y)
        .low()
        .level("zero", 0.0)
        .line("before", line_of(line, error))
        .key("before", "output − reference")
}

fn torques(id: &str, line: &Line, x: Axis, y: Axis) -> Chart {
    let title = format!("{}: both pulleys", line.controller);
    let text = format!("Proximal and distal torque with {}.", line.controller);
    Chart::new(id, &title, &text, x, y)
        .low()
        .line("before", line_of(line, |row| row.tau_i))
        .line("final", line_of(line, |row| row.tau_o))
        .key("before", "proximal")
        .key("final", "distal")
}
